// SPDX-License-Identifier: MIT
#include "core/meshes/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>

#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/meshes/distance.h"
#include "core/meshes/holes.h"
#include "core/vectors.h"

namespace wholehand {
namespace {

// The least cosine between a corner's direction and its faces that counts: a sharper corner moves less far.
constexpr double SHARPEST_BEND = 0.3;
// The share of the inner side's area that may be turned over. Beside creases and in bends narrower than the wall is thick it folds over within the
// wall, which does no harm.
constexpr double MOST_TURNED = 0.25;
// The cosine between the normals of two walls that face each other is below this: a tube of five sides has -0.81.
constexpr double OPPOSITE = -0.8;
constexpr std::size_t MOST_SEARCHED = 100'000;  // triangles whose walls are compared with others, evenly picked
constexpr double CLEARLY_NEAR = 0.99;  // of the thickness: closer to the sheet than the inner side's rounding and bends explain
constexpr double LEVEL_RIM = 1e-3;     // of its size: how far the corners of a flat rim lie off its plane

// Corners of a flat rim move within its plane, so that the rim of a leaning wall stays level.
void keep_rims_level(const TriangleMesh& mesh, std::vector<glm::dvec3>& directions, std::vector<double>& cosines) {
  for (const MeshHole& hole : find_holes(mesh).loops) {
    const glm::dvec3 area = to_vec3(hole.area);
    if (!(hole.off_plane <= LEVEL_RIM * hole.across) || !(glm::length(area) > 0)) continue;
    const glm::dvec3 across = glm::normalize(area);
    for (const std::uint32_t corner : hole.corners) {
      const glm::dvec3 level = directions[corner] - glm::dot(directions[corner], across) * across;
      if (glm::length(level) < SHARPEST_BEND) continue;  // the sheet lies nearly in the rim's plane
      const glm::dvec3 direction = glm::normalize(level);
      cosines[corner] *= glm::dot(direction, directions[corner]);
      directions[corner] = direction;
    }
  }
}

// Where each corner of the sheet lies on its inner side: so far along the mean of its faces' normals, weighted by their angles there, that it is as far
// behind each of them as the wall is thick, if they are flat.
std::vector<Triple> inner_side(const TriangleMesh& mesh, double thickness) {
  std::vector<glm::dvec3> normals(mesh.triangles.size()), sums(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Corners& corners = mesh.triangles[t];
    const auto at = [&](int k) { return to_vec3(mesh.vertices[corners[k % 3]]); };
    const glm::dvec3 normal = glm::cross(at(1) - at(0), at(2) - at(0));
    if (glm::length(normal) > 0) normals[t] = glm::normalize(normal);
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 to_next = at(k + 1) - at(k), to_last = at(k + 2) - at(k);
      const double scale = glm::length(to_next) * glm::length(to_last);
      if (scale > 0) sums[corners[k]] += std::acos(std::clamp(glm::dot(to_next, to_last) / scale, -1.0, 1.0)) * normals[t];
    }
  }
  std::vector<double> least(mesh.vertices.size(), 1);
  for (glm::dvec3& sum : sums) sum = glm::length(sum) > 0 ? glm::normalize(sum) : sum;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t corner : mesh.triangles[t])
      least[corner] = std::min(least[corner], glm::dot(sums[corner], normals[t]));
  keep_rims_level(mesh, sums, least);
  std::vector<Triple> inner;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    inner.push_back(to_triple(to_vec3(mesh.vertices[v]) - thickness / std::max(least[v], SHARPEST_BEND) * sums[v]));
  return inner;
}

// Where two walls that face each other leave the least room between the outer sides; none if the inner sides of all such walls keep clear of each
// other.
struct NarrowRoom {
  double width = std::numeric_limits<double>::infinity();  // m
  Triple at{};
};

// A triangle's middle and normal, whose length is twice its area.
struct SheetFace {
  glm::dvec3 middle, normal;
};

SheetFace face_of(const std::vector<Triple>& vertices, const Corners& triangle) {
  const glm::dvec3 a = to_vec3(vertices[triangle[0]]), b = to_vec3(vertices[triangle[1]]), c = to_vec3(vertices[triangle[2]]);
  return {(a + b + c) / 3.0, glm::cross(b - a, c - a)};
}

