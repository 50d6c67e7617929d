// SPDX-License-Identifier: MIT
// What the drawings and tables of a grip show: labels of its points, and which of its states.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "base/charts/colors.h"
#include "sweeps/grips/report.h"

namespace wholehand {

enum class PointState { touching, projected, free };

// A state's name and its color.
struct PointStyle {
  const char* name;
  Rgb color;
};
extern const std::array<PointStyle, 3> POINT_STYLES;  // by PointState

// A point is projected where its finger brought it to the glass, touching where it was there, free where it is not.
PointState point_state(const GripResult& result, int joint);

// Throws Error (usage) where the grip is not feasible: there is no hand to draw. `option` is what asked for the drawing.
void check_drawable(const GripReport& report, const std::string& option);

// The first of the report's states that has liquid; null where none has.
const GripState* drawn_liquid(const GripReport& report);

// A fill of the report in mL where fills are asked for as volumes, else as a share of the capacity: "250", "0.605".
std::string fill_number(const GripReport& report, double fill);
// The same in words: "250 mL", "fill 0.605", "empty".
std::string fill_words(const GripReport& report, double fill);

// A fill of a vessel as the scene gives it, for a page: "250 mL" of fills_ml, else "60.5 %" of what the vessel holds; "empty" without liquid. Number
// and
// unit stay in one line.
std::string fill_text(const Scene& scene, std::size_t vessel, double fill);
// As a share, whatever the scene gives.
std::string share_text(const Scene& scene, double fill);

// The place in `holds` of the state that takes most effort: the report's worst one where that is listed and takes as much, to the
// tolerance of efforts; else the first of those that take as much, or that no force holds, if there are any. A state whose effort is NaN
// is passed over. Nothing where no other is.
std::optional<std::size_t> hardest_state(const GripReport& report);

}  // namespace wholehand
