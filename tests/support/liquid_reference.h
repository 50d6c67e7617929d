// SPDX-License-Identifier: MIT
// Liquid in a tilted cavity a second time, in long double and another way round: slices along the direction of the tilt (planes of
// constant n, where the core takes slices of constant height), the height integrated inside them, tanh-sinh in both. And the
// volumes of revolution of lines and arcs in closed form.
#pragma once

#include <vector>

#include "core/prepare.h"

namespace wholehand::liquid_reference {

using Wide = long double;

// A piece of the inner wall on which the radius is monotone in the height. `side` 0: a line; +1: an arc on the half r >= center_r.
struct Piece {
  Wide low = 0, high = 0;                // heights, m
  Wide low_radius = 0, high_radius = 0;  // at its ends, m
  int side = 0;
  Wide center_r = 0, center_y = 0, radius = 0;
};
using Cavity = std::vector<Piece>;  // y ascending

// Volume m3, center of mass along n and y, m (0 where there is no volume).
struct Body {
  Wide volume = 0, lean = 0, height = 0;
};

Piece line_piece(Wide low, Wide low_radius, Wide high, Wide high_radius);
Piece arc_piece(Wide low, Wide high, Wide center_r, Wide center_y, Wide radius, int side);

Wide radius_at(const Piece& piece, Wide y);

// The cavities of the default scene's vessels, derived by hand: wall 1.5 mm.
Cavity beaker1_cavity();  // r = 38.5 from 1.5 to 110
Cavity beaker2_cavity();  // a sphere of 41, a fillet of 1.5 about the corner at the neck, the neck of 15.5
Cavity beaker3_cavity();  // upright, cone, fillet about the corner at the neck, neck
// What the program prepared, split where an arc passes its circle's largest radius.
Cavity cavity_of(const std::vector<PreparedElement>& elements);

// The part of the cavity under u . p = level at a tilt, u = cos y - sin n.
Body below(const Cavity& cavity, Wide level, Wide tilt);
// The whole cavity upright, in closed form.
Body revolved(const Cavity& cavity);

// Level of the mouth's lowest point.
Wide lip_level(const Cavity& cavity, Wide tilt);

}  // namespace wholehand::liquid_reference
