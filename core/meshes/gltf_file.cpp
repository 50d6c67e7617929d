// SPDX-License-Identifier: MIT
#include "core/meshes/gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "base/files/json.h"
#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/file_kind.h"
#include "core/meshes/gltf_compression.h"

namespace wholehand {
namespace {

using GltfJson = nlohmann::json;

constexpr int DEEPEST_GLTF = 64;  // tinygltf and others recurse; glTF itself needs 7
constexpr std::uint32_t GLB_MAGIC = 0x46546C67, GLB_JSON = 0x4E4F534A, GLB_BIN = 0x004E4942;

// ---- what is kept ----

enum class GltfKind { integer, integers, numbers, text, flag, table, tables };

struct GltfField {
  std::string_view key;
  GltfKind kind;
  std::span<const GltfField> inside{};
};

namespace gltf_fields {
using enum GltfKind;
constexpr GltfField ASSET_FIELDS[]{{"version", text}, {"minVersion", text}};
constexpr GltfField SCENE_FIELDS[]{{"nodes", integers}};
constexpr GltfField NODE_FIELDS[]{{"mesh", integer},  {"skin", integer},        {"children", integers}, {"matrix", numbers},
                                  {"scale", numbers}, {"translation", numbers}, {"rotation", numbers}};
constexpr GltfField ATTRIBUTE_FIELDS[]{{"POSITION", integer}};
constexpr GltfField TARGET_FIELDS[]{{"POSITION", integer}};
constexpr GltfField DRACO_FIELDS[]{{"bufferView", integer}, {"attributes", table, ATTRIBUTE_FIELDS}};
constexpr GltfField PRIMITIVE_EXTENSION_FIELDS[]{{"KHR_draco_mesh_compression", table, DRACO_FIELDS}};
constexpr GltfField PRIMITIVE_FIELDS[]{{"attributes", table, ATTRIBUTE_FIELDS},
                                       {"indices", integer},
                                       {"mode", integer},
                                       {"targets", tables, TARGET_FIELDS},
                                       {"extensions", table, PRIMITIVE_EXTENSION_FIELDS}};
constexpr GltfField MESH_FIELDS[]{{"name", text}, {"primitives", tables, PRIMITIVE_FIELDS}};
constexpr GltfField SPARSE_INDEX_FIELDS[]{{"bufferView", integer}, {"byteOffset", integer}, {"componentType", integer}};
constexpr GltfField SPARSE_VALUE_FIELDS[]{{"bufferView", integer}, {"byteOffset", integer}};
constexpr GltfField SPARSE_FIELDS[]{
    {"count", integer}, {"indices", table, SPARSE_INDEX_FIELDS}, {"values", table, SPARSE_VALUE_FIELDS}};
constexpr GltfField ACCESSOR_FIELDS[]{
    {"bufferView", integer}, {"byteOffset", integer}, {"componentType", integer},      {"count", integer},
    {"type", text},          {"normalized", flag},    {"sparse", table, SPARSE_FIELDS}};
constexpr GltfField MESHOPT_FIELDS[]{{"buffer", integer}, {"byteOffset", integer}, {"byteLength", integer}, {"byteStride", integer},
                                     {"count", integer},  {"mode", text},          {"filter", text}};
constexpr GltfField VIEW_EXTENSION_FIELDS[]{{"EXT_meshopt_compression", table, MESHOPT_FIELDS}};
constexpr GltfField VIEW_FIELDS[]{{"buffer", integer},
                                  {"byteOffset", integer},
                                  {"byteLength", integer},
                                  {"byteStride", integer},
                                  {"extensions", table, VIEW_EXTENSION_FIELDS}};
constexpr GltfField FALLBACK_FIELDS[]{{"fallback", flag}};
constexpr GltfField BUFFER_EXTENSION_FIELDS[]{{"EXT_meshopt_compression", table, FALLBACK_FIELDS}};
constexpr GltfField BUFFER_FIELDS[]{{"uri", text}, {"byteLength", integer}, {"extensions", table, BUFFER_EXTENSION_FIELDS}};
constexpr GltfField GLTF_FIELDS[]{{"asset", table, ASSET_FIELDS},       {"scene", integer},
                                  {"scenes", tables, SCENE_FIELDS},     {"nodes", tables, NODE_FIELDS},
                                  {"meshes", tables, MESH_FIELDS},      {"accessors", tables, ACCESSOR_FIELDS},
                                  {"bufferViews", tables, VIEW_FIELDS}, {"buffers", tables, BUFFER_FIELDS}};
}  // namespace gltf_fields

// Copies the above fields of a parsed file, each with its type, so that tinygltf, which ignores what it does not understand and cuts integers to 32
// bits, understands everything it gets.
class GltfTrim {
 public:
  explicit GltfTrim(const MeshFile& file) : file_(file) {}

