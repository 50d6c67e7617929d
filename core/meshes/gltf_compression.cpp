// SPDX-License-Identifier: MIT
#include "core/meshes/gltf_compression.h"

// Draco has an enumerator JOINTS, and shaders/layout.h a macro of that name.
#pragma push_macro("JOINTS")
#undef JOINTS
#include <draco/compression/config/compression_shared.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/decoder_buffer.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>
#pragma pop_macro("JOINTS")

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <nlohmann/json.hpp>
#include <span>
#include <type_traits>
#include <utility>

#include "base/text/readable.h"
#include "core/meshes/triangles.h"

namespace wholehand {
namespace {

constexpr const char* MESHOPT = "EXT_meshopt_compression";
constexpr const char* DRACO = "KHR_draco_mesh_compression";
// Decoded bytes that a compressed byte can become. meshopt spends a quarter of a byte on 16 bytes at least. Draco has no such limit: a flat grid of a
// million triangles takes a few kilobytes.
constexpr std::uint64_t MOST_MESHOPT_GROWTH = 64, MOST_DRACO_GROWTH = 10'000;
constexpr std::uint64_t MOST_DRACO_BYTES = std::uint64_t{4} << 30;
// What Draco's decoders keep for a face, and again for each attribute with edges of its own.
constexpr std::uint64_t DRACO_FACE_BYTES = 40;

// Takes an object's extensions away, and returns one of them; an empty object if it is not there.
nlohmann::json take_extension(nlohmann::json& owner, const char* name) {
  nlohmann::json taken = nlohmann::json::object();
  const auto extensions = owner.find("extensions");
  if (extensions == owner.end()) return taken;
  if (extensions->contains(name)) taken = std::move((*extensions)[name]);
  owner.erase("extensions");
  return taken;
}

// A list of the file; empty if it has none.
nlohmann::json& list_of(nlohmann::json& owner, const char* key, nlohmann::json& none) {
  const auto found = owner.find(key);
  return found == owner.end() ? none : *found;
}

std::span<const unsigned char> bytes_of_buffer(const MeshFile& file, const tinygltf::Model& model, int buffer, std::size_t offset,
                                               std::size_t length, const std::string& place) {
  if (buffer < 0 || static_cast<std::size_t>(buffer) >= model.buffers.size())
    file.refuse(fmt::format("{} names buffers[{}], which is not there", place, buffer));
  const std::vector<unsigned char>& bytes = model.buffers[static_cast<std::size_t>(buffer)].data;
  if (offset > bytes.size() || length > bytes.size() - offset)
    file.refuse(fmt::format("{} reaches beyond buffers[{}]", place, buffer));
  return std::span(bytes).subspan(offset, length);
}

int add_buffer(tinygltf::Model& model, std::vector<unsigned char> bytes) {
  model.buffers.emplace_back().data = std::move(bytes);
  return static_cast<int>(model.buffers.size() - 1);
}

// ---- meshopt ----

bool is_meshopt_layout(const MeshoptView& view) {
  const bool is_plain = view.filter.empty() || view.filter == "NONE";
  if (view.mode == "TRIANGLES" || view.mode == "INDICES")
    return is_plain && (view.stride == 2 || view.stride == 4) && (view.mode == "INDICES" || view.count % 3 == 0);
  if (view.mode != "ATTRIBUTES" || view.stride < 4 || view.stride > 256 || view.stride % 4 != 0) return false;
  return is_plain || view.filter == "EXPONENTIAL" || (view.filter == "OCTAHEDRAL" && (view.stride == 4 || view.stride == 8)) ||
         (view.filter == "QUATERNION" && view.stride == 8);
}

std::vector<unsigned char> meshopt_bytes(const MeshFile& file, const MeshoptView& view, std::span<const unsigned char> from,
                                         const std::string& place) {
  std::vector<unsigned char> bytes(view.count * view.stride);
  const int failed =
      view.mode == "TRIANGLES" ? meshopt_decodeIndexBuffer(bytes.data(), view.count, view.stride, from.data(), from.size())
      : view.mode == "INDICES" ? meshopt_decodeIndexSequence(bytes.data(), view.count, view.stride, from.data(), from.size())
                               : meshopt_decodeVertexBuffer(bytes.data(), view.count, view.stride, from.data(), from.size());
  if (failed != 0)
    file.refuse(fmt::format("{} is damaged: its bytes are not {} elements of {} bytes", place, view.count, view.stride));
  if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), view.count, view.stride);
  if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), view.count, view.stride);
  if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), view.count, view.stride);
  return bytes;
}

