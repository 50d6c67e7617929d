// SPDX-License-Identifier: MIT
// Turns the mesh files that a scene names into bodies for the kernels and the drawings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "core/mesh_body.h"
#include "core/scene.h"

namespace wholehand {

struct LatticePlan;  // core/meshes/lattice.h

constexpr std::size_t LARGEST_LATTICE = 512u << 20;  // bytes of samples, whatever the device

constexpr double MOST_LATTICE_SECONDS = 60;  // of work, where the scene gives no grid_mm

struct MeshOptions {
  std::size_t most_bytes = LARGEST_LATTICE;          // of a lattice's samples: floats up to half of it, 16 bits each beyond
  int threads = 0;                                   // 0: all cores
  std::string lattices;                              // as from mesh_lattices; if not empty, it overrides what the scene asks for
  std::string cache_folder;                          // of lattices, see cached_lattice
  std::function<void(const std::string&)> say;       // gets the findings of each mesh, one line per call; may be empty
  std::function<void(const std::string&)> forecast;  // without `say`: gets only the note that a lattice takes long; may be empty
  bool is_quiet = false;                             // no status line on a terminal: for work inside another program
  std::function<double()> clock;                     // s of work before its duration is forecast; empty: the machine's
};

// The limit of a lattice's bytes here: LARGEST_LATTICE, an eighth of the machine's memory, or `device_bytes`, whichever is least.
std::size_t largest_lattice(std::uint64_t device_bytes);

// From which duration `forecast_text` announces a lattice: 10 s; for an open mesh 3 s.
bool is_long(double seconds, bool is_closed);
// If there is a finer lattice, says what is taken in its place.
std::string forecast_text(const LatticePlan& plan, bool is_closed);

// Reads, checks and samples the mesh of every vessel that has one, and sets its body, base and height; files are relative to the scene file's folder.
// Without grid_mm, a lattice that is forecast to take more than a minute gives way to a coarser one.
// The lattice covers everything that hands of the scene's sizes can touch. Existing bodies stay. Throws Error (usage), one line with the place in the
// scene file, for what read_mesh and check_mesh refuse, a lattice that is too large, or an inner outline that does not fit the mesh.
void load_meshes(Scene& scene, const MeshOptions& options);
// For a device whose buffers hold `device_bytes()`, which is called only if there is a mesh; for the core without it. Prints the findings on stderr.
void load_meshes(Scene& scene, const std::function<std::uint64_t()>& device_bytes = nullptr);

// For a scene read back from a file `kept_in`, such as a recording: if all its meshes lie beside `kept_in`, sets scene.file (where mesh paths start)
// to the file of the same name there; else it stays. Throws Error (usage), naming both places, if neither has them.
void follow_moved_scene(Scene& scene, const std::string& kept_in);

// For a scene read back from the result `kept_in`, whose meshes had those keys and lattices (mesh_lattices). Searches for them beside the result,
// then at scene.file's place, and sets scene.file accordingly. Returns "" if the meshes are the same; then every body is set. Otherwise returns why
// not, and sets none. Says on stderr if a lattice takes long, unless `is_quiet`.
std::string reload_meshes(Scene& scene, const std::string& kept_in, const std::string& keys, const std::string& lattices,
                          bool is_quiet = false);

bool has_meshes(const Scene& scene);
// The findings of each mesh, a line each with the vessel's name.
std::string mesh_lines(const Scene& scene);
// The keys of all bodies, equal if two scenes have the same meshes; empty without meshes.
std::string mesh_keys(const Scene& scene);
// The spacing (m) and bits of all lattices, "0.001 32 0.0012 16", from which the same lattices can be made again with any memory.
std::string mesh_lattices(const Scene& scene);

}  // namespace wholehand
