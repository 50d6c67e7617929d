// SPDX-License-Identifier: MIT
// Compressed glTF files: the same triangles as without compression, and one line about damaged ones.
#include "core/meshes/gltf_compression.h"

// Draco has an enumerator JOINTS, and shaders/layout.h a macro of that name.
#pragma push_macro("JOINTS")
#undef JOINTS
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#pragma pop_macro("JOINTS")

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>

#include "core/meshes/check.h"
#include "tests/support/gltf_making.h"
#include "tests/support/meshes.h"

namespace wholehand {
namespace {

// A ring whose corners lie anywhere between -0.07 and 0.07 m.
TriangleMesh packed_ring() { return placed_mesh(torus(0.05, 0.02, 24, 12), {0.3, 0.2, 0.1}, {}); }

double volume_of_file(const std::string& bytes) { return mesh_volume(read_mesh(mesh_as_is(write_gltf("packed.glb", bytes)), "")); }

// ---- Draco ----

struct DracoBytes {
  std::string bytes;
  std::uint32_t id = 0;  // of the positions
  std::size_t points = 0, triangles = 0;
};

// `scale`: of the coordinates, before they become T.
template <class T>
DracoBytes draco_bytes(const TriangleMesh& mesh, draco::DataType type, double scale, int method, int speed, int bits) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(mesh.triangles.size()));
  const int normal = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32),
            position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, type);
  const std::array<float, 3> up{0, 1, 0};
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<std::array<T, 3>, 3> corners{};
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) corners[i][k] = static_cast<T>(scale * mesh.vertices[mesh.triangles[t][i]][k]);
    builder.SetAttributeValuesForFace(normal, draco::FaceIndex(t), up.data(), up.data(), up.data());
    builder.SetAttributeValuesForFace(position, draco::FaceIndex(t), corners[0].data(), corners[1].data(), corners[2].data());
  }
  const std::unique_ptr<draco::Mesh> made = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  encoder.SetSpeedOptions(speed, speed);
  if (bits > 0) encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*made, &buffer).ok());
  return {{buffer.data(), buffer.size()}, made->attribute(position)->unique_id(), made->num_points(), made->num_faces()};
}

DracoBytes draco_ring(int method = draco::MESH_EDGEBREAKER_ENCODING) {
  return draco_bytes<float>(packed_ring(), draco::DT_FLOAT32, 1, method, 5, 14);
}

Gltf draco_gltf(const DracoBytes& packed, int type = GLTF_FLOAT) {
  Gltf gltf;
  const int view = gltf.view(packed.bytes),
            position = gltf.accessor(-1, type, packed.points, "VEC3", {{"normalized", type != GLTF_FLOAT}}),
            corners = gltf.accessor(-1, GLTF_UINT, 3 * packed.triangles, "SCALAR");
  gltf.primitive(position, corners);
  gltf.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view},
                                                                                         {"attributes", {{"POSITION", packed.id}}}};
  gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return gltf;
}

TEST(MeshCompression, DracoGivesTheSameTriangles) {
  const TriangleMesh ring = packed_ring();
  const double volume = volume_of_file(glb_text(ring));
  for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING})
    for (const int speed : {0, 5, 10})
      for (const int bits : {0, 14}) {
        const DracoBytes packed = draco_bytes<float>(ring, draco::DT_FLOAT32, 1, method, speed, bits);
        EXPECT_GT(packed.id, 0u) << "the normals are 0";
        const TriangleMesh read = read_gltf(draco_gltf(packed));
        EXPECT_EQ(read.triangles.size(), ring.triangles.size());
        EXPECT_EQ(read.vertices.size(), ring.vertices.size());
        // 2^-14 of 14 cm is 9 um, of 20 mm
        EXPECT_NEAR(mesh_volume(read) / volume, 1, bits == 0 ? 1e-12 : 1e-3) << method << " " << speed << " " << bits;
      }
}

