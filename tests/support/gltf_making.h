// SPDX-License-Identifier: MIT
// glTF files in the making, whole and with something wrong in them, and what reading them gives.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "base/files/json.h"
#include "base/text/error.h"
#include "core/meshes/check.h"
#include "core/meshes/gltf_file.h"
#include "core/meshes/mesh.h"
#include "tests/support/files.h"
#include "tests/support/meshes.h"

namespace wholehand {

using Json = nlohmann::json;

constexpr int GLTF_BYTE = 5120, GLTF_UBYTE = 5121, GLTF_SHORT = 5122, GLTF_USHORT = 5123, GLTF_UINT = 5125, GLTF_FLOAT = 5126;
constexpr int GLTF_STRIP = 5, GLTF_FAN = 6;
constexpr double GLTF_FLOAT_ROUNDING = 1e-7;  // m: single precision of some 10 cm

// For this process; it goes with it.
inline const std::string& gltf_folder() {
  static const TemporaryFolder made;
  return made.path();
}

inline std::string write_gltf(const std::string& name, const std::string& bytes) {
  const std::string path = gltf_folder() + "/" + name;
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

template <class T>
std::string raw_bytes(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

// A file in the making: views and accessors one after the other, each with bytes of its own.
struct Gltf {
  Json json{{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
  std::string binary;

  int view(const std::string& bytes, int stride = 0) {
    binary.append((4 - binary.size() % 4) % 4, '\x7F');
    Json view{{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
    if (stride > 0) view["byteStride"] = stride;
    binary += bytes;
    json["bufferViews"].push_back(view);
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }
  int accessor(int view, int type, std::size_t count, const char* shape, Json more = Json::object()) {
    Json accessor{{"componentType", type}, {"count", count}, {"type", shape}};
    if (view >= 0) accessor["bufferView"] = view;
    accessor.update(more);
    json["accessors"].push_back(accessor);
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  int positions(const std::vector<float>& numbers) {
    return accessor(view(raw_bytes(numbers)), GLTF_FLOAT, numbers.size() / 3, "VEC3");
  }
  template <class T>
  int indices(const std::vector<T>& numbers) {
    const int type = sizeof(T) == 1 ? GLTF_UBYTE : sizeof(T) == 2 ? GLTF_USHORT : GLTF_UINT;
    return accessor(view(raw_bytes(numbers)), type, numbers.size(), "SCALAR");
  }
  void primitive(int position, int index = -1, int mode = 4) {
    Json primitive{{"attributes", {{"POSITION", position}}}, {"mode", mode}};
    if (index >= 0) primitive["indices"] = index;
    json["meshes"][0]["primitives"].push_back(primitive);
  }
  std::string glb() const {
    Json whole = json;
    whole["buffers"] = {{{"byteLength", binary.size()}}};
    return glb_text(json_text(whole), binary);
  }
};

// A tetrahedron with legs of 1, 2 and 3 along the axes, outward; volume 1.
inline const std::vector<float> TETRAHEDRON_LEGS{0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3};
inline const std::vector<std::uint8_t> TETRAHEDRON_FACES{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

inline Gltf gltf_tetrahedron() {
  Gltf gltf;
  const int position = gltf.positions(TETRAHEDRON_LEGS);
  gltf.primitive(position, gltf.indices(TETRAHEDRON_FACES));
  return gltf;
}

inline MeshData mesh_as_is(const std::string& path) {
  MeshData data;
  data.file = path;
  data.origin_at_base = false;
  return data;
}

inline TriangleMesh read_gltf(const Gltf& gltf) { return read_mesh(mesh_as_is(write_gltf("a.glb", gltf.glb())), ""); }

// Signed, by the file's own winding.
inline double mesh_volume(const TriangleMesh& mesh) {
  const MeshFacts facts = check_mesh(mesh, "mesh").facts;
  EXPECT_TRUE(facts.closed && facts.oriented);
  return facts.was_inside_out ? -facts.volume : facts.volume;
}

inline std::string mesh_refusal(const MeshData& data, const std::string& base = "") {
  try {
    read_mesh(data, base);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    const std::string line = error.what();
    EXPECT_EQ(line.find_first_of("\n\r"), line.npos) << line;
    EXPECT_LT(line.size(), 1000u);
    EXPECT_NE(line.find(data.file), line.npos) << line;
    return line;
  }
  return "read";
}

inline std::string mesh_refusal(const Gltf& gltf) { return mesh_refusal(mesh_as_is(write_gltf("bad.glb", gltf.glb()))); }
inline std::string mesh_refusal_of_bytes(const std::string& bytes) {
  return mesh_refusal(mesh_as_is(write_gltf("bad.glb", bytes)));
}

inline std::string refusal_after(const std::function<void(Gltf&)>& change) {
  Gltf gltf = gltf_tetrahedron();
  change(gltf);
  return mesh_refusal(gltf);
}

#define EXPECT_SAYS(line, part) EXPECT_NE((line).find(part), std::string::npos) << (line)

}  // namespace wholehand
