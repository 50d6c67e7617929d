// SPDX-License-Identifier: MIT
#include "core/meshes/gltf_triangles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>

#include "base/text/readable.h"
#include "core/meshes/gltf_file.h"

namespace wholehand {
namespace {

constexpr std::size_t MOST_WITHOUT_BYTES = 100'000;  // of a sparse accessor without data: a few bytes must not become gigabytes

template <class T>
double value_as(const unsigned char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return static_cast<double>(value);
}

// One component, as glTF maps normalized integers to [-1, 1] and [0, 1].
double component_at(const unsigned char* at, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return normalized ? std::max(value_as<std::int8_t>(at) / 127, -1.0) : value_as<std::int8_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return value_as<std::uint8_t>(at) / (normalized ? 255 : 1);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return normalized ? std::max(value_as<std::int16_t>(at) / 32767, -1.0) : value_as<std::int16_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return value_as<std::uint16_t>(at) / (normalized ? 65535 : 1);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return value_as<std::uint32_t>(at);
    default:
      return value_as<float>(at);
  }
}

std::size_t component_size(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

bool is_index_type(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

// StoredElements in a buffer, so many bytes apart.
struct StoredElements {
  const unsigned char* first = nullptr;
  std::size_t stride = 0;
};

// Reads numbers from accessors whose bytes are all known to exist.
class AccessorReader {
 public:
  AccessorReader(const MeshFile& file, const tinygltf::Model& model) : file_(file), model_(model) {}

  // How many elements an accessor has, without reading one.
  std::size_t count_of(int index) const {
    const tinygltf::Accessor& accessor = accessor_at(index);
    const bool has_bytes = accessor.bufferView >= 0;
    if (!has_bytes && !accessor.sparse.isSparse) file_.refuse(fmt::format("accessors[{}] has no data", index));
    if (accessor.count > (has_bytes ? MOST_MESH_VERTICES : MOST_WITHOUT_BYTES))
      file_.refuse(fmt::format("accessors[{}] says it has {} elements, which is absurd", index, readable_number(accessor.count)));
    return accessor.count;
  }

  // The accessor must have been counted.
  std::vector<Triple> positions(int index) const {
    const tinygltf::Accessor& accessor = accessor_at(index);
    if (accessor.type != TINYGLTF_TYPE_VEC3) file_.refuse(fmt::format("accessors[{}] holds positions and is not VEC3", index));
    const std::vector<double> values = values_of(accessor, index, 3);
    std::vector<Triple> points(accessor.count);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    return points;
  }

  std::vector<std::uint32_t> indices(int index) const {
    const tinygltf::Accessor& accessor = accessor_at(index);
    if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_index_type(accessor.componentType))
      file_.refuse(fmt::format("accessors[{}] holds indices and is no SCALAR of unsigned bytes, shorts or ints", index));
    const std::vector<double> values = values_of(accessor, index, 1);
    std::vector<std::uint32_t> numbers(values.size());
    std::transform(values.begin(), values.end(), numbers.begin(), [](double value) { return static_cast<std::uint32_t>(value); });
    return numbers;
  }

 private:
  const tinygltf::Accessor& accessor_at(int index) const {
    if (index < 0 || static_cast<std::size_t>(index) >= model_.accessors.size())
      file_.refuse(fmt::format("accessors[{}] is named and is not there", index));
    return model_.accessors[index];
  }

  // `count` elements of `size` bytes from `offset` of a view; they must end within it, and it within its buffer.
  StoredElements elements(int view_index, std::size_t offset, std::size_t count, std::size_t size, int accessor) const {
    if (view_index < 0 || static_cast<std::size_t>(view_index) >= model_.bufferViews.size())
      file_.refuse(fmt::format("bufferViews[{}], named by accessors[{}], is not there", view_index, accessor));
    const tinygltf::BufferView& view = model_.bufferViews[view_index];
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model_.buffers.size())
      file_.refuse(fmt::format("buffers[{}], named by bufferViews[{}], is not there", view.buffer, view_index));
    const std::vector<unsigned char>& bytes = model_.buffers[view.buffer].data;
    if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
      file_.refuse(fmt::format("bufferViews[{}] reaches beyond its buffer", view_index));
    const std::size_t stride = view.byteStride > 0 ? view.byteStride : size;
    if (stride < size) file_.refuse(fmt::format("bufferViews[{}] has a byteStride less than an element", view_index));
    if (count > 0 && offset + (count - 1) * stride + size > view.byteLength)  // each at most 2^31: no overflow
      file_.refuse(fmt::format("accessors[{}] reaches beyond bufferViews[{}]", accessor, view_index));
    return {bytes.data() + view.byteOffset + offset, stride};
  }

  std::vector<double> values_of(const tinygltf::Accessor& accessor, int index, std::size_t components) const {
    const std::size_t width = component_size(accessor.componentType);
    if (width == 0)
      file_.refuse(fmt::format("accessors[{}] has the component type {}, which glTF does not have", index, accessor.componentType));
    const bool has_bytes = accessor.bufferView >= 0;
    StoredElements from;
    if (has_bytes) from = elements(accessor.bufferView, accessor.byteOffset, accessor.count, components * width, index);
    std::vector<double> values(accessor.count * components);
    for (std::size_t i = 0; has_bytes && i < accessor.count; ++i)
      for (std::size_t k = 0; k < components; ++k)
        values[i * components + k] =
            component_at(from.first + i * from.stride + k * width, accessor.componentType, accessor.normalized);
    if (accessor.sparse.isSparse) put_sparse(accessor, index, components, values);
    return values;
  }

  void put_sparse(const tinygltf::Accessor& accessor, int index, std::size_t components, std::vector<double>& values) const {
    const auto& sparse = accessor.sparse;
    if (!is_index_type(sparse.indices.componentType))
      file_.refuse(fmt::format("accessors[{}].sparse has indices of no unsigned type", index));
    const std::size_t count = static_cast<std::size_t>(sparse.count), width = component_size(accessor.componentType);
    if (count > accessor.count) file_.refuse(fmt::format("accessors[{}].sparse has more values than the accessor", index));
    const StoredElements places = elements(sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset), count,
                                           component_size(sparse.indices.componentType), index);
    const StoredElements given =
        elements(sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), count, components * width, index);
    for (std::size_t i = 0; i < count; ++i) {
      const double place = component_at(places.first + i * places.stride, sparse.indices.componentType, false);
      if (place >= static_cast<double>(accessor.count))
        file_.refuse(fmt::format("accessors[{}].sparse has an index out of range", index));
      for (std::size_t k = 0; k < components; ++k)
        values[static_cast<std::size_t>(place) * components + k] =
            component_at(given.first + i * given.stride + k * width, accessor.componentType, accessor.normalized);
    }
  }

  const MeshFile& file_;
  const tinygltf::Model& model_;
};

