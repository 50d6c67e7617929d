// SPDX-License-Identifier: MIT
#include "core/meshes/assimp_input.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cstdint>
#include <vector>

#include "base/text/readable.h"
#include "core/file_kind.h"
#include "core/meshes/triangles.h"
#include "core/meshes/words.h"

namespace wholehand {
namespace {

void append_little(std::string& bytes, std::uint32_t word, int count = 4) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<char>(word >> 8 * i & 0xFFu));
}

// ---- STL ----

bool is_word(std::string_view word, std::string_view lower) {
  return word.size() == lower.size() &&
         std::equal(word.begin(), word.end(), lower.begin(), [](char a, char b) { return (a | 0x20) == b; });
}

// A facet after its first word, as a record of a binary STL: normal, three corners, no attribute.
void append_facet(MeshWords& words, std::string& bytes) {
  const auto expect = [&](const char* wanted) {
    const std::string_view word = words.next();
    if (!is_word(word, wanted)) words.refuse(fmt::format("'{}' where '{}' should be", MeshWords::shown(word), wanted));
  };
  const auto append_numbers = [&] {
    for (int k = 0; k < 3; ++k) append_little(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(words.number(words.next()))));
  };
  expect("normal");
  for (int k = 0; k < 3; ++k) words.next();  // which says no more than the corners do, and is often "nan"
  bytes.append(12, '\0');
  expect("outer");
  expect("loop");
  for (int corner = 0; corner < 3; ++corner) {
    expect("vertex");
    append_numbers();
  }
  expect("endloop");
  expect("endfacet");
  append_little(bytes, 0, 2);
}

std::string binary_of_ascii_stl(const MeshFile& file, std::string_view text) {
  std::string bytes(84, '\0');
  MeshWords words(file, text);
  std::uint32_t count = 0;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (is_word(word, "solid") || is_word(word, "endsolid")) {
      words.skip_line();  // its name
    } else if (is_word(word, "facet")) {
      append_facet(words, bytes);
      if (++count > MOST_TRIANGLES) file.refuse_size();
    } else {
      words.refuse(fmt::format("'{}' is no word of an STL, which has 'facet' there", MeshWords::shown(word)));
    }
  }
  if (count == 0) file.refuse("has no triangle");
  for (int i = 0; i < 4; ++i) bytes[80 + i] = static_cast<char>(count >> 8 * i & 0xFFu);
  return bytes;
}

// ---- OBJ ----

// Vertices and faces of an OBJ. A face names its corners by index, from 1 up or from -1 back.
class ObjShape {
 public:
  ObjShape(const MeshFile& file, std::string_view text) : file_(file), words_(file, text) {}

  std::string read() {
    for (; !words_.at_end(); words_.skip_line()) {
      const std::string_view key = word();
      if (key == "v") {
        add_vertex();
      } else if (key == "f") {
        add_face();
      } else if (key == "cstype" || key == "curv" || key == "curv2" || key == "surf") {
        words_.refuse("has curves or surfaces, which are not read: export polygons");
      }
    }
    if (largest_ > vertices_)
      file_.refuse(
          fmt::format("has a face with the vertex {} and {} vertices", readable_number(largest_), readable_number(vertices_)));
    if (triangles_ == 0) file_.refuse("has no face");
    return points_ + faces_;
  }

 private:
  // A backslash at its end goes on with the next line.
  std::string_view word() {
    std::string_view word = words_.next_in_line();
    while (word == "\\") {
      words_.skip_line();
      word = words_.next_in_line();
    }
    return word;
  }

  void add_vertex() {
    points_ += "v";
    for (int k = 0; k < 3; ++k) points_ += fmt::format(" {}", static_cast<float>(words_.number(word())));
    points_ += "\n";
    if (++vertices_ > static_cast<std::int64_t>(MOST_MESH_VERTICES)) file_.refuse_size();
  }

  // "7", "7/2", "7//3" or "7/2/3".
  std::int64_t corner(std::string_view word) const {
    std::int64_t index = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
    const bool is_whole = end == word.data() + word.size() || *end == '/';
    if (error != std::errc() || !is_whole || index == 0)
      words_.refuse(fmt::format("'{}' is no corner of a face", MeshWords::shown(word)));
    if (index < -vertices_)
      words_.refuse(fmt::format("has a face with the vertex {} and {} vertices before it", index, readable_number(vertices_)));
    return index < 0 ? vertices_ + 1 + index : index;
  }

  void add_face() {
    faces_ += "f";
    std::size_t corners = 0;
    for (std::string_view next = word(); !next.empty(); next = word()) {
      const std::int64_t vertex = corner(next);
      largest_ = std::max(largest_, vertex);
      faces_ += fmt::format(" {}", vertex);
      if (++corners > MOST_CORNERS)
        words_.refuse(fmt::format("has a face of more than {} corners: cut it into triangles", readable_number(MOST_CORNERS)));
    }
    if (corners < 3) words_.refuse(fmt::format("has a face of {} corners", corners));
    faces_ += "\n";
    triangles_ += corners - 2;
    if (triangles_ > MOST_TRIANGLES) file_.refuse_size();
  }

  const MeshFile& file_;
  MeshWords words_;
  std::string points_, faces_;
  std::int64_t vertices_ = 0, largest_ = 0;
  std::size_t triangles_ = 0;
};

}  // namespace

std::string stl_input(const MeshFile& file, std::string_view bytes) {
  if (!is_binary_stl(bytes, bytes.size())) {
    const bool is_text = bytes.substr(0, 1000).find('\0') == bytes.npos && is_word(MeshWords(file, bytes).next(), "solid");
    if (!is_text) file.refuse("is truncated or damaged: as a binary STL it has another size than its count of triangles says");
    return binary_of_ascii_stl(file, bytes);
  }
  if (bytes.size() == 84) file.refuse("has no triangle");
  return std::string(bytes);
}

std::string obj_input(const MeshFile& file, std::string_view bytes) { return ObjShape(file, bytes).read(); }

std::string assimp_input(const MeshFile& file, MeshFormat format, std::string_view bytes) {
  switch (format) {
    case MeshFormat::stl:
      return stl_input(file, bytes);
    case MeshFormat::ply:
      return ply_input(file, bytes);
    case MeshFormat::off:
      return off_input(file, bytes);
    case MeshFormat::collada:
      return collada_input(file, bytes);
    default:
      return obj_input(file, bytes);
  }
}

}  // namespace wholehand
