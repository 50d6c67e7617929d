// SPDX-License-Identifier: MIT
// What a plot of base/charts/plot has drawn, read back from its SVG.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <regex>
#include <string>
#include <vector>

namespace wholehand {

// The axes of a plot on the picture, units; they turn a place back to shares of the axes.
struct DrawnAxes {
  double left = 0, top = 0, width = 0, height = 0;
  std::array<double, 2> share(const std::array<double, 2>& p) const {
    return {(p[0] - left) / width, (top + height - p[1]) / height};
  }
};

// The axes of all plots, in their order.
inline std::vector<DrawnAxes> drawn_axes(const std::string& svg) {
  static const std::regex axes("<clipPath[^>]*>\\s*<rect x=\"([^\"]+)\" y=\"([^\"]+)\" width=\"([^\"]+)\" height=\"([^\"]+)\"");
  std::vector<DrawnAxes> found;
  for (std::sregex_iterator a(svg.begin(), svg.end(), axes), end; a != end; ++a)
    found.push_back({std::stod((*a)[1]), std::stod((*a)[2]), std::stod((*a)[3]), std::stod((*a)[4])});
  return found;
}

inline std::vector<std::string> drawn_paths(const std::string& svg, const std::string& attribute) {
  std::vector<std::string> paths;
  const std::regex path("<path [^>]*" + attribute + "[^>]* d=\"([^\"]*)\"");
  for (std::sregex_iterator p(svg.begin(), svg.end(), path), end; p != end; ++p) paths.push_back((*p)[1]);
  return paths;
}

// Points of the lines of a color, each unbroken stretch by itself; those in the legend too.
inline std::vector<std::vector<std::array<double, 2>>> drawn_lines(const std::string& svg, const std::string& color) {
  std::vector<std::vector<std::array<double, 2>>> lines;
  static const std::regex point("([ML])([-0-9.]+) ([-0-9.]+)");
  for (const std::string& path : drawn_paths(svg, "stroke=\"" + color + "\"")) {
    for (std::sregex_iterator p(path.begin(), path.end(), point), end; p != end; ++p) {
      if ((*p)[1] == "M") lines.emplace_back();
      lines.back().push_back({std::stod((*p)[2]), std::stod((*p)[3])});
    }
  }
  return lines;
}

// Left, top, right and bottom of the areas of a color.
inline std::vector<std::array<double, 4>> drawn_boxes(const std::string& svg, const std::string& color) {
  std::vector<std::array<double, 4>> boxes;
  static const std::regex box("M([-0-9.]+) ([-0-9.]+)H([-0-9.]+)V([-0-9.]+)H");
  for (const std::string& path : drawn_paths(svg, "class=\"cell\" fill=\"" + color + "\""))
    for (std::sregex_iterator b(path.begin(), path.end(), box), end; b != end; ++b)
      boxes.push_back({std::stod((*b)[1]), std::stod((*b)[2]), std::stod((*b)[3]), std::stod((*b)[4])});
  return boxes;
}

// How many marks of a color there are; those in the legend too.
inline std::size_t drawn_marks(const std::string& svg, const std::string& color) {
  std::size_t marks = 0;
  static const std::regex path("<path fill=\"([^\"]*)\" d=\"([^\"]*)\"");
  for (std::sregex_iterator p(svg.begin(), svg.end(), path), end; p != end; ++p) {
    const std::string data = (*p)[2];
    if ((*p)[1] == color) marks += static_cast<std::size_t>(std::count(data.begin(), data.end(), 'M'));
  }
  return marks;
}

// Where a text stands; fails where it is not there.
inline std::array<double, 2> drawn_text(const std::string& svg, const std::string& text) {
  std::smatch found;
  const std::regex place("<text x=\"([^\"]+)\" y=\"([^\"]+)\"[^>]*>" + text + "</text>");
  EXPECT_TRUE(std::regex_search(svg, found, place)) << text;
  return found.empty() ? std::array<double, 2>{} : std::array<double, 2>{std::stod(found[1]), std::stod(found[2])};
}

}  // namespace wholehand