TEST(MeshCompression, DracoKeepsIntegerCoordinates) {
  const double scale = 32767 / 0.1;
  const DracoBytes packed =
      draco_bytes<std::int16_t>(packed_ring(), draco::DT_INT16, scale, draco::MESH_EDGEBREAKER_ENCODING, 5, 0);
  Gltf gltf = draco_gltf(packed, GLTF_SHORT);
  gltf.json["extensionsRequired"].push_back("KHR_mesh_quantization");
  gltf.json["nodes"][0]["scale"] = {0.1, 0.1, 0.1};
  EXPECT_NEAR(mesh_volume(read_gltf(gltf)) / volume_of_file(glb_text(packed_ring())), 1, 1e-3) << "3 um, of 20 mm";
}

// With plain accessors beside it, which other readers may take.
TEST(MeshCompression, DracoIsReadWhereItIsOptional) {
  Gltf gltf = gltf_tetrahedron();
  const DracoBytes packed = draco_ring();
  gltf.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", gltf.view(packed.bytes)},
                                                                                         {"attributes", {{"POSITION", packed.id}}}};
  gltf.json["accessors"][1]["count"] = 3 * packed.triangles;
  gltf.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  EXPECT_EQ(read_gltf(gltf).triangles.size(), packed.triangles);
}

TEST(MeshCompression, WrongDracoIsRefused) {
  const DracoBytes packed = draco_ring();
  const auto refused = [&](const std::function<void(Gltf&, Json&)>& change) {
    Gltf gltf = draco_gltf(packed);
    change(gltf, gltf.json["meshes"][0]["primitives"][0]);
    return mesh_refusal(gltf);
  };
  const std::string name = "KHR_draco_mesh_compression", place = "meshes[0].primitives[0].extensions." + name;
  EXPECT_EQ(refused([](Gltf&, Json&) {}), "read");
  EXPECT_SAYS(refused([&](Gltf&, Json& primitive) { primitive["extensions"][name]["bufferView"] = 9; }),
              place + " names bufferViews[9], which is not there");
  EXPECT_SAYS(refused([&](Gltf&, Json& primitive) { primitive["extensions"][name]["attributes"]["POSITION"] = 7; }),
              place + " has no attribute 7");
  EXPECT_SAYS(refused([&](Gltf&, Json& primitive) { primitive["extensions"][name]["attributes"].erase("POSITION"); }),
              "has no attribute -1");
  EXPECT_SAYS(refused([&](Gltf&, Json& primitive) { primitive["extensions"][name]["bufferView"] = "0"; }), "is not an integer");
  EXPECT_SAYS(refused([](Gltf&, Json& primitive) { primitive.erase("indices"); }), "is there without indices");
  EXPECT_SAYS(refused([](Gltf&, Json& primitive) { primitive["indices"] = 9; }), "needs accessors[9], which is not there");
  EXPECT_SAYS(refused([](Gltf&, Json& primitive) { primitive["mode"] = GLTF_STRIP; }), "holds no list of triangles");
  EXPECT_SAYS(refused([&](Gltf& gltf, Json&) { gltf.json["accessors"][1]["count"] = 3 * packed.triangles - 3; }),
              place + " says more triangles or points than its accessors and its bytes hold");
  EXPECT_SAYS(refused([](Gltf& gltf, Json&) { gltf.json["accessors"][1]["count"] = 2'000'000'000; }),
              "more than 20 million triangles");
  EXPECT_SAYS(refused([](Gltf& gltf, Json&) { gltf.json["bufferViews"][0]["byteLength"] = 1'000'000; }),
              "reaches beyond buffers[0]");
  EXPECT_SAYS(refused([](Gltf& gltf, Json&) { gltf.json["bufferViews"][0]["buffer"] = 3; }),
              "names buffers[3], which is not there");
  EXPECT_SAYS(refused([](Gltf& gltf, Json&) { gltf.binary[0] = 'd'; }), place + " is no Draco data");
  EXPECT_SAYS(refused([](Gltf& gltf, Json&) { gltf.binary[5] = 1; }), place + " is Draco 1.2, and 2.2 is read");
  EXPECT_SAYS(refused([](Gltf& gltf, Json&) { gltf.binary[7] = 0; }), place + " holds a cloud of points");
  EXPECT_SAYS(refused([](Gltf& gltf, Json&) { gltf.binary[8] = 7; }), place + " is packed by a method 7");
}

// Counts in the stream for which a decoder would take gigabytes: 6 million triangles in some 30 bytes.
TEST(MeshCompression, DracoTakesNoMemoryByAWrongCount) {
  const std::string million = "\x80\x9B\xEE\x02";  // 6,000,000 in groups of 7 bits
  const auto refused = [&](const std::string& bytes) {
    return mesh_refusal(draco_gltf({bytes + std::string(16, '\1'), 0, 100, 6'000'000}));
  };
  const std::string head = std::string("DRACO\2\2\1", 8);
  EXPECT_SAYS(refused(head + std::string("\0\0\0", 3) + million + "\x03"), "says more triangles");
  EXPECT_SAYS(refused(head + std::string("\1\0\0\0\3", 5) + million + "\1"), "says more triangles");
  EXPECT_SAYS(refused(head + std::string("\1\0\0\0", 4) + million + "\3\1"), "says more triangles") << "more vertices than corners";
}

TEST(MeshCompression, DamagedDracoIsReadOrRefused) {
  for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
    const DracoBytes packed = draco_ring(method);
    for (std::size_t at = 1; at < packed.bytes.size(); at += packed.bytes.size() / 100 + 1) {
      DracoBytes cut = packed;
      cut.bytes.resize(at);
      EXPECT_SAYS(mesh_refusal(draco_gltf(cut)), "KHR_draco_mesh_compression");
      for (const char byte : {'\0', '\x7F', '\xFF'}) {
        DracoBytes changed = packed;
        changed.bytes[at] = byte;
        mesh_refusal(draco_gltf(changed));  // anything but Error ends the test
      }
    }
  }
}

// ---- meshopt ----

std::string meshopt_elements(const void* elements, std::size_t count, std::size_t stride) {
  std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(count, stride));
  bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), elements, count, stride));
  return {bytes.begin(), bytes.end()};
}

