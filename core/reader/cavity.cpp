// SPDX-License-Identifier: MIT
// What a vessel holds: wall_mm and floor_mm, or inner_outline = [{line = [0, y]}, ..], half the outline of the cavity in mm.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/reader/elements.h"
#include "core/scene.h"

namespace wholehand {
namespace {

// A cavity has one radius at each height.
void check_inner_element(const SceneFile& file, const RawElement& raw, bool is_first, bool is_last) {
  const PlaneCurve& curve = raw.curve;
  if (is_first) {
    if (!curve.is_arc && curve.b[0] == 0) return;
    file.refuse(raw.place, fmt::format("the inner outline begins at {}, off the axis", show(curve.b)),
                "allowed: a first element {line = [0, y]}, where the cavity's floor meets the axis");
  }
  check_length(file, raw);
  const double top = curve.extent(PI / 2), bottom = -curve.extent(-PI / 2), leftmost = -curve.extent(PI);
  if (curve.b[1] < curve.a[1] || top > curve.b[1] + TOUCHING || bottom < curve.a[1] - TOUCHING) {
    file.refuse(raw.place, fmt::format("the inner outline falls between {} and {}", show(curve.a), show(curve.b)),
                "allowed: elements that rise or are level, as a cavity has one radius at each height");
  }
  if (leftmost < -TOUCHING) {
    file.refuse(raw.place, fmt::format("the inner outline leaves its half plane: it reaches r = {}", show(leftmost)),
                "allowed: r >= 0");
  }
  if (is_last && (curve.b[0] <= TOUCHING || curve.b[1] <= curve.a[1])) {
    file.refuse(raw.place, fmt::format("the inner outline ends at {}, which is not a mouth", show(curve.b)),
                "allowed: a last element that rises to the mouth's edge, off the axis");
  }
  const bool ends_there = curve.b[0] <= TOUCHING;
  if (ends_there || (curve.a[0] > TOUCHING && leftmost <= TOUCHING)) {
    file.refuse(
        raw.place,
        fmt::format("the inner outline comes back to the axis at {}", show(ends_there ? curve.b : Point{0, curve.center[1]})),
        "allowed: one cavity, which is off the axis from its floor to the mouth");
  }
}

// The vessel's own outline without its mouth, mm.
std::vector<PlaneCurve> open_outline(const Silhouette& silhouette) {
  std::vector<PlaneCurve> curves;
  Point at{0, 0};
  for (std::size_t i = 0; i + 1 < silhouette.elements.size(); ++i) {
    const OutlineElement& element = silhouette.elements[i];
    const Point end{element.end[0] * 1e3, element.end[1] * 1e3}, center{element.center[0] * 1e3, element.center[1] * 1e3};
    const auto arc = element.is_arc ? make_arc(at, end, center) : std::nullopt;
    curves.push_back(arc.value_or(make_line(at, end)));
    at = end;
  }
  return curves;
}

// The thinnest place of the wall between the two, mm. Both are curves, so that the least of their distances is exact; an inner outline that
// begins inside and meets the outline nowhere lies inside.
double check_within(const SceneFile& file, const Silhouette& silhouette, const std::vector<RawElement>& inner) {
  const double mouth = silhouette.height * 1e3;
  const Point begin = inner.front().curve.b, end = inner.back().curve.b;
  if (begin[1] <= 0 || begin[1] >= mouth) {
    file.refuse(inner.front().place, fmt::format("the inner outline begins at {}, outside of the vessel", show(begin)),
                fmt::format("allowed: a floor between y = 0 and the mouth at {}", show(mouth)));
  }
  if (std::abs(end[1] - mouth) > TOUCHING) {
    file.refuse(inner.back().place, fmt::format("the inner outline ends at {}, and the mouth is at y = {}", show(end), show(mouth)),
                "allowed: an end at the mouth's height");
  }
  double thinnest = mouth;
  const std::vector<PlaneCurve> outer = open_outline(silhouette);
  for (std::size_t i = 1; i < inner.size(); ++i) {
    for (std::size_t k = 0; k < outer.size(); ++k) {
      const double wall = distance(inner[i].curve, outer[k]);
      thinnest = std::min(thinnest, wall);
      if (wall >= ranges::WALL.low * (1 - TOUCHING)) continue;
      const std::string what =
          wall < TOUCHING ? std::string("meets the outline") : fmt::format("leaves a wall of {} mm", show(wall));
      file.refuse(inner[i].place,
                  fmt::format("the inner outline between {} and {} {} on the element of line {}, column {}", show(inner[i].curve.a),
                              show(inner[i].curve.b), what, silhouette.elements[k].line, silhouette.elements[k].column),
                  fmt::format("allowed: a wall of at least {} mm everywhere", ranges::WALL.low));
    }
  }
  return thinnest;
}

// prepare_vessel checks more closely what the wall leaves inside.
void read_wall(const SceneTable& table, const Silhouette& silhouette, VesselData& vessel) {
  table.need("wall_mm", ranges::WALL, vessel.wall);
  vessel.cavity_place = table.file().text_of(table.place("wall_mm"));
  if (vessel.wall >= silhouette.largest_radius) {
    table.file().refuse(table.place("wall_mm"), "wall_mm " + found(*table.find("wall_mm")),
                        fmt::format("allowed: less than the vessel's largest radius, {:.6g} mm", silhouette.largest_radius * 1e3));
  }
  if (vessel.wall >= silhouette.height) {
    table.file().refuse(table.place("wall_mm"), "wall_mm " + found(*table.find("wall_mm")),
                        fmt::format("allowed: less than the vessel's height, {:.6g} mm", silhouette.height * 1e3));
  }
  if (!table.has("floor_mm")) return;
  table.need("floor_mm", ranges::FLOOR, vessel.floor);
  vessel.cavity_place = table.file().text_of(table.place("floor_mm"));
  if (vessel.floor >= silhouette.height) {
    table.file().refuse(table.place("floor_mm"), "floor_mm " + found(*table.find("floor_mm")),
                        fmt::format("allowed: less than the vessel's height, {:.6g} mm", silhouette.height * 1e3));
  }
}

}  // namespace

void read_cavity(const SceneTable& table, const Silhouette& silhouette, VesselData& vessel) {
  const SceneFile& file = table.file();
  const bool has_inner = table.has("inner_outline"), has_wall = table.has("wall_mm");
  for (const char* key : {"wall_mm", "floor_mm"}) {
    if (has_inner && table.has(key))
      file.refuse(table.place(key), fmt::format("both {} and inner_outline are given", key),
                  "allowed: inner_outline alone, which describes the whole cavity");
  }
  if (table.has("floor_mm") && !has_wall)
    file.refuse(table.place("floor_mm"), "floor_mm without wall_mm",
                "allowed: with 'wall_mm'; an inner outline has a floor of its own");
  table.read("surface", {{"solid", Surface::solid}, {"shell", Surface::shell}}, vessel.surface);
  if (vessel.surface == Surface::shell && !has_wall && !has_inner)
    file.refuse(table.place("surface"), "surface = 'shell' without a wall", "allowed: with 'wall_mm' or 'inner_outline'");
  if (has_wall) read_wall(table, silhouette, vessel);
  if (!has_inner) return;
  const std::vector<RawElement> inner =
      read_elements(table, "inner_outline",
                    [&](const RawElement& raw, bool is_first, bool is_last) { check_inner_element(file, raw, is_first, is_last); });
  vessel.inner = in_meters(inner);
  vessel.cavity_place = file.text_of(table.place("inner_outline"));
  if (vessel.mesh) return;
  vessel.wall = to_si(check_within(file, silhouette, inner), Unit::mm);
  vessel.inner.back().end[1] = silhouette.height;
}

}  // namespace wholehand
