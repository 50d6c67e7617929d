// outline = [{line = [r, y]}, {arc = [r, y], center = [r, y]}, ..]: half an outline in mm, from the axis at the base to the axis at the
// mouth. The body lies to the left of its way: base, outwards, up, mouth. A curve from [0, 0] that stays off the axis, meets itself
// nowhere and ends on the axis at its highest point runs that way round of itself, so its direction needs no check of its own.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/scene_geometry.h"
#include "app/scene_parts.h"

namespace wholehand {
namespace {

constexpr const char* ELEMENTS = "each {line = [r, y]} or {arc = [r, y], center = [r, y]}";
constexpr double SHORTEST_ELEMENT = 1e-3;  // mm
// An end at 50.001 is less than that from one at 50, by rounding of either: this much of it may be missing.
constexpr double ROUNDED_AWAY = 1e-6;
constexpr double UNEQUAL_RADII = 1e-6;  // of an arc's radius: by how much its ends may differ in distance from the center
constexpr double TOUCHING = 1e-6;       // mm: elements nearer than this touch
// mm: around an end that two elements share, they are near each other by right. Rounding makes tangents seem to cross there again.
constexpr double SHARED_END = 5e-4;

// An element as the file gives it, mm.
struct RawElement {
  PlaneCurve curve;
  Place place;
};

// To nanometres, so that rounding does not show.
std::string show(double length) { return fmt::format("{:.9g}", std::round(length * 1e6) / 1e6 + 0.0); }
std::string show(const Point& p) { return fmt::format("[{}, {}]", show(p[0]), show(p[1])); }

Point read_point(const SceneFile& file, const toml::node& node, const char* what, const Quantity& r_range,
                 const Quantity& y_range) {
  const toml::array* pair = node.as_array();
  if (!pair || pair->size() != 2) {
    file.refuse(place_of(node), std::string(what) + (pair ? fmt::format(" has {} entries", pair->size()) : " " + found(node)),
                "allowed: [r, y] in mm");
  }
  // checked in the file's unit, and kept in it: the conversion to metres comes last
  const Quantity r_plain{r_range.low, r_range.high}, y_plain{y_range.low, y_range.high};
  return {read_number(file, (*pair)[0], fmt::format("r of {}", what), r_plain),
          read_number(file, (*pair)[1], fmt::format("y of {}", what), y_plain)};
}

RawElement read_element(const SceneFile& file, const toml::node& node, const std::string& key, const Point& start) {
  const toml::table* table = node.as_table();
  const std::string allowed = "allowed: {line = [r, y]} or {arc = [r, y], center = [r, y]}", what = "an element of " + key;
  if (!table) file.refuse(place_of(node), what + " " + found(node), allowed);
  const SceneTable element(file, *table, what, {"line", "arc", "center"});
  const bool is_line = element.has("line"), is_arc = element.has("arc"), has_center = element.has("center");
  const char* fault = is_line && is_arc       ? "both 'line' and 'arc'"
                      : !is_line && !is_arc   ? "neither 'line' nor 'arc'"
                      : is_arc && !has_center ? "'arc' and no 'center'"
                      : is_line && has_center ? "'line' and 'center'"
                                              : nullptr;
  if (fault) file.refuse(element.place(), fmt::format("{} with {}", what, fault), allowed);
  RawElement raw;
  raw.place = element.place();
  if (!is_arc) {
    raw.curve = make_line(start, read_point(file, *element.find("line"), "line", ranges::OUTLINE_R, ranges::OUTLINE_Y));
    return raw;
  }
  const Point end = read_point(file, *element.find("arc"), "arc", ranges::OUTLINE_R, ranges::OUTLINE_Y);
  const Point center = read_point(file, *element.find("center"), "center", ranges::CENTER, ranges::CENTER);
  const double start_radius = distance(start, center), end_radius = distance(end, center);
  if (std::abs(start_radius - end_radius) > UNEQUAL_RADII * std::max(start_radius, end_radius)) {
    file.refuse(element.place("center"),
                fmt::format("center {} is {:.9g} mm from the arc's start and {:.9g} mm from its end", show(center), start_radius,
                            end_radius),
                "allowed: a center equally far from both, to one part in a million");
  }
  const auto arc = make_arc(start, end, center);
  if (!arc && distance(start, end) >= SHORTEST_ELEMENT) {
    file.refuse(raw.place,
                fmt::format("a half circle from {} to {}, which may go above or below its center", show(start), show(end)),
                "allowed: two arcs in its place, to say which");
  }
  raw.curve = arc.value_or(make_line(start, end));
  return raw;
}

// What an element must hold by itself; `is_last`: it is the mouth.
void check_element(const SceneFile& file, const RawElement& raw, bool is_last) {
  const PlaneCurve& curve = raw.curve;
  if (distance(curve.a, curve.b) < SHORTEST_ELEMENT * (1 - ROUNDED_AWAY)) {
    file.refuse(raw.place, fmt::format("an element of no length, from {} to {}", show(curve.a), show(curve.b)),
                fmt::format("allowed: elements of at least {} mm", SHORTEST_ELEMENT));
  }
  if (is_last) {
    if (curve.b[0] != 0) {
      file.refuse(raw.place, fmt::format("the outline is open: it ends at {}, off the axis", show(curve.b)),
                  "allowed: as the last element the mouth, a level line to the axis, {line = [0, y]}");
    }
    if (curve.is_arc || curve.a[1] != curve.b[1]) {
      file.refuse(raw.place, fmt::format("the last element, from {} to {}, is no level line", show(curve.a), show(curve.b)),
                  "allowed: as the last element the mouth, a level line to the axis, {line = [0, y]}");
    }
    return;
  }
  if (curve.b[0] <= TOUCHING) {
    file.refuse(raw.place, fmt::format("the outline comes back to the axis at {}, before its mouth", show(curve.b)),
                "allowed: r = 0 only at the start and at the end");
  }
  // an arc may begin on the axis, upright even, but must not reach or cross it on its way
  const double leftmost = -curve.extent(PI);
  if (curve.is_arc && leftmost < std::min(curve.a[0], curve.b[0]) && leftmost <= TOUCHING &&
      distance(curve.a, {leftmost, curve.center[1]}) > TOUCHING) {
    file.refuse(
        raw.place,
        fmt::format("the outline leaves its half plane: this arc reaches r = {} at y = {}", show(leftmost), show(curve.center[1])),
        "allowed: r > 0 all along");
  }
}

OutlineElement in_metres(const RawElement& raw) {
  const auto to_metres = [](const Point& p) { return Point{to_si(p[0], Unit::mm), to_si(p[1], Unit::mm)}; };
  return {raw.curve.is_arc, to_metres(raw.curve.b), to_metres(raw.curve.center), raw.place.line, raw.place.column};
}

// A cavity has one radius at each height.
void check_inner_element(const SceneFile& file, const RawElement& raw, bool is_first, bool is_last) {
  const PlaneCurve& curve = raw.curve;
  if (is_first) {
    if (!curve.is_arc && curve.b[0] == 0) return;
    file.refuse(raw.place, fmt::format("the inner outline begins at {}, off the axis", show(curve.b)),
                "allowed: as the first element where the cavity's floor meets the axis, {line = [0, y]}");
  }
  if (distance(curve.a, curve.b) < SHORTEST_ELEMENT * (1 - ROUNDED_AWAY)) {
    file.refuse(raw.place, fmt::format("an element of no length, from {} to {}", show(curve.a), show(curve.b)),
                fmt::format("allowed: elements of at least {} mm", SHORTEST_ELEMENT));
  }
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
    file.refuse(raw.place, fmt::format("the inner outline ends at {}, which is no mouth", show(curve.b)),
                "allowed: as the last element one that rises to the mouth's edge, off the axis");
  }
}

void check_whole(const SceneFile& file, const std::vector<RawElement>& elements) {
  const double mouth = elements.back().curve.b[1];
  for (const RawElement& raw : elements) {
    const double top = raw.curve.extent(PI / 2);
    if (top > mouth + TOUCHING) {
      file.refuse(raw.place, fmt::format("the outline rises to y = {}, above its mouth at {}", show(top), show(mouth)),
                  "allowed: nothing above the mouth, the last element");
    }
  }
  for (std::size_t later = 1; later < elements.size(); ++later) {
    for (std::size_t earlier = 0; earlier < later; ++earlier) {
      const RawElement& first = elements[earlier];
      const RawElement& second = elements[later];
      const auto shared = later == earlier + 1 ? std::optional<Point>(second.curve.a) : std::nullopt;
      const auto meeting = meeting_point(first.curve, second.curve, TOUCHING, shared, SHARED_END);
      if (!meeting) continue;
      file.refuse(second.place,
                  fmt::format("the outline meets itself at {}, on the element of line {}, column {}", show(*meeting),
                              first.place.line, first.place.column),
                  "allowed: no crossing and no touching");
    }
  }
}

}  // namespace

