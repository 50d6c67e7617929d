// SPDX-License-Identifier: MIT
// STL, OBJ, PLY, OFF and Collada files: the same triangles as glTF, or one line about why not.
#include "core/meshes/assimp_triangles.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/text/error.h"
#include "core/meshes/assimp_input.h"
#include "core/meshes/check.h"
#include "core/meshes/hints.h"
#include "tests/support/meshes.h"

namespace wholehand {
namespace {

// A folder with a file, for the length of a test.
class MeshFormats : public testing::Test {
 protected:
  MeshFormats() : folder_(testing::TempDir() + "wholehand-formats-" + std::to_string(::getpid())) {
    std::filesystem::create_directories(folder_);
  }
  ~MeshFormats() override { std::filesystem::remove_all(folder_); }

  MeshData file(const std::string& name, const std::string& bytes) const {
    MeshData data;
    data.file = folder_ + "/" + name;
    data.origin_at_base = false;
    std::ofstream(data.file, std::ios::binary | std::ios::trunc) << bytes;
    return data;
  }

  TriangleMesh read(const std::string& name, const std::string& bytes) const { return read_mesh(file(name, bytes), ""); }

  // The refusal, or "read".
  std::string line(const std::string& name, const std::string& bytes) const {
    const MeshData data = file(name, bytes);
    try {
      read_mesh(data, "");
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      const std::string text = error.what();
      EXPECT_EQ(text.find_first_of("\n\r"), text.npos) << text;
      EXPECT_TRUE(text.starts_with(data.file + ": ")) << text;
      return text;
    }
    return "read";
  }

