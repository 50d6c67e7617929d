// SPDX-License-Identifier: MIT
// What glTF files become: triangles where they should be, or one line about why not.
#include "objects/mesh.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/error.h"
#include "objects/check.h"
#include "objects/gltf_file.h"
#include "tests/support/files.h"
#include "tests/support/meshes.h"

namespace wholehand {
namespace {

using Json = nlohmann::json;

constexpr int BYTE = 5120, UBYTE = 5121, SHORT = 5122, USHORT = 5123, UINT = 5125, FLOAT = 5126;
constexpr int STRIP = 5, FAN = 6;
constexpr double FLOAT_ROUNDING = 1e-7;  // m: single precision of some 10 cm

// For this process; it goes with it.
const std::string& folder() {
  static const TemporaryFolder made;
  return made.path();
}

std::string write(const std::string& name, const std::string& bytes) {
  const std::string path = folder() + "/" + name;
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
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
  int positions(const std::vector<float>& numbers) { return accessor(view(bytes_of(numbers)), FLOAT, numbers.size() / 3, "VEC3"); }
  template <class T>
  int indices(const std::vector<T>& numbers) {
    const int type = sizeof(T) == 1 ? UBYTE : sizeof(T) == 2 ? USHORT : UINT;
    return accessor(view(bytes_of(numbers)), type, numbers.size(), "SCALAR");
  }
  void primitive(int position, int index = -1, int mode = 4) {
    Json primitive{{"attributes", {{"POSITION", position}}}, {"mode", mode}};
    if (index >= 0) primitive["indices"] = index;
    json["meshes"][0]["primitives"].push_back(primitive);
  }
  std::string glb() const {
    Json whole = json;
    whole["buffers"] = {{{"byteLength", binary.size()}}};
    return glb_text(whole.dump(), binary);
  }
};

// A tetrahedron with legs of 1, 2 and 3 along the axes, outward; volume 1.
const std::vector<float> LEGS{0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3};
const std::vector<std::uint8_t> FACES{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

Gltf tetrahedron() {
  Gltf gltf;
  const int position = gltf.positions(LEGS);
  gltf.primitive(position, gltf.indices(FACES));
  return gltf;
}

MeshData as_is(const std::string& path) {
  MeshData data;
  data.file = path;
  data.origin_at_base = false;
  return data;
}

TriangleMesh read(const Gltf& gltf) { return read_mesh(as_is(write("a.glb", gltf.glb())), ""); }

// Signed, by the file's own winding.
double volume_of(const TriangleMesh& mesh) {
  const MeshFacts facts = check_mesh(mesh, "mesh").facts;
  EXPECT_TRUE(facts.closed && facts.oriented);
  return facts.was_inside_out ? -facts.volume : facts.volume;
}

std::string line_of(const MeshData& data, const std::string& base = "") {
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

std::string line_of(const Gltf& gltf) { return line_of(as_is(write("bad.glb", gltf.glb()))); }
std::string line_of_bytes(const std::string& bytes) { return line_of(as_is(write("bad.glb", bytes))); }

std::string after(const std::function<void(Gltf&)>& change) {
  Gltf gltf = tetrahedron();
  change(gltf);
  return line_of(gltf);
}

#define EXPECT_SAYS(line, part) EXPECT_NE((line).find(part), std::string::npos) << (line)

TEST(Mesh, EveryIndexWidthAndNone) {
  const std::vector<std::uint16_t> shorts(FACES.begin(), FACES.end());
  const std::vector<std::uint32_t> ints(FACES.begin(), FACES.end());
  for (int width : {1, 2, 4, 0}) {
    Gltf gltf;
    std::vector<float> corners;
    for (const int i : FACES) corners.insert(corners.end(), &LEGS[3 * i], &LEGS[3 * i] + 3);
    const int position = gltf.positions(width == 0 ? corners : LEGS);
    gltf.primitive(position, width == 1   ? gltf.indices(FACES)
                             : width == 2 ? gltf.indices(shorts)
                             : width == 4 ? gltf.indices(ints)
                                          : -1);
    const TriangleMesh mesh = read(gltf);
    EXPECT_EQ(mesh.triangles.size(), 4u);
    EXPECT_NEAR(volume_of(mesh), 1, FLOAT_ROUNDING) << width;
  }
}

TEST(Mesh, StripsAndFansKeepTheirSide) {
  Gltf strip;
  strip.primitive(strip.positions(LEGS), strip.indices<std::uint8_t>({0, 2, 1, 3, 0, 2}), STRIP);
  EXPECT_NEAR(volume_of(read(strip)), 1, FLOAT_ROUNDING);
  // three faces about one corner, the fourth as a fan of one
  Gltf fan;
  const int position = fan.positions(LEGS);
  fan.primitive(position, fan.indices<std::uint16_t>({0, 2, 1, 3, 2}), FAN);
  fan.primitive(position, fan.indices<std::uint16_t>({1, 2, 3}), FAN);
  EXPECT_NEAR(volume_of(read(fan)), 1, FLOAT_ROUNDING);
}

TEST(Mesh, SparseAccessorsReplaceWhatTheyName) {
  std::vector<float> moved = LEGS;
  moved[3] = 9;
  moved[11] = -7;
  Gltf gltf;
  const int base = gltf.view(bytes_of(moved)), places = gltf.view(bytes_of<std::uint16_t>({1, 3})),
            values = gltf.view(bytes_of<float>({1, 0, 0, 0, 0, 3}));
  const Json sparse{
      {"sparse",
       {{"count", 2}, {"indices", {{"bufferView", places}, {"componentType", USHORT}}}, {"values", {{"bufferView", values}}}}}};
  gltf.primitive(gltf.accessor(base, FLOAT, 4, "VEC3", sparse), gltf.indices(FACES));
  EXPECT_NEAR(volume_of(read(gltf)), 1, FLOAT_ROUNDING);
}

TEST(Mesh, SparseAccessorsMayStandOnNothing) {
  Gltf gltf;
  const int places = gltf.view(bytes_of<std::uint8_t>({1, 2, 3})), values = gltf.view(bytes_of<float>({1, 0, 0, 0, 2, 0, 0, 0, 3}));
  const Json sparse{
      {"sparse",
       {{"count", 3}, {"indices", {{"bufferView", places}, {"componentType", UBYTE}}}, {"values", {{"bufferView", values}}}}}};
  gltf.primitive(gltf.accessor(-1, FLOAT, 4, "VEC3", sparse), gltf.indices(FACES));
  EXPECT_NEAR(volume_of(read(gltf)), 1, FLOAT_ROUNDING);
}

TEST(Mesh, NormalizedAndPlainIntegers) {
  struct Case {
    int type;
    std::string bytes;
    bool normalized;
    double leg;
  };
  const std::vector<Case> cases{
      {BYTE, bytes_of<std::int8_t>({0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 0, 0, 0, -128, 0}), true, 1},
      {UBYTE, bytes_of<std::uint8_t>({0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0}), true, 1},
      {SHORT, bytes_of<std::int16_t>({0, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0}), true, 1},
      {USHORT, bytes_of<std::uint16_t>({0, 0, 0, 0, 65535, 0, 0, 0, 0, 65535, 0, 0, 0, 0, 65535, 0}), true, 1},
      {USHORT, bytes_of<std::uint16_t>({0, 0, 0, 0, 300, 0, 0, 0, 0, 300, 0, 0, 0, 0, 300, 0}), false, 300},
      {SHORT, bytes_of<std::int16_t>({0, 0, 0, 0, 300, 0, 0, 0, 0, 300, 0, 0, 0, 0, 300, 0}), false, 300}};
  for (const Case& c : cases) {
    Gltf gltf;
    const int view = gltf.view(c.bytes, static_cast<int>(c.bytes.size()) / 4);
    gltf.primitive(gltf.accessor(view, c.type, 4, "VEC3", {{"normalized", c.normalized}}), gltf.indices(FACES));
    const TriangleMesh mesh = read(gltf);
    EXPECT_NEAR(mesh.vertices[1][0], c.leg, 1e-15) << c.type;
    EXPECT_NEAR(std::abs(mesh.vertices[3][2]), c.leg, 1e-15) << c.type;
  }
}

TEST(Mesh, StridedViewsAreStepped) {
  Gltf gltf;
  std::vector<float> interleaved{77, 77, 77};
  for (std::size_t i = 0; i < LEGS.size(); i += 3)
    interleaved.insert(interleaved.end(), {LEGS[i], LEGS[i + 1], LEGS[i + 2], 5, 6, 7});
  const int view = gltf.view(bytes_of(interleaved), 24);
  gltf.primitive(gltf.accessor(view, FLOAT, 4, "VEC3", {{"byteOffset", 12}}), gltf.indices(FACES));
  EXPECT_NEAR(volume_of(read(gltf)), 1, FLOAT_ROUNDING);
}

TEST(Mesh, NodesPlaceTheirMeshes) {
  Gltf gltf = tetrahedron();
  const double half = std::sqrt(0.5);
  // the parent moves by (10, 0, 0) and turns by 90 degrees about z; the child scales by (2, 3, 4) and then moves by (0, 1, 0)
  gltf.json["nodes"] = {{{"translation", {10, 0, 0}}, {"rotation", {0, 0, half, half}}, {"children", {1}}},
                        {{"mesh", 0}, {"scale", {2, 3, 4}}, {"translation", {0, 1, 0}}}};
  const TriangleMesh mesh = read(gltf);
  EXPECT_NEAR(mesh.vertices[0][0], 9, FLOAT_ROUNDING);
  EXPECT_NEAR(mesh.vertices[1][1], 2, FLOAT_ROUNDING);
  EXPECT_NEAR(mesh.vertices[2][0], 10 - 1 - 6, FLOAT_ROUNDING);
  EXPECT_NEAR(mesh.vertices[3][2], 12, FLOAT_ROUNDING);
  EXPECT_NEAR(volume_of(mesh), 24, 1e-5);
}

TEST(Mesh, MatricesAreReadByColumns) {
  Gltf gltf = tetrahedron();
  gltf.json["nodes"] = {{{"mesh", 0}, {"matrix", {0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 5, 6, 7, 1}}}};
  const TriangleMesh mesh = read(gltf);
  EXPECT_EQ(mesh.vertices[0], (Triple{5, 6, 7}));
  EXPECT_EQ(mesh.vertices[1], (Triple{5, 7, 7}));
  EXPECT_EQ(mesh.vertices[3], (Triple{8, 6, 7}));
  EXPECT_NEAR(volume_of(mesh), 1, FLOAT_ROUNDING);
}

TEST(Mesh, MirroringNodesKeepTheOutsideOut) {
  Gltf gltf = tetrahedron();
  gltf.json["nodes"] = {{{"mesh", 0}, {"scale", {-1, 1, 1}}}};
  EXPECT_NEAR(volume_of(read(gltf)), 1, FLOAT_ROUNDING);
  gltf.json["nodes"] = {{{"scale", {1, -1, 1}}, {"children", {1}}}, {{"mesh", 0}, {"scale", {1, 1, -2}}}};
  EXPECT_NEAR(volume_of(read(gltf)), 2, FLOAT_ROUNDING);
}

TEST(Mesh, AllMeshesOfTheDefaultSceneAndNoOther) {
  Gltf gltf = tetrahedron();
  gltf.json["nodes"] = {
      {{"mesh", 0}}, {{"mesh", 0}, {"translation", {5, 0, 0}}}, {{"mesh", 0}, {"translation", {50, 0, 0}}}, {{"camera", 0}}};
  gltf.json["scenes"] = {{{"nodes", {2}}}, {{"nodes", {0, 1, 3}}}};
  gltf.json["scene"] = 1;
  EXPECT_EQ(read(gltf).triangles.size(), 8u);
  gltf.json.erase("scene");
  EXPECT_EQ(read(gltf).triangles.size(), 4u);
}

TEST(Mesh, IsScaledThenTurnedThenSetDown) {
  const std::string path = write("a.glb", tetrahedron().glb());
  MeshData data = as_is(path);
  data.scale = 0.1;
  data.rotate = {0, 0, std::numbers::pi / 2};
  EXPECT_NEAR(read_mesh(data, "").vertices[2][0], -0.2, FLOAT_ROUNDING);
  // first about x, then about the y that x has turned: the leg along z goes to -y by x; about the turned y it would stay in the plane
  data.rotate = {std::numbers::pi / 2, std::numbers::pi / 2, 0};
  const TriangleMesh turned = read_mesh(data, "");
  EXPECT_NEAR(turned.vertices[3][0], 0.3, FLOAT_ROUNDING);  // z -> (Ry) x -> (Rx) x
  EXPECT_NEAR(turned.vertices[1][1], 0.1, FLOAT_ROUNDING);  // x -> (Ry) -z -> (Rx) y
  EXPECT_NEAR(turned.vertices[2][2], 0.2, FLOAT_ROUNDING);  // y -> (Ry) y -> (Rx) z
  data.rotate = {};
  data.origin_at_base = true;
  const TriangleMesh set = read_mesh(data, "");
  EXPECT_NEAR(set.vertices[0][0], -0.05, FLOAT_ROUNDING);
  EXPECT_NEAR(set.vertices[0][1], 0, FLOAT_ROUNDING);
  EXPECT_NEAR(set.vertices[0][2], -0.15, FLOAT_ROUNDING);
}

TEST(Mesh, APointHasNoSayInWhereTheOriginIs) {
  TriangleMesh mesh = box_mesh({0, 0, 0}, {0.1, 0.2, 0.3});
  mesh.vertices.push_back({5, -1, 0});
  mesh.triangles.push_back({8, 8, 8});
  MeshData data = as_is(write("a.glb", glb_text(mesh)));
  data.origin_at_base = true;
  const TriangleMesh set = read_mesh(data, "");
  EXPECT_NEAR(set.vertices[0][0], -0.05, 1e-8);  // the file's single precision
  EXPECT_NEAR(set.vertices[0][1], 0, 1e-8);
  EXPECT_NEAR(set.vertices[0][2], -0.15, 1e-8);
}

TEST(Mesh, ZUpIsTurnedBeforeAnythingElse) {
  MeshData data = as_is(write("a.glb", tetrahedron().glb()));
  data.z_is_up = true;
  data.scale = 0.1;
  const TriangleMesh upright = read_mesh(data, "");
  EXPECT_NEAR(upright.vertices[1][0], 0.1, FLOAT_ROUNDING);   // x stays
  EXPECT_NEAR(upright.vertices[2][2], -0.2, FLOAT_ROUNDING);  // y to the back
  EXPECT_NEAR(upright.vertices[3][1], 0.3, FLOAT_ROUNDING);   // z up
  EXPECT_NEAR(volume_of(upright), 1e-3, FLOAT_ROUNDING);      // a turn, no mirror
  data.rotate = {std::numbers::pi / 2, 0, 0};                 // which undoes it
  const TriangleMesh turned = read_mesh(data, "");
  EXPECT_NEAR(turned.vertices[2][1], 0.2, FLOAT_ROUNDING);
  EXPECT_NEAR(turned.vertices[3][2], 0.3, FLOAT_ROUNDING);
  data.origin_at_base = true;
  EXPECT_NEAR(read_mesh(data, "").vertices[2][1], 0.2, FLOAT_ROUNDING);
}

// The vertices are on a view that is not there: whoever counts first does not come to see that.
TEST(Mesh, TrianglesAreCountedBeforeAnyIsRead) {
  const auto shown = [](int nodes, int primitives) {
    Gltf gltf;
    const int points = gltf.accessor(7, FLOAT, 4, "VEC3"), corners = gltf.indices(std::vector<std::uint8_t>(300'000));
    for (int i = 0; i < primitives; ++i) gltf.primitive(points, corners);
    gltf.json["scenes"][0]["nodes"] = gltf.json["nodes"] = Json::array();
    for (int i = 0; i < nodes; ++i) {
      gltf.json["nodes"].push_back({{"mesh", 0}});
      gltf.json["scenes"][0]["nodes"].push_back(i);
    }
    return line_of(gltf);
  };
  EXPECT_SAYS(shown(200, 1), "bufferViews[7]");  // 20 million, which are read
  EXPECT_SAYS(shown(201, 1), "more than 20 million triangles");
  EXPECT_SAYS(shown(1, 201), "more than 20 million triangles");
  EXPECT_SAYS(shown(67, 3), "more than 20 million triangles");
}

TEST(Mesh, DeepChainsOfNodesAreRead) {
  Gltf gltf = tetrahedron();
  const int depth = 20'000;
  gltf.json["nodes"] = Json::array();
  for (int i = 0; i + 1 < depth; ++i) gltf.json["nodes"].push_back({{"children", {i + 1}}});
  gltf.json["nodes"].push_back({{"mesh", 0}});
  EXPECT_EQ(read(gltf).triangles.size(), 4u);
}

TEST(Mesh, BuffersMayBeFilesOrDataUris) {
  Gltf gltf = tetrahedron();
  gltf.json["buffers"] = {{{"byteLength", gltf.binary.size()}, {"uri", "a%20buffer.bin"}}};
  std::filesystem::create_directories(folder() + "/models");
  write("models/a buffer.bin", gltf.binary);
  write("models/a.gltf", gltf.json.dump());
  EXPECT_EQ(read_mesh(as_is("models/a.gltf"), folder()).triangles.size(), 4u);
  // four corners of a byte each, and the faces
  Gltf small;
  const int position = small.accessor(small.view(std::string("\0\0\0\0\1\0\0\0\0\2\0\0\0\0\3\0", 16), 4), UBYTE, 4, "VEC3");
  small.primitive(position, small.indices(FACES));
  small.json["buffers"] = {
      {{"byteLength", 28}, {"uri", "data:application/octet-stream;base64,AAAAAAEAAAAAAgAAAAADAAACAQABAwADAgECAw=="}}};
  EXPECT_NEAR(volume_of(read_mesh(as_is(write("small.gltf", small.json.dump())), "")), 1, FLOAT_ROUNDING);
}

TEST(Mesh, LooksAreLeftOut) {
  Gltf gltf = tetrahedron();
  gltf.json["images"] = {{{"uri", "missing.png"}}, {{"bufferView", 999}}};
  gltf.json["textures"] = {{{"source", 0}}};
  gltf.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  gltf.json["extensionsUsed"] = {"KHR_materials_unlit", "KHR_texture_transform"};
  gltf.json["extensionsRequired"] = {"KHR_texture_transform"};
  gltf.json["extras"] = {{"a", 1}};
  EXPECT_EQ(read(gltf).triangles.size(), 4u);
}

TEST(Mesh, WhatIsNotReadIsNamedWithTheRemedy) {
  EXPECT_SAYS(after([](Gltf& g) { g.json["nodes"][0]["skin"] = 0; }), "skin, which is not read: apply the armature");
  EXPECT_SAYS(after([](Gltf& g) { g.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}}; }), "morph targets");
  for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"}) {
    const std::string line = after([&](Gltf& g) { g.json["extensionsUsed"] = g.json["extensionsRequired"] = {name}; });
    EXPECT_SAYS(line, name);
    EXPECT_SAYS(line, "without compression");
  }
  EXPECT_SAYS(after([](Gltf& g) { g.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"}; }), "make them real");
  EXPECT_SAYS(after([](Gltf& g) { g.json["extensionsUsed"] = {"KHR_node_visibility"}; }), "remove what is hidden");
  EXPECT_SAYS(after([](Gltf& g) { g.json["extensionsRequired"] = {"ACME_shape"}; }), "requires the extension ACME_shape");
  for (const auto& [mode, name] : std::map<int, std::string>{{0, "points"}, {1, "lines"}, {2, "lines"}, {3, "lines"}})
    EXPECT_SAYS(after([mode = mode](Gltf& g) { g.json["meshes"][0]["primitives"][0]["mode"] = mode; }), "made of " + name);
  EXPECT_SAYS(after([](Gltf& g) { g.json["meshes"][0]["primitives"][0]["mode"] = 7; }), "mode 7");
}

TEST(Mesh, BytesThatAreNoGltfAreRefused) {
  EXPECT_SAYS(line_of_bytes(""), "is empty");
  EXPECT_SAYS(line_of_bytes("what is this"), "neither .glb nor .gltf");
  EXPECT_SAYS(line_of_bytes("{\"asset\": "), "is damaged, or no glTF");
  EXPECT_SAYS(line_of_bytes("{}"), "no asset.version");
  EXPECT_SAYS(line_of_bytes(std::string(200'000, '[')), "neither");
  EXPECT_SAYS(line_of_bytes("{\"a\":" + std::string(200'000, '[')), "nested more than 64");
  EXPECT_SAYS(line_of(as_is(folder() + "/there-is-none.glb")), "no such file");
  EXPECT_SAYS(line_of(as_is(folder())), "is not a file");
  EXPECT_SAYS(after([](Gltf& g) { g.json["asset"]["version"] = "1.0"; }), "glTF version '1.0'");
  EXPECT_SAYS(after([](Gltf& g) { g.json["asset"]["minVersion"] = "2.1"; }), "needs a reader of glTF '2.1'");
  std::string old = tetrahedron().glb();
  old[4] = 1;
  EXPECT_SAYS(line_of_bytes(old), "glTF version 1");
}

TEST(Mesh, EveryTruncationIsRefused) {
  const std::string whole = tetrahedron().glb();
  for (std::size_t length = 0; length < whole.size(); ++length) EXPECT_NE(line_of_bytes(whole.substr(0, length)), "read") << length;
}

TEST(Mesh, AChangedByteIsReadOrRefused) {
  const std::string whole = tetrahedron().glb();
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const char byte : {'\0', '\xFF', '9', '"', '-'}) {
      std::string bytes = whole;
      bytes[at] = byte;
      line_of_bytes(bytes);  // anything but Error ends the test
    }
}

TEST(Mesh, SizesThatAreAbsurdAreRefused) {
  const std::string large = write("large.glb", "glTF");
  std::filesystem::resize_file(large, std::uintmax_t{2} << 30);  // no blocks of the disk are taken
  EXPECT_SAYS(line_of(as_is(large)), "2048 MB large");
  std::filesystem::remove(large);
  EXPECT_SAYS(after([](Gltf& g) { g.json["accessors"][0]["count"] = 2'000'000'000; }), "absurd");
  EXPECT_SAYS(after([](Gltf& g) { g.json["accessors"][0]["count"] = 4'294'967'300; }), "accessors[0].count");
  EXPECT_SAYS(after([](Gltf& g) { g.json["accessors"][0]["count"] = -1; }), "accessors[0].count");
  EXPECT_SAYS(after([](Gltf& g) { g.json["accessors"][0]["count"] = "four"; }), "accessors[0].count is not an integer");
  Gltf zeros = tetrahedron();
  zeros.json["accessors"][0].erase("bufferView");
  EXPECT_SAYS(line_of(zeros), "has no data");
  MeshData giant = as_is(write("a.glb", tetrahedron().glb()));
  giant.scale = 1e300;
  EXPECT_SAYS(line_of(giant), "scale is wrong");
}

TEST(Mesh, ReferencesThatLeadNowhereAreRefused) {
  EXPECT_SAYS(after([](Gltf& g) { g.json["scene"] = 3; }), "names scene 3 and has 1");
  EXPECT_SAYS(after([](Gltf& g) { g.json["scenes"] = Json::array(); }), "no scene");
  EXPECT_SAYS(after([](Gltf& g) { g.json["scenes"][0]["nodes"] = {7}; }), "nodes[7]");
  EXPECT_SAYS(after([](Gltf& g) { g.json["nodes"][0]["mesh"] = 7; }), "meshes[7]");
  EXPECT_SAYS(after([](Gltf& g) { g.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 7; }), "accessors[7]");
  EXPECT_SAYS(after([](Gltf& g) { g.json["meshes"][0]["primitives"][0]["indices"] = 7; }), "out of bounds");
  EXPECT_SAYS(after([](Gltf& g) { g.json["accessors"][0]["bufferView"] = 7; }), "bufferViews[7]");
  EXPECT_SAYS(after([](Gltf& g) { g.json["accessors"][1]["bufferView"] = 7; }), "accessor[1] invalid bufferView");
  EXPECT_SAYS(after([](Gltf& g) { g.json["bufferViews"][0]["buffer"] = 7; }), "buffers[7]");
  EXPECT_SAYS(after([](Gltf& g) { g.json["bufferViews"][0]["byteLength"] = 70'000; }), "beyond its buffer");
  EXPECT_SAYS(after([](Gltf& g) { g.json["accessors"][0]["count"] = 5; }), "accessors[0] reaches beyond");
  EXPECT_SAYS(after([](Gltf& g) { g.json["accessors"][1]["byteOffset"] = 1; }), "accessors[1] reaches beyond");
  EXPECT_SAYS(after([](Gltf& g) { g.json["accessors"][0]["type"] = "VEC2"; }), "not VEC3");
  EXPECT_SAYS(after([](Gltf& g) { g.json["accessors"][1]["componentType"] = BYTE; }), "no SCALAR of unsigned");
  EXPECT_SAYS(after([](Gltf& g) { g.json["accessors"][0]["componentType"] = 5124; }), "component type 5124");
  EXPECT_SAYS(after([](Gltf& g) { g.binary[g.binary.size() - 1] = 9; }), "index 9 and 4 vertices");
}

TEST(Mesh, BuffersOutsideTheFolderAreNotRead) {
  write("secret.bin", tetrahedron().binary);
  std::filesystem::create_directories(folder() + "/inner");
  for (const std::string& uri : {std::string("../secret.bin"), folder() + "/secret.bin", std::string("%2e%2e/secret.bin"),
                                 std::string("a/../../secret.bin"), std::string("file:///etc/passwd")}) {
    Gltf gltf = tetrahedron();
    gltf.json["buffers"] = {{{"byteLength", gltf.binary.size()}, {"uri", uri}}};
    EXPECT_SAYS(line_of(as_is(write("inner/a.gltf", gltf.json.dump()))), "outside its own folder");
  }
  Gltf gltf = tetrahedron();
  gltf.json["buffers"] = {{{"byteLength", gltf.binary.size()}, {"uri", "missing.bin"}}};
  EXPECT_SAYS(line_of(as_is(write("a.gltf", gltf.json.dump()))), "missing.bin");
  gltf.json["buffers"] = {{{"byteLength", gltf.binary.size()}}};
  EXPECT_SAYS(line_of(as_is(write("a.gltf", gltf.json.dump()))), "buffers[0] has no uri");
  gltf.json["buffers"] = {{{"byteLength", gltf.binary.size()}, {"uri", "data:text/csv,1"}}};
  EXPECT_SAYS(line_of(as_is(write("a.gltf", gltf.json.dump()))), "data URI");
}

TEST(Mesh, ShapesThatAreNoBodyAreRefused) {
  EXPECT_SAYS(after([](Gltf& g) { g.json["nodes"] = {{{"name", "empty"}}}; }), "no mesh in its scene");
  Gltf two;
  two.primitive(two.positions(LEGS), two.indices<std::uint8_t>({0, 1, 2, 2, 1, 0}));
  EXPECT_SAYS(line_of(two), "2 triangles");
  Gltf half;
  half.primitive(half.positions(LEGS), half.indices<std::uint8_t>({0, 1, 2, 2}));
  EXPECT_SAYS(line_of(half), "no whole triangles");
  for (const float wrong : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    std::vector<float> numbers = LEGS;
    numbers[4] = wrong;
    Gltf gltf;
    gltf.primitive(gltf.positions(numbers), gltf.indices(FACES));
    EXPECT_SAYS(line_of(gltf), "not a finite number");
  }
}

TEST(Mesh, NodesThatAreTheirOwnAncestorsAreRefused) {
  EXPECT_SAYS(after([](Gltf& g) { g.json["nodes"][0]["children"] = {0}; }), "its own ancestor");
  EXPECT_SAYS(after([](Gltf& g) {
                g.json["nodes"] = {{{"children", {1}}}, {{"mesh", 0}, {"children", {0}}}};
              }),
              "its own ancestor");
  EXPECT_SAYS(after([](Gltf& g) { g.json["scenes"][0]["nodes"] = {0, 0}; }), "two parents");
}

TEST(Mesh, TransformsThatAreNoneAreRefused) {
  EXPECT_SAYS(after([](Gltf& g) { g.json["nodes"][0]["matrix"] = {1, 2, 3}; }), "matrix has 3 numbers");
  EXPECT_SAYS(after([](Gltf& g) { g.json["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }), "last row");
  EXPECT_SAYS(after([](Gltf& g) { g.json["nodes"][0]["rotation"] = {0, 0, 0, 0}; }), "unit quaternion");
  EXPECT_SAYS(after([](Gltf& g) { g.json["nodes"][0]["scale"] = {1, 1}; }), "scale has 2 numbers");
}

TEST(Mesh, PlaceInTheSceneComesFirst) {
  MeshData data = as_is(folder() + "/there-is-none.glb");
  data.place = "scene.toml:7:3";
  EXPECT_TRUE(line_of(data).starts_with("scene.toml:7:3: " + data.file));
}

}  // namespace
}  // namespace wholehand