// The corners of a list, a strip or a fan as triangles, all turning the same way (glTF 2.0, 3.7.2.1).
std::vector<std::array<std::uint32_t, 3>> triangles_of(int mode, const std::vector<std::uint32_t>& corners) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const std::size_t step = mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
  for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 == 1) {
      triangles.push_back({corners[i], corners[i + 2], corners[i + 1]});
    } else if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
      triangles.push_back({corners[i + 1], corners[i + 2], corners[0]});
    } else {
      triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    }
  }
  return triangles;
}

// Walks the nodes of a scene and gathers their triangles.
class SceneWalk {
 public:
  SceneWalk(const MeshFile& file, const tinygltf::Model& model) : file_(file), model_(model), accessors_(file, model) {}

  TriangleMesh triangles() {
    const std::vector<Visit> placed = placed_meshes();
    count(placed);
    mesh_.says_what_is_up = true;
    for (const Visit& visit : placed) add_mesh(visit);
    return std::move(mesh_);
  }

 private:
  // A node and where its parents, or they and itself, place it.
  struct Visit {
    int node;
    glm::dmat4 placed;
  };
  // The parts of a mesh that make triangles: counted once, however many nodes show it.
  struct MeshCount {
    std::vector<std::size_t> primitives;
    std::uint64_t triangles = 0, vertices = 0;
  };

  const tinygltf::Scene& scene() const {
    if (model_.scenes.empty()) file_.refuse("has no scene, so nothing in it is shown: export the objects within a scene");
    const int chosen = std::max(model_.defaultScene, 0);
    if (static_cast<std::size_t>(chosen) >= model_.scenes.size())
      file_.refuse(fmt::format("names scene {} and has {}", chosen, model_.scenes.size()));
    return model_.scenes[chosen];
  }