Silhouette read_outline(const SceneTable& vessel) {
  const SceneFile& file = vessel.file();
  const auto* array = vessel.array("outline", 2, ranges::LARGEST_OUTLINE, ELEMENTS);
  std::vector<RawElement> elements;
  Point at{0, 0};
  for (const toml::node& node : *array) {
    elements.push_back(read_element(file, node, "outline", at));
    check_element(file, elements.back(), elements.size() == array->size());
    at = elements.back().curve.b;
  }
  check_whole(file, elements);

  Silhouette silhouette;
  for (const RawElement& raw : elements) {
    silhouette.elements.push_back(in_metres(raw));
    silhouette.largest_radius = std::max(silhouette.largest_radius, to_si(raw.curve.extent(0), Unit::mm));
  }
  silhouette.height = to_si(at[1], Unit::mm);
  return silhouette;
}

std::vector<OutlineElement> read_inner_outline(const SceneTable& vessel) {
  std::vector<OutlineElement> elements;
  const toml::array* array = vessel.array("inner_outline", 2, ranges::LARGEST_OUTLINE, ELEMENTS);
  if (!array) return elements;
  Point at{0, 0};
  for (const toml::node& node : *array) {
    const RawElement raw = read_element(vessel.file(), node, "inner_outline", at);
    check_inner_element(vessel.file(), raw, elements.empty(), elements.size() + 1 == array->size());
    elements.push_back(in_metres(raw));
    at = raw.curve.b;
  }
  return elements;
}

}  // namespace wholehand