  GltfJson trimmed(GltfJson& root) const { return table_of(root, gltf_fields::GLTF_FIELDS, ""); }

 private:
  [[noreturn]] void mistyped(const std::string& place, const char* wanted) const {
    file_.refuse(fmt::format("{} is not {}", place.empty() ? "its JSON" : place, wanted));
  }

  GltfJson table_of(GltfJson& from, std::span<const GltfField> fields, const std::string& place) const {
    if (!from.is_object()) mistyped(place, "an object");
    GltfJson kept = GltfJson::object();
    for (const GltfField& field : fields) {
      const auto found = from.find(field.key);
      if (found == from.end()) continue;
      const std::string inner = fmt::format("{}{}{}", place, place.empty() ? "" : ".", field.key);
      kept[std::string(field.key)] = value_of(*found, field, inner);
    }
    return kept;
  }

  GltfJson value_of(GltfJson& from, const GltfField& field, const std::string& place) const {
    switch (field.kind) {
      case GltfKind::integer:
        return integer_of(from, place);
      case GltfKind::text:
        if (!from.is_string()) mistyped(place, "a string");
        return std::move(from);
      case GltfKind::flag:
        if (!from.is_boolean()) mistyped(place, "true or false");
        return from;
      case GltfKind::table:
        return table_of(from, field.inside, place);
      default:
        break;
    }
    if (!from.is_array()) mistyped(place, "a list");
    GltfJson kept = GltfJson::array();
    for (std::size_t i = 0; i < from.size(); ++i) kept.push_back(item_of(from[i], field, fmt::format("{}[{}]", place, i)));
    return kept;
  }

  GltfJson item_of(GltfJson& from, const GltfField& field, const std::string& place) const {
    if (field.kind == GltfKind::tables) return table_of(from, field.inside, place);
    if (field.kind == GltfKind::integers) return integer_of(from, place);
    if (!from.is_number()) mistyped(place, "a number");
    return from;
  }

  // JSON knows one kind of number: 3.0 is an integer too.
  GltfJson integer_of(const GltfJson& from, const std::string& place) const {
    if (!from.is_number()) mistyped(place, "an integer");
    const double value = from.get<double>();
    if (!(value >= 0 && value <= std::numeric_limits<std::int32_t>::max()) || value != std::floor(value))
      mistyped(place, "an integer of 0 to 2147483647");
    return static_cast<std::int32_t>(value);
  }

  const MeshFile& file_;
};

// ---- bytes ----

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (int i = 3; i >= 0; --i) word = word << 8 | static_cast<unsigned char>(bytes[at + i]);
  return word;
}

void append_word(std::string& bytes, std::uint32_t word) {
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<char>(word >> 8 * i & 0xFFu));
}

// A file's JSON, and the binary chunk of a .glb.
struct GltfChunks {
  std::string_view json, binary;
  bool is_binary = false;
};

GltfChunks glb_chunks(const MeshFile& file, std::string_view bytes) {
  if (bytes.size() < 20) file.refuse("is truncated: shorter than the header of a .glb");
  const std::uint32_t version = word_at(bytes, 4), length = word_at(bytes, 8);
  if (version != 2) file.refuse(fmt::format("is glTF version {}, and only version 2 is read", version));
  if (length > bytes.size())
    file.refuse(fmt::format("is truncated: it says {} bytes and has {}", readable_number(length), readable_number(bytes.size())));
  GltfChunks chunks;
  chunks.is_binary = true;
  for (std::size_t at = 12, chunk = 0; at + 8 <= length; ++chunk) {
    const std::uint32_t size = word_at(bytes, at), type = word_at(bytes, at + 4);
    at += 8;
    if (size > length - at)
      file.refuse(fmt::format("is damaged: its chunk {} of {} bytes ends beyond the file", chunk, readable_number(size)));
    if ((chunk == 0) != (type == GLB_JSON)) file.refuse("is damaged: its first chunk, and no other, must be JSON");
    if (chunk == 0) chunks.json = bytes.substr(at, size);
    if (chunk == 1 && type == GLB_BIN) chunks.binary = bytes.substr(at, size);
    at += size;
  }
  if (chunks.json.empty()) file.refuse("is damaged: it has no JSON");
  return chunks;
}

