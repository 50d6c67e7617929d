// SPDX-License-Identifier: MIT
// outline = [{line = [r, y]}, {arc = [r, y], center = [r, y]}, ..]: half an outline in mm, from the axis at the base to the axis at the
// mouth. The body lies to the left of its way: base, outwards, up, mouth. A curve from [0, 0] that stays off the axis, meets itself
// nowhere and ends on the axis at its highest point runs that way round of itself, so its direction needs no check of its own.
#include <fmt/format.h>

#include <algorithm>

#include "core/reader/elements.h"

namespace wholehand {
namespace {

// mm: around an end that two elements share, they are near each other by right. Rounding makes tangents seem to cross there again.
constexpr double SHARED_END = 5e-4;

// What an element must hold by itself; `is_last`: it is the mouth.
void check_element(const SceneFile& file, const RawElement& raw, bool is_last) {
  const PlaneCurve& curve = raw.curve;
  check_length(file, raw);
  if (is_last) {
    if (curve.b[0] != 0) {
      file.refuse(raw.place, fmt::format("the outline is open: it ends at {}, off the axis", show(curve.b)),
                  "allowed: a last element {line = [0, y]}: the mouth, a level line to the axis");
    }
    if (curve.is_arc || curve.a[1] != curve.b[1]) {
      file.refuse(raw.place, fmt::format("the last element, from {} to {}, is not a level line", show(curve.a), show(curve.b)),
                  "allowed: a last element {line = [0, y]}: the mouth, a level line to the axis");
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

void check_whole(const SceneFile& file, const std::vector<RawElement>& elements) {
  const double mouth = elements.back().curve.b[1];
  for (const RawElement& raw : elements) {
    const double top = raw.curve.extent(PI / 2);
    if (top > mouth + TOUCHING) {
      file.refuse(raw.place, fmt::format("the outline rises to y = {}, above its mouth at {}", show(top), show(mouth)),
                  "allowed: no element above the mouth, which is the last element");
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
  const std::vector<RawElement> elements =
      read_elements(vessel, "outline", [&](const RawElement& raw, bool, bool is_last) { check_element(file, raw, is_last); });
  check_whole(file, elements);

  Silhouette silhouette;
  silhouette.elements = in_meters(elements);
  for (const RawElement& raw : elements)
    silhouette.largest_radius = std::max(silhouette.largest_radius, to_si(raw.curve.extent(0), Unit::mm));
  silhouette.height = to_si(elements.back().curve.b[1], Unit::mm);
  return silhouette;
}

}  // namespace wholehand
