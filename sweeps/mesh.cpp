#include "sweeps/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <limits>

#include "sweeps/gltf_file.h"

namespace wholehand {
namespace {

constexpr std::size_t MOST_VERTICES = 3 * MOST_TRIANGLES;
constexpr double FARTHEST = 1e9;                     // m: beyond it squares and cubes lose their meaning
constexpr std::size_t FEWEST_TRIANGLES = 4;          // a tetrahedron
constexpr std::size_t MOST_WITHOUT_BYTES = 100'000;  // of a sparse accessor on nothing: a few bytes must not become gigabytes

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

// Numbers out of accessors, each byte of which is known to be there.
class AccessorReader {
 public:
  AccessorReader(const MeshFile& file, const tinygltf::Model& model) : file_(file), model_(model) {}

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
    if (!has_bytes && !accessor.sparse.isSparse) file_.refuse(fmt::format("accessors[{}] has no data", index));
    if (accessor.count > (has_bytes ? MOST_VERTICES : MOST_WITHOUT_BYTES))
      file_.refuse(fmt::format("accessors[{}] says it has {} elements, which is absurd", index, accessor.count));
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
    struct Visit {
      int node;
      glm::dmat4 parent;
    };
    std::vector<Visit> waiting;
    for (const int node : scene().nodes) waiting.push_back({node, glm::dmat4(1)});
    std::vector<bool> seen(model_.nodes.size());
    while (!waiting.empty()) {
      const Visit visit = waiting.back();
      waiting.pop_back();
      if (visit.node < 0 || static_cast<std::size_t>(visit.node) >= model_.nodes.size())
        file_.refuse(fmt::format("nodes[{}] is named and is not there", visit.node));
      // each node has one parent in glTF: a second visit is a circle, or a branch that is there twice
      if (seen[visit.node]) file_.refuse(fmt::format("nodes[{}] is its own ancestor, or has two parents", visit.node));
      seen[visit.node] = true;
      const tinygltf::Node& node = model_.nodes[visit.node];
      const glm::dmat4 placed = visit.parent * transform_of(node, visit.node);
      if (node.mesh >= 0) add_mesh(node, visit.node, placed);
      for (const int child : node.children) waiting.push_back({child, placed});
    }
    return std::move(mesh_);
  }

 private:
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

  void add_mesh(const tinygltf::Node& node, int index, const glm::dmat4& placed) {
    if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size())
      file_.refuse(fmt::format("meshes[{}], named by nodes[{}], is not there", node.mesh, index));
    if (node.skin >= 0)
      file_.refuse(fmt::format("nodes[{}] has a skin, which is not read: apply the armature before exporting", index));
    const tinygltf::Mesh& mesh = model_.meshes[node.mesh];
    for (std::size_t k = 0; k < mesh.primitives.size(); ++k)
      add_primitive(mesh.primitives[k], fmt::format("meshes[{}].primitives[{}]", node.mesh, k), placed);
  }

  void refuse_primitive(const tinygltf::Primitive& primitive, const std::string& place) const {
    if (!primitive.targets.empty())
      file_.refuse(fmt::format("{} has morph targets, which are not read: apply the shape keys before exporting", place));
    const int mode = primitive.mode;
    if (mode == TINYGLTF_MODE_POINTS) file_.refuse(fmt::format("{} is made of points, which have no inside: remove it", place));
    if (mode == TINYGLTF_MODE_LINE || mode == TINYGLTF_MODE_LINE_LOOP || mode == TINYGLTF_MODE_LINE_STRIP)
      file_.refuse(fmt::format("{} is made of lines, which have no inside: remove it", place));
    if (mode != TINYGLTF_MODE_TRIANGLES && mode != TINYGLTF_MODE_TRIANGLE_STRIP && mode != TINYGLTF_MODE_TRIANGLE_FAN)
      file_.refuse(fmt::format("{} has the mode {}, which glTF does not have", place, mode));
  }

