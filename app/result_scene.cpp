// SPDX-License-Identifier: MIT
#include "app/result_scene.h"

#include <filesystem>
#include <fstream>
#include <system_error>

#include "core/error.h"
#include "objects/vessel.h"
#include "scene/reader.h"
#include "system/files.h"

namespace wholehand {

bool is_result(const std::string& path) {
  std::error_code absent;
  if (!std::filesystem::is_regular_file(path, absent)) return false;  // a pipe would be waited for
  std::ifstream file(path, std::ios::binary);
  std::string start(NETCDF4_START.size(), ' ');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  return start == NETCDF4_START;
}

Scene scene_of_result(const SweepResult& result, std::string& trouble) {
  const SweepOrigin& origin = result.origin();
  Scene scene = parse_scene(origin.scene, result.path() + " (its scene)");
  trouble = reload_meshes(scene, origin.scene_file, origin.mesh_keys, origin.mesh_lattices);
  return scene;
}

Scene whole_scene_of_result(const SweepResult& result) {
  std::string trouble;
  Scene scene = scene_of_result(result, trouble);
  if (!trouble.empty()) throw usage_error(result.path() + ": " + trouble);
  if (!result.origin().scene_file.empty()) scene.file = result.origin().scene_file;
  return scene;
}

}  // namespace wholehand
