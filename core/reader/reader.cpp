// SPDX-License-Identifier: MIT
#include "core/reader/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/text/error.h"
#include "core/file_kind.h"
#include "core/reader/parts.h"
#include "core/reader/scan.h"

namespace wholehand {
namespace {

toml::table parse_table(const SceneFile& file, std::string_view text, const std::string& name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    const auto begin = error.source().begin;
    std::string what;
    for (const char c : error.description()) what += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    constexpr std::size_t LARGEST = 300;
    if (what.size() > LARGEST) what = what.substr(0, LARGEST) + "...";
    const bool is_escape = what.find("escape sequence") != what.npos || what.find("unicode scalar sequence") != what.npos;
    file.refuse({static_cast<int>(begin.line), static_cast<int>(begin.column)}, what,
                fmt::format("allowed: TOML 1.0{}{}", is_escape ? "; " : "", is_escape ? WRITE_SLASHES : ""));
  }
}

std::string stem_of(const std::string& name) {
  std::string stem;
  for (const char c : std::filesystem::path(name).stem().string())
    stem += static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? '?' : c;
  return stem.substr(0, ranges::LARGEST_NAME);
}

void read_scene(const SceneTable& root, Scene& scene) {
  if (const auto table = root.table("scene", {"name", "pose", "gravity_m_s2"})) {
    table->read_text("name", ranges::LARGEST_NAME, scene.name);
    if (scene.name.find('/') != std::string::npos) {
      root.file().refuse(table->place("name"), "name = " + in_quotes(scene.name), "allowed: a name without '/'");
    }
    table->read("pose", {{"articulated", Pose::articulated}, {"paper", Pose::paper}, {"rigged", Pose::rigged}}, scene.pose);
    table->read("gravity_m_s2", ranges::GRAVITY, scene.gravity);
  }
  read_hand(root, scene.hand);
  read_vessels(root, scene);
  read_liquid(root, scene.liquid);
  check_vessels(root, scene);
  set_vessel_fills(root, scene);
  read_force(root, scene.force);
  read_strength(root, scene.strength);
  const bool has_mesh =
      std::any_of(scene.vessels.begin(), scene.vessels.end(), [](const VesselData& vessel) { return vessel.mesh.has_value(); });
  read_grips(root, has_mesh, scene.grips);
  read_tilts(root, scene);
  read_score(root, !scene.tilts.empty(), scene.score);
  read_output(root, scene.output);
  read_tabletop(root, scene.vessels, scene.table);
  read_arm(root, scene.hand.handedness, scene.arm);
  read_robust(root, scene.robust);
  read_people(root, scene.people);
  read_live(root, scene.strength.has_value(), scene.live);
  read_device(root, scene.device);
  read_task(root, scene.vessels, scene.task);
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& name) {
  const SceneFile file(name);
  static_assert(ranges::LARGEST_FILE == 1 << 20, "as the line below says");
  if (text.size() > ranges::LARGEST_FILE) {
    file.refuse({}, "more than 1,048,576 bytes", "allowed: a scene of at most 1 MiB");
  }
  scan_scene(file, text);
  const toml::table table = parse_table(file, text, name);
  Scene scene;
  scene.name = stem_of(name);
  scene.file = name;
  scene.text = text;
  const SceneTable root(file, table, "the scene",
                        {"scene", "hand", "vessel", "liquid", "force", "strength", "grips", "tilts", "score", "output", "table",
                         "arm", "robust", "people", "live", "device", "task"});
  scene.strength.emplace();
  read_scene(root, scene);
  return scene;
}

Scene read_scene_file(const std::string& path) {
  const std::string shown = in_quotes(path);
  std::error_code failed;
  const auto status = std::filesystem::status(path, failed);
  if (!std::filesystem::exists(status))
    throw usage_error(fmt::format("no scene file {}{}; give the path of a TOML file", shown, backslash_note(path)));
  if (std::filesystem::is_directory(status))
    throw usage_error(fmt::format("{} is a directory; give the path of a scene file", shown));
  std::ifstream stream(path, std::ios::binary);
  const int open_error = errno;
  if (!stream) throw usage_error(fmt::format("cannot open scene file {}: {}; make it readable", shown, std::strerror(open_error)));
  // one byte past the limit tells a file that is too large, or endless
  std::string text(ranges::LARGEST_FILE + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  const int read_error = errno;
  if (stream.bad()) throw usage_error(fmt::format("cannot read scene file {}: {}", shown, std::strerror(read_error)));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  const std::uintmax_t size = std::filesystem::file_size(path, failed);
  const FileKind kind = file_kind(text, failed ? text.size() : size);
  if (kind != FileKind::unknown && kind != FileKind::scene)
    throw usage_error(fmt::format("{} {}", shown, wrong_kind(kind, "a scene")));
  return parse_scene(text, path);
}

}  // namespace wholehand
