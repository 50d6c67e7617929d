// From the mesh files that a scene names to the bodies that the kernels and the drawings take.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "core/mesh_body.h"
#include "core/scene.h"

namespace wholehand {

constexpr std::size_t LARGEST_LATTICE = 512u << 20;  // bytes of samples, whatever the device

struct MeshOptions {
  std::size_t most_bytes = LARGEST_LATTICE;     // of a lattice's samples: floats up to half of it, 16 bits each beyond
  int threads = 0;                              // 0: all cores
  std::string lattices;                         // as of mesh_lattices; not empty: these, whatever the scene asks for
  std::string cache_folder;                     // of lattices, see cached_grid
  std::function<void(const std::string&)> say;  // gets what was found of each mesh, a line a time; may be empty
};

// What a lattice may take for `on` (core, vulkan or a device's name): its largest storage buffer, an eighth of the
// machine's memory, or LARGEST_LATTICE, whichever is least. Throws Error
// as choose_device does.
std::size_t largest_lattice(const std::string& on);

// Reads, checks and samples the mesh of every vessel that has one and sets its body, base and height; files are looked for from the scene
// file's folder. The lattice holds all that hands of the scene's sizes can touch. A body that is there already stays. Throws Error (usage),
// one line with the place in the scene file: what read_mesh and check_mesh refuse, a lattice that is too large, an inner outline that is
// not the mesh's.
void load_meshes(Scene& scene, const MeshOptions& options);
// For `on`, saying on stderr what was found.
void load_meshes(Scene& scene, const std::string& on);

// For a scene read back from a result, whose file lay at `scene_file` and whose meshes had those keys and lattices (mesh_lattices). Returns
// why the meshes are no longer those, "" where they are; then every body is there, else none.
std::string reload_meshes(Scene& scene, const std::string& scene_file, const std::string& keys, const std::string& lattices);

bool has_meshes(const Scene& scene);
// What was found of each mesh, a line each with the vessel's name.
std::string mesh_lines(const Scene& scene);
// The keys of all bodies, which tell whether two scenes have the same meshes; empty without any.
std::string mesh_keys(const Scene& scene);
// Of all lattices their spacing (m) and bits, "0.001 32 0.0012 16": what makes the same ones again, whatever the memory here allows.
std::string mesh_lattices(const Scene& scene);

}  // namespace wholehand