GltfChunks chunks_of(const MeshFile& file, std::string_view bytes) {
  if (bytes.size() >= 4 && word_at(bytes, 0) == GLB_MAGIC) return glb_chunks(file, bytes);
  const std::size_t first = bytes.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  if (first == bytes.npos || bytes[first] != '{') file.refuse("is neither .glb nor .gltf: it starts with neither 'glTF' nor '{'");
  return {bytes, {}, false};
}

// Checks the depth before parsing: the parser's own callback scans all earlier values for each value, so a long list would take quadratic time.
void check_depth(const MeshFile& file, std::string_view text) {
  int depth = 0;
  bool is_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_string) {
      i += c == '\\';
      is_string = c != '"';
    } else if (c == '[' || c == '{') {
      if (++depth > DEEPEST_GLTF) file.refuse(fmt::format("has JSON nested more than {} deep", DEEPEST_GLTF));
    } else if (c == ']' || c == '}') {
      --depth;
    } else {
      is_string = c == '"';
    }
  }
}

GltfJson parse_gltf(const MeshFile& file, std::string_view text) {
  if (text.size() > LARGEST_MESH_JSON)
    file.refuse(
        fmt::format("has {} MB of JSON, and at most {} MB are read: export as .glb, or with the buffers as files of their own",
                    text.size() >> 20, LARGEST_MESH_JSON >> 20));
  check_depth(file, text);
  try {
    return parse_json(text);
  } catch (const GltfJson::exception& error) {
    file.refuse(fmt::format("is damaged, or no glTF: {}", error.what()));
  }
}

// ---- what is refused by name ----

void refuse_version(const MeshFile& file, const GltfJson& trimmed) {
  const std::string version = trimmed.value("asset", GltfJson::object()).value("version", std::string());
  if (version.empty()) file.refuse("is no glTF: it has no asset.version");
  if (!version.starts_with("2.")) file.refuse(fmt::format("is glTF version '{}', and only version 2 is read", version));
  const std::string least = trimmed["asset"].value("minVersion", version);
  if (least != "2.0" && least != version) file.refuse(fmt::format("needs a reader of glTF '{}', and this one reads 2.0", least));
}

// Extensions that define how things look, not where they are.
bool only_looks(std::string_view name) {
  constexpr std::array<std::string_view, 6> LOOKS{"KHR_materials_", "KHR_texture_", "EXT_texture_",
                                                  "MSFT_texture_",  "KHR_lights_",  "KHR_xmp"};
  return std::any_of(LOOKS.begin(), LOOKS.end(), [&](std::string_view start) { return name.starts_with(start); });
}

void refuse_extensions(const MeshFile& file, const GltfJson& root) {
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    const auto names = root.find(list);
    if (names == root.end() || !names->is_array()) continue;
    for (const GltfJson& entry : *names) {
      const std::string name = entry.is_string() ? entry.get<std::string>() : "?";
      if (name == "KHR_meshopt_compression")
        file.refuse(fmt::format("is compressed ({}), which is not read: export it with EXT_meshopt_compression, or without", name));
      // they change the surface, and files may use them without requiring them
      if (name == "EXT_mesh_gpu_instancing")
        file.refuse(fmt::format("has instances ({}), which are not read: make them real, then export", name));
      if (name == "KHR_node_visibility")
        file.refuse(
            fmt::format("has nodes that may be hidden ({}), which is not read: remove what is hidden, export it without", name));
      const bool is_read = name == "KHR_mesh_quantization" || name == "KHR_draco_mesh_compression" ||
                           name == "EXT_meshopt_compression" || only_looks(name);
      if (list == std::string_view("extensionsRequired") && !is_read)
        file.refuse(fmt::format("requires the extension {}, which is not read: export it without", name));
    }
  }
}

void refuse_buffers(const MeshFile& file, const GltfJson& trimmed, bool is_binary) {
  const GltfJson buffers = trimmed.value("buffers", GltfJson::array());
  std::size_t total = 0;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const std::int32_t length = buffers[i].value("byteLength", 0);
    if (length < 1) file.refuse(fmt::format("buffers[{}] has no byteLength, or 0", i));
    total += static_cast<std::size_t>(length);
    const std::string uri = buffers[i].value("uri", std::string());
    if (uri.empty() && !(is_binary && i == 0)) file.refuse(fmt::format("buffers[{}] has no uri, so there are no bytes for it", i));
    if (uri.starts_with("data:") && !tinygltf::IsDataURI(uri))
      file.refuse(fmt::format("buffers[{}] is a data URI of a kind that is not read: export as .glb", i));
  }
  if (total > LARGEST_MESH_FILE)
    file.refuse(fmt::format("has buffers of {} MB, and at most {} MB are read", total >> 20, LARGEST_MESH_FILE >> 20));
}