void decode_meshopt(const MeshFile& file, const std::vector<MeshoptView>& views, tinygltf::Model& model) {
  std::uint64_t total = 0;
  for (const MeshoptView& view : views) {
    const std::string place = fmt::format("bufferViews[{}].extensions.{}", view.view, MESHOPT);
    const std::span<const unsigned char> from = bytes_of_buffer(file, model, view.buffer, view.offset, view.length, place);
    if (!is_meshopt_layout(view))
      file.refuse(fmt::format("{} has a mode '{}', a filter '{}', a byteStride of {} and a count of {}, which do not go together",
                              place, view.mode, view.filter, view.stride, readable_number(view.count)));
    const std::uint64_t size = std::uint64_t{view.count} * view.stride;  // each below 2^31
    if (view.count == 0 || size > MOST_MESHOPT_GROWTH * view.length)
      file.refuse(fmt::format("{} says {} elements, which its {} bytes do not hold", place, readable_number(view.count),
                              readable_number(view.length)));
    total += size;
    if (total > LARGEST_MESH_FILE)
      file.refuse(fmt::format("has more than {} MB of buffers when decompressed", LARGEST_MESH_FILE >> 20));
    std::vector<unsigned char> bytes = meshopt_bytes(file, view, from, place);
    tinygltf::BufferView& plain = model.bufferViews[view.view];
    plain.byteOffset = 0;
    plain.byteLength = bytes.size();
    plain.byteStride = view.mode == "ATTRIBUTES" ? view.stride : 0;
    plain.buffer = add_buffer(model, std::move(bytes));
  }
}

// ---- Draco ----

// Draco's decoders allocate by counts that they read. This one looks ahead at them, and stops first.
template <class Method>
class BoundedDecoder : public Method {
 public:
  BoundedDecoder(std::uint64_t most_faces, std::uint64_t most_bytes) : most_faces_(most_faces), most_bytes_(most_bytes) {}

  bool says_too_much() const { return says_too_much_; }

 protected:
  // The sequential method begins with faces and points. Edgebreaker begins with vertices, faces and the number of attributes with edges of their own.
  bool DecodeConnectivity() override {
    draco::DecoderBuffer ahead = *this->buffer();
    std::uint32_t faces = 0, vertices = 0;
    std::uint8_t attributes = 0;
    const bool is_read =
        IS_EDGEBREAKER ? draco::DecodeVarint(&vertices, &ahead) && draco::DecodeVarint(&faces, &ahead) && ahead.Decode(&attributes)
                       : draco::DecodeVarint(&faces, &ahead) && draco::DecodeVarint(&vertices, &ahead);
    if (!is_read) return false;
    says_too_much_ = faces > most_faces_ || DRACO_FACE_BYTES * (1 + std::uint64_t{attributes}) * faces > most_bytes_ ||
                     (IS_EDGEBREAKER && vertices > 3 * std::uint64_t{faces});
    return !says_too_much_ && Method::DecodeConnectivity();
  }

  // Attributes are declared by now. Each value is kept twice: decoded, and as integers.
  bool DecodeAllAttributes() override {
    const draco::PointCloud& cloud = *this->point_cloud();
    std::uint64_t bytes = sizeof(std::uint32_t);
    for (int i = 0; i < cloud.num_attributes(); ++i) {
      const draco::PointAttribute& attribute = *cloud.attribute(i);
      bytes += static_cast<std::uint64_t>(attribute.byte_stride()) + sizeof(std::int32_t) * attribute.num_components();
    }
    says_too_much_ = bytes * cloud.num_points() > most_bytes_;
    return !says_too_much_ && Method::DecodeAllAttributes();
  }

 private:
  static constexpr bool IS_EDGEBREAKER = std::is_same_v<Method, draco::MeshEdgebreakerDecoder>;

  std::uint64_t most_faces_, most_bytes_;
  bool says_too_much_ = false;
};

// Decodes a primitive; `most_faces`: as its accessor says.
class DracoReader {
 public:
  DracoReader(const MeshFile& file, std::string place) : file_(file), place_(std::move(place)) {}

