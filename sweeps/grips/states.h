// SPDX-License-Identifier: MIT
// Labels and states for the drawings and tables of a grip.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "base/charts/colors.h"
#include "sweeps/grips/report.h"

namespace wholehand::sweeps {

enum class PointState { touching, projected, free };

// A state's name and its color.
struct PointStyle {
  const char* name;
  Rgb color;
};
extern const std::array<PointStyle, 3> POINT_STYLES;  // by PointState

// A point is projected if its finger brought it to the glass, touching if it was there already, free if it is not there.
PointState point_state(const GripResult& result, int joint);

// Throws Error (usage) if the grip is not feasible: there is no hand to draw. `option` asked for the drawing.
void check_drawable(const GripReport& report, const std::string& option);

// The first of the report's states that has liquid; null if none has.
const GripState* drawn_liquid(const GripReport& report);

// A fill of the report, in mL if fills are requested as volumes, else as a share of the capacity: "250", "0.605".
std::string fill_number(const GripReport& report, double fill);
// The same in words: "250 mL", "fill 0.605", "empty".
std::string fill_words(const GripReport& report, double fill);

// A fill of a vessel as the scene gives it, for a page: "250 mL" for fills_ml, else "60.5 %" of the vessel's capacity; "empty" without liquid. Number
// and unit stay in one line.
std::string fill_text(const Scene& scene, std::size_t vessel, double fill);
// As a share, whichever the scene uses.
std::string share_text(const Scene& scene, double fill);

// The index in `holds` of the state with the largest effort. This is the report's worst state if it is listed and equally hard, to the tolerance of
// efforts; else the first of the hardest states, or of those that no force holds, if there are any. States with NaN efforts are skipped. Nothing if
// no other state exists.
std::optional<std::size_t> hardest_state(const GripReport& report);

}  // namespace wholehand::sweeps
