// SPDX-License-Identifier: MIT
// From the mesh files that a scene names to the bodies that the kernels and the drawings take.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "core/mesh_body.h"
#include "core/scene.h"

namespace wholehand {

constexpr std::size_t LARGEST_LATTICE = 512u << 20;  // bytes of samples, whatever the device

struct MeshOptions {
  std::size_t most_bytes = LARGEST_LATTICE;          // of a lattice's samples: floats up to half of it, 16 bits each beyond
  int threads = 0;                                   // 0: all cores
  std::string lattices;                              // as of mesh_lattices; not empty: these, whatever the scene asks for
  std::string cache_folder;                          // of lattices, see cached_lattice
  std::function<void(const std::string&)> say;       // gets what was found of each mesh, a line a time; may be empty
  std::function<void(const std::string&)> forecast;  // without `say`: gets only that a lattice takes long; may be empty
  bool is_quiet = false;                             // no status line on a terminal: for work inside another program
  std::function<double()> clock;                     // s, times work before its duration is forecast; empty: the machine's
};

// Bytes that a lattice may take here: LARGEST_LATTICE, an eighth of the machine's memory, or `device_bytes`, whichever is least.
std::size_t largest_lattice(std::uint64_t device_bytes);

// Whether a lattice that takes so long is announced, by `forecast_text`: 10 s; of an open mesh 3 s.
bool is_long(double seconds, bool is_closed);
std::string forecast_text(const PreparedLattice& lattice, double seconds, bool is_closed);

// Reads, checks and samples the mesh of every vessel that has one and sets its body, base and height; files are relative to the scene
// file's folder. The lattice holds all that hands of the scene's sizes can touch. A body that is there already stays. Throws Error (usage),
// one line with the place in the scene file: what read_mesh and check_mesh refuse, a lattice that is too large, an inner outline that is
// not the mesh's.
void load_meshes(Scene& scene, const MeshOptions& options);
// For a device whose buffers hold `device_bytes()`, called only where there is a mesh; for the core without it. Prints what was found on
// stderr.
void load_meshes(Scene& scene, const std::function<std::uint64_t()>& device_bytes = nullptr);

// For a scene read back from a file `kept_in`, say a recording: sets its own file (scene.file, where mesh paths start) to that of the
// same name beside `kept_in`, if all its meshes are there. Else it stays. Throws Error (usage) that names both places where neither has them.
void follow_moved_scene(Scene& scene, const std::string& kept_in);

// For a scene read back from the result `kept_in`, whose meshes had those keys and lattices (mesh_lattices). Searches for them beside the
// result, then where scene.file lay; scene.file becomes the place where they are. Returns why the meshes are no longer those, "" where they
// are; then every body is there, else none. Says on stderr where a lattice takes long, unless `is_quiet`.
std::string reload_meshes(Scene& scene, const std::string& kept_in, const std::string& keys, const std::string& lattices,
                          bool is_quiet = false);

bool has_meshes(const Scene& scene);
// What was found of each mesh, a line each with the vessel's name.
std::string mesh_lines(const Scene& scene);
// The keys of all bodies, equal where two scenes have the same meshes; empty without any.
std::string mesh_keys(const Scene& scene);
// The spacing (m) and bits of all lattices, "0.001 32 0.0012 16": what makes the same ones again, whatever the memory here allows.
std::string mesh_lattices(const Scene& scene);

}  // namespace wholehand
