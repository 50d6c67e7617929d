// SPDX-License-Identifier: MIT
#include "sweeps/result/output_names.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/files/files.h"
#include "base/text/error.h"
#include "core/scene.h"

namespace wholehand::sweeps {

OutputNames output_names(const std::string& result) {
  OutputNames names;
  names.result = result;
  names.target = followed(result);
  names.partial = names.target + ".partial";
  names.mark = names.partial + ".mark";
  names.lock = names.partial + ".lock";
  names.stem = result.ends_with(".nc") && result.size() > 3 ? result.substr(0, result.size() - 3) : result;
  names.best = names.stem + ".best.csv";
  return names;
}

std::string default_output(const Scene& scene) {
  std::string stem = scene.file.substr(scene.file.rfind('/') + 1);
  if (stem.ends_with(".toml")) stem.resize(stem.size() - 5);
  return (stem.empty() ? "sweep" : stem) + ".nc";
}

void check_not_the_scene(const std::string& path, const Scene& scene, const char* option) {
  const auto refuse = [&](const std::string& source, const std::string& what) {
    if (is_same_file(path, source))
      throw usage_error(fmt::format("{} {}: this is {}; name another file for the results", option, path, what));
  };
  refuse(scene.file, "the scene file itself");
  const std::filesystem::path folder = std::filesystem::path(scene.file).parent_path();
  for (const VesselData& vessel : scene.vessels) {
    if (vessel.mesh) refuse((folder / vessel.mesh->file).string(), fmt::format("the mesh of vessel '{}'", vessel.name));
  }
}

}  // namespace wholehand::sweeps
