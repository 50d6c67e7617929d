// SPDX-License-Identifier: MIT
#include "base/text/nearest_name.h"

#include <algorithm>
#include <cstdint>

namespace wholehand {
namespace {

constexpr std::size_t LARGEST_NAME_COMPARED = 64;  // bytes
constexpr std::size_t SHORTEST_BEGINNING = 2;      // bytes: of a name that is not written to its end

// Levenshtein distance, row by row. A name longer than 64 bytes is cut: it is not a typing mistake.
std::size_t edit_distance(std::string_view name, std::string_view known) {
  name = name.substr(0, LARGEST_NAME_COMPARED);
  std::vector<std::size_t> row(known.size() + 1);
  for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < name.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < known.size(); ++j) {
      const std::size_t changed = diagonal + (name[i] == known[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string guess(std::string_view name) { return " (did you mean '" + std::string(name) + "'?)"; }

}  // namespace

std::string nearest_name(std::string_view name, std::span<const std::string_view> names) {
  std::string nearest;
  std::size_t smallest = SIZE_MAX;
  for (const std::string_view known : names) {
    const std::size_t distance = edit_distance(name, known);
    if (distance >= smallest) continue;
    smallest = distance;
    nearest = known;
  }
  return nearest;
}

std::string did_you_mean(std::string_view name, std::span<const std::string_view> names) {
  for (const std::string_view known : names)
    if (name.size() >= SHORTEST_BEGINNING && known.starts_with(name)) return guess(known);
  const std::string nearest = nearest_name(name, names);
  const bool is_slip = !nearest.empty() && 3 * edit_distance(name, nearest) <= std::min(name.size(), nearest.size());
  return is_slip ? guess(nearest) : "";
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& names) {
  return did_you_mean(name, std::vector<std::string_view>(names.begin(), names.end()));
}

}  // namespace wholehand
