// SPDX-License-Identifier: MIT
// Kernel 6 tilted, against closed forms and against the same volumes integrated another way round
// (tests/support/liquid_reference.h).
#include "core/liquid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/liquid_reference.h"
#include "tests/support/liquid_samples.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

namespace reference = liquid_reference;
using core_f64::LiquidState;
using core_f64::Slices;
using core_f64::Vessel;
using reference::Wide;

// ---- tilted, in closed form ----

// While the surface meets only the wall, the depth over the floor is h + n tan t with h = V / (pi r^2): the moments of a disc give
// lean = r^2 tan t / (4 h), height over the floor = h / 2 + r^2 tan^2 t / (8 h).
TEST(Liquid, TiltedCylinderIsTheClosedFormWhileTheSurfaceMeetsOnlyTheWall) {
  const Wide r = BEAKER1_RADIUS;
  for (const double fill : {0.3, 0.5, 0.7}) {
    const Wide h = Wide(fill) * BEAKER1_DEPTH, room = std::min(h, BEAKER1_DEPTH - h);
    for (const double share : {1e-6, 0.01, 0.3, 0.7, 0.99, 1.0}) {
      const double tilt = std::atan(double(room / r) * share);
      const Wide tangent = std::tan(Wide(tilt)), cosine = std::cos(Wide(tilt));
      const LiquidState state = liquid_at_rest(beaker1_ready(), fill * double(BEAKER1_CAPACITY), tilt);
      EXPECT_DOUBLE_EQ(state.volume, fill * double(BEAKER1_CAPACITY));
      EXPECT_NEAR(state.lean, double(r * r * tangent / (4 * h)), LIQUID_CENTER) << fill << " " << tilt;
      EXPECT_NEAR(state.height, double(BEAKER1_FLOOR + h / 2 + r * r * tangent * tangent / (8 * h)), LIQUID_CENTER)
          << fill << " " << tilt;
      const Slices slices = liquid_under(beaker1_ready(), double((BEAKER1_FLOOR + h) * cosine), tilt);
      EXPECT_NEAR(slices.volume, double(fill * BEAKER1_CAPACITY), LIQUID_VOLUME_SHARE * double(BEAKER1_CAPACITY))
          << fill << " " << tilt;
      EXPECT_NEAR(slices.surface, double(PI_L * r * r / cosine), 1e-10)
          << fill << " " << tilt;  // m2, of an ellipse of 5e-3 or more
    }
  }
}

TEST(Liquid, SmallTiltsLeanInProportion) {
  const Wide r = BEAKER1_RADIUS, h = BEAKER1_DEPTH / 2;
  for (const double tilt : {1e-7, 1e-6, 1e-5, 1e-4}) {
    const LiquidState state = liquid_at_rest(beaker1_ready(), double(BEAKER1_CAPACITY) / 2, tilt);
    // 1e-12 m: a free surface that falls by r t is cut into slices whose ends are known to 1e-17 m
    EXPECT_NEAR(state.lean, double(r * r * std::tan(Wide(tilt)) / (4 * h)), 1e-12) << tilt;
  }
  for (const double tilt : {1e-10, 1e-9, 1e-8}) {
    EXPECT_NEAR(liquid_at_rest(beaker1_ready(), double(BEAKER1_CAPACITY) / 2, tilt).lean, 0, 1e-10)
        << tilt;  // m: r^2 t / (4 h) is 7e-11 at most
  }
}

TEST(Liquid, HoofsFormulaIsArchimedes) {
  const Hoof half = hoof(1, 0, 1);  // through the middle of the floor: 2/3 r^3 tan t, lean 3 pi r / 16, height 3 pi r tan t / 32
  EXPECT_NEAR(double(half.volume), 2.0 / 3, 1e-15);
  EXPECT_NEAR(double(half.lean), 3 * PI / 16, 1e-15);
  EXPECT_NEAR(double(half.height), 3 * PI / 32, 1e-15);
}

