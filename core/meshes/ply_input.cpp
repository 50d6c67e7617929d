// SPDX-License-Identifier: MIT
// PLY for assimp; see assimp_input.h.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include "base/text/readable.h"
#include "core/meshes/assimp_input.h"
#include "core/meshes/triangles.h"
#include "core/meshes/words.h"

namespace wholehand {
namespace {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class PlyForm { ascii, little, big };

struct PlyProperty {
  std::string name;
  PlyType type{};
  std::optional<PlyType> count;  // of a list: the type of its length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyForm form{};
  std::vector<PlyElement> elements;
  std::size_t size = 0;  // bytes
  std::size_t lines = 0;
};

PlyType ply_type(const MeshWords& words, std::string_view word) {
  constexpr std::array<std::array<std::string_view, 2>, 8> NAMES{{{"char", "int8"},
                                                                  {"uchar", "uint8"},
                                                                  {"short", "int16"},
                                                                  {"ushort", "uint16"},
                                                                  {"int", "int32"},
                                                                  {"uint", "uint32"},
                                                                  {"float", "float32"},
                                                                  {"double", "float64"}}};
  for (std::size_t i = 0; i < NAMES.size(); ++i)
    if (word == NAMES[i][0] || word == NAMES[i][1]) return static_cast<PlyType>(i);
  words.refuse(fmt::format("'{}' is no type of a PLY", MeshWords::shown(word)));
}

PlyProperty ply_property(MeshWords& words) {
  PlyProperty property;
  std::string_view word = words.next_in_line();
  if (word == "list") {
    property.count = ply_type(words, words.next_in_line());
    if (*property.count >= PlyType::float32) words.refuse("has a list whose length is no whole number");
    word = words.next_in_line();
  }
  property.type = ply_type(words, word);
  property.name = words.next_in_line();
  return property;
}

PlyHeader ply_header(const MeshFile& file, std::string_view bytes) {
  PlyHeader header;
  MeshWords words(file, bytes);
  words.skip_line();
  for (header.lines = 2;; ++header.lines, words.skip_line()) {
    if (words.at_end()) file.refuse("is truncated: it has no end_header");
    const std::string_view key = words.next_in_line();
    if (key == "end_header") break;
    if (key == "format") {
      const std::string_view form = words.next_in_line();
      if (form != "ascii" && form != "binary_little_endian" && form != "binary_big_endian")
        words.refuse(fmt::format("'{}' is no format of a PLY", MeshWords::shown(form)));
      header.form = form == "ascii" ? PlyForm::ascii : form == "binary_big_endian" ? PlyForm::big : PlyForm::little;
    } else if (key == "element") {
      PlyElement& element = header.elements.emplace_back();
      element.name = words.next_in_line();
      const double count = words.number(words.next_in_line());
      if (!(count >= 0 && count <= 1e15) || count != std::floor(count))
        words.refuse("has an element whose count is no whole number");
      element.count = static_cast<std::uint64_t>(count);
    } else if (key == "property") {
      if (header.elements.empty()) words.refuse("has a property of no element");
      header.elements.back().properties.push_back(ply_property(words));
    } else if (!key.empty() && key != "comment" && key != "obj_info") {
      words.refuse(fmt::format("'{}' is no word of a PLY's header", MeshWords::shown(key)));
    }
  }
  words.skip_line();
  header.size = bytes.size() - words.rest().size();
  return header;
}

// The numbers after the header, one after the other.
class PlyBody {
 public:
  PlyBody(const MeshFile& file, std::string_view bytes, const PlyHeader& header)
      : file_(file), form_(header.form), bytes_(bytes.substr(header.size)), words_(file, bytes_, header.lines + 1) {}

  double next(PlyType type) {
    if (form_ == PlyForm::ascii) {
      const std::string_view word = words_.next();
      if (word.empty()) file_.refuse("is truncated: it ends before its last element");
      return words_.number(word);
    }
    constexpr std::array<std::size_t, 8> SIZES{1, 1, 2, 2, 4, 4, 4, 8};
    const std::size_t size = SIZES[static_cast<int>(type)];
    if (bytes_.size() < size) file_.refuse("is truncated: it ends before its last element");
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < size; ++i)
      word = word << 8 | static_cast<unsigned char>(bytes_[form_ == PlyForm::big ? i : size - 1 - i]);
    bytes_.remove_prefix(size);
    return value_of(type, word);
  }

 private:
  static double value_of(PlyType type, std::uint64_t word) {
    switch (type) {
      case PlyType::int8:
        return static_cast<std::int8_t>(word);
      case PlyType::int16:
        return static_cast<std::int16_t>(word);
      case PlyType::int32:
        return static_cast<std::int32_t>(word);
      case PlyType::float32:
        return std::bit_cast<float>(static_cast<std::uint32_t>(word));
      case PlyType::float64:
        return std::bit_cast<double>(word);
      default:
        return static_cast<double>(word);
    }
  }

