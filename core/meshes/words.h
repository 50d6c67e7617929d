// SPDX-License-Identifier: MIT
// Splits the text of a mesh file into words.
#pragma once

#include <string_view>

#include "core/meshes/file.h"

namespace wholehand {

class MeshWords {
 public:
  // Lines are counted from `line` in messages.
  MeshWords(const MeshFile& file, std::string_view text, std::size_t line = 1) : file_(file), text_(text), line_(line) {}

  std::string_view next();          // crosses line ends; empty at the end of the text
  std::string_view next_in_line();  // empty at the end of the line
  void skip_line();                 // to the start of the next
  bool at_end() const { return text_.empty(); }
  std::string_view rest() const { return text_; }

  // The word as a number that single precision holds. Throws Error (usage), one line.
  double number(std::string_view word) const;
  // Throws Error (usage): one line with file and line.
  [[noreturn]] void refuse(const std::string& message) const;
  // As much of a word as fits a message, printable.
  static std::string shown(std::string_view word);

 private:
  const MeshFile& file_;
  std::string_view text_;
  std::size_t line_;
};

}  // namespace wholehand