  void require_length(const std::vector<double>& numbers, std::size_t length, int index, const char* key) const {
    if (!numbers.empty() && numbers.size() != length)
      file_.refuse(fmt::format("nodes[{}].{} has {} numbers in place of {}", index, key, numbers.size(), length));
  }

  glm::dmat4 transform_of(const tinygltf::Node& node, int index) const {
    require_length(node.matrix, 16, index, "matrix");
    require_length(node.translation, 3, index, "translation");
    require_length(node.rotation, 4, index, "rotation");
    require_length(node.scale, 3, index, "scale");
    glm::dmat4 matrix(1);
    if (!node.matrix.empty()) {
      for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[i];
      if (matrix[0][3] != 0 || matrix[1][3] != 0 || matrix[2][3] != 0 || matrix[3][3] != 1)
        file_.refuse(fmt::format("nodes[{}].matrix has another last row than 0, 0, 0, 1", index));
      return matrix;
    }
    if (!node.rotation.empty()) {
      const glm::dquat turn(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
      const double length = glm::length(turn);
      if (!(length > 1e-3 && length < 1e3)) file_.refuse(fmt::format("nodes[{}].rotation is no unit quaternion", index));
      matrix = glm::mat4_cast(turn / length);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (!node.scale.empty()) matrix[k] *= node.scale[k];
      if (!node.translation.empty()) matrix[3][k] = node.translation[k];
    }
    return matrix;
  }

  // The nodes of the scene that show a mesh, each once.
  std::vector<Visit> placed_meshes() const {
    std::vector<Visit> waiting, found;
    for (const int node : scene().nodes) waiting.push_back({node, glm::dmat4(1)});
    std::vector<bool> seen(model_.nodes.size());
    while (!waiting.empty()) {
      const Visit visit = waiting.back();
      waiting.pop_back();
      if (visit.node < 0 || static_cast<std::size_t>(visit.node) >= model_.nodes.size())
        file_.refuse(fmt::format("nodes[{}] is named and is not there", visit.node));
      // each node has one parent in glTF: a second visit is a cycle, or a duplicated branch
      if (seen[visit.node]) file_.refuse(fmt::format("nodes[{}] is its own ancestor, or has two parents", visit.node));
      seen[visit.node] = true;
      const tinygltf::Node& node = model_.nodes[visit.node];
      const glm::dmat4 placed = visit.placed * transform_of(node, visit.node);
      if (node.mesh >= 0) {
        refuse_node(node, visit.node);
        found.push_back({visit.node, placed});
      }
      for (const int child : node.children) waiting.push_back({child, placed});
    }
    return found;
  }

  void refuse_node(const tinygltf::Node& node, int index) const {
    if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size())
      file_.refuse(fmt::format("meshes[{}], named by nodes[{}], is not there", node.mesh, index));
    if (node.skin >= 0)
      file_.refuse(fmt::format("nodes[{}] has a skin, which is not read: apply the armature before exporting", index));
  }

  // Sums what all nodes show before reading any vertex: a few bytes may show a mesh a million times.
  void count(const std::vector<Visit>& placed) {
    std::vector<bool> is_counted(model_.meshes.size());
    counts_.resize(model_.meshes.size());
    std::uint64_t triangles = 0, vertices = 0;
    for (const Visit& visit : placed) {
      const int mesh = model_.nodes[visit.node].mesh;
      if (!is_counted[mesh]) counts_[mesh] = count_of_mesh(mesh);
      is_counted[mesh] = true;
      triangles += counts_[mesh].triangles;
      vertices += counts_[mesh].vertices;
      if (triangles > MOST_TRIANGLES || vertices > MOST_MESH_VERTICES) file_.refuse_size();
    }
  }

  MeshCount count_of_mesh(int index) const {
    MeshCount count;
    const std::vector<tinygltf::Primitive>& primitives = model_.meshes[index].primitives;
    for (std::size_t k = 0; k < primitives.size(); ++k) {
      refuse_primitive(primitives[k], index, k);
      const auto position = primitives[k].attributes.find("POSITION");
      if (position == primitives[k].attributes.end()) continue;  // glTF: it is passed over
      const std::size_t points = accessors_.count_of(position->second),
                        corners = primitives[k].indices < 0 ? points : accessors_.count_of(primitives[k].indices);
      const bool is_list = primitives[k].mode == TINYGLTF_MODE_TRIANGLES;
      if (corners < 3 || (is_list && corners % 3 != 0))
        file_.refuse(fmt::format("{} has {} corners, which make no whole triangles", place_of(index, k), readable_number(corners)));
      count.primitives.push_back(k);
      count.vertices += points;  // a list is at most as long as the file's JSON, and its numbers below 2^31: no overflow
      count.triangles += is_list ? corners / 3 : corners - 2;
    }
    return count;
  }