std::string meshopt_corners(const std::vector<std::uint32_t>& corners, std::size_t vertices, bool is_list) {
  std::vector<unsigned char> bytes(is_list ? meshopt_encodeIndexBufferBound(corners.size(), vertices)
                                           : meshopt_encodeIndexSequenceBound(corners.size(), vertices));
  bytes.resize(is_list ? meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), corners.data(), corners.size())
                       : meshopt_encodeIndexSequence(bytes.data(), bytes.size(), corners.data(), corners.size()));
  return {bytes.begin(), bytes.end()};
}

// A file whose views are compressed. A second buffer, which has no bytes, stands for what they are decoded to.
struct MeshoptGltf {
  Gltf gltf;
  std::size_t decoded = 0;

  int view(const std::string& bytes, std::size_t count, std::size_t stride, const std::string& mode, const char* filter = "NONE") {
    const int made = gltf.view(bytes);
    Json& view = gltf.json["bufferViews"][made];
    const Json packed{{"buffer", 0},
                      {"byteOffset", view["byteOffset"]},
                      {"byteLength", bytes.size()},
                      {"byteStride", stride},
                      {"count", count},
                      {"mode", mode},
                      {"filter", filter}};
    view = {{"buffer", 1}, {"byteOffset", decoded}, {"byteLength", count * stride}};
    if (mode == "ATTRIBUTES") view["byteStride"] = stride;
    view["extensions"]["EXT_meshopt_compression"] = packed;
    decoded += count * stride;
    return made;
  }
  Json& packed(int view) { return gltf.json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"]; }
  std::string glb() const {
    Json whole = gltf.json;
    whole["buffers"] = Json::array({{{"byteLength", gltf.binary.size()}}, {{"byteLength", std::max<std::size_t>(decoded, 1)}}});
    whole["buffers"][1]["extensions"]["EXT_meshopt_compression"]["fallback"] = true;
    whole["extensionsUsed"] = whole["extensionsRequired"] = Json::array({"EXT_meshopt_compression", "KHR_mesh_quantization"});
    return glb_text(json_text(whole), gltf.binary);
  }
};

std::vector<float> floats_of(const TriangleMesh& mesh) {
  std::vector<float> numbers;
  for (const Triple& vertex : mesh.vertices)
    for (const double x : vertex) numbers.push_back(static_cast<float>(x));
  return numbers;
}

std::vector<std::uint32_t> corners_of_mesh(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> corners;
  for (const auto& triangle : mesh.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  return corners;
}

// View 0: positions, 12 bytes each; view 1: triangles.
MeshoptGltf meshopt_ring(int index_type = GLTF_UINT, bool is_list = true) {
  const TriangleMesh ring = packed_ring();
  const std::vector<std::uint32_t> corners = corners_of_mesh(ring);
  MeshoptGltf made;
  const int points = made.view(meshopt_elements(floats_of(ring).data(), ring.vertices.size(), 12), ring.vertices.size(), 12,
                               "ATTRIBUTES"),
            faces = made.view(meshopt_corners(corners, ring.vertices.size(), is_list), corners.size(),
                              index_type == GLTF_UINT ? 4 : 2, is_list ? "TRIANGLES" : "INDICES");
  const int position = made.gltf.accessor(points, GLTF_FLOAT, ring.vertices.size(), "VEC3");
  made.gltf.primitive(position, made.gltf.accessor(faces, index_type, corners.size(), "SCALAR"));
  return made;
}

TEST(MeshCompression, MeshoptGivesTheSameTriangles) {
  const double volume = volume_of_file(glb_text(packed_ring()));
  for (const int type : {GLTF_UINT, GLTF_USHORT})
    for (const bool is_list : {true, false})
      EXPECT_NEAR(volume_of_file(meshopt_ring(type, is_list).glb()) / volume, 1, 1e-12) << type << is_list;
}

TEST(MeshCompression, MeshoptFiltersAreUndone) {
  const TriangleMesh ring = packed_ring();
  const double volume = volume_of_file(glb_text(ring));
  const std::size_t count = ring.vertices.size();
  std::vector<std::uint32_t> exponential(3 * count);
  meshopt_encodeFilterExp(exponential.data(), count, 12, 20, floats_of(ring).data());
  MeshoptGltf made = meshopt_ring();
  const int points = made.view(meshopt_elements(exponential.data(), count, 12), count, 12, "ATTRIBUTES", "EXPONENTIAL");
  made.gltf.json["accessors"][0]["bufferView"] = points;
  // what positions do not need
  std::vector<float> upward(4 * count);
  for (std::size_t i = 0; i < count; ++i) upward[4 * i + 1] = 1;
  std::vector<std::uint64_t> filtered(count);
  meshopt_encodeFilterQuat(filtered.data(), count, 8, 16, upward.data());
  made.view(meshopt_elements(filtered.data(), count, 8), count, 8, "ATTRIBUTES", "QUATERNION");
  meshopt_encodeFilterOct(filtered.data(), count, 8, 16, upward.data());
  made.view(meshopt_elements(filtered.data(), count, 8), count, 8, "ATTRIBUTES", "OCTAHEDRAL");
  meshopt_encodeFilterOct(filtered.data(), count, 4, 8, upward.data());
  made.view(meshopt_elements(filtered.data(), count, 4), count, 4, "ATTRIBUTES", "OCTAHEDRAL");
  EXPECT_NEAR(volume_of_file(made.glb()) / volume, 1, 1e-4) << "20 bits";
}

// As gltfpack writes it: 16 bits a coordinate, four to a point, and a node that scales and moves.
TEST(MeshCompression, MeshoptWithQuantizedPositions) {
  const TriangleMesh ring = packed_ring();
  const double volume = volume_of_file(glb_text(ring)), step = 0.2 / 65535;
  for (const bool is_normalized : {false, true}) {
    std::vector<std::uint16_t> points;
    for (const Triple& vertex : ring.vertices) {
      for (const double x : vertex) points.push_back(static_cast<std::uint16_t>(std::lround((x + 0.1) / step)));
      points.push_back(0);
    }
    MeshoptGltf made = meshopt_ring();
    const int view = made.view(meshopt_elements(points.data(), ring.vertices.size(), 8), ring.vertices.size(), 8, "ATTRIBUTES");
    Json& accessor = made.gltf.json["accessors"][0];
    accessor["bufferView"] = view;
    accessor["componentType"] = GLTF_USHORT;
    accessor["normalized"] = is_normalized;
    const double scale = is_normalized ? 0.2 : step;
    made.gltf.json["nodes"][0]["scale"] = {scale, scale, scale};
    made.gltf.json["nodes"][0]["translation"] = {-0.1, -0.1, -0.1};
    EXPECT_NEAR(volume_of_file(made.glb()) / volume, 1, 1e-3) << "3 um, of 20 mm";
  }
}

TEST(MeshCompression, WrongMeshoptIsRefused) {
  const auto refused = [](int view, const std::function<void(Json&)>& change) {
    MeshoptGltf made = meshopt_ring();
    change(made.packed(view));
    return mesh_refusal_of_bytes(made.glb());
  };
  const std::string place = "bufferViews[0].extensions.EXT_meshopt_compression";
  EXPECT_EQ(refused(0, [](Json&) {}), "read");
  EXPECT_SAYS(refused(0, [](Json& packed) { packed["buffer"] = 7; }), place + " names buffers[7], which is not there");
  EXPECT_SAYS(refused(0, [](Json& packed) { packed["byteOffset"] = 2'000'000'000; }), place + " reaches beyond buffers[0]");
  EXPECT_SAYS(refused(0, [](Json& packed) { packed["byteLength"] = 2'000'000'000; }), place + " reaches beyond buffers[0]");
  EXPECT_SAYS(refused(0, [](Json& packed) { packed["byteLength"] = packed["byteLength"].get<int>() / 2; }), place + " is damaged");
  EXPECT_SAYS(refused(0, [](Json& packed) { packed["count"] = 2'000'000'000; }),
              place + " says 2,000,000,000 elements, which its ");
  EXPECT_SAYS(refused(1, [](Json& packed) { packed["count"] = 2'000'000'001; }), "says 2,000,000,001 elements, which its ");
  EXPECT_SAYS(refused(0, [](Json& packed) { packed["count"] = 0; }), place + " says 0 elements");
  // the codec packs elements in blocks of up to 256, and a few more in the last block may be zeros that take no bytes
  EXPECT_SAYS(refused(0, [](Json& packed) { packed["count"] = packed["count"].get<int>() + 256; }), place + " is damaged");
  EXPECT_SAYS(refused(0, [](Json& packed) { packed["count"] = -1; }), "is not an integer of 0 to 2147483647");
  for (const int stride : {0, 2, 6, 260})
    EXPECT_SAYS(refused(0, [&](Json& packed) { packed["byteStride"] = stride; }), "do not go together");
  EXPECT_SAYS(refused(0, [](Json& packed) { packed["mode"] = "POINTS"; }), "has a mode 'POINTS'");
  EXPECT_SAYS(refused(0, [](Json& packed) { packed["filter"] = "OCTAHEDRAL"; }), "do not go together");
  EXPECT_SAYS(refused(0, [](Json& packed) { packed["filter"] = "COLOR"; }), "a filter 'COLOR'");
  EXPECT_SAYS(refused(1, [](Json& packed) { packed["count"] = packed["count"].get<int>() - 1; }), "do not go together");
  EXPECT_SAYS(refused(1, [](Json& packed) { packed["byteStride"] = 8; }), "do not go together");
  EXPECT_SAYS(refused(1, [](Json& packed) { packed["mode"] = "INDICES"; }),
              "bufferViews[1].extensions.EXT_meshopt_compression is damaged");
  MeshoptGltf beyond = meshopt_ring();
  beyond.gltf.json["bufferViews"][0].erase("extensions");
  EXPECT_SAYS(mesh_refusal_of_bytes(beyond.glb()), "bufferViews[0] reaches beyond its buffer");
}

TEST(MeshCompression, DamagedMeshoptIsReadOrRefused) {
  const MeshoptGltf made = meshopt_ring();
  for (std::size_t at = 0; at < made.gltf.binary.size(); at += made.gltf.binary.size() / 200 + 1)
    for (const char byte : {'\0', '\x7F', '\xFF'}) {
      MeshoptGltf changed = made;
      changed.gltf.binary[at] = byte;
      mesh_refusal_of_bytes(changed.glb());  // anything but Error ends the test
    }
}

}  // namespace
}  // namespace wholehand
