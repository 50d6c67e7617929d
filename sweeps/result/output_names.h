// SPDX-License-Identifier: MIT
// The names of a sweep's files.
#pragma once

#include <cstddef>
#include <string>

namespace wholehand {
struct Scene;
}

namespace wholehand::sweeps {

// The files of a sweep: NAME.nc and its companions, from the name of the result file. If that is a symbolic link, temporary files lie beside the file
// that it points to.
struct OutputNames {
  std::string result;   // NAME.nc as the user gave it
  std::string target;   // the file that this is or points to
  std::string partial;  // NAME.nc.partial while it is being written
  std::string mark;     // NAME.nc.partial.mark: how much of it is complete
  std::string lock;     // NAME.nc.partial.lock: who writes it
  std::string best;     // NAME.best.csv
  std::string heat_map(const std::string& vessel_part) const { return stem + "." + vessel_part + ".svg"; }
  std::string grip_glb(const std::string& vessel_part, std::size_t rank) const {
    return stem + "." + vessel_part + "." + std::to_string(rank) + ".glb";
  }
  std::string stem;  // NAME
};

OutputNames output_names(const std::string& result);

// NAME.nc for a scene file if the user names none.
std::string default_output(const Scene& scene);

// Throws Error (usage) if `path` is the scene file itself or one of its meshes, under any name.
void check_not_the_scene(const std::string& path, const Scene& scene, const char* option = "-o");

}  // namespace wholehand::sweeps