TEST(Liquid, SurfaceThatCutsTheFloorLeavesAHoof) {
  for (const double tilt : {0.5, 1.0, 1.2, 1.5}) {
    for (const double share : {-0.9, -0.5, 0.0, 0.5, 0.9}) {
      const Wide x = share * BEAKER1_RADIUS, tangent = std::tan(Wide(tilt)),
                 level = BEAKER1_FLOOR * std::cos(Wide(tilt)) - x * std::sin(Wide(tilt));
      if ((BEAKER1_RADIUS - x) * tangent > BEAKER1_DEPTH) continue;  // it would cut the mouth as well
      const Hoof expected = hoof(BEAKER1_RADIUS, x, tangent);
      const Slices slices = liquid_under(beaker1_ready(), double(level), tilt);
      EXPECT_NEAR(slices.volume, double(expected.volume), LIQUID_VOLUME_SHARE * double(BEAKER1_CAPACITY)) << tilt << " " << share;
      const LiquidState state = liquid_at_rest(beaker1_ready(), double(expected.volume), tilt);
      EXPECT_NEAR(state.lean, double(expected.lean), LIQUID_CENTER) << tilt << " " << share;
      EXPECT_NEAR(state.height, double(BEAKER1_FLOOR + expected.height), LIQUID_CENTER) << tilt << " " << share;
    }
  }
}

TEST(Liquid, SurfaceThatCutsTheMouthLacksAHoof) {
  const Wide moment_of_all = BEAKER1_CAPACITY * (BEAKER1_FLOOR + BEAKER1_DEPTH / 2.0L);
  for (const double tilt : {0.5, 1.0, 1.2}) {
    for (const double share : {-0.9, -0.2, 0.4}) {
      // the air over the surface is a hoof that hangs from the mouth on the other side
      const Wide x = share * BEAKER1_RADIUS, tangent = std::tan(Wide(tilt));
      if ((BEAKER1_RADIUS - x) * tangent > BEAKER1_DEPTH) continue;
      const Hoof air = hoof(BEAKER1_RADIUS, x, tangent);
      const Slices slices = liquid_under(
          beaker1_ready(), double((BEAKER1_FLOOR + BEAKER1_DEPTH) * std::cos(Wide(tilt)) + x * std::sin(Wide(tilt))), tilt);
      const Wide volume = BEAKER1_CAPACITY - air.volume;
      EXPECT_NEAR(slices.volume, double(volume), LIQUID_VOLUME_SHARE * double(BEAKER1_CAPACITY)) << tilt << " " << share;
      EXPECT_NEAR(slices.lean, double(air.volume * air.lean), 1e-10 * double(BEAKER1_CAPACITY) * BEAKER1_RADIUS)
          << tilt << " " << share;
      EXPECT_NEAR(slices.height, double(moment_of_all - air.volume * (BEAKER1_FLOOR + BEAKER1_DEPTH - air.height)),
                  1e-10 * double(BEAKER1_CAPACITY) * BEAKER1_DEPTH)
          << tilt << " " << share;
    }
  }
}

TEST(Liquid, LiquidInASphereIsTheSameAtEveryTilt) {
  // a cap of depth h that stays clear of the neck and under the lip up to the tilt beside it
  for (const auto& [h, last] : {std::pair<Wide, int>{5e-3L, 100}, {10e-3L, 95}, {20e-3L, 90}}) {
    const Wide R = 41e-3L, volume = PI_L * h * h * (3 * R - h) / 3;
    const Wide under = R - h * (8 * R - 3 * h) / (4 * (3 * R - h));  // of its center under the sphere's
    for (int whole = 0; whole <= last; whole += 5) {
      const double tilt = radians(whole);
      const LiquidState state = liquid_at_rest(cavity_samples()[1].vessel, double(volume), tilt);
      EXPECT_NEAR(state.lean, double(under * std::sin(Wide(tilt))), LIQUID_CENTER) << whole;
      EXPECT_NEAR(state.height, double(42.5e-3L - under * std::cos(Wide(tilt))), LIQUID_CENTER) << whole;
    }
  }
}

