// SPDX-License-Identifier: MIT
// Checks a glTF file before tinygltf reads it: sizes, headers, depth, types and ranges first, and only the parts that a shape needs.
#pragma once

#include <tiny_gltf.h>

#include <string_view>

#include "core/meshes/file.h"

namespace wholehand {

constexpr std::size_t LARGEST_MESH_JSON = 64u << 20;  // bytes: parsed JSON takes some twenty times its size

// Only the file's scenes, nodes, meshes, accessors, buffer views and buffers with their bytes, decompressed (core/meshes/gltf_compression.h). Every
// integer is 0 to 2^31 - 1, or -1 if absent, and every key has its type; indices into the lists are not checked. Throws Error (usage) if the file is
// not glTF 2, is truncated or too large, needs an extension that changes shapes, or has a buffer that cannot be read whole. Buffers are read only
// from the file's folder and its subfolders. `bytes`: the file's contents.
tinygltf::Model read_gltf(const MeshFile& file, std::string_view bytes);

}  // namespace wholehand
