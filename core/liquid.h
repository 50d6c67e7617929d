// SPDX-License-Identifier: MIT
// Kernel 6: the liquid left in a tilted vessel, and its center. Slices at the height y hold circular segments, whose areas and moments are closed
// forms; they are integrated over y piece by piece of the cavity.
#pragma once

#include <array>

#include "core/prepared.h"
#include "core/sdf.h"

namespace CORE_NS {

constexpr int WHOLE_DEGREES = 181;  // tilts 0..180 at which the lip's capacity is tabulated
constexpr Real LEVEL_TOLERANCE = Real(SINGLE ? wholehand::LEVEL_TOLERANCE_F32 : wholehand::LEVEL_TOLERANCE_F64);
constexpr Real UPRIGHT_SINE =
    SINGLE ? Real(1e-5) : Real(1e-9);  // sine of the tilt under which the free surface is level in the vessel frame

// Gauss-Legendre in the angle of a cosine map: y = middle - half cos(theta), theta in [0, pi]. `weight` holds the rule's weight times
// sin(theta) pi / 2. Filled by core/prepare.h.
constexpr int MAX_QUADRATURE = 64;
struct Quadrature {
  int count = 0;
  std::array<Real, MAX_QUADRATURE> cosine{}, weight{};
};

// Integrals over the part of a cavity under a plane, in the (n, y) plane of the tilt: volume m3, its moments along n and y (m4), and
// the area of the free surface (m2), which is the derivative of the volume by the level.
struct Slices {
  Real volume = 0, lean = 0, height = 0, surface = 0;
};

// Liquid at rest: m3 and its center of mass along n and y, m. Its surface, if any, is the plane u . p = level (u: up, in the vessel frame),
// m.
struct LiquidState {
  Real volume = 0, lean = 0, height = 0;
  Real level = 0;
};

// Area (m2) and first moment (m3) of the part x >= h of a disc of radius r at the origin.
Real segment_area(Real r, Real h);
Real segment_moment(Real r, Real h);
// Elements here are pieces of a cavity, which rise: a.y < b.y, except slivers that round to no height and hold nothing. Radius of a piece at a height
// within its ends, m.
Real element_radius(const Element& element, Real y);
// Heights at which the plane cos y - sin sigma r = level meets the element, sigma = +-1; the element's start if there is none.
Vec2 plane_crossings(const Element& element, Real level, Real sine_tilt, Real cosine_tilt, Real sigma);
// Integrals over the slices low..high of one piece of the cavity; the plane does not meet the wall between them.
Slices integrate_slices(const Quadrature& quadrature, const Element& element, Real low, Real high, Real level, Real sine_tilt,
                        Real cosine_tilt);
// Integrals over one piece, and over the whole cavity, under the plane u . p = level.
Slices piece_below(const Quadrature& quadrature, const Element& element, Real level, Real sine_tilt, Real cosine_tilt);
Slices liquid_below(const Vessel& vessel, const Quadrature& quadrature, Real level, Real sine_tilt, Real cosine_tilt);
// Level of the mouth's lowest point, and the volume under it: the most that the lip holds back.
Real lip_level(const Vessel& vessel, Real sine_tilt, Real cosine_tilt);
Real lip_capacity(const Vessel& vessel, const Quadrature& quadrature, Real sine_tilt, Real cosine_tilt);
// A level under which nothing lies: the cavity's lowest, or lower if an arc counts with its whole circle.
Real bottom_level(const Vessel& vessel, Real sine_tilt, Real cosine_tilt);
// Liquid of a volume (m3, at most the lip's capacity) at rest; for volume 0 the center is at the inner floor. The volume under the level is accurate
// to LEVEL_TOLERANCE of the capacity. For a vessel that was loaded without liquid, whose capacity is 0, it is accurate to rounding.
LiquidState liquid_at(const Vessel& vessel, const Quadrature& quadrature, Real volume, Real sine_tilt, Real cosine_tilt);

}  // namespace CORE_NS
