// SPDX-License-Identifier: MIT
#include "core/reader/list.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "base/text/printable.h"
#include "base/text/text.h"
#include "core/reader/reader.h"
#include "core/reader/text.h"

namespace wholehand {

std::string purpose_of_scene(std::string_view text) {
  std::string comment;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line) && line.starts_with('#');) {
    const std::size_t begin = line.find_first_not_of("# \t\r");
    if (begin == std::string::npos) break;  // an empty one ends a paragraph
    if (line.ends_with('\r')) line.pop_back();
    comment += (comment.empty() ? "" : " ") + line.substr(begin);
  }
  return one_line(comment.substr(0, std::min(comment.find(". "), comment.find_last_not_of(". \t\r") + 1)));
}

std::string list_scenes(const std::vector<std::string>& files) {
  struct Row {
    std::string name, vessels, purpose;
  };
  std::vector<Row> rows;
  std::size_t name_width = 0, vessels_width = 0;
  for (const std::string& file : files) {
    const Scene scene = read_scene_file(file);
    std::vector<std::string> vessels;
    for (const VesselData& vessel : scene.vessels) vessels.push_back(vessel.name);
    rows.push_back({std::filesystem::path(file).stem().string(), joined(vessels, ", "), purpose_of_scene(scene.text)});
    name_width = std::max(name_width, rows.back().name.size());
    vessels_width = std::max(vessels_width, rows.back().vessels.size());
  }
  std::string list;
  for (const Row& row : rows) {
    list += fmt::format("{:{}}  {:{}}  {}\n", row.name, name_width, row.vessels, vessels_width, row.purpose);
  }
  return list;
}

}  // namespace wholehand
