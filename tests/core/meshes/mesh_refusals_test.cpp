// SPDX-License-Identifier: MIT
// What is no glTF file, or one that is not read: one line about why not.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "base/files/json.h"
#include "core/scene.h"
#include "tests/support/files.h"
#include "tests/support/gltf_making.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"

namespace wholehand {
namespace {

TEST(Mesh, WhatIsNotReadIsNamedWithTheRemedy) {
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["nodes"][0]["skin"] = 0; }), "skin, which is not read: apply the armature");
  EXPECT_SAYS(refusal_after([](Gltf& g) {
                g.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}};
              }),
              "morph targets");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["extensionsUsed"] = {"KHR_meshopt_compression"}; }),
              "is compressed (KHR_meshopt_compression), which is not read");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"}; }), "make them real");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["extensionsUsed"] = {"KHR_node_visibility"}; }), "remove what is hidden");
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["extensionsRequired"] = {"ACME_shape"}; }), "requires the extension ACME_shape");
  for (const auto& [mode, name] : std::map<int, std::string>{{0, "points"}, {1, "lines"}, {2, "lines"}, {3, "lines"}})
    EXPECT_SAYS(refusal_after([mode = mode](Gltf& g) { g.json["meshes"][0]["primitives"][0]["mode"] = mode; }), "made of " + name);
  EXPECT_SAYS(refusal_after([](Gltf& g) { g.json["meshes"][0]["primitives"][0]["mode"] = 7; }), "mode 7");
}

// What such a line says to do, done: the file as it is refused, words of the line, and what they make of it.
TEST(Mesh, AFileIsReadOnceItsRemedyIsFollowed) {
  using Change = std::function<void(Gltf&)>;
  struct Case {
    Change change;
    const char* words;
    Change mend;
  };
  const auto used = [](const char* name) {
    return [=](Gltf& g) { g.json["extensionsUsed"] = g.json["extensionsRequired"] = {name}; };
  };
  const auto without_extensions = [](Gltf& g) {
    g.json.erase("extensionsUsed");
    g.json.erase("extensionsRequired");
  };
  const std::vector<Case> cases{
      {[](Gltf& g) { g.json["nodes"][0]["skin"] = 0; }, "apply the armature", [](Gltf& g) { g.json["nodes"][0].erase("skin"); }},
      {[](Gltf& g) {
         g.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}};
       },
       "apply the shape keys", [](Gltf& g) { g.json["meshes"][0]["primitives"][0].erase("targets"); }},
      {used("KHR_meshopt_compression"), "export it with EXT_meshopt_compression, or without", without_extensions},
      {used("EXT_mesh_gpu_instancing"), "make them real, then export",
       [&](Gltf& g) {
         without_extensions(g);
         g.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {5, 0, 0}}}};
         g.json["scenes"][0]["nodes"] = {0, 1};
       }},
      {used("KHR_node_visibility"), "remove what is hidden, export it without", without_extensions},
      {used("ACME_shape"), "requires the extension ACME_shape, which is not read: export it without", without_extensions},
      {[](Gltf& g) { g.primitive(0, 1, 1); }, "made of lines, which have no inside: remove it",
       [](Gltf& g) { g.json["meshes"][0]["primitives"].erase(1); }},
      {[](Gltf& g) { g.json["scenes"] = Json::array(); }, "export the objects within a scene",
       [](Gltf& g) {
         g.json["scenes"] = {{{"nodes", {0}}}};
       }},
      // 2,000 triangles, 10,001 times
      {[](Gltf& g) {
         std::vector<std::uint8_t> faces;
         for (int k = 0; k < 500; ++k) faces.insert(faces.end(), TETRAHEDRON_FACES.begin(), TETRAHEDRON_FACES.end());
         g.json["meshes"][0]["primitives"][0]["indices"] = g.indices(faces);
         for (int k = 1; k <= 10'000; ++k) {
           g.json["nodes"].push_back({{"mesh", 0}, {"translation", {5 * k, 0, 0}}});
           g.json["scenes"][0]["nodes"].push_back(k);
         }
       },
       "has more than 20 million triangles, or three times as many vertices: simplify it",
       [](Gltf& g) { g.json["meshes"][0]["primitives"][0]["indices"] = 1; }},
  };
  for (const Case& each : cases) {
    Gltf gltf = gltf_tetrahedron();
    each.change(gltf);
    EXPECT_SAYS(mesh_refusal(gltf), each.words);
    each.mend(gltf);
    EXPECT_EQ(mesh_refusal(gltf), "read") << each.words;
  }
}

