// SPDX-License-Identifier: MIT
// A mesh file before parsing: its bytes, and their format.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace wholehand {

constexpr std::size_t LARGEST_MESH_FILE = 512u << 20;  // bytes, of the file and all its buffers together

enum class MeshFormat { gltf, stl, obj, ply, off, collada };

// A mesh file and where the scene names it, for messages.
struct MeshFile {
  std::string path;
  std::string place;  // in the scene file, may be empty

  // Each throws Error (usage): one line with place and path.
  [[noreturn]] void refuse(const std::string& message) const;
  [[noreturn]] void refuse_size() const;  // more than MOST_TRIANGLES, or three times as many vertices
};

// Why the file cannot be read whole, or that it exceeds LARGEST_MESH_FILE; empty if `bytes` holds its contents.
std::string read_mesh_bytes(const std::string& path, std::string& bytes);

// The file's contents, at least one byte. Throws Error (usage).
std::string mesh_bytes(const MeshFile& file);

// The format, by the first bytes and the name's ending (.glb, .gltf, .stl, .obj, .ply, .off, .dae, in any case), which must not contradict each
// other; by the ending alone if the bytes are of no known kind. Throws Error (usage) if neither tells, or the bytes are another kind of file; names a
// program that converts it if the ending tells one.
MeshFormat mesh_format(const MeshFile& file, std::string_view bytes);

}  // namespace wholehand