  static std::string place_of(int mesh, std::size_t primitive) { return fmt::format("meshes[{}].primitives[{}]", mesh, primitive); }

  void add_mesh(const Visit& visit) {
    const int mesh = model_.nodes[visit.node].mesh;
    for (const std::size_t k : counts_[mesh].primitives) add_primitive(mesh, k, visit.placed);
  }

  void refuse_primitive(const tinygltf::Primitive& primitive, int mesh, std::size_t index) const {
    const int mode = primitive.mode;
    const bool is_points = mode == TINYGLTF_MODE_POINTS,
               is_lines = mode == TINYGLTF_MODE_LINE || mode == TINYGLTF_MODE_LINE_LOOP || mode == TINYGLTF_MODE_LINE_STRIP,
               is_triangles =
                   mode == TINYGLTF_MODE_TRIANGLES || mode == TINYGLTF_MODE_TRIANGLE_STRIP || mode == TINYGLTF_MODE_TRIANGLE_FAN;
    if (is_triangles && primitive.targets.empty()) return;
    const std::string place = place_of(mesh, index);
    if (!primitive.targets.empty())
      file_.refuse(fmt::format("{} has morph targets, which are not read: apply the shape keys before exporting", place));
    if (is_points || is_lines)
      file_.refuse(fmt::format("{} is made of {}, which have no inside: remove it", place, is_points ? "points" : "lines"));
    file_.refuse(fmt::format("{} has the mode {}, which glTF does not have", place, mode));
  }

  void add_primitive(int mesh, std::size_t index, const glm::dmat4& placed) {
    const tinygltf::Primitive& primitive = model_.meshes[mesh].primitives[index];
    const std::vector<Triple> points = accessors_.positions(primitive.attributes.at("POSITION"));
    std::vector<std::uint32_t> corners(primitive.indices < 0 ? points.size() : 0);
    for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = static_cast<std::uint32_t>(i);
    if (primitive.indices >= 0) corners = accessors_.indices(primitive.indices);
    for (const std::uint32_t corner : corners)
      if (corner >= points.size())
        file_.refuse(fmt::format("{} has the index {} and {} vertices", place_of(mesh, index), readable_number(corner),
                                 readable_number(points.size())));
    const double stretch = std::max({glm::length(placed[0]), glm::length(placed[1]), glm::length(placed[2])});
    for (const Triple& point : points) {
      const glm::dvec4 moved = placed * glm::dvec4(point[0], point[1], point[2], 1);
      for (int k = 0; k < 3; ++k)
        if (!std::isfinite(moved[k]))
          file_.refuse(fmt::format("{} has a vertex that is not a finite number", place_of(mesh, index)));
      mesh_.vertices.push_back({moved.x, moved.y, moved.z});
      mesh_.rounding = std::max(mesh_.rounding, stretch * single_rounding(point));
    }
    add_triangles(triangles_of(primitive.mode, corners), mesh_.vertices.size() - points.size(), placed);
  }

  // A mirroring transform turns each triangle round; glTF then reads it the other way.
  void add_triangles(const std::vector<std::array<std::uint32_t, 3>>& triangles, std::size_t first, const glm::dmat4& placed) {
    const bool mirrors = glm::determinant(glm::dmat3(placed)) < 0;
    const auto base = static_cast<std::uint32_t>(first);
    for (const auto& [a, b, c] : triangles)
      mesh_.triangles.push_back({base + a, base + (mirrors ? c : b), base + (mirrors ? b : c)});
  }

  const MeshFile& file_;
  const tinygltf::Model& model_;
  AccessorReader accessors_;
  std::vector<MeshCount> counts_;  // a mesh of the file each, empty where no node shows it
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh gltf_triangles(const MeshFile& file, std::string_view bytes) {
  const tinygltf::Model model = read_gltf(file, bytes);
  return SceneWalk(file, model).triangles();
}

}  // namespace wholehand
