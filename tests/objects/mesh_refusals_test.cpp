// SPDX-License-Identifier: MIT
// What is no glTF file, or one that is not read: one line about why not.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "system/json.h"
#include "tests/support/files.h"

#include "tests/support/gltf_making.h"

namespace wholehand {
namespace {

TEST(Mesh, WhatIsNotReadIsNamedWithTheRemedy) {
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["nodes"][0]["skin"] = 0; }), "skin, which is not read: apply the armature");
  EXPECT_SAYS(refusal_after([](Gltf& g) {
                g.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}};
              }),
              "morph targets");
  for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"}) {
    const std::string line = refusal_after([&](Gltf& g) { g.json["extensionsUsed"] = g.json["extensionsRequired"] = {name}; });
    EXPECT_SAYS(line, name);
    EXPECT_SAYS(line, "without compression");
  }
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"}; }), "make them real");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["extensionsUsed"] = {"KHR_node_visibility"}; }), "remove what is hidden");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["extensionsRequired"] = {"ACME_shape"}; }), "requires the extension ACME_shape");
  for (const auto& [mode, name] : std::map<int, std::string>{{0, "points"}, {1, "lines"}, {2, "lines"}, {3, "lines"}})
    EXPECT_SAYS(refusal_after([mode = mode](Gltf& g) { g.json["meshes"][0]["primitives"][0]["mode"] = mode; }), "made of " + name);
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["meshes"][0]["primitives"][0]["mode"] = 7; }), "mode 7");
}

TEST(Mesh, BytesThatAreNoGltfAreRefused) {
  EXPECT_SAYS(mesh_refusal_of_bytes(""), "is empty");
  EXPECT_SAYS(mesh_refusal_of_bytes("what is this"), "neither .glb nor .gltf");
  EXPECT_SAYS(mesh_refusal_of_bytes("{\"asset\": "), "is damaged, or no glTF");
  EXPECT_SAYS(mesh_refusal_of_bytes("{}"), "no asset.version");
  EXPECT_SAYS(mesh_refusal_of_bytes(std::string(200'000, '[')), "neither");
  EXPECT_SAYS(mesh_refusal_of_bytes("{\"a\":" + std::string(200'000, '[')), "nested more than 64");
  EXPECT_SAYS(mesh_refusal(mesh_as_is(gltf_folder() + "/there-is-none.glb")), "no such file");
  EXPECT_SAYS(mesh_refusal(mesh_as_is(gltf_folder())), "is not a file");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["asset"]["version"] = "1.0"; }), "glTF version '1.0'");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["asset"]["minVersion"] = "2.1"; }), "needs a reader of glTF '2.1'");
  std::string old = gltf_tetrahedron().glb();
  old[4] = 1;
  EXPECT_SAYS(mesh_refusal_of_bytes(old), "glTF version 1");
}

TEST(Mesh, EveryTruncationIsRefused) {
  const std::string whole = gltf_tetrahedron().glb();
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_NE(mesh_refusal_of_bytes(whole.substr(0, length)), "read") << length;
}

TEST(Mesh, AChangedByteIsReadOrRefused) {
  const std::string whole = gltf_tetrahedron().glb();
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const char byte : {'\0', '\xFF', '9', '"', '-'}) {
      std::string bytes = whole;
      bytes[at] = byte;
      mesh_refusal_of_bytes(bytes);  // anything but Error ends the test
    }
}

TEST(Mesh, SizesThatAreAbsurdAreRefused) {
  const std::string large = write_gltf("large.glb", "glTF");
  std::filesystem::resize_file(large, std::uintmax_t{2} << 30);  // no blocks of the disk are taken
  EXPECT_SAYS(mesh_refusal(mesh_as_is(large)), "2048 MB large");
  std::filesystem::remove(large);
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["accessors"][0]["count"] = 2'000'000'000; }), "absurd");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["accessors"][0]["count"] = 4'294'967'300; }), "accessors[0].count");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["accessors"][0]["count"] = -1; }), "accessors[0].count");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["accessors"][0]["count"] = "four"; }), "accessors[0].count is not an integer");
  Gltf zeros = gltf_tetrahedron();
  zeros.json["accessors"][0].erase("bufferView");
  EXPECT_SAYS(mesh_refusal(zeros), "has no data");
  MeshData giant = mesh_as_is(write_gltf("a.glb", gltf_tetrahedron().glb()));
  giant.scale = 1e300;
  EXPECT_SAYS(mesh_refusal(giant), "scale is wrong");
}