  void add_primitive(const tinygltf::Primitive& primitive, const std::string& place, const glm::dmat4& placed) {
    refuse_primitive(primitive, place);
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) return;  // glTF: it is passed over
    const std::vector<Triple> points = accessors_.positions(position->second);
    if (points.size() > MOST_VERTICES - mesh_.vertices.size()) refuse_size();
    std::vector<std::uint32_t> corners(primitive.indices < 0 ? points.size() : 0);
    for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = static_cast<std::uint32_t>(i);
    if (primitive.indices >= 0) corners = accessors_.indices(primitive.indices);
    if (corners.size() < 3 || (primitive.mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0))
      file_.refuse(fmt::format("{} has {} corners, which make no whole triangles", place, corners.size()));
    for (const std::uint32_t corner : corners)
      if (corner >= points.size()) file_.refuse(fmt::format("{} has the index {} and {} vertices", place, corner, points.size()));
    add_points(points, place, placed);
    add_triangles(triangles_of(primitive.mode, corners), mesh_.vertices.size() - points.size(), placed);
  }

  void add_points(const std::vector<Triple>& points, const std::string& place, const glm::dmat4& placed) {
    for (const Triple& point : points) {
      const glm::dvec4 moved = placed * glm::dvec4(point[0], point[1], point[2], 1);
      for (int k = 0; k < 3; ++k)
        if (!std::isfinite(moved[k])) file_.refuse(fmt::format("{} has a vertex that is not a finite number", place));
      mesh_.vertices.push_back({moved.x, moved.y, moved.z});
    }
  }

  // A mirroring transform turns each triangle round; glTF then reads it the other way.
  void add_triangles(const std::vector<std::array<std::uint32_t, 3>>& triangles, std::size_t first, const glm::dmat4& placed) {
    if (triangles.size() > MOST_TRIANGLES - mesh_.triangles.size()) refuse_size();
    const bool mirrors = glm::determinant(glm::dmat3(placed)) < 0;
    const auto base = static_cast<std::uint32_t>(first);
    for (const auto& [a, b, c] : triangles)
      mesh_.triangles.push_back({base + a, base + (mirrors ? c : b), base + (mirrors ? b : c)});
  }

  [[noreturn]] void refuse_size() const {
    file_.refuse(fmt::format("has more than {} million triangles, or three times as many vertices: simplify it",
                             MOST_TRIANGLES / 1'000'000));
  }

  const MeshFile& file_;
  const tinygltf::Model& model_;
  AccessorReader accessors_;
  TriangleMesh mesh_;
};

// Columns of Rx Ry Rz.
glm::dmat3 turn_of(const Triple& angles) {
  const glm::dquat x = glm::angleAxis(angles[0], glm::dvec3(1, 0, 0)), y = glm::angleAxis(angles[1], glm::dvec3(0, 1, 0)),
                   z = glm::angleAxis(angles[2], glm::dvec3(0, 0, 1));
  return glm::mat3_cast(x * y * z);
}

void place_mesh(TriangleMesh& mesh, const MeshData& data, const MeshFile& file) {
  const glm::dmat3 turn = turn_of(data.rotate);
  constexpr double FAR = std::numeric_limits<double>::infinity();
  Triple low{FAR, FAR, FAR}, high{-FAR, -FAR, -FAR};
  for (Triple& vertex : mesh.vertices) {
    const glm::dvec3 turned = turn * (data.scale * glm::dvec3(vertex[0], vertex[1], vertex[2]));
    for (int k = 0; k < 3; ++k) {
      if (!(std::abs(turned[k]) <= FARTHEST))
        file.refuse("has a vertex more than a million km away: its scale is wrong, or its numbers");
      vertex[k] = turned[k];
    }
  }
  if (!data.origin_at_base) return;
  for (const auto& triangle : mesh.triangles) {  // vertices that none uses have no say
    if (is_point_or_edge(mesh, triangle)) continue;
    for (const std::uint32_t corner : triangle)
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], mesh.vertices[corner][k]);
        high[k] = std::max(high[k], mesh.vertices[corner][k]);
      }
  }
  if (!(low[0] <= high[0])) return;  // nothing but points and edges, which check_mesh refuses
  const Triple origin{low[0] / 2 + high[0] / 2, low[1], low[2] / 2 + high[2] / 2};
  for (Triple& vertex : mesh.vertices)
    for (int k = 0; k < 3; ++k) vertex[k] -= origin[k];
}

}  // namespace

bool is_point_or_edge(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const Triple &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]], &c = mesh.vertices[triangle[2]];
  return a == b || b == c || c == a;
}

TriangleMesh read_mesh(const MeshData& data, const std::string& base_folder) {
  const MeshFile file{(std::filesystem::path(base_folder) / data.file).string(), data.place};
  const tinygltf::Model model = read_gltf(file);
  TriangleMesh mesh = SceneWalk(file, model).triangles();
  if (mesh.triangles.empty()) file.refuse("has no mesh in its scene");
  if (mesh.triangles.size() < FEWEST_TRIANGLES)
    file.refuse(fmt::format("has {} triangles, and a body needs at least {}", mesh.triangles.size(), FEWEST_TRIANGLES));
  place_mesh(mesh, data, file);
  return mesh;
}

}  // namespace wholehand
