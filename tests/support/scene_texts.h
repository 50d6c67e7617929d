// SPDX-License-Identifier: MIT
// Scene files in tests, and what they are refused for.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "base/text/error.h"
#include "core/reader/reader.h"

namespace wholehand {

// A vessel to complete a scene with.
inline const std::string VESSEL =
    "\n[[vessel]]\nname = \"v\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 110\nwall_mm = 2\n";

inline Scene scene_from(const std::string& text) { return parse_scene(text, "test.toml"); }

inline std::string refusal_of(const std::string& text) {
  try {
    scene_from(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    return error.what();
  }
  return "accepted";
}

// `text` has one '@', where the refusal must point; the rest of its line must hold `gist`.
inline void expect_refusal(std::string text, const std::string& gist) {
  const std::size_t mark = text.find('@');
  ASSERT_NE(mark, std::string::npos) << text;
  text.erase(mark, 1);
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(mark), '\n');
  const std::size_t begin = mark == 0 ? std::string::npos : text.rfind('\n', mark - 1);
  const std::size_t column = begin == std::string::npos ? mark + 1 : mark - begin;
  const std::string expected = "test.toml:" + std::to_string(line) + ":" + std::to_string(column) + ": ";
  const std::string refusal = refusal_of(text);
  EXPECT_EQ(refusal.substr(0, expected.size()), expected) << refusal << "\nof\n" << text;
  EXPECT_NE(refusal.find(gist), std::string::npos) << refusal << "\nlacks " << gist << "\nof\n" << text;
  EXPECT_EQ(refusal.find('\n'), std::string::npos) << refusal;
}

}  // namespace wholehand
