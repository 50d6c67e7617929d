// SPDX-License-Identifier: MIT
#include "core/reader/elements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/reader/fillet.h"

namespace wholehand {
namespace {

constexpr const char* FORMS = "{line = [r, y]}, {arc = [r, y], center = [r, y]} or {arc_through = [r, y], to = [r, y]}";
// An end at 50.001 is less than that from one at 50, by rounding of either: this much of it may be missing.
constexpr double ROUNDED_AWAY = 1e-6;
constexpr double UNEQUAL_RADII = 1e-6;       // of an arc's radius: by how much its ends may differ in distance from the center
constexpr double USED_UP = 1e-9;             // mm: what two fillets leave of an element between them, by rounding
constexpr double LONGEST_SWEEP = 0.99 * PI;  // rad: of one arc whose way follows from its center and ends

Point read_point(const SceneFile& file, const toml::node& node, const char* what, const Quantity& r_range,
                 const Quantity& y_range) {
  const toml::array* pair = node.as_array();
  if (!pair || pair->size() != 2) {
    file.refuse(place_of(node), std::string(what) + (pair ? fmt::format(" has {} entries", pair->size()) : " " + found(node)),
                "allowed: [r, y] in mm");
  }
  // checked in the file's unit, and kept in it: the conversion to meters comes last
  const Quantity r_plain{r_range.low, r_range.high}, y_plain{y_range.low, y_range.high};
  return {read_number(file, (*pair)[0], fmt::format("r of {}", what), r_plain),
          read_number(file, (*pair)[1], fmt::format("y of {}", what), y_plain)};
}

Point read_end(const SceneTable& element, const char* key) {
  return read_point(element.file(), *element.find(key), key, ranges::OUTLINE_R, ranges::OUTLINE_Y);
}

PlaneCurve read_arc(const SceneTable& element, const Point& start) {
  const SceneFile& file = element.file();
  const Point end = read_end(element, "arc");
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
    file.refuse(element.place(),
                fmt::format("a half circle from {} to {} may pass above or below its center", show(start), show(end)),
                "allowed: two arcs instead, or arc_through with a point on the way");
  }
  return arc.value_or(make_line(start, end));
}

PlaneCurve read_arc_through(const SceneTable& element, const Point& start) {
  const SceneFile& file = element.file();
  const Point through = read_end(element, "arc_through"), end = read_end(element, "to");
  const double nearest = std::min(distance(through, start), distance(through, end));
  if (nearest < SHORTEST_ELEMENT * (1 - ROUNDED_AWAY) || distance(start, end) < SHORTEST_ELEMENT * (1 - ROUNDED_AWAY)) {
    file.refuse(element.place(), fmt::format("two of the points {}, {} and {} are the same", show(start), show(through), show(end)),
                fmt::format("allowed: a start, a point on the way and an end at least {} mm from each other", SHORTEST_ELEMENT));
  }
  const auto arc = make_arc_through(start, through, end);
  if (!arc) {
    file.refuse(element.place("arc_through"), fmt::format("{}, {} and {} lie on one line", show(start), show(through), show(end)),
                "allowed: a point beside the line from start to end, or {line = [r, y]}");
  }
  const double furthest = std::max(std::abs(arc->center[0]), std::abs(arc->center[1]));
  if (furthest > ranges::CENTER.high) {
    file.refuse(
        element.place("arc_through"), fmt::format("the circle through these points has its center at {}", show(arc->center)),
        fmt::format("allowed: -{0} to {0} mm; take a point further from the line between start and end", ranges::CENTER.high));
  }
  return *arc;
}

RawElement read_element(const SceneFile& file, const toml::node& node, const std::string& key, const Point& start) {
  const toml::table* table = node.as_table();
  const std::string allowed = std::string("allowed: ") + FORMS, what = "an element of " + key;
  if (!table) file.refuse(place_of(node), what + " " + found(node), allowed);
  const SceneTable element(file, *table, what, {"line", "arc", "center", "arc_through", "to", "fillet_mm"});
  const bool is_line = element.has("line"), is_arc = element.has("arc"), has_center = element.has("center");
  const bool is_through = element.has("arc_through"), has_to = element.has("to");
  const char* fault = is_line && is_arc                    ? "both 'line' and 'arc'"
                      : is_through && (is_line || is_arc)  ? "'arc_through' and another form"
                      : !is_line && !is_arc && !is_through ? "none of 'line', 'arc' and 'arc_through'"
                      : is_arc && !has_center              ? "'arc' but no 'center'"
                      : is_line && has_center              ? "'line' and 'center'"
                      : is_through && has_center           ? "'arc_through' and 'center'"
                      : is_through && !has_to              ? "'arc_through' but no 'to'"
                      : !is_through && has_to              ? "'to' but no 'arc_through'"
                                                           : nullptr;
  if (fault) file.refuse(element.place(), fmt::format("{} has {}", what, fault), allowed);
  RawElement raw;
  raw.place = element.place();
  raw.by_sweep = is_through;
  raw.curve = is_line  ? make_line(start, read_end(element, "line"))
              : is_arc ? read_arc(element, start)
                       : read_arc_through(element, start);
  const Quantity plain{ranges::FILLET.low, ranges::FILLET.high};
  element.read("fillet_mm", plain, raw.fillet);
  raw.fillet_place = element.place("fillet_mm");
  return raw;
}

// Puts the fillet of element i between it and the next.
void round_corner(const SceneFile& file, std::vector<RawElement>& elements, std::size_t i) {
  RawElement &first = elements[i], &second = elements[i + 1];
  const Point corner = first.curve.b;
  const auto refuse = [&](const std::string& what, const std::string& allowed) {
    file.refuse(first.fillet_place, fmt::format("fillet_mm = {} at {}: {}", show(first.fillet), show(corner), what),
                "allowed: " + allowed);
  };
  if (corner[0] == 0) refuse("this corner is on the axis", "at corners off the axis");
  if (corner_turn(first.curve, second.curve) == 0)
    refuse("the two elements have the same direction, or opposite directions",
           "at corners between elements of different directions");
  const auto fillet = make_fillet(first.curve, second.curve, first.fillet);
  if (!fillet) {
    const double largest = largest_fillet(first.curve, second.curve, first.fillet);
    refuse("the fillet is too large for its two elements",
           largest >= ranges::FILLET.low ? "up to " + show(largest) + " there" : std::string("no fillet there"));
  }
  first.curve = fillet->first;
  second.curve = fillet->second;
  RawElement arc;
  arc.curve = fillet->arc;
  arc.place = first.fillet_place;
  arc.by_sweep = true;
  elements.insert(elements.begin() + static_cast<std::ptrdiff_t>(i) + 1, arc);
}

// Whether there were any.
bool round_corners(const SceneFile& file, std::vector<RawElement>& elements) {
  bool any = false;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (elements[i].fillet == 0) continue;
    if (i + 1 == elements.size()) {
      file.refuse(elements[i].fillet_place, "fillet_mm of the last element, whose end is not a corner",
                  "allowed: at the end of an element that another element follows");
    }
    any = true;
    round_corner(file, elements, i);
    ++i;  // past the arc
  }
  std::erase_if(elements, [](const RawElement& raw) {
    return distance(raw.curve.a, raw.curve.b) <= USED_UP && std::abs(raw.curve.sweep) < PI;
  });
  return any;
}