// A prism with `sides` sides, whose ends are polygons, or triangles.
std::string prism_text(int sides, bool is_cut) {
  std::string text;
  for (const int y : {0, 1})
    for (int k = 0; k < sides; ++k)
      text += fmt::format("v {} {} {}\n", std::cos(2 * PI * k / sides), y, std::sin(2 * PI * k / sides));
  for (int k = 1; k <= sides; ++k) {
    const int next = k % sides + 1;
    text += fmt::format("f {} {} {} {}\n", k, sides + k, sides + next, next);
    if (is_cut && k > 1 && k < sides) text += fmt::format("f 1 {} {}\nf {} {} {}\n", k, next, sides + 1, sides + next, sides + k);
  }
  if (is_cut) return text;
  for (const int end : {0, 1}) {
    text += "f";
    for (int k = 0; k < sides; ++k) text += fmt::format(" {}", end == 0 ? k + 1 : 2 * sides - k);
    text += "\n";
  }
  return text;
}

TEST(Mesh, AFileOfAnotherFormatIsReadOnceItsRemedyIsFollowed) {
  struct Case {
    std::string name, bytes, words, mended_name, mended_bytes;
  };
  Gltf gltf = gltf_tetrahedron();
  const std::string glb = gltf.glb();
  gltf.json["buffers"] = {{{"byteLength", gltf.binary.size()}, {"uri", "data:text/csv,1"}}};
  const std::string beside = json_text(gltf.json);
  const TriangleMesh box = box_mesh({0, 0, 0}, {1, 1, 1});
  const std::string points = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n",
                    strip = "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const Case& each : std::vector<Case>{
           {"a.gltf", beside, "a data URI of a kind that is not read: export as .glb", "a.glb", glb},
           {"a.gltf", "{" + std::string(std::size_t{65} << 20, ' ') + beside.substr(1), "export as .glb", "a.glb", glb},
           {"a.obj", glb, "is named as OBJ and holds glTF: give it the ending of what it holds", "a.glb", glb},
           {"a.obj", obj_text(box) + "cstype bezier\n", "which are not read: export polygons", "a.obj", obj_text(box)},
           {"a.obj", prism_text(1001, false), "cut it into triangles", "a.obj", prism_text(1001, true)},
           {"a.ply", points + strip, "export faces", "a.ply", ply_text(box, PlyWriting::ascii)},
       }) {
    EXPECT_SAYS(mesh_refusal(mesh_as_is(write_gltf(each.name, each.bytes))), each.words);
    EXPECT_EQ(mesh_refusal(mesh_as_is(write_gltf(each.mended_name, each.mended_bytes))), "read") << each.words;
  }
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
  EXPECT_SAYS(mesh_refusal(mesh_as_is(large)), "2,048 MB large");
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

TEST(Mesh, NumbersOfAnStlThatAreNoneAreRefused) {
  constexpr std::size_t HEAD = 84, RECORD = 50, NORMAL = 12;
  const std::string whole = stl_text(box_mesh({0, 0, 0}, {1, 1, 1}));
  const auto with_number = [&](float number, std::size_t triangle, std::size_t corner, std::size_t axis) {
    std::string bytes = whole;
    std::memcpy(bytes.data() + HEAD + RECORD * triangle + NORMAL + 12 * corner + 4 * axis, &number, sizeof number);
    return mesh_refusal(mesh_as_is(write_gltf("bad.stl", bytes)));
  };
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  EXPECT_SAYS(with_number(nan, 0, 0, 0), "triangle 1: 'nan' is no finite number");
  EXPECT_SAYS(with_number(infinity, 6, 1, 1), "triangle 7: 'inf' is no finite number");
  EXPECT_SAYS(with_number(-infinity, 11, 2, 2), "triangle 12: '-inf' is no finite number");
  EXPECT_SAYS(with_number(3e38F, 3, 0, 2), "has a vertex at 3e+38, beyond 1e+15, in its own numbers");
  EXPECT_SAYS(with_number(1e14F, 3, 0, 2), "more than a million km away: its scale is wrong");
}

TEST(Mesh, NumbersThatNoScaleBringsNearAreRefused) {
  const TriangleMesh box = box_mesh({0, 0, 0}, {1, 1e20, 1});
  for (const auto& far : {std::pair("far.glb", glb_text(box)), {"far.obj", obj_text(box)}, {"far.off", off_text(box)}}) {
    EXPECT_SAYS(mesh_refusal(mesh_as_is(write_gltf(far.first, far.second))), "has a vertex at 1e+20, beyond 1e+15");
    EXPECT_SAYS(refusal_line([&] { read_triangles({gltf_folder() + "/" + far.first, ""}); }), "beyond 1e+15");
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