  std::string folder_;
};

struct Written {
  const char* name;
  std::string bytes;
};

std::vector<Written> written_in_all(const TriangleMesh& mesh) {
  return {{"a.stl", stl_text(mesh)},
          {"ascii.STL", ascii_stl_text(mesh)},
          {"a.obj", obj_text(mesh)},
          {"a.ply", ply_text(mesh, PlyWriting::ascii)},
          {"little.ply", ply_text(mesh, PlyWriting::little_endian)},
          {"big.PLY", ply_text(mesh, PlyWriting::big_endian)},
          {"a.off", off_text(mesh)},
          {"a.dae", collada_text(mesh)}};
}

TEST_F(MeshFormats, AllGiveWhatGltfGives) {
  const TriangleMesh mesh = placed_mesh(torus(50, 20, 24, 12), {0.3, 0.2, 0.1}, {5, 60, -7});
  const CheckedMesh gltf = check_mesh(read("a.glb", glb_text(mesh)), "glb");
  for (const Written& each : written_in_all(mesh)) {
    const CheckedMesh checked = check_mesh(read(each.name, each.bytes), each.name);
    EXPECT_EQ(checked.mesh.vertices.size(), gltf.mesh.vertices.size()) << each.name;
    // in order of coordinates; assimp rounds decimal numbers twice, each time to a float
    const std::string ending = std::filesystem::path(each.name).extension();
    const double off = ending == ".obj" || ending == ".STL" || ending == ".off" || ending == ".dae" ? 2 * 100 * 0x1p-23 : 0;
    for (std::size_t i = 0; i < std::min(checked.mesh.vertices.size(), gltf.mesh.vertices.size()); ++i)
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(checked.mesh.vertices[i][k], gltf.mesh.vertices[i][k], off) << each.name;
    EXPECT_EQ(checked.mesh.triangles.size(), gltf.mesh.triangles.size()) << each.name;
    EXPECT_TRUE(checked.facts.closed && checked.facts.oriented) << each.name;
    EXPECT_NEAR(checked.facts.volume, gltf.facts.volume, 1e-6 * gltf.facts.volume) << each.name;
    EXPECT_NE(mesh_size_hint(checked.facts.size()).text.find("mesh_scale = 0.001"), std::string::npos) << each.name;
  }
}

TEST_F(MeshFormats, ContentDecidesWhereTheNameSaysNothing) {
  const TriangleMesh mesh = icosphere(0.05, 1);
  for (const Written& each : written_in_all(mesh)) EXPECT_EQ(read("scan", each.bytes).triangles.size(), 80u) << each.name;
  EXPECT_NE(
      line("scan", "what is this").find("neither its name nor its first bytes are those of glTF, STL, OBJ, PLY, OFF or Collada"),
      std::string::npos);
}

TEST_F(MeshFormats, NameAndContentMustAgree) {
  const TriangleMesh mesh = icosphere(0.05, 1);
  EXPECT_NE(line("a.glb", stl_text(mesh)).find("is named as glTF and holds STL"), std::string::npos);
  EXPECT_NE(line("a.stl", glb_text(mesh)).find("is named as STL and holds glTF"), std::string::npos);
  EXPECT_NE(line("a.obj", ply_text(mesh, PlyWriting::ascii)).find("is named as OBJ and holds PLY"), std::string::npos);
  EXPECT_NE(line("a.ply", obj_text(mesh)).find("is named as PLY and holds OBJ"), std::string::npos);
}

// assimp would open whatever mtllib names.
TEST_F(MeshFormats, OfAnObjOnlyVerticesAndFacesAreLeft) {
  const MeshFile obj{"a.obj", ""};
  EXPECT_EQ(obj_input(obj,
                      "mtllib /etc/passwd\nv 0 0 +0.5 # a comment\nvt 1 1\nv 1 0 0 0.1 0.2 0.3\nusemtl /etc/shadow\ng a\n"
                      "f 1/1 2/1/1 -1//7 \\\n 4\nl 1 2\np 1\ns off\n  v 1e-3 -2 3\nv\t4 5 6\nf 1 2 4"),
            "v 0 0 0.5\nv 1 0 0\nv 0.001 -2 3\nv 4 5 6\nf 1 2 2 4\nf 1 2 4\n");
}

TEST_F(MeshFormats, PolygonsAreCutIntoTriangles) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
  const CheckedMesh cube =
      check_mesh(read("cube.obj", corners + "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf -6 -5 -1 -2\nf 4 1 5 8\n"), "cube");
  EXPECT_TRUE(cube.facts.closed && cube.facts.oriented);
  EXPECT_EQ(cube.facts.triangles, 12u);
  EXPECT_NEAR(cube.facts.volume, 1, 1e-7);
  // an L, which a fan from its first corner would not fill
  std::string prism;
  for (const int z : {0, 1})
    for (const char* xy : {"2 1", "1 1", "1 2", "0 2", "0 0", "2 0"}) prism += fmt::format("v {} {}\n", xy, z);
  prism += "f 1 2 3 4 5 6\nf 12 11 10 9 8 7\n";
  for (int i = 1; i <= 6; ++i) prism += fmt::format("f {0} {2} {3} {1}\n", i, i % 6 + 1, i + 6, i % 6 + 7);
  const CheckedMesh ell = check_mesh(read("ell.obj", prism), "ell");
  EXPECT_TRUE(ell.facts.closed);
  EXPECT_NEAR(ell.facts.volume, 3, 1e-6);
}

// A reader that passes over blanks after a header would lose numbers of these bytes.
TEST_F(MeshFormats, NumbersMadeOfLineEndsAndBlanksAreRead) {
  for (const std::uint32_t bits : {0x3D0A0A0Au, 0x3D202020u, 0x3D0D0A0Du}) {
    const double low = std::bit_cast<float>(bits);
    const TriangleMesh box = box_mesh({low, low, low}, {1, 1, 1});
    for (const PlyWriting writing : {PlyWriting::little_endian, PlyWriting::big_endian})
      EXPECT_EQ(read("a.ply", ply_text(box, writing)).vertices, box.vertices) << bits;
  }
}

TEST_F(MeshFormats, WhatIsNoBodyIsRefused) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n";
  const std::string xyz = head + "property float y\nproperty float z\n", points = "end_header\n0 0 0\n1 0 0\n0 1 0\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n",
                    off_points = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  const std::vector<std::array<std::string, 3>> cases{
      {"a.stl", "", "is empty"},
      {"a.stl", "cylinder", "as a binary STL it has another size"},
      {"a.stl", stl_text(icosphere(1, 1)).substr(0, 500), "as a binary STL it has another size"},
      {"a.stl", std::string(200, '\x05'), "as a binary STL it has another size"},
      {"a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n", "line 4: 'x' is no number"},
      {"a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1\nendloop", "line 5: 'endloop' where 'vertex' should be"},
      {"a.stl", "solid a\nendsolid a\n", "has no triangle"},
      {"a.stl", "solid a\ncolor 1 1 1\n", "line 2: 'color' is no word of an STL"},
      {"a.obj", vertices + "v 1 2\nf 1 2 3\n", "line 4: ends where a number should be"},
      {"a.obj", vertices + "v 1 2 nan\nf 1 2 3\n", "line 4: 'nan' is no finite number"},
      {"a.obj", vertices + "v 1 2 1e39\nf 1 2 3\n", "line 4: '1e39' is no finite number"},
      {"a.obj", vertices + "f 1 2 4\n", "has a face with the vertex 4 and 3 vertices"},
      {"a.obj", vertices + "f 1 2 -4\n", "line 4: has a face with the vertex -4 and 3 vertices before it"},
      {"a.obj", vertices + "f 1 2 0\n", "'0' is no corner of a face"},
      {"a.obj", vertices + "f 1 2 99999999999999999999\n", "is no corner of a face"},
      {"a.obj", vertices + "f 1 2\n", "line 4: has a face of 2 corners"},
      {"a.obj", vertices, "has no face"},
      {"a.obj", vertices + "surf 0 1 0 1 1 2 3\n", "export polygons"},
      {"a.ply", "ply\nformat ascii 1.0\n", "it has no end_header"},
      {"a.ply", "ply\nformat text 1.0\nend_header\n", "line 2: 'text' is no format of a PLY"},
      {"a.ply", "ply\nproperty float x\nend_header\n", "line 2: has a property of no element"},
      {"a.ply", "ply\nelement vertex -3\nend_header\n", "count is no whole number"},
      {"a.ply", head + "property quaternion y\n" + points, "'quaternion' is no type of a PLY"},
      {"a.ply", head + faces + points, "has vertices without y"},
      {"a.ply", xyz + points, "has no face: a cloud of points is no body"},
      {"a.ply", xyz + "element face 1\nproperty int a\n" + points, "has faces without vertex_indices"},
      {"a.ply", xyz + faces + points + "3 0 1\n", "is truncated: it ends before its last element"},
      {"a.ply", xyz + faces + points + "3 0 1 3\n", "has a face with the vertex 3 and 3 vertices, counted from 0"},
      {"a.ply", xyz + faces + points + "3 0 1 -1\n", "has a face with the vertex -1"},
      {"a.ply", xyz + faces + points + "2 0 1\n", "has a face of 2 corners; 3 to 1,000 are read"},
      {"a.ply", xyz + "element tristrips 1\nproperty list int int vertex_indices\n" + points + "3 0 1 2\n", "triangle strips"},
      {"a.ply", xyz + faces + points + "3 0 1 2\n", "has 1 triangle, and a body needs at least 4"},
      {"a.off", "what is this", "line 1: 'what' is no OFF of points in space"},
      {"a.off", "4OFF\n1 1 0\n", "'4OFF' is no OFF of points in space"},
      {"a.off", "OFF BINARY\n", "is a binary OFF, which is not read: export it as text"},
      {"a.off", "OFF\n", "ends where a count of vertices should be"},
      {"a.off", "OFF\n3\n1 0\n", "line 2: ends where a count of faces should be"},
      {"a.off", "OFF\n-3 1 0\n", "'-3' is not a count of vertices"},
      {"a.off", "OFF\n60000001 1 0\n", "more than 20 million triangles"},
      {"a.off", "OFF\n3 0 0\n", "has no face"},
      {"a.off", off_points + "3 0 1\n", "line 6: ends where a corner of a face should be"},
      {"a.off", off_points + "3 0 1 3\n", "has a face with the vertex 3 and 3 vertices, counted from 0"},
      {"a.off", off_points + "2 0 1\n", "has a face of 2 corners; 3 to 1,000 are read"},
      {"a.off", "OFF\n3 1 0\n0 0 0\n1 0\n", "line 4: ends where a number should be"}};
  for (const auto& [name, bytes, gist] : cases) {
    const std::string said = line(name, bytes);
    EXPECT_NE(said.find(gist), std::string::npos) << "'" << gist << "' not in: " << said;
  }
}

