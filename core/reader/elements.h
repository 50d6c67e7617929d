// SPDX-License-Identifier: MIT
// Elements of an outline as the file gives them, in mm: {line = [r, y]}, {arc = [r, y], center = [r, y]}, {arc_through = [r, y], to = [r, y]},
// each from the end of the one before, and fillets at their ends.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/reader/geometry.h"
#include "core/reader/parts.h"

namespace wholehand {

struct RawElement {
  PlaneCurve curve;
  Place place;
  bool by_sweep = false;  // the sweep alone tells which way an arc goes
  double fillet = 0;      // radius at its end; 0: none
  Place fillet_place;
};

// In mm, rounded to nanometers to hide rounding.
std::string show(double length);
std::string show(const Point& p);

// Throws Error (usage) for an element that is shorter than SHORTEST_ELEMENT.
void check_length(const SceneFile& file, const RawElement& raw);

// The elements under a key from [0, 0] on, with their fillets: 2 to 1000. `check` runs for each element as it is read, and for all again once there
// are fillets. Empty if the key is absent.
using ElementCheck = std::function<void(const RawElement& raw, bool is_first, bool is_last)>;
std::vector<RawElement> read_elements(const SceneTable& vessel, const char* key, const ElementCheck& check);

// In SI; an arc that takes the longer way round its center becomes two.
std::vector<OutlineElement> in_meters(const std::vector<RawElement>& elements);

}  // namespace wholehand