TEST(Liquid, AtNinetyDegreesACylinderHoldsSegmentsAlongItsWholeLength) {
  for (const double share : {-0.7, 0.0, 0.6}) {
    const Wide x = share * BEAKER1_RADIUS;
    const Slices slices = liquid_under(beaker1_ready(), double(-x), PI / 2);  // n >= x
    const Wide area =
        BEAKER1_RADIUS * BEAKER1_RADIUS * std::acos(Wide(share)) - x * std::sqrt(Wide(BEAKER1_RADIUS) * BEAKER1_RADIUS - x * x);
    EXPECT_NEAR(slices.volume, double(area * BEAKER1_DEPTH), LIQUID_LEVEL_SHARE * double(BEAKER1_CAPACITY)) << share;
    EXPECT_NEAR(slices.height, double(area * BEAKER1_DEPTH * (BEAKER1_FLOOR + BEAKER1_DEPTH / 2.0L)),
                LIQUID_LEVEL_SHARE * double(BEAKER1_CAPACITY) * BEAKER1_DEPTH)
        << share;
    EXPECT_NEAR(slices.surface, double(2 * std::sqrt(Wide(BEAKER1_RADIUS) * BEAKER1_RADIUS - x * x) * BEAKER1_DEPTH), 1e-12)
        << share;  // m2, of 8e-3
  }
}

TEST(Liquid, UpsideDownTheVolumeUnderALevelLiesAtTheMouth) {
  for (const CavitySample& s : cavity_samples()) {
    const double level = -0.6 * s.data.height;  // everything above y = 0.6 of the height
    reference::Cavity upper;
    for (reference::Piece piece : s.cavity) {
      if (piece.high <= -level) continue;
      if (piece.low < -level) {
        piece.low_radius = reference::radius_at(piece, -level);
        piece.low = -level;
      }
      upper.push_back(piece);
    }
    const reference::Body body = reference::revolved(upper);
    const Slices slices = liquid_under(s.vessel, level, PI);
    EXPECT_NEAR(slices.volume, double(body.volume), LIQUID_LEVEL_SHARE * s.vessel.capacity) << s.name;
    EXPECT_NEAR(slices.height, double(body.volume * body.height), LIQUID_LEVEL_SHARE * s.vessel.capacity * s.data.height) << s.name;
  }
}

// ---- tilted, against the other integration ----

TEST(Liquid, TheReferenceItselfMeetsTheClosedForms) {
  const Wide tilt = 0.6L, tangent = std::tan(tilt), h = BEAKER1_DEPTH / 2.0L;
  const reference::Body body = reference::below(reference::beaker1_cavity(), (BEAKER1_FLOOR + h) * std::cos(tilt), tilt);
  EXPECT_NEAR(double(body.volume / BEAKER1_CAPACITY), 0.5, 1e-14);
  EXPECT_NEAR(double(body.lean), double(Wide(BEAKER1_RADIUS) * BEAKER1_RADIUS * tangent / (4 * h)), 1e-15);
  for (const CavitySample& s : cavity_samples()) {
    const reference::Body whole = reference::revolved(s.cavity);
    for (const Wide t : {0.0L, 0.9L, 2.0L}) {  // everything is under a level of 1 m
      const reference::Body all = reference::below(s.cavity, 1, t);
      EXPECT_NEAR(double(all.volume / whole.volume), 1, 1e-13) << s.name;
      EXPECT_NEAR(double(all.height), double(whole.height), 1e-14) << s.name;
    }
  }
}

TEST(Liquid, VolumeIsConservedOverAllTiltsUntilTheLip) {
  int states = 0;
  for (const CavitySample& s : cavity_samples()) {
    for (const double fill : {0.02, 0.25, 0.5, 0.75, 0.98}) {
      const double volume = fill * s.vessel.capacity;
      for (double degree = 1; degree < 180; degree += 7.3) {
        const double tilt = radians(degree);
        if (lip_capacity(s.vessel, tilt) < volume) break;
        const reference::Body body = reference::below(s.cavity, level_of_volume(s.vessel, volume, tilt), tilt);
        const LiquidState state = liquid_at_rest(s.vessel, volume, tilt);
        EXPECT_NEAR(double(body.volume), volume, LIQUID_VOLUME_SHARE * s.vessel.capacity) << s.name << " " << fill << " " << degree;
        EXPECT_NEAR(double(body.lean), state.lean, LIQUID_CENTER) << s.name << " " << fill << " " << degree;
        EXPECT_NEAR(double(body.height), state.height, LIQUID_CENTER) << s.name << " " << fill << " " << degree;
        ++states;
      }
    }
  }
  EXPECT_GT(states, 150);
}