TEST_F(MeshFormats, WritersOfOffDiffer) {
  const std::string points = "0 0 0\n1 0 0\n0 2 0\n0 0 3\n", faces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3";
  for (const std::string& text :
       {"OFF\n4 4 6\n" + points + faces, "OFF4 4 0\n" + points + faces,  // as ModelNet has it
        "# a comment\nCOFF 4 4 0\n\n0 0 0 255 0 0 255\r\n1 0 0 1 0 0 1\n# another\n0 2 0\n0 0 3\n" + faces})
    EXPECT_NEAR(check_mesh(read("scan", text), "scan").facts.volume, 1, 1e-7) << text;
  EXPECT_EQ(off_input({"a.off", ""}, "OFF 5 1 0\n0 0 0\n1 0 0\n1 1 0\n0.5 2 0\n0 1 0\n5 0 1 2 3 4\n"),
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 2 0\nv 0 1 0\nf 1 2 3 4 5\n");
}

TEST_F(MeshFormats, OtherFormatsAreNamedWithAConverter) {
  EXPECT_NE(line("cup.FBX", "Kaydara FBX Binary  ")
                .find("is .fbx, which is not read: convert it to glTF or STL, for example with Blender"),
            std::string::npos);
  EXPECT_NE(line("cup.step", "ISO-10303-21;").find("with FreeCAD"), std::string::npos);
  EXPECT_NE(line("cup.3mf", "PK\3\4rest").find("with MeshLab"), std::string::npos) << "an archive";
  EXPECT_NE(line("cup.usdz", "PK\3\4rest").find("with Blender"), std::string::npos);
  EXPECT_NE(line("cup.zip", "PK\3\4rest").find("unpack it"), std::string::npos);
  EXPECT_EQ(read("cup.fbx", stl_text(icosphere(0.05, 1))).triangles.size(), 80u) << "what it holds counts";
}

TEST_F(MeshFormats, TrianglesAreCountedBeforeTheyAreRead) {
  const MeshFile ply{"a.ply", ""};
  const std::string vast =
      "ply\nformat binary_little_endian 1.0\nelement vertex 60000001\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n";
  EXPECT_THROW(ply_input(ply, vast), Error);
}

// Whatever is read or refused, nothing else may happen: assimp alone crashes on such PLY files, or never ends.
TEST_F(MeshFormats, DamageIsReadOrRefused) {
  const TriangleMesh mesh = box_mesh({0, 0, 0}, {1, 2, 3});
  for (const Written& each : written_in_all(mesh)) {
    const std::size_t step = each.bytes.size() / 60 + 1;
    for (std::size_t at = 0; at < each.bytes.size(); at += step) {
      line(each.name, each.bytes.substr(0, at));
      for (const char byte : {'\0', '\xFF', '9', '-', '\n'}) {
        std::string bytes = each.bytes;
        bytes[at] = byte;
        line(each.name, bytes);
      }
    }
  }
}

}  // namespace
}  // namespace wholehand
