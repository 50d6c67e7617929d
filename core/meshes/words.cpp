// SPDX-License-Identifier: MIT
#include "core/meshes/words.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>

#include "base/text/printable.h"

namespace wholehand {
namespace {

constexpr std::string_view WORD_GAPS = " \t\r\v\f";

}  // namespace

std::string_view MeshWords::next_in_line() {
  const std::size_t start = text_.find_first_not_of(WORD_GAPS);
  if (start == text_.npos) {
    text_ = {};
    return {};
  }
  text_.remove_prefix(start);
  if (text_[0] == '\n') return {};
  std::size_t end = 1;
  while (end < text_.size() && text_[end] != '\n' && WORD_GAPS.find(text_[end]) == WORD_GAPS.npos) ++end;
  const std::string_view word = text_.substr(0, end);
  text_.remove_prefix(end);
  return word;
}

std::string_view MeshWords::next() {
  while (!text_.empty()) {
    const std::string_view word = next_in_line();
    if (!word.empty()) return word;
    skip_line();
  }
  return {};
}

void MeshWords::skip_line() {
  const std::size_t end = text_.find('\n');
  text_.remove_prefix(end == text_.npos ? text_.size() : end + 1);
  ++line_;
}

double MeshWords::number(std::string_view word) const {
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool is_tiny = error == std::errc::result_out_of_range && std::abs(value) < 1;  // 1e-400
  if ((error != std::errc() && !is_tiny) || end != digits.data() + digits.size() || digits.empty())
    refuse(word.empty() ? "ends where a number should be" : fmt::format("'{}' is no number", shown(word)));
  if (!(std::abs(value) <= std::numeric_limits<float>::max())) refuse(fmt::format("'{}' is no finite number", shown(word)));
  return value;
}

void MeshWords::refuse(const std::string& message) const { file_.refuse(fmt::format("line {}: {}", line_, message)); }

std::string MeshWords::shown(std::string_view word) { return one_line(word.substr(0, 40)); }

}  // namespace wholehand