  void read(std::span<const unsigned char> bytes, std::uint64_t most_faces) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::DecoderBuffer ahead = buffer;
    draco::DracoHeader header{};
    if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok()) refuse("is no Draco data");
    if (header.encoder_type != draco::TRIANGULAR_MESH) refuse("holds a cloud of points");
    if (header.version_major != 2 || header.version_minor != 2)
      refuse(fmt::format("is Draco {}.{}, and 2.2 is read", header.version_major, header.version_minor));
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
      decode<draco::MeshEdgebreakerDecoder>(buffer, bytes.size(), most_faces);
    } else if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING) {
      decode<draco::MeshSequentialDecoder>(buffer, bytes.size(), most_faces);
    } else {
      refuse(fmt::format("is packed by a method {}, which Draco does not have", header.encoder_method));
    }
  }

  std::size_t points() const { return mesh_.num_points(); }
  std::size_t faces() const { return mesh_.num_faces(); }

  std::vector<unsigned char> indices() const {
    std::vector<unsigned char> bytes;
    bytes.reserve(12 * faces());
    for (std::uint32_t face = 0; face < faces(); ++face)
      for (const draco::PointIndex& corner : mesh_.face(draco::FaceIndex(face))) {
        const std::uint32_t point = corner.value();
        for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<unsigned char>(point >> 8 * i & 0xFFu));
      }
    return bytes;
  }

  // The values of an attribute, a point each; sets the component type that they have.
  std::vector<unsigned char> positions(int id, int& type) const {
    const draco::PointAttribute* attribute = id < 0 ? nullptr : mesh_.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
    if (attribute == nullptr) refuse(fmt::format("has no attribute {}, which POSITION names", id));
    type = component_type(attribute->data_type());
    const auto size = static_cast<std::size_t>(attribute->byte_stride());
    if (type < 0 || attribute->num_components() != 3 || attribute->buffer() == nullptr || attribute->byte_offset() != 0)
      refuse(fmt::format("has an attribute {} that is no list of points", id));
    const bool has_map = !attribute->is_mapping_identity();
    if (has_map && attribute->indices_map_size() < points()) refuse("has points without a place");
    const draco::DataBuffer& from = *attribute->buffer();
    std::vector<unsigned char> bytes(points() * size);
    for (std::uint32_t point = 0; point < points(); ++point) {
      const std::size_t entry = attribute->mapped_index(draco::PointIndex(point)).value();
      if ((entry + 1) * size > from.data_size()) refuse("has points without a place");
      std::memcpy(bytes.data() + point * size, from.data() + entry * size, size);
    }
    return bytes;
  }

 private:
  [[noreturn]] void refuse(const std::string& message) const { file_.refuse(fmt::format("{} {}", place_, message)); }

  template <class Method>
  void decode(draco::DecoderBuffer& buffer, std::size_t size, std::uint64_t most_faces) {
    BoundedDecoder<Method> decoder(most_faces, std::min(MOST_DRACO_BYTES, MOST_DRACO_GROWTH * size));
    draco::DecoderOptions options;
    std::string fault;
    try {
      const draco::Status status = decoder.Decode(options, &buffer, &mesh_);
      if (!status.ok()) fault = status.error_msg_string();
    } catch (const std::exception& thrown) {
      fault = thrown.what();
    }
    if (decoder.says_too_much()) refuse("says more triangles or points than its accessors and its bytes hold");
    if (!fault.empty()) refuse("is damaged: " + fault);
  }

  static int component_type(draco::DataType type) {
    switch (type) {
      case draco::DT_INT8:
        return TINYGLTF_COMPONENT_TYPE_BYTE;
      case draco::DT_UINT8:
        return TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
      case draco::DT_INT16:
        return TINYGLTF_COMPONENT_TYPE_SHORT;
      case draco::DT_UINT16:
        return TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
      case draco::DT_FLOAT32:
        return TINYGLTF_COMPONENT_TYPE_FLOAT;
      default:
        return -1;
    }
  }

  const MeshFile& file_;
  std::string place_;
  draco::Mesh mesh_;
};

int add_accessor(tinygltf::Model& model, std::vector<unsigned char> bytes, int component, int type, std::size_t count) {
  tinygltf::BufferView view;
  view.byteLength = bytes.size();
  view.buffer = add_buffer(model, std::move(bytes));
  model.bufferViews.push_back(view);
  tinygltf::Accessor accessor;
  accessor.bufferView = static_cast<int>(model.bufferViews.size() - 1);
  accessor.componentType = component;
  accessor.type = type;
  accessor.count = count;
  model.accessors.push_back(accessor);
  return static_cast<int>(model.accessors.size() - 1);
}