// A tilt at which the lip holds something, and a level between the bottom and the lip.
std::pair<double, double> random_state(const Vessel& vessel, Random& random) {
  for (;;) {
    const double tilt = random.uniform(0.001, PI - 0.001), sine = std::sin(tilt), cosine = std::cos(tilt);
    const double bottom = core_f64::bottom_level(vessel, sine, cosine), lip = core_f64::lip_level(vessel, sine, cosine);
    if (lip > bottom) return {tilt, bottom + (lip - bottom) * random.uniform(0, 1)};
  }
}

TEST(Liquid, VolumeUnderAnyLevelUpToTheLipIsThatOfTheOtherIntegration) {
  Random random(61);
  for (const CavitySample& s : cavity_samples()) {
    for (int i = 0; i < 60; ++i) {
      const auto [tilt, level] = random_state(s.vessel, random);
      const reference::Body body = reference::below(s.cavity, level, tilt);
      EXPECT_NEAR(liquid_under(s.vessel, level, tilt).volume, double(body.volume), LIQUID_VOLUME_SHARE * s.vessel.capacity)
          << s.name << " level " << level << " tilt " << tilt;
    }
  }
}

// The level's tolerance, 1e-12 of the capacity, and rounding.
void expect_level(const VesselData& data, const Vessel& vessel, double volume, double tilt) {
  const LiquidState state = liquid_at_rest(vessel, volume, tilt);
  EXPECT_NEAR(liquid_under(vessel, state.level, tilt).volume, volume, 1e-11 * vessel.capacity)
      << data.name << ", tilt " << degrees(tilt) << ", " << volume / vessel.capacity << " of the capacity";
}

TEST(Liquid, LevelHoldsItsVolumeAtEveryFillAndTilt) {
  for (const VesselData& data : {beaker1(), beaker2(), beaker3(), liquid_bottle(), vase()}) {
    const Vessel vessel = ready_vessel(data, true);
    for (const double tilt : {0.0, radians(7), radians(49), radians(70)}) {
      const double lip = lip_capacity(vessel, tilt);
      for (int k = 1; k < 20 && lip > 0; ++k) expect_level(data, vessel, k / 20.0 * lip, tilt);
    }
  }
}

// A wide body under a narrow neck. From about 65.17 % on, for less than a thousandth of the capacity, Newton's steps alone go to
// and fro between the two until all are spent: each stays in a bracket that hardly shrinks.
TEST(Liquid, LevelBetweenAWideBodyAndANarrowNeckIsFound) {
  const VesselData thick = vessel_of("thick",
                                     {line_to(24.6689337, 0), line_to(24.6689337, 8.07939779), line_to(9.1716877, 16.206503),
                                      line_to(9.1716877, 34.9939849), line_to(0, 34.9939849)},
                                     6.11534834);
  const Vessel vessel = ready_vessel(thick, true);
  for (int k = 0; k <= 40; ++k) expect_level(thick, vessel, (0.651 + 5e-5 * k) * vessel.capacity, radians(36.2097766));
}

TEST(Liquid, TwelvePiecesWithArcsAndCornersAreIntegratedAsWell) {
  const Vessel vessel = ready_vessel(vase(), true);
  const reference::Cavity cavity = reference::cavity_of(prepare_vessel(vase(), true).cavity);
  EXPECT_NEAR(vessel.capacity, double(reference::revolved(cavity).volume), LIQUID_VOLUME_SHARE * vessel.capacity);
  Random random(62);
  for (int i = 0; i < 40; ++i) {
    const auto [tilt, level] = random_state(vessel, random);
    EXPECT_NEAR(liquid_under(vessel, level, tilt).volume, double(reference::below(cavity, level, tilt).volume),
                LIQUID_VOLUME_SHARE * vessel.capacity)
        << "level " << level << " tilt " << tilt;
  }
}

