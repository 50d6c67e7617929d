// SPDX-License-Identifier: MIT
// Meshes of vessels with their own walls: a mug with a handle, a bowl and a bottle. m.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/support/meshes.h"

namespace wholehand {

using WallPoints = std::vector<std::array<double, 2>>;  // (r, y)

inline void append_arc(WallPoints& points, const std::array<double, 2>& center, double radius, double from, double to, int steps) {
  for (int i = 0; i <= steps; ++i) {
    const double angle = from + (to - from) * i / steps;
    points.push_back({std::max(0.0, center[0] + radius * std::cos(angle)), center[1] + radius * std::sin(angle)});
  }
}

// The body that a path turned about the y axis encloses: outside up, over the rim, and down inside. Both ends lie on the axis.
inline TriangleMesh turned_wall(const WallPoints& points, int around) {
  TriangleMesh mesh;
  std::vector<std::vector<std::uint32_t>> rows;
  for (const auto& [r, y] : points) {
    std::vector<std::uint32_t>& row = rows.emplace_back();
    for (int j = 0; j < around; ++j) {
      const double angle = 2 * PI * j / around;
      if (j == 0 || r > 1e-9) mesh.vertices.push_back({r * std::sin(angle), y, r * std::cos(angle)});
      row.push_back(static_cast<std::uint32_t>(mesh.vertices.size() - 1));
    }
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
  };
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows[i].size(); ++j) {
      const std::size_t next = (j + 1) % rows[i].size();
      add(rows[i][j], rows[i + 1][next], rows[i + 1][j]);
      add(rows[i][j], rows[i][next], rows[i + 1][next]);
    }
  }
  return mesh;
}

// Half a torus in the plane z = 0 about (x, y), towards +x; its flat ends are hidden in a wall.
inline TriangleMesh handle_mesh(double x, double y, double bend, double bar, int along, int across) {
  TriangleMesh mesh;
  for (int i = 0; i <= along; ++i) {
    const double a = -PI / 2 + PI * i / along;
    for (int j = 0; j < across; ++j) {
      const double b = 2 * PI * j / across, r = bend + bar * std::cos(b);
      mesh.vertices.push_back({x + r * std::cos(a), y + r * std::sin(a), bar * std::sin(b)});
    }
  }
  const auto at = [across](int i, int j) { return static_cast<std::uint32_t>(i * across + j % across); };
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < across; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  for (int j = 1; j + 1 < across; ++j) {
    mesh.triangles.push_back({at(0, 0), at(0, j + 1), at(0, j)});
    mesh.triangles.push_back({at(along, 0), at(along, j), at(along, j + 1)});
  }
  return mesh;
}

// 80 mm wide and 95 mm high, with a wall of 3 mm and a floor of 4 mm.
inline TriangleMesh cup_mesh(int around = 64) {
  return turned_wall({{0, 0}, {0.04, 0}, {0.04, 0.095}, {0.037, 0.095}, {0.037, 0.004}, {0, 0.004}}, around);
}
inline TriangleMesh mug_mesh(int around = 64) { return joined(cup_mesh(around), handle_mesh(0.0385, 0.048, 0.027, 0.005, 24, 16)); }
// A half sphere 110 mm wide, with a wall of 4 mm and a foot.
inline TriangleMesh bowl_mesh() {
  constexpr double OUTER = 0.055, INNER = 0.051, FOOT = 0.025;
  WallPoints points{{0, 0}};
  append_arc(points, {0, OUTER}, OUTER, -std::acos(FOOT / OUTER), 0, 20);
  points.insert(points.begin() + 1, {FOOT, 0});
  append_arc(points, {0, OUTER}, INNER, 0, -PI / 2, 24);
  points.back()[0] = 0;
  return turned_wall(points, 72);
}
// 66 mm wide and 200 mm high, with a round shoulder and a neck 26 mm wide.
inline TriangleMesh bottle_mesh() {
  WallPoints points{{0, 0}, {0.033, 0}};
  append_arc(points, {0.013, 0.12}, 0.02, 0, PI / 2, 8);
  points.insert(points.end(), {{0.013, 0.2}, {0.01, 0.2}, {0.01, 0.138}});
  append_arc(points, {0.013, 0.12}, 0.017, PI / 2, 0, 8);
  points.insert(points.end(), {{0.03, 0.004}, {0, 0.004}});
  return turned_wall(points, 64);
}

}  // namespace wholehand
