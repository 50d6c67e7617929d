// SPDX-License-Identifier: MIT
#include "core/meshes/section.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace wholehand {
namespace {

using SectionPoint = std::array<double, 2>;
using CutEdge = std::pair<std::uint32_t, std::uint32_t>;  // vertices on both sides of the plane

// The place where the plane cuts an edge, and where the triangles' cuts lead from there: all in the same sense about what is inside.
struct CutPlace {
  SectionPoint point{};
  std::vector<CutEdge> next;
  bool is_end = true;     // no triangle leads here
  std::size_t drawn = 0;  // of `next`
};

}  // namespace

double farthest_azimuth(const TriangleMesh& mesh) {
  double farthest = -1, azimuth = 0;
  for (const Triple& p : mesh.vertices)
    if (const double away = std::hypot(p[0], p[2]); away > farthest * (1 + 1e-6)) farthest = away, azimuth = std::atan2(p[2], p[0]);
  return azimuth;
}

std::vector<std::vector<SectionPoint>> mesh_section(const TriangleMesh& mesh, double azimuth) {
  const double cosine = std::cos(azimuth), sine = std::sin(azimuth);
  const auto side_of = [&](std::uint32_t v) { return mesh.vertices[v][2] * cosine - mesh.vertices[v][0] * sine; };
  std::map<CutEdge, CutPlace> places;
  const auto place_on = [&](std::uint32_t a, std::uint32_t b) {
    const CutEdge edge = std::minmax(a, b);
    const Triple &p = mesh.vertices[edge.first], &q = mesh.vertices[edge.second];
    const double t = side_of(edge.first) / (side_of(edge.first) - side_of(edge.second));
    const auto at = [&](const Triple& v) { return v[0] * cosine + v[2] * sine; };
    places[edge].point = {at(p) + t * (at(q) - at(p)), p[1] + t * (q[1] - p[1])};
    return edge;
  };
  for (const Corners& triangle : mesh.triangles) {
    std::optional<CutEdge> in, out;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3];
      const bool is_before = side_of(a) < 0;
      if (is_before != (side_of(b) < 0)) (is_before ? in : out) = place_on(a, b);  // a vertex in the plane counts as behind it
    }
    if (!in || !out) continue;
    places[*in].next.push_back(*out);
    places[*out].is_end = false;
  }
  std::vector<std::vector<SectionPoint>> lines;
  // A way from a place along cuts that were not drawn before.
  const auto follow = [&](CutPlace& from) {
    std::vector<SectionPoint> line{from.point};
    for (CutPlace* place = &from; place->drawn < place->next.size();) {
      place = &places[place->next[place->drawn++]];
      line.push_back(place->point);
    }
    return line;
  };
  for (const bool is_loop : {false, true})  // lines with ends first: a loop may be followed from anywhere
    for (auto& [edge, place] : places)
      while (place.drawn < place.next.size() && (is_loop || place.is_end)) lines.push_back(follow(place));
  return lines;
}

}  // namespace wholehand
