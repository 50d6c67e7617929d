// SPDX-License-Identifier: MIT
// Vessels with their cavities made ready and derived by hand, the functions of kernel 6 with the usual quadrature, and how exact
// they are.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/liquid.h"
#include "core/prepare.h"
#include "tests/support/liquid_reference.h"
#include "tests/support/scenes.h"

namespace wholehand {

constexpr liquid_reference::Wide PI_L = 3.14159265358979323846264338327950288L;

// The inside of beaker1: 77 mm wide, floor at 1.5, mouth at 110 mm.
constexpr double BEAKER1_RADIUS = 38.5e-3, BEAKER1_FLOOR = 1.5e-3, BEAKER1_DEPTH = 108.5e-3;
constexpr liquid_reference::Wide BEAKER1_CAPACITY = PI_L * BEAKER1_RADIUS * BEAKER1_RADIUS * BEAKER1_DEPTH;

// 1e-10 of the capacity is what is promised of volumes; 1e-9 m of the liquid's center follows for fills that are not tiny: a center
// is a moment over a volume, good to 1e-10 of the vessel's 0.1 m over the fill's 0.05.
constexpr double LIQUID_VOLUME_SHARE = 1e-10;
constexpr double LIQUID_CENTER = 1e-9;
// Upright there is no slanted surface, and the closed forms hold to rounding: 1e-12 of the capacity is where levels are stopped.
constexpr double LIQUID_LEVEL_SHARE = 1e-12;

inline core_f64::Quadrature liquid_quadrature(int points = QUADRATURE_POINTS) {
  return core_f64::load_quadrature(prepare_quadrature(points));
}

// A bottle with a rounded foot, a shoulder that levels out and a waist: every piece smooth against the next. Its cavity by hand.
inline VesselData liquid_bottle() {
  return vessel_of("bottle",
                   {line_to(20, 0), arc_to(40, 20, 20, 20), line_to(40, 50), arc_to(30, 60, 30, 50), arc_to(20, 70, 30, 70),
                    line_to(20, 100), line_to(0, 100)},
                   2);
}

inline liquid_reference::Cavity liquid_bottle_cavity() {
  return {liquid_reference::arc_piece(2e-3L, 20e-3L, 20e-3L, 20e-3L, 18e-3L, 1),
          liquid_reference::line_piece(20e-3L, 38e-3L, 50e-3L, 38e-3L),
          liquid_reference::arc_piece(50e-3L, 58e-3L, 30e-3L, 50e-3L, 8e-3L, 1),
          liquid_reference::arc_piece(58e-3L, 70e-3L, 30e-3L, 70e-3L, 12e-3L, -1),
          liquid_reference::line_piece(70e-3L, 18e-3L, 100e-3L, 18e-3L)};
}

struct CavitySample {
  std::string name;
  VesselData data;
  liquid_reference::Cavity cavity;
  core_f64::Vessel vessel;
};

inline const std::vector<CavitySample>& cavity_samples() {
  static const std::vector<CavitySample> all{
      {"beaker1", beaker1(), liquid_reference::beaker1_cavity(), ready_vessel(beaker1(), true)},
      {"beaker2", beaker2(), liquid_reference::beaker2_cavity(), ready_vessel(beaker2(), true)},
      {"beaker3", beaker3(), liquid_reference::beaker3_cavity(), ready_vessel(beaker3(), true)},
      {"bottle", liquid_bottle(), liquid_bottle_cavity(), ready_vessel(liquid_bottle(), true)}};
  return all;
}

inline const core_f64::Vessel& beaker1_ready() { return cavity_samples()[0].vessel; }

inline core_f64::Slices liquid_under(const core_f64::Vessel& vessel, double level, double tilt, int points = QUADRATURE_POINTS) {
  return core_f64::liquid_below(vessel, liquid_quadrature(points), level, std::sin(tilt), std::cos(tilt));
}

inline double lip_capacity(const core_f64::Vessel& vessel, double tilt) {
  return core_f64::lip_capacity(vessel, liquid_quadrature(), std::sin(tilt), std::cos(tilt));
}

inline core_f64::LiquidState liquid_at_rest(const core_f64::Vessel& vessel, double volume, double tilt) {
  return core_f64::liquid_at(vessel, liquid_quadrature(), volume, std::sin(tilt), std::cos(tilt));
}

// The level of a volume by bisection on the core's own volumes, to the last bit.
inline double level_of_volume(const core_f64::Vessel& vessel, double volume, double tilt) {
  double low = -1, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (liquid_under(vessel, middle, tilt).volume < volume ? low : high) = middle;
  }
  return high;
}

inline Scene liquid_scene() {
  Scene scene = three_beakers();
  scene.vessels.push_back(liquid_bottle());
  return scene;
}

inline liquid_reference::Wide cavity_radius(const liquid_reference::Cavity& cavity, liquid_reference::Wide y) {
  for (const liquid_reference::Piece& piece : cavity) {
    if (y <= piece.high) return liquid_reference::radius_at(piece, y);
  }
  return 0;
}

// A surface that cuts the floor at n = x leaves the hoof over [x, r]: depth (n - x) tan t.
struct Hoof {
  liquid_reference::Wide volume, lean, height;  // height over the floor
};

inline Hoof hoof(liquid_reference::Wide r, liquid_reference::Wide x, liquid_reference::Wide tangent) {
  const liquid_reference::Wide root = std::sqrt((r - x) * (r + x)), angle = std::acos(x / r);
  const liquid_reference::Wide m0 = r * r * angle - x * root, m1 = 2 * root * root * root / 3;  // moments of the segment n >= x
  const liquid_reference::Wide m2 = r * r * r * r * angle / 4 + x * root * (r * r - 2 * x * x) / 4;  // of n^2
  const liquid_reference::Wide volume = tangent * (m1 - x * m0);
  return {volume, tangent * (m2 - x * m1) / volume, tangent * tangent * (m2 - 2 * x * m1 + x * x * m0) / (2 * volume)};
}

}  // namespace wholehand
