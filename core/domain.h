// SPDX-License-Identifier: MIT
// The domain in which float agrees with double to 10 micrometers and 10 millinewtons, and warnings for scenes outside it.
#pragma once

#include <string>
#include <vector>

#include "core/backend.h"
#include "core/scene.h"

namespace wholehand {

// Measured (docs/evidence.md, "Where float is enough"; tests/core/domain_test.cpp repeats it at the limits): core in float against core in double,
// 3,000 random grips each of a cylinder, a flask and a conical flask, sizes 1 mm to 10 m, tilts 0 to 180 degrees. Among grips that do not graze and
// have the same discrete outcomes, separations differ by at most FLOAT_LENGTH in 999 of 1,000, joints in 99 of 100, forces by at most FLOAT_FORCE in
// 999 of 1,000. Outcomes differ in about 1 of 1,000 at most.
namespace float_domain {

constexpr double FLOAT_LENGTH = 10e-6;  // m
constexpr double FLOAT_FORCE = 10e-3;   // N

// Scale of the hand, the scene's times the grip's. Outcomes differ in 0.8 of 1,000 grips at 0.1, in 1.5 at 0.07, and in 4 at 0.02, where the stop
// tolerance is no longer small beside the hand. One joint in 100 is 7.0 um off at 100, and 10.9 um at 120, where the hand reaches further than 16 m.
constexpr double SMALLEST_HAND = 0.1;
constexpr double LARGEST_HAND = 100;

// m. Beyond 16 m adjacent floats are further apart than twice their stop tolerance, so distances step over it. Outcomes differ in 5 of 1,000 grips on
// an arc of 15 m, in 190 on one of 17 m.
constexpr double LARGEST_COORDINATE = 10;

// N, for the forces that hold a vessel, (m g lever / (2 gamma) + m g / 2) / mu. They differ by up to 1.8e-6 of that (20 mN at 11 kN).
constexpr double LARGEST_HOLD = 5e3;

// Strength of the strongest digit over that of the weakest. Efforts are solved in units of the strongest, so the weakest approaches rounding: in 400
// random scenes, efforts differ by more than their tolerance only at ratios of 35 and more.
constexpr double LARGEST_STRENGTH_RATIO = 30;

// Strength of the strongest digit over the weight of the lightest glass. If a hand squeezes this much more than it lifts, its limit depends on
// float's last digits: `push` may be 0 and `friction_needed` a percent too large. In 500 random scenes, they differ by more than their tolerance only
// at ratios of 5,800 and more, or beyond another limit.
constexpr double LARGEST_STRENGTH_OF_WEIGHT = 3e3;

// m, of torsion that is not 0. Moments about a line of contacts act on arms of this length, and contact positions differ by 1e-6 m. In the same
// scenes, efforts differ only at 0.24 mm and less.
constexpr double SMALLEST_TORSION = 1e-3;

}  // namespace float_domain

// A sentence for each limit of the domain that the scene exceeds, with the limit; the remedy is Remedy::double_precision. Empty in double, and within
// the domain. Throws Error (usage) for vessels that cannot be prepared.
std::vector<std::string> domain_warnings(const Scene& scene, Precision precision);

}  // namespace wholehand