  const MeshFile& file_;
  PlyForm form_;
  std::string_view bytes_;
  MeshWords words_;
};

// Walks through all elements and writes what makes the shape.
class PlyShape {
 public:
  PlyShape(const MeshFile& file, std::string_view bytes, const PlyHeader& header) : file_(file), body_(file, bytes, header) {}

  std::string read(const PlyHeader& header) {
    for (const PlyElement& element : header.elements) read_element(element);
    if (faces_ == 0) file_.refuse("has no face: a cloud of points is no body");
    if (largest_ >= static_cast<double>(vertices_))
      file_.refuse(fmt::format("has a face with the vertex {} and {} vertices, counted from 0", readable_count(largest_),
                               readable_number(vertices_)));
    return fmt::format(
               "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty uchar begin\nproperty float x\nproperty float "
               "y\nproperty float z\n"
               "element face {}\nproperty list ushort uint vertex_indices\nend_header\n",
               vertices_, faces_) +
           points_ + corners_;
  }

 private:
  void read_element(const PlyElement& element) {
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    if (element.name == "tristrips" && element.count > 0) file_.refuse("has triangle strips, which are not read: export faces");
    if (element.properties.empty()) return;
    std::array<std::size_t, 3> place{};
    for (int k = 0; is_vertex && k < 3; ++k) place[k] = place_of(element, std::array{"x", "y", "z"}[k]);
    const std::size_t list = is_face ? place_of_list(element) : 0;
    if (is_vertex && (vertices_ += element.count) > MOST_MESH_VERTICES) file_.refuse_size();
    std::vector<double> values(element.properties.size());
    for (std::uint64_t i = 0; i < element.count; ++i) {  // each takes a byte at least: the file's end ends it
      for (std::size_t p = 0; p < values.size(); ++p) {
        const PlyProperty& property = element.properties[p];
        if (property.count) {
          read_list(property, is_face && p == list);
        } else {
          values[p] = body_.next(property.type);
        }
      }
      if (is_vertex) add_vertex({values[place[0]], values[place[1]], values[place[2]]});
    }
  }

  std::size_t place_of(const PlyElement& element, const char* name) const {
    for (std::size_t p = 0; p < element.properties.size(); ++p)
      if (element.properties[p].name == name && !element.properties[p].count) return p;
    file_.refuse(fmt::format("has vertices without {}", name));
  }

  std::size_t place_of_list(const PlyElement& element) const {
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (property.count && (property.name == "vertex_indices" || property.name == "vertex_index")) return p;
    }
    file_.refuse("has faces without vertex_indices");
  }

  // The first byte is no line's end: after the header assimp passes over all of those, whatever they belong to.
  void add_vertex(const Triple& point) {
    append(1, 1, points_);
    for (const double x : point) {
      if (!(std::abs(x) <= std::numeric_limits<float>::max())) file_.refuse("has a vertex that is not a finite number");
      append(std::bit_cast<std::uint32_t>(static_cast<float>(x)), 4, points_);
    }
  }

  void read_list(const PlyProperty& property, bool is_shape) {
    const double length = body_.next(*property.count);
    if (!(length >= 0) || length != std::floor(length)) file_.refuse("has a list whose length is no whole number");
    if (is_shape && (length < 3 || length > static_cast<double>(MOST_CORNERS)))
      file_.refuse(
          fmt::format("has a face of {} corners; 3 to {} are read", readable_count(length), readable_number(MOST_CORNERS)));
    if (is_shape) append(static_cast<std::uint32_t>(length), 2, corners_);
    for (double i = 0; i < length; ++i) {
      const double index = body_.next(property.type);
      if (!is_shape) continue;
      if (!(index >= 0 && index < static_cast<double>(MOST_MESH_VERTICES)) || index != std::floor(index))
        file_.refuse(fmt::format("has a face with the vertex {}", index));
      largest_ = std::max(largest_, index);
      append(static_cast<std::uint32_t>(index), 4, corners_);
    }
    if (!is_shape) return;
    ++faces_;
    triangles_ += static_cast<std::size_t>(length) - 2;
    if (triangles_ > MOST_TRIANGLES) file_.refuse_size();
  }

  static void append(std::uint32_t word, int count, std::string& bytes) {
    for (int i = 0; i < count; ++i) bytes.push_back(static_cast<char>(word >> 8 * i & 0xFFu));
  }

  const MeshFile& file_;
  PlyBody body_;
  std::string points_, corners_;
  std::uint64_t vertices_ = 0;
  std::size_t faces_ = 0, triangles_ = 0;
  double largest_ = -1;
};

}  // namespace

std::string ply_input(const MeshFile& file, std::string_view bytes) {
  const PlyHeader header = ply_header(file, bytes);
  return PlyShape(file, bytes, header).read(header);
}

}  // namespace wholehand
