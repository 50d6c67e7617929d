// SPDX-License-Identifier: MIT
// Decodes what EXT_meshopt_compression and KHR_draco_mesh_compression hold in a glTF file.
#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/meshes/file.h"

namespace wholehand {

// A buffer view with EXT_meshopt_compression. An index is -1 if the file lacks it.
struct MeshoptView {
  std::size_t view = 0;                                       // among the buffer views
  int buffer = -1;                                            // with the compressed bytes
  std::size_t offset = 0, length = 0, stride = 0, count = 0;  // of these bytes; of the decoded elements
  std::string mode, filter;
};

// A primitive with KHR_draco_mesh_compression.
struct DracoPrimitive {
  std::size_t mesh = 0, primitive = 0;
  int mode = 4;
  int view = -1;                    // with the compressed bytes
  int attribute = -1;               // unique id of the positions in them
  int position = -1, indices = -1;  // accessors
};

struct GltfCompression {
  std::vector<MeshoptView> views;
  std::vector<DracoPrimitive> primitives;
};

// Takes both extensions out of a trimmed file, so that tinygltf meets neither views without bytes nor accessors without views. A buffer that only
// stands for decoded bytes becomes a buffer of one byte.
GltfCompression take_compression(nlohmann::json& trimmed);

// Replaces compressed views and accessors by decoded ones. Every offset, count and size is checked first: decoders allocate no more than the file can
// hold. Throws Error (usage), one line with the place in the file.
void decompress(const MeshFile& file, const GltfCompression& compression, tinygltf::Model& model);

}  // namespace wholehand
