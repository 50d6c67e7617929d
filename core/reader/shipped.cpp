// SPDX-License-Identifier: MIT
#include "core/reader/shipped.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <filesystem>

#include "base/text/error.h"
#include "base/text/text.h"
#include "core/file_kind.h"
#include "core/reader/text.h"

namespace wholehand {
namespace fs = std::filesystem;

namespace {

// The program, the shared library or the Python module that contains this code. Empty if the system does not say.
fs::path file_of_this_code() {
  std::error_code failed;
  Dl_info info;
  link_map* map = nullptr;
  const auto* here = reinterpret_cast<const void*>(&file_of_this_code);
  const bool is_known = dladdr1(here, &info, reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP) != 0 && map;
  const std::string loaded = is_known && map->l_name ? map->l_name : "";  // empty for a program
  const fs::path file = loaded.empty() ? fs::read_symlink("/proc/self/exe", failed) : fs::absolute(loaded, failed);
  return failed ? fs::path() : file;
}

// The folder whose share/ belongs to a file of this code in `folder`; only in places where packages put one. A share/ further up belongs to nobody.
// Empty: it is in no such place.
fs::path prefix_of(const fs::path& folder) {
  const fs::path above = folder.parent_path(), second = above.parent_path(), third = second.parent_path();
  if (folder.filename() == "bin" || folder.filename() == "lib") return above;
  if (above.filename() == "lib") return second;  // lib/x86_64-linux-gnu
  // lib/python3/dist-packages/wholehand
  const std::string packages = above.filename().string(), python = second.filename().string();
  if (packages.ends_with("-packages") && python.starts_with("python3") && third.filename() == "lib") return third.parent_path();
  return {};
}

}  // namespace

std::string scenes_dir() {
  std::vector<fs::path> candidates;
  const fs::path folder = file_of_this_code().parent_path();
  if (!folder.empty()) {
    candidates.push_back(folder / "share/wholehand/scenes");  // a Python module that pip installed has its own
    const fs::path prefix = prefix_of(folder);
    if (!prefix.empty()) candidates.push_back(prefix / "share/wholehand/scenes");
  }
  // a build folder lies in its source tree, or has a link to the scenes; tests' programs are one folder below it
  constexpr int LEVELS = 4;
  fs::path above = folder;
  for (int level = 0; level <= LEVELS && above.has_relative_path(); ++level, above = above.parent_path())
    candidates.push_back(above / "examples/scenes");
  // for a program of others, which lies somewhere else than the package
  for (const char* system : {"/usr/local/share/wholehand/scenes", "/usr/share/wholehand/scenes"}) candidates.emplace_back(system);
  std::error_code failed;
  for (const fs::path& candidate : candidates) {
    if (fs::is_regular_file(candidate / (std::string(DEFAULT_SCENE) + ".toml"), failed)) return candidate.string();
  }
  return "";
}

std::vector<std::string> shipped_scenes() {
  std::vector<std::string> names;
  std::error_code failed;
  const std::string dir = scenes_dir();
  if (dir.empty()) return names;
  for (const auto& entry : fs::directory_iterator(dir, failed)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> extreme_scene_files() {
  std::vector<std::string> files;
  std::error_code failed;
  const std::string dir = scenes_dir();
  if (dir.empty()) return files;
  for (const auto& entry : fs::directory_iterator(fs::path(dir).parent_path() / "extreme", failed)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string find_scene(const std::string& name) {
  const std::string dir = scenes_dir();
  std::error_code failed;
  if (name.empty()) {
    if (dir.empty())
      throw failure_error(fmt::format(
          "the shipped scene '{}' is missing where the program was built or installed; give a scene file", DEFAULT_SCENE));
    return (fs::path(dir) / (std::string(DEFAULT_SCENE) + ".toml")).string();
  }
  if (fs::exists(name, failed) && !fs::is_directory(name, failed)) return name;
  if (!dir.empty() && name.find('/') == std::string::npos) {
    for (const std::string& file : {name, name + ".toml"}) {
      if (fs::is_regular_file(fs::path(dir) / file, failed)) return (fs::path(dir) / file).string();
    }
  }
  if (fs::is_directory(name, failed)) throw usage_error(fmt::format("{} is a directory; give a scene file", in_quotes(name)));
  const auto shipped = shipped_scenes();
  throw usage_error(fmt::format("no scene file {}{}{}; give the path of a TOML file{}{}", in_quotes(name),
                                did_you_mean(name, shipped), backslash_note(name),
                                shipped.empty() ? "" : " or one of the shipped scenes: ", joined(shipped, ", ")));
}

}  // namespace wholehand
