// SPDX-License-Identifier: MIT
#include "core/meshes/assimp_triangles.h"

#include <assimp/BaseImporter.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string_view>

#include "core/meshes/assimp_input.h"

namespace wholehand {
namespace {

// Bytes as assimp reads a file.
class ByteStream : public Assimp::IOStream {
 public:
  explicit ByteStream(std::string_view bytes) : bytes_(bytes) {}
  std::size_t Read(void* to, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    const std::size_t whole = std::min(count, (bytes_.size() - at_) / size);
    std::memcpy(to, bytes_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t base = origin == aiOrigin_CUR ? at_ : 0;
    if (offset > bytes_.size() - base) return aiReturn_FAILURE;
    at_ = origin == aiOrigin_END ? bytes_.size() - offset : base + offset;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

// The only file: materials and textures that it names do not exist.
class OneFile : public Assimp::IOSystem {
 public:
  OneFile(std::string name, std::string_view bytes) : name_(std::move(name)), bytes_(bytes) {}
  bool Exists(const char* name) const override { return name_ == name; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char*) override { return Exists(name) ? new ByteStream(bytes_) : nullptr; }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::string name_;
  std::string_view bytes_;
};

// assimp detects formats by content; without the other readers it cannot mistake a file.
void keep_reader(Assimp::Importer& importer, const std::string& ending) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    if (importer.GetImporterInfo(i)->mFileExtensions == ending) continue;
    const std::unique_ptr<Assimp::BaseImporter> other(importer.GetImporter(i));
    importer.UnregisterLoader(other.get());
  }
}

void add_assimp_mesh(const MeshFile& file, const aiMesh& from, TriangleMesh& mesh) {
  const std::size_t base = mesh.vertices.size();
  if (from.mNumVertices > MOST_MESH_VERTICES - base) file.refuse_size();
  for (unsigned i = 0; i < from.mNumVertices; ++i)
    mesh.vertices.push_back({from.mVertices[i].x, from.mVertices[i].y, from.mVertices[i].z});
  for (unsigned i = 0; i < from.mNumFaces; ++i) {
    const aiFace& face = from.mFaces[i];
    if (face.mNumIndices != 3)
      file.refuse(fmt::format("has a face of {} corners that assimp cannot cut into triangles", face.mNumIndices));
    std::array<std::uint32_t, 3> corners{};
    for (int k = 0; k < 3; ++k) {
      if (face.mIndices[k] >= from.mNumVertices) file.refuse("has a face with a corner that is not there");
      corners[k] = static_cast<std::uint32_t>(base + face.mIndices[k]);
    }
    mesh.triangles.push_back(corners);
  }
  if (mesh.triangles.size() > MOST_TRIANGLES) file.refuse_size();
}

// A binary STL needs no parser: after 84 bytes, each triangle has 50, of which the corners are those from 12 to 47. assimp would take longer.
TriangleMesh stl_triangles(const MeshFile& file, const std::string& bytes) {
  constexpr std::size_t HEAD = 84, RECORD = 50, NORMAL = 12;
  const std::size_t count = (bytes.size() - HEAD) / RECORD;
  TriangleMesh mesh;
  mesh.vertices.reserve(3 * count);
  mesh.triangles.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<std::array<float, 3>, 3> corners{};
    std::memcpy(&corners, bytes.data() + HEAD + i * RECORD + NORMAL, sizeof corners);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.triangles.push_back({first, first + 1, first + 2});
    for (const auto& [x, y, z] : corners) {
      for (const float number : {x, y, z})
        if (!std::isfinite(number)) file.refuse(fmt::format("triangle {}: '{}' is no finite number", i + 1, number));
      mesh.vertices.push_back({x, y, z});
    }
  }
  return mesh;
}

TriangleMesh parsed_triangles(const MeshFile& file, const std::string& ending, const std::string& bytes) {
  const std::string name = "mesh." + ending;
  Assimp::Importer importer;
  keep_reader(importer, ending);
  importer.SetIOHandler(new OneFile(name, bytes));  // which the importer deletes
  const aiScene* scene = importer.ReadFile(name, aiProcess_Triangulate | aiProcess_ValidateDataStructure);
  if (scene == nullptr) file.refuse(fmt::format("cannot be read: {}", importer.GetErrorString()));
  TriangleMesh mesh;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) add_assimp_mesh(file, *scene->mMeshes[i], mesh);
  return mesh;
}

}  // namespace

TriangleMesh assimp_triangles(const MeshFile& file, MeshFormat format, const std::string& bytes) {
  const std::string given = assimp_input(file, format, bytes);
  TriangleMesh mesh = format == MeshFormat::stl ? stl_triangles(file, given)
                                                : parsed_triangles(file, format == MeshFormat::ply ? "ply" : "obj", given);
  mesh.says_what_is_up = format == MeshFormat::collada;
  for (const Triple& vertex : mesh.vertices) mesh.rounding = std::max(mesh.rounding, single_rounding(vertex));
  return mesh;
}

}  // namespace wholehand