TEST(Mesh, ReferencesThatLeadNowhereAreRefused) {
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["scene"] = 3; }), "names scene 3 and has 1");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["scenes"] = Json::array(); }), "no scene");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["scenes"][0]["nodes"] = {7}; }), "nodes[7]");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["nodes"][0]["mesh"] = 7; }), "meshes[7]");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 7; }), "accessors[7]");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["meshes"][0]["primitives"][0]["indices"] = 7; }), "out of bounds");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["accessors"][0]["bufferView"] = 7; }), "bufferViews[7]");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["accessors"][1]["bufferView"] = 7; }), "accessor[1] invalid bufferView");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["bufferViews"][0]["buffer"] = 7; }), "buffers[7]");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["bufferViews"][0]["byteLength"] = 70'000; }), "beyond its buffer");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["accessors"][0]["count"] = 5; }), "accessors[0] reaches beyond");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["accessors"][1]["byteOffset"] = 1; }), "accessors[1] reaches beyond");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["accessors"][0]["type"] = "VEC2"; }), "not VEC3");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["accessors"][1]["componentType"] = GLTF_BYTE; }), "no SCALAR of unsigned");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["accessors"][0]["componentType"] = 5124; }), "component type 5124");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.binary[g.binary.size() - 1] = 9; }), "index 9 and 4 vertices");
}

TEST(Mesh, BuffersOutsideTheFolderAreNotRead) {
  write_gltf("secret.bin", gltf_tetrahedron().binary);
  std::filesystem::create_directories(gltf_folder() + "/inner");
  for (const std::string& uri : {std::string("../secret.bin"), gltf_folder() + "/secret.bin", std::string("%2e%2e/secret.bin"),
                                 std::string("a/../../secret.bin"), std::string("file:///etc/passwd")}) {
    Gltf gltf = gltf_tetrahedron();
    gltf.json["buffers"] = {{{"byteLength", gltf.binary.size()}, {"uri", uri}}};
    EXPECT_SAYS(mesh_refusal(mesh_as_is(write_gltf("inner/a.gltf", json_text(gltf.json)))), "outside its own folder");
  }
  Gltf gltf = gltf_tetrahedron();
  gltf.json["buffers"] = {{{"byteLength", gltf.binary.size()}, {"uri", "missing.bin"}}};
  EXPECT_SAYS(mesh_refusal(mesh_as_is(write_gltf("a.gltf", json_text(gltf.json)))), "missing.bin");
  write_gltf("pointer.bin", "version https://git-lfs.github.com/spec/v1\noid sha256:4d\nsize 48\n");
  gltf.json["buffers"] = {{{"byteLength", gltf.binary.size()}, {"uri", "pointer.bin"}}};
  EXPECT_SAYS(mesh_refusal(mesh_as_is(write_gltf("a.gltf", json_text(gltf.json)))),
              "pointer.bin is a Git LFS pointer and not the file: git lfs pull");
  gltf.json["buffers"] = {{{"byteLength", gltf.binary.size()}}};
  EXPECT_SAYS(mesh_refusal(mesh_as_is(write_gltf("a.gltf", json_text(gltf.json)))), "buffers[0] has no uri");
  gltf.json["buffers"] = {{{"byteLength", gltf.binary.size()}, {"uri", "data:text/csv,1"}}};
  EXPECT_SAYS(mesh_refusal(mesh_as_is(write_gltf("a.gltf", json_text(gltf.json)))), "data URI");
}

TEST(Mesh, ShapesThatAreNoBodyAreRefused) {
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["nodes"] = {{{"name", "empty"}}}; }), "no mesh in its scene");
  Gltf two;
  two.primitive(two.positions(TETRAHEDRON_LEGS), two.indices<std::uint8_t>({0, 1, 2, 2, 1, 0}));
  EXPECT_SAYS(mesh_refusal(two), "2 triangles");
  Gltf half;
  half.primitive(half.positions(TETRAHEDRON_LEGS), half.indices<std::uint8_t>({0, 1, 2, 2}));
  EXPECT_SAYS(mesh_refusal(half), "no whole triangles");
  for (const float wrong : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    std::vector<float> numbers = TETRAHEDRON_LEGS;
    numbers[4] = wrong;
    Gltf gltf;
    gltf.primitive(gltf.positions(numbers), gltf.indices(TETRAHEDRON_FACES));
    EXPECT_SAYS(mesh_refusal(gltf), "not a finite number");
  }
}

TEST(Mesh, NodesThatAreTheirOwnAncestorsAreRefused) {
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["nodes"][0]["children"] = {0}; }), "its own ancestor");
  EXPECT_SAYS(refusal_after([](Gltf& g) {
                g.json["nodes"] = {{{"children", {1}}}, {{"mesh", 0}, {"children", {0}}}};
              }),
              "its own ancestor");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["scenes"][0]["nodes"] = {0, 0}; }), "two parents");
}

TEST(Mesh, TransformsThatAreNoneAreRefused) {
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["nodes"][0]["matrix"] = {1, 2, 3}; }), "matrix has 3 numbers");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }),
              "last row");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["nodes"][0]["rotation"] = {0, 0, 0, 0}; }), "unit quaternion");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["nodes"][0]["scale"] = {1, 1}; }), "scale has 2 numbers");
}

TEST(Mesh, PlaceInTheSceneComesFirst) {
  MeshData data = mesh_as_is(gltf_folder() + "/there-is-none.glb");
  data.place = "scene.toml:7:3";
  EXPECT_TRUE(mesh_refusal(data).starts_with("scene.toml:7:3: " + data.file));
}

}  // namespace
}  // namespace wholehand