void decode_draco(const MeshFile& file, const std::vector<DracoPrimitive>& primitives, tinygltf::Model& model) {
  const std::size_t views = model.bufferViews.size(), accessors = model.accessors.size();
  std::uint64_t triangles = 0;
  for (const DracoPrimitive& packed : primitives) {
    const std::string place = fmt::format("meshes[{}].primitives[{}].extensions.{}", packed.mesh, packed.primitive, DRACO);
    if (packed.mode != TINYGLTF_MODE_TRIANGLES) file.refuse(fmt::format("{} holds no list of triangles: export one", place));
    if (packed.view < 0 || static_cast<std::size_t>(packed.view) >= views)
      file.refuse(fmt::format("{} names bufferViews[{}], which is not there", place, packed.view));
    if (packed.indices < 0) file.refuse(fmt::format("{} is there without indices", place));
    for (const int accessor : {packed.position, packed.indices})
      if (accessor < 0 || static_cast<std::size_t>(accessor) >= accessors)
        file.refuse(fmt::format("{} needs accessors[{}], which is not there", place, accessor));
    const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(packed.view)];
    const std::span<const unsigned char> bytes = bytes_of_buffer(file, model, view.buffer, view.byteOffset, view.byteLength, place);
    const std::size_t faces = model.accessors[static_cast<std::size_t>(packed.indices)].count / 3;
    triangles += faces;
    if (triangles > MOST_TRIANGLES) file.refuse_size();
    DracoReader reader(file, place);
    reader.read(bytes, faces);
    int component = 0;
    std::vector<unsigned char> points = reader.positions(packed.attribute, component);
    const bool is_normalized = model.accessors[static_cast<std::size_t>(packed.position)].normalized;
    const int position = add_accessor(model, std::move(points), component, TINYGLTF_TYPE_VEC3, reader.points());
    model.accessors.back().normalized = is_normalized;
    tinygltf::Primitive& primitive = model.meshes.at(packed.mesh).primitives.at(packed.primitive);
    primitive.attributes["POSITION"] = position;
    primitive.indices =
        add_accessor(model, reader.indices(), TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, 3 * reader.faces());
  }
}

}  // namespace

GltfCompression take_compression(nlohmann::json& trimmed) {
  GltfCompression compression;
  nlohmann::json none = nlohmann::json::array();
  nlohmann::json& views = list_of(trimmed, "bufferViews", none);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const nlohmann::json taken = take_extension(views[i], MESHOPT);
    if (taken.empty()) continue;
    compression.views.push_back({i, taken.value("buffer", -1), taken.value("byteOffset", std::size_t{0}),
                                 taken.value("byteLength", std::size_t{0}), taken.value("byteStride", std::size_t{0}),
                                 taken.value("count", std::size_t{0}), taken.value("mode", std::string()),
                                 taken.value("filter", std::string())});
  }
  for (nlohmann::json& buffer : list_of(trimmed, "buffers", none))
    if (take_extension(buffer, MESHOPT).value("fallback", false))
      buffer = {{"byteLength", 1}, {"uri", "data:application/octet-stream;base64,AA=="}};
  nlohmann::json& meshes = list_of(trimmed, "meshes", none);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    nlohmann::json& primitives = list_of(meshes[i], "primitives", none);
    for (std::size_t k = 0; k < primitives.size(); ++k) {
      nlohmann::json& primitive = primitives[k];
      const nlohmann::json taken = take_extension(primitive, DRACO),
                           attributes = primitive.value("attributes", nlohmann::json::object());
      if (taken.empty() || !attributes.contains("POSITION")) continue;
      compression.primitives.push_back({i, k, primitive.value("mode", 4), taken.value("bufferView", -1),
                                        taken.value("attributes", nlohmann::json::object()).value("POSITION", -1),
                                        attributes.value("POSITION", -1), primitive.value("indices", -1)});
      primitive.erase("indices");
    }
  }
  return compression;
}

void decompress(const MeshFile& file, const GltfCompression& compression, tinygltf::Model& model) {
  decode_meshopt(file, compression.views, model);
  decode_draco(file, compression.primitives, model);
}

}  // namespace wholehand
