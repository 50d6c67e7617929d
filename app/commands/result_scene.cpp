// SPDX-License-Identifier: MIT
#include "app/commands/result_scene.h"

#include "base/files/files.h"
#include "base/text/error.h"
#include "core/file_kind.h"
#include "core/meshes/vessel.h"
#include "core/reader/reader.h"

namespace wholehand {
bool is_result(const std::string& path) { return file_kind_at(path) == FileKind::result; }

Scene scene_of_result(const sweeps::SweepResult& result, std::string& mesh_error) {
  const sweeps::SweepOrigin& origin = result.origin();
  Scene scene = parse_scene(origin.scene, result.path() + " (its scene)");
  if (!origin.scene_file.empty()) scene.file = origin.scene_file;
  mesh_error = reload_meshes(scene, result.path(), origin.mesh_keys, origin.mesh_lattices);
  return scene;
}

Scene whole_scene_of_result(const sweeps::SweepResult& result) {
  std::string mesh_error;
  Scene scene = scene_of_result(result, mesh_error);
  if (!mesh_error.empty()) throw usage_error(result.path() + ": " + mesh_error);
  return scene;
}

}  // namespace wholehand