OutlineElement in_meters(const RawElement& raw, const Point& end) {
  const auto to_meters = [](const Point& p) { return Point{to_si(p[0], Unit::mm), to_si(p[1], Unit::mm)}; };
  return {raw.curve.is_arc, to_meters(end), to_meters(raw.curve.center), raw.place.line, raw.place.column};
}

}  // namespace

std::string show(double length) { return fmt::format("{:.9g}", std::round(length * 1e6) / 1e6 + 0.0); }

std::string show(const Point& p) { return fmt::format("[{}, {}]", show(p[0]), show(p[1])); }

void check_length(const SceneFile& file, const RawElement& raw) {
  if (distance(raw.curve.a, raw.curve.b) >= SHORTEST_ELEMENT * (1 - ROUNDED_AWAY)) return;
  file.refuse(raw.place, fmt::format("an element has no length: from {} to {}", show(raw.curve.a), show(raw.curve.b)),
              fmt::format("allowed: elements of at least {} mm", SHORTEST_ELEMENT));
}

std::vector<RawElement> read_elements(const SceneTable& vessel, const char* key, const ElementCheck& check) {
  const SceneFile& file = vessel.file();
  const toml::array* array = vessel.array(key, 2, ranges::LARGEST_OUTLINE, std::string("each ") + FORMS);
  std::vector<RawElement> elements;
  if (!array) return elements;
  Point at{0, 0};
  for (const toml::node& node : *array) {
    elements.push_back(read_element(file, node, key, at));
    check(elements.back(), elements.size() == 1, elements.size() == array->size());
    at = elements.back().curve.b;
  }
  if (!round_corners(file, elements)) return elements;
  for (std::size_t i = 0; i < elements.size(); ++i) check(elements[i], i == 0, i + 1 == elements.size());
  if (elements.size() > ranges::LARGEST_OUTLINE) {
    file.refuse(vessel.place(key), fmt::format("{} has {} elements with its fillets", key, elements.size()),
                fmt::format("allowed: 2 to {}", ranges::LARGEST_OUTLINE));
  }
  return elements;
}

std::vector<OutlineElement> in_meters(const std::vector<RawElement>& elements) {
  std::vector<OutlineElement> outline;
  for (const RawElement& raw : elements) {
    const PlaneCurve& curve = raw.curve;
    if (raw.by_sweep && std::abs(curve.sweep) > LONGEST_SWEEP) {
      const double middle = curve.from + curve.sweep / 2;
      outline.push_back(
          in_meters(raw, {curve.center[0] + curve.radius * std::cos(middle), curve.center[1] + curve.radius * std::sin(middle)}));
    }
    outline.push_back(in_meters(raw, curve.b));
  }
  return outline;
}

}  // namespace wholehand
