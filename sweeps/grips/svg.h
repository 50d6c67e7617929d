// SPDX-License-Identifier: MIT
// A grip as a line drawing for papers: front, side and top view with a scale bar.
#pragma once

#include <string>
#include <string_view>

#include "sweeps/grips/report.h"

namespace wholehand {

// By what such a drawing is known as made here.
inline constexpr std::string_view GRIP_SVG_MARK = "<title id=\"title\">Grip of ";

// The text of an SVG of at most 180 mm by 250 mm, one unit of its coordinates a millimeter of the vessel; black on white, contact points in colors
// that
// color-blind readers distinguish and in shapes that do without color. Third-angle projection: the front view from the side of the hand,
// the thumb-index line across; the top view above it; the side view beside it, from the right. Posed joints with their skin, seen through
// the glass where they are behind it. With a title and a description for screen readers.
// Where the report has holds, arrows show the contact forces of the hardest state, unless no force holds it (sweeps/grips/forces.h).
// Draws what is seen of a mesh: contours, open edges and edges of 30 degrees or more.
// Throws Error: (usage) where the grip is not feasible, (failure) where the vessel's mesh has not been read.
std::string grip_svg(const Scene& scene, std::size_t vessel, const GripReport& report);

}  // namespace wholehand