TEST(Liquid, MorePointsApproachTheReference) {
  for (const CavitySample& s : cavity_samples()) {
    Random random(64);
    std::array<double, 5> worst{};
    const std::array<int, 5> points{4, 8, 16, 32, 64};
    for (int i = 0; i < 60; ++i) {
      const auto [tilt, level] = random_state(s.vessel, random);
      const double volume = double(reference::below(s.cavity, level, tilt).volume);
      for (std::size_t k = 0; k < points.size(); ++k) {
        worst[k] = std::max(worst[k], std::abs(liquid_under(s.vessel, level, tilt, points[k]).volume - volume) / s.vessel.capacity);
      }
    }
    for (std::size_t k = 1; k < points.size(); ++k) {
      EXPECT_LT(worst[k], std::max(worst[k - 1], 1e-14)) << s.name << " " << points[k];  // 1e-14: rounding stays
    }
    EXPECT_LT(worst[4], LIQUID_LEVEL_SHARE) << s.name;
  }
}

TEST(Liquid, FreeSurfaceIsTheDerivativeOfTheVolumeByTheLevel) {
  Random random(63);
  int compared = 0;
  for (const CavitySample& s : cavity_samples()) {
    for (int i = 0; i < 60; ++i) {
      const double tilt = i == 0 ? 0 : i == 1 ? PI / 2 : random.uniform(0, PI), step = 1e-6;
      const double level = random.uniform(-0.04, 0.1);
      // a kink of the area within the step (a corner of the wall, the edge of mouth or floor) has no derivative: leave such levels
      // out
      const double before = liquid_under(s.vessel, level - step, tilt).surface,
                   after = liquid_under(s.vessel, level + step, tilt).surface;
      if (std::abs(after - before) > 1e-6) continue;
      compared += after > 0;
      const double slope =
          (liquid_under(s.vessel, level + step, tilt).volume - liquid_under(s.vessel, level - step, tilt).volume) / (2 * step);
      // 1e-7 m2 of 5e-3: what a kink of at most 1e-6 m2 within the step leaves, and volumes rounded to 1e-19 m3 over 2e-6 m
      EXPECT_NEAR(liquid_under(s.vessel, level, tilt).surface, slope, 1e-7) << s.name << " level " << level << " tilt " << tilt;
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(Liquid, NothingLiesUnderTheBottomLevel) {
  for (const CavitySample& s : cavity_samples()) {
    for (double degree = 0; degree <= 180; degree += 7.5) {
      const double tilt = radians(degree), sine = std::sin(tilt), cosine = std::cos(tilt);
      double lowest = s.vessel.floor_height * cosine;  // the floor's middle
      for (const reference::Piece& piece : s.cavity) {
        for (int k = 0; k <= 1000; ++k) {
          const Wide y = piece.low + (piece.high - piece.low) * k / 1000;
          lowest = std::min(lowest, double(cosine * y - sine * reference::radius_at(piece, y)));
        }
      }
      const double bottom = core_f64::bottom_level(s.vessel, sine, cosine);
      EXPECT_LE(bottom, lowest + 1e-15) << s.name << " " << degree;
      EXPECT_NEAR(liquid_under(s.vessel, bottom, tilt).volume, 0, LIQUID_LEVEL_SHARE * s.vessel.capacity)
          << s.name << " " << degree;
    }
  }
}

TEST(Liquid, ATraceOfLiquidLiesInTheLowestCorner) {
  const double volume = 1e-12 * double(BEAKER1_CAPACITY);
  for (const double degree : {0.0, 1.0, 45.0, 89.0}) {
    const LiquidState state = liquid_at_rest(beaker1_ready(), volume, radians(degree));
    EXPECT_EQ(state.volume, volume);
    EXPECT_NEAR(state.lean, degree == 0 ? 0 : BEAKER1_RADIUS, 1e-4)
        << degree;  // m: 5e-16 m3 on one degree reach 0.1 mm from the corner
    EXPECT_NEAR(state.height, BEAKER1_FLOOR, 1e-4) << degree;
  }
}

}  // namespace
}  // namespace wholehand
