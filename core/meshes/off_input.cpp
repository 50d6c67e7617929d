// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <charconv>
#include <cstdint>

#include "base/text/readable.h"
#include "core/file_kind.h"
#include "core/meshes/assimp_input.h"
#include "core/meshes/triangles.h"
#include "core/meshes/words.h"

namespace wholehand {
namespace {

// The next word that belongs to no comment.
std::string_view off_word(MeshWords& words) {
  std::string_view word = words.next();
  while (word.starts_with('#')) {
    words.skip_line();
    word = words.next();
  }
  return word;
}

std::uint64_t off_number(const MeshWords& words, std::string_view word, const char* what) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size())
    words.refuse(word.empty() ? fmt::format("ends where {} should be", what)
                              : fmt::format("'{}' is not {}", MeshWords::shown(word), what));
  return number;
}

}  // namespace

// A vertex or a face takes a line, which may go on with colors and the like.
std::string off_input(const MeshFile& file, std::string_view bytes) {
  MeshWords words(file, bytes);
  std::string_view word = off_word(words);
  const std::size_t head = off_head(word);
  if (head == 0 || word.substr(0, head).find_first_of("4n") != word.npos)
    words.refuse(fmt::format("'{}' is no OFF of points in space", MeshWords::shown(word)));
  word.remove_prefix(head);
  if (word.empty()) word = off_word(words);
  if (word == "BINARY") file.refuse("is a binary OFF, which is not read: export it as text");
  const std::uint64_t vertices = off_number(words, word, "a count of vertices"),
                      faces = off_number(words, words.next_in_line(), "a count of faces");
  if (vertices > MOST_MESH_VERTICES || faces > MOST_TRIANGLES) file.refuse_size();
  if (faces == 0) file.refuse("has no face");
  words.skip_line();
  std::string text;
  for (std::uint64_t i = 0; i < vertices; ++i) {
    text += "v";
    for (int k = 0; k < 3; ++k)
      text += fmt::format(" {}", static_cast<float>(words.number(k == 0 ? off_word(words) : words.next_in_line())));
    text += "\n";
    words.skip_line();
  }
  std::uint64_t triangles = 0;
  for (std::uint64_t i = 0; i < faces; ++i) {
    const std::uint64_t corners = off_number(words, off_word(words), "a number of corners");
    if (corners < 3 || corners > MOST_CORNERS)
      words.refuse(
          fmt::format("has a face of {} corners; 3 to {} are read", readable_number(corners), readable_number(MOST_CORNERS)));
    text += "f";
    for (std::uint64_t k = 0; k < corners; ++k) {
      const std::uint64_t vertex = off_number(words, words.next_in_line(), "a corner of a face");
      if (vertex >= vertices)
        words.refuse(fmt::format("has a face with the vertex {} and {} vertices, counted from 0", readable_number(vertex),
                                 readable_number(vertices)));
      text += fmt::format(" {}", vertex + 1);
    }
    text += "\n";
    words.skip_line();
    triangles += corners - 2;
    if (triangles > MOST_TRIANGLES) file.refuse_size();
  }
  return text;
}

}  // namespace wholehand
