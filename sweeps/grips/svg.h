// SPDX-License-Identifier: MIT
// A grip as a line drawing for papers: front, side and top view with a scale bar.
#pragma once

#include <string>
#include <string_view>

#include "sweeps/grips/report.h"

namespace wholehand::sweeps {

// Identifies drawings made by this program.
inline constexpr std::string_view GRIP_SVG_MARK = "<title id=\"title\">Grip of ";

// The text of an SVG of at most 180 mm by 250 mm, with one coordinate unit per millimeter of the vessel. It is black on white; contact points have
// colors that color-blind readers distinguish, and shapes that work without color. Third-angle projection: the front view from the side of the hand,
// with the thumb-index line across; the top view above it; the side view beside it, from the right. Posed joints have their skin, and show through
// the glass if they are behind it. A title and a description serve screen readers. If the report has holds, arrows show the contact forces of the
// hardest state, unless no force holds it (sweeps/grips/forces.h). For a mesh, draws its visible contours, open edges and edges of 30 degrees or
// more. Throws Error: (usage) the grip is not feasible; (failure) the vessel's mesh has not been read.
std::string grip_svg(const Scene& scene, std::size_t vessel, const GripReport& report);

}  // namespace wholehand::sweeps
