// SPDX-License-Identifier: MIT
// What glTF files become: triangles where they should be.
#include "core/meshes/mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/files/json.h"
#include "core/meshes/gltf_file.h"
#include "tests/support/gltf_making.h"
#include "tests/support/meshes.h"

namespace wholehand {
namespace {

TEST(Mesh, EveryIndexWidthAndNone) {
  const std::vector<std::uint16_t> shorts(TETRAHEDRON_FACES.begin(), TETRAHEDRON_FACES.end());
  const std::vector<std::uint32_t> ints(TETRAHEDRON_FACES.begin(), TETRAHEDRON_FACES.end());
  for (int width : {1, 2, 4, 0}) {
    Gltf gltf;
    std::vector<float> corners;
    for (const int i : TETRAHEDRON_FACES) corners.insert(corners.end(), &TETRAHEDRON_LEGS[3 * i], &TETRAHEDRON_LEGS[3 * i] + 3);
    const int position = gltf.positions(width == 0 ? corners : TETRAHEDRON_LEGS);
    gltf.primitive(position, width == 1   ? gltf.indices(TETRAHEDRON_FACES)
                             : width == 2 ? gltf.indices(shorts)
                             : width == 4 ? gltf.indices(ints)
                                          : -1);
    const TriangleMesh mesh = read_gltf(gltf);
    EXPECT_EQ(mesh.triangles.size(), 4u);
    EXPECT_NEAR(mesh_volume(mesh), 1, GLTF_FLOAT_ROUNDING) << width;
  }
}

TEST(Mesh, StripsAndFansKeepTheirSide) {
  Gltf strip;
  strip.primitive(strip.positions(TETRAHEDRON_LEGS), strip.indices<std::uint8_t>({0, 2, 1, 3, 0, 2}), GLTF_STRIP);
  EXPECT_NEAR(mesh_volume(read_gltf(strip)), 1, GLTF_FLOAT_ROUNDING);
  // three faces about one corner, the fourth as a fan of one
  Gltf fan;
  const int position = fan.positions(TETRAHEDRON_LEGS);
  fan.primitive(position, fan.indices<std::uint16_t>({0, 2, 1, 3, 2}), GLTF_FAN);
  fan.primitive(position, fan.indices<std::uint16_t>({1, 2, 3}), GLTF_FAN);
  EXPECT_NEAR(mesh_volume(read_gltf(fan)), 1, GLTF_FLOAT_ROUNDING);
}

TEST(Mesh, SparseAccessorsReplaceWhatTheyName) {
  std::vector<float> moved = TETRAHEDRON_LEGS;
  moved[3] = 9;
  moved[11] = -7;
  Gltf gltf;
  const int base = gltf.view(raw_bytes(moved)), places = gltf.view(raw_bytes<std::uint16_t>({1, 3})),
            values = gltf.view(raw_bytes<float>({1, 0, 0, 0, 0, 3}));
  const Json sparse{{"sparse",
                     {{"count", 2},
                      {"indices", {{"bufferView", places}, {"componentType", GLTF_USHORT}}},
                      {"values", {{"bufferView", values}}}}}};
  gltf.primitive(gltf.accessor(base, GLTF_FLOAT, 4, "VEC3", sparse), gltf.indices(TETRAHEDRON_FACES));
  EXPECT_NEAR(mesh_volume(read_gltf(gltf)), 1, GLTF_FLOAT_ROUNDING);
}

TEST(Mesh, SparseAccessorsMayStandOnNothing) {
  Gltf gltf;
  const int places = gltf.view(raw_bytes<std::uint8_t>({1, 2, 3})),
            values = gltf.view(raw_bytes<float>({1, 0, 0, 0, 2, 0, 0, 0, 3}));
  const Json sparse{
      {"sparse",
       {{"count", 3}, {"indices", {{"bufferView", places}, {"componentType", GLTF_UBYTE}}}, {"values", {{"bufferView", values}}}}}};
  gltf.primitive(gltf.accessor(-1, GLTF_FLOAT, 4, "VEC3", sparse), gltf.indices(TETRAHEDRON_FACES));
  EXPECT_NEAR(mesh_volume(read_gltf(gltf)), 1, GLTF_FLOAT_ROUNDING);
}

TEST(Mesh, NormalizedAndPlainIntegers) {
  struct Case {
    int type;
    std::string bytes;
    bool normalized;
    double leg;
  };
  const std::vector<Case> cases{
      {GLTF_BYTE, raw_bytes<std::int8_t>({0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 0, 0, 0, -128, 0}), true, 1},
      {GLTF_UBYTE, raw_bytes<std::uint8_t>({0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0}), true, 1},
      {GLTF_SHORT, raw_bytes<std::int16_t>({0, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0}), true, 1},
      {GLTF_USHORT, raw_bytes<std::uint16_t>({0, 0, 0, 0, 65535, 0, 0, 0, 0, 65535, 0, 0, 0, 0, 65535, 0}), true, 1},
      {GLTF_USHORT, raw_bytes<std::uint16_t>({0, 0, 0, 0, 300, 0, 0, 0, 0, 300, 0, 0, 0, 0, 300, 0}), false, 300},
      {GLTF_SHORT, raw_bytes<std::int16_t>({0, 0, 0, 0, 300, 0, 0, 0, 0, 300, 0, 0, 0, 0, 300, 0}), false, 300}};
  for (const Case& c : cases) {
    Gltf gltf;
    const int view = gltf.view(c.bytes, static_cast<int>(c.bytes.size()) / 4);
    gltf.primitive(gltf.accessor(view, c.type, 4, "VEC3", {{"normalized", c.normalized}}), gltf.indices(TETRAHEDRON_FACES));
    const TriangleMesh mesh = read_gltf(gltf);
    EXPECT_NEAR(mesh.vertices[1][0], c.leg, 1e-15) << c.type;
    EXPECT_NEAR(std::abs(mesh.vertices[3][2]), c.leg, 1e-15) << c.type;
  }
}

TEST(Mesh, StridedViewsAreStepped) {
  Gltf gltf;
  std::vector<float> interleaved{77, 77, 77};
  for (std::size_t i = 0; i < TETRAHEDRON_LEGS.size(); i += 3)
    interleaved.insert(interleaved.end(), {TETRAHEDRON_LEGS[i], TETRAHEDRON_LEGS[i + 1], TETRAHEDRON_LEGS[i + 2], 5, 6, 7});
  const int view = gltf.view(raw_bytes(interleaved), 24);
  gltf.primitive(gltf.accessor(view, GLTF_FLOAT, 4, "VEC3", {{"byteOffset", 12}}), gltf.indices(TETRAHEDRON_FACES));
  EXPECT_NEAR(mesh_volume(read_gltf(gltf)), 1, GLTF_FLOAT_ROUNDING);
}

TEST(Mesh, NodesPlaceTheirMeshes) {
  Gltf gltf = gltf_tetrahedron();
  const double half = std::sqrt(0.5);
  // the parent moves by (10, 0, 0) and turns by 90 degrees about z; the child scales by (2, 3, 4) and then moves by (0, 1, 0)
  gltf.json["nodes"] = {{{"translation", {10, 0, 0}}, {"rotation", {0, 0, half, half}}, {"children", {1}}},
                        {{"mesh", 0}, {"scale", {2, 3, 4}}, {"translation", {0, 1, 0}}}};
  const TriangleMesh mesh = read_gltf(gltf);
  EXPECT_NEAR(mesh.vertices[0][0], 9, GLTF_FLOAT_ROUNDING);
  EXPECT_NEAR(mesh.vertices[1][1], 2, GLTF_FLOAT_ROUNDING);
  EXPECT_NEAR(mesh.vertices[2][0], 10 - 1 - 6, GLTF_FLOAT_ROUNDING);
  EXPECT_NEAR(mesh.vertices[3][2], 12, GLTF_FLOAT_ROUNDING);
  EXPECT_NEAR(mesh_volume(mesh), 24, 1e-5);
}

TEST(Mesh, MatricesAreReadByColumns) {
  Gltf gltf = gltf_tetrahedron();
  gltf.json["nodes"] = {{{"mesh", 0}, {"matrix", {0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 5, 6, 7, 1}}}};
  const TriangleMesh mesh = read_gltf(gltf);
  EXPECT_EQ(mesh.vertices[0], (Triple{5, 6, 7}));
  EXPECT_EQ(mesh.vertices[1], (Triple{5, 7, 7}));
  EXPECT_EQ(mesh.vertices[3], (Triple{8, 6, 7}));
  EXPECT_NEAR(mesh_volume(mesh), 1, GLTF_FLOAT_ROUNDING);
}

TEST(Mesh, MirroringNodesKeepTheOutsideOut) {
  Gltf gltf = gltf_tetrahedron();
  gltf.json["nodes"] = {{{"mesh", 0}, {"scale", {-1, 1, 1}}}};
  EXPECT_NEAR(mesh_volume(read_gltf(gltf)), 1, GLTF_FLOAT_ROUNDING);
  gltf.json["nodes"] = {{{"scale", {1, -1, 1}}, {"children", {1}}}, {{"mesh", 0}, {"scale", {1, 1, -2}}}};
  EXPECT_NEAR(mesh_volume(read_gltf(gltf)), 2, GLTF_FLOAT_ROUNDING);
}

TEST(Mesh, AllMeshesOfTheDefaultSceneAndNoOther) {
  Gltf gltf = gltf_tetrahedron();
  gltf.json["nodes"] = {
      {{"mesh", 0}}, {{"mesh", 0}, {"translation", {5, 0, 0}}}, {{"mesh", 0}, {"translation", {50, 0, 0}}}, {{"camera", 0}}};
  gltf.json["scenes"] = {{{"nodes", {2}}}, {{"nodes", {0, 1, 3}}}};
  gltf.json["scene"] = 1;
  EXPECT_EQ(read_gltf(gltf).triangles.size(), 8u);
  gltf.json.erase("scene");
  EXPECT_EQ(read_gltf(gltf).triangles.size(), 4u);
}

TEST(Mesh, IsScaledThenTurnedThenSetDown) {
  const std::string path = write_gltf("a.glb", gltf_tetrahedron().glb());
  MeshData data = mesh_as_is(path);
  data.scale = 0.1;
  data.rotate = {0, 0, std::numbers::pi / 2};
  EXPECT_NEAR(read_mesh(data, "").vertices[2][0], -0.2, GLTF_FLOAT_ROUNDING);
  // first about x, then about the y that x has turned: the leg along z goes to -y by x; about the turned y it would stay in the
  // plane
  data.rotate = {std::numbers::pi / 2, std::numbers::pi / 2, 0};
  const TriangleMesh turned = read_mesh(data, "");
  EXPECT_NEAR(turned.vertices[3][0], 0.3, GLTF_FLOAT_ROUNDING);  // z -> (Ry) x -> (Rx) x
  EXPECT_NEAR(turned.vertices[1][1], 0.1, GLTF_FLOAT_ROUNDING);  // x -> (Ry) -z -> (Rx) y
  EXPECT_NEAR(turned.vertices[2][2], 0.2, GLTF_FLOAT_ROUNDING);  // y -> (Ry) y -> (Rx) z
  data.rotate = {};
  data.origin_at_base = true;
  const TriangleMesh set = read_mesh(data, "");
  EXPECT_NEAR(set.vertices[0][0], -0.05, GLTF_FLOAT_ROUNDING);
  EXPECT_NEAR(set.vertices[0][1], 0, GLTF_FLOAT_ROUNDING);
  EXPECT_NEAR(set.vertices[0][2], -0.15, GLTF_FLOAT_ROUNDING);
}

TEST(Mesh, APointHasNoSayInWhereTheOriginIs) {
  TriangleMesh mesh = box_mesh({0, 0, 0}, {0.1, 0.2, 0.3});
  mesh.vertices.push_back({5, -1, 0});
  mesh.triangles.push_back({8, 8, 8});
  MeshData data = mesh_as_is(write_gltf("a.glb", glb_text(mesh)));
  data.origin_at_base = true;
  const TriangleMesh set = read_mesh(data, "");
  EXPECT_NEAR(set.vertices[0][0], -0.05, 1e-8);  // the file's single precision
  EXPECT_NEAR(set.vertices[0][1], 0, 1e-8);
  EXPECT_NEAR(set.vertices[0][2], -0.15, 1e-8);
}

TEST(Mesh, ZUpIsTurnedBeforeAnythingElse) {
  MeshData data = mesh_as_is(write_gltf("a.glb", gltf_tetrahedron().glb()));
  data.z_is_up = true;
  data.scale = 0.1;
  const TriangleMesh upright = read_mesh(data, "");
  EXPECT_NEAR(upright.vertices[1][0], 0.1, GLTF_FLOAT_ROUNDING);   // x stays
  EXPECT_NEAR(upright.vertices[2][2], -0.2, GLTF_FLOAT_ROUNDING);  // y to the back
  EXPECT_NEAR(upright.vertices[3][1], 0.3, GLTF_FLOAT_ROUNDING);   // z up
  EXPECT_NEAR(mesh_volume(upright), 1e-3, GLTF_FLOAT_ROUNDING);    // a turn, no mirror
  data.rotate = {std::numbers::pi / 2, 0, 0};                      // which undoes it
  const TriangleMesh turned = read_mesh(data, "");
  EXPECT_NEAR(turned.vertices[2][1], 0.2, GLTF_FLOAT_ROUNDING);
  EXPECT_NEAR(turned.vertices[3][2], 0.3, GLTF_FLOAT_ROUNDING);
  data.origin_at_base = true;
  EXPECT_NEAR(read_mesh(data, "").vertices[2][1], 0.2, GLTF_FLOAT_ROUNDING);
}

// The vertices are on a view that is not there: whoever counts first does not come to see that.
TEST(Mesh, TrianglesAreCountedBeforeAnyIsRead) {
  const auto shown = [](int nodes, int primitives) {
    Gltf gltf;
    const int points = gltf.accessor(7, GLTF_FLOAT, 4, "VEC3"), corners = gltf.indices(std::vector<std::uint8_t>(300'000));
    for (int i = 0; i < primitives; ++i) gltf.primitive(points, corners);
    gltf.json["scenes"][0]["nodes"] = gltf.json["nodes"] = Json::array();
    for (int i = 0; i < nodes; ++i) {
      gltf.json["nodes"].push_back({{"mesh", 0}});
      gltf.json["scenes"][0]["nodes"].push_back(i);
    }
    return mesh_refusal(gltf);
  };
  EXPECT_SAYS(shown(200, 1), "bufferViews[7]");  // 20 million, which are read
  EXPECT_SAYS(shown(201, 1), "more than 20 million triangles");
  EXPECT_SAYS(shown(1, 201), "more than 20 million triangles");
  EXPECT_SAYS(shown(67, 3), "more than 20 million triangles");
}

TEST(Mesh, DeepChainsOfNodesAreRead) {
  Gltf gltf = gltf_tetrahedron();
  const int depth = 20'000;
  gltf.json["nodes"] = Json::array();
  for (int i = 0; i + 1 < depth; ++i) gltf.json["nodes"].push_back({{"children", {i + 1}}});
  gltf.json["nodes"].push_back({{"mesh", 0}});
  EXPECT_EQ(read_gltf(gltf).triangles.size(), 4u);
}

TEST(Mesh, BuffersMayBeFilesOrDataUris) {
  Gltf gltf = gltf_tetrahedron();
  gltf.json["buffers"] = {{{"byteLength", gltf.binary.size()}, {"uri", "a%20buffer.bin"}}};
  std::filesystem::create_directories(gltf_folder() + "/models");
  write_gltf("models/a buffer.bin", gltf.binary);
  write_gltf("models/a.gltf", json_text(gltf.json));
  EXPECT_EQ(read_mesh(mesh_as_is("models/a.gltf"), gltf_folder()).triangles.size(), 4u);
  // four corners of a byte each, and the faces
  Gltf small;
  const int position = small.accessor(small.view(std::string("\0\0\0\0\1\0\0\0\0\2\0\0\0\0\3\0", 16), 4), GLTF_UBYTE, 4, "VEC3");
  small.primitive(position, small.indices(TETRAHEDRON_FACES));
  small.json["buffers"] = {
      {{"byteLength", 28}, {"uri", "data:application/octet-stream;base64,AAAAAAEAAAAAAgAAAAADAAACAQABAwADAgECAw=="}}};
  EXPECT_NEAR(mesh_volume(read_mesh(mesh_as_is(write_gltf("small.gltf", json_text(small.json))), "")), 1, GLTF_FLOAT_ROUNDING);
}

TEST(Mesh, LooksAreLeftOut) {
  Gltf gltf = gltf_tetrahedron();
  gltf.json["images"] = {{{"uri", "missing.png"}}, {{"bufferView", 999}}};
  gltf.json["textures"] = {{{"source", 0}}};
  gltf.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  gltf.json["extensionsUsed"] = {"KHR_materials_unlit", "KHR_texture_transform"};
  gltf.json["extensionsRequired"] = {"KHR_texture_transform"};
  gltf.json["extras"] = {{"a", 1}};
  EXPECT_EQ(read_gltf(gltf).triangles.size(), 4u);
}

}  // namespace
}  // namespace wholehand