// ---- tinygltf ----

// Gives tinygltf the files next to a .gltf. tinygltf also tries "./NAME" in the working directory, which here means the same folder.
struct GltfNeighbors {
  std::filesystem::path folder;
  std::string outside;  // the name that was asked for, where it leads out of the folder
};

bool leads_outside(const std::string& name) {
  const std::filesystem::path path(name);
  const bool climbs = std::any_of(path.begin(), path.end(), [](const auto& part) { return part == ".."; });
  return climbs || path.is_absolute() || name.find("://") != name.npos || name.find('\\') != name.npos ||
         name.find('\0') != name.npos;
}

bool neighbor_exists(const std::string& name, void* user) {
  auto& neighbors = *static_cast<GltfNeighbors*>(user);
  if (leads_outside(name)) {
    if (neighbors.outside.empty()) neighbors.outside = name;
    return false;
  }
  std::error_code error;
  return std::filesystem::exists(neighbors.folder / name, error);
}

bool read_neighbor(std::vector<unsigned char>* bytes, std::string* error, const std::string& name, void* user) {
  std::string contents;
  *error = read_mesh_bytes((static_cast<GltfNeighbors*>(user)->folder / name).string(), contents);
  const FileKind kind = error->empty() ? file_kind(contents, contents.size()) : FileKind::unknown;
  if (kind == FileKind::lfs_pointer || kind == FileKind::web_page) *error = name + " " + wrong_kind(kind, "a buffer");
  bytes->assign(contents.begin(), contents.end());
  return error->empty();
}

std::string same_name(const std::string& name, void*) { return name; }

bool writes_nothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; }

bool decodes_no_image(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
  return true;
}

std::string glb_of(std::string json, std::string_view binary) {
  json.append((4 - json.size() % 4) % 4, ' ');
  const std::size_t padding = (4 - binary.size() % 4) % 4, length = 20 + json.size() + 8 + binary.size() + padding;
  std::string bytes;
  bytes.reserve(length);
  for (const std::size_t word : {std::size_t{GLB_MAGIC}, std::size_t{2}, length, json.size(), std::size_t{GLB_JSON}})
    append_word(bytes, static_cast<std::uint32_t>(word));
  bytes += json;
  append_word(bytes, static_cast<std::uint32_t>(binary.size() + padding));
  append_word(bytes, GLB_BIN);
  bytes += binary;
  bytes.append(padding, '\0');
  return bytes;
}

tinygltf::Model load_gltf(const MeshFile& file, const std::string& json, std::string_view binary) {
  GltfNeighbors neighbors{std::filesystem::path(file.path).parent_path(), ""};
  tinygltf::TinyGLTF reader;
  reader.SetImageLoader(decodes_no_image, nullptr);
  reader.SetFsCallbacks({neighbor_exists, same_name, read_neighbor, writes_nothing, &neighbors});
  tinygltf::Model model;
  std::string error, warning;
  bool is_read = false;
  try {
    if (binary.empty()) {
      is_read = reader.LoadASCIIFromString(&model, &error, &warning, json.data(), static_cast<unsigned>(json.size()), "");
    } else {
      const std::string bytes = glb_of(json, binary);
      is_read = reader.LoadBinaryFromMemory(&model, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()),
                                            static_cast<unsigned>(bytes.size()), "");
    }
  } catch (const std::exception& thrown) {
    file.refuse(fmt::format("cannot be read as glTF: {}", thrown.what()));
  }
  if (!neighbors.outside.empty())
    file.refuse(fmt::format("names a buffer outside its own folder, which is not read: '{}'", neighbors.outside));
  if (!is_read || !error.empty()) file.refuse(fmt::format("cannot be read as glTF: {}", error));
  return model;
}

}  // namespace

tinygltf::Model read_gltf(const MeshFile& file, std::string_view bytes) {
  const GltfChunks chunks = chunks_of(file, bytes);
  GltfJson root = parse_gltf(file, chunks.json);
  GltfJson trimmed = GltfTrim(file).trimmed(root);
  refuse_version(file, trimmed);
  refuse_extensions(file, root);
  const GltfCompression compression = take_compression(trimmed);
  refuse_buffers(file, trimmed, chunks.is_binary && !chunks.binary.empty());
  root = nullptr;
  tinygltf::Model model = load_gltf(file, json_text(trimmed), chunks.binary);
  decompress(file, compression, model);
  return model;
}

}  // namespace wholehand