NarrowRoom narrowest_room(const CheckedMesh& sheet, const std::vector<Triple>& inner, double thickness) {
  const MeshDistance distance(sheet);
  const std::vector<Corners>& triangles = sheet.mesh.triangles;
  NarrowRoom narrowest;
  const auto step = static_cast<std::uint32_t>(triangles.size() / MOST_SEARCHED + 1);
  for (std::uint32_t t = 0; t < triangles.size(); t += step) {
    const glm::dvec3 behind = face_of(inner, triangles[t]).middle;
    std::uint32_t nearest = t;
    if (distance.distance(to_triple(behind), nearest) >= CLEARLY_NEAR * thickness) continue;
    const SheetFace own = face_of(sheet.mesh.vertices, triangles[t]), other = face_of(sheet.mesh.vertices, triangles[nearest]);
    const double area = glm::length(own.normal), other_area = glm::length(other.normal);
    if (!(glm::dot(own.normal, other.normal) < OPPOSITE * area * other_area)) continue;
    const double width =
        glm::dot(own.middle - behind, own.normal) / area + glm::dot(other.middle - behind, other.normal) / other_area;
    if (width < narrowest.width) narrowest = {width, to_triple(own.middle)};
  }
  return narrowest;
}

// A length or a place in mm, to a hundredth.
std::string rounded_mm(double length) { return plain_text(std::round(1e5 * length) / 100); }
std::string sheet_place(const Triple& p) {
  return fmt::format("({}, {}, {}) mm", rounded_mm(p[0]), rounded_mm(p[1]), rounded_mm(p[2]));
}

// A triangle is turned over if an edge of it runs back on the inner side: past one center of curvature its normal turns, past both it does not.
// `prefix`: of messages, with the thickness.
void refuse_folded_walls(const CheckedMesh& sheet, const std::vector<Triple>& inner, const std::string& prefix) {
  double turned = 0;
  std::optional<Triple> first;
  for (const Corners& triangle : sheet.mesh.triangles) {
    const auto runs_back = [&](int k) {
      const auto along = [&](const std::vector<Triple>& vertices) {
        return to_vec3(vertices[triangle[(k + 1) % 3]]) - to_vec3(vertices[triangle[k]]);
      };
      return glm::dot(along(sheet.mesh.vertices), along(inner)) < 0;
    };
    if (!runs_back(0) && !runs_back(1) && !runs_back(2)) continue;
    const SheetFace face = face_of(sheet.mesh.vertices, triangle);
    turned += glm::length(face.normal) / 2;
    if (!first) first = to_triple(face.middle);
  }
  if (turned > MOST_TURNED * sheet.facts.area)
    throw usage_error(
        fmt::format("{} more than its bends leave room for, as at {}: give a smaller one", prefix, sheet_place(*first)));
}

void refuse_crossing_walls(const CheckedMesh& sheet, const std::vector<Triple>& inner, double thickness,
                           const std::string& prefix) {
  const NarrowRoom room = narrowest_room(sheet, inner, thickness);
  if (std::isinf(room.width)) return;
  throw usage_error(
      fmt::format("{} too thick where walls face each other: at {} their outer sides are {} mm apart, so give less than {}", prefix,
                  sheet_place(room.at), rounded_mm(room.width), rounded_mm(room.width / 2)));
}

}  // namespace

CheckedMesh thickened(const CheckedMesh& sheet, double thickness, const std::string& name) {
  if (sheet.facts.open_edges == 0)
    throw usage_error(name + ": thickness_mm: no edge is open, so its walls have a thickness: leave out thickness_mm");
  if (!sheet.facts.oriented || sheet.facts.non_manifold_edges > 0)
    throw usage_error(
        fmt::format("{}: thickness_mm: {}: make one sheet of it", name,
                    sheet.facts.oriented ? "more than two triangles meet at an edge" : "its surface has one side only"));
  TriangleMesh body = sheet.mesh;
  const auto count = static_cast<std::uint32_t>(sheet.mesh.vertices.size());
  const std::vector<Triple> inner = inner_side(sheet.mesh, thickness);
  const std::string prefix = fmt::format("{}: thickness_mm: {} mm is", name, plain_text(1e3 * thickness, 4));
  refuse_crossing_walls(sheet, inner, thickness, prefix);
  refuse_folded_walls(sheet, inner, prefix);
  body.vertices.insert(body.vertices.end(), inner.begin(), inner.end());
  for (const auto& [a, b, c] : sheet.mesh.triangles) body.triangles.push_back({a + count, c + count, b + count});
  for_each_edge(edge_uses(sheet.mesh.triangles), [&](std::span<const EdgeUse> uses) {
    if (uses.size() != 1) return;
    const std::uint32_t a = uses[0].is_forward ? uses[0].low : uses[0].high, b = uses[0].is_forward ? uses[0].high : uses[0].low;
    body.triangles.push_back({b, a, a + count});
    body.triangles.push_back({b, a + count, b + count});
  });
  CheckedMesh thick = check_mesh(body, name);
  if (!thick.facts.oriented) throw usage_error(prefix + " more than its bends leave room for: give a smaller one");
  thick.facts.triangles = sheet.facts.triangles;
  thick.facts.back_triangles = sheet.facts.back_triangles;
  thick.facts.thickness = thickness;
  return thick;
}

}  // namespace wholehand
