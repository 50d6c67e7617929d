// SPDX-License-Identifier: MIT
// Statistics of grips against their own counts; distances from guidance points against geometry.
// sanitizers: address
#include "evidence/report/guidance_statistics.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "core/evaluator.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

// Some roundings of numbers near 1.
constexpr double ROUNDING = 1e-12;
// m: stop tolerance of the closure and of the search for the surface, and what slopes of up to 10 make of them.
constexpr double PLACE_TOLERANCE = 1e-7;

std::vector<GuidedGrip> random_grips(int count, double farthest) {
  Random random(11);
  std::vector<GuidedGrip> grips;
  for (int i = 0; i < count; ++i) {
    GuidedGrip grip;
    grip.distance = random.uniform(0, farthest);
    for (int j = 1; j < JOINT_COUNT; ++j) grip.touch_mask |= random.uniform(0, farthest) < grip.distance * j / 30 ? 1u << j : 0;
    grip.fingers = static_cast<int>(random.uniform(0, 6));
    grips.push_back(grip);
  }
  return grips;
}

TEST(GuidanceStatistics, CountsEveryPointByDefinition) {
  const auto grips = random_grips(1500, 0.08);
  const GuidanceStatistics statistics = guidance_statistics(grips);
  ASSERT_EQ(statistics.grips, grips.size());
  std::vector<double> distances, fingers;
  for (const GuidedGrip& grip : grips) {
    distances.push_back(grip.distance);
    fingers.push_back(grip.fingers);
  }
  EXPECT_NEAR(*statistics.fingers.r, *pearson(distances, fingers).r, ROUNDING);
  for (int j = 0; j < JOINT_COUNT; ++j) {
    std::vector<double> touches;
    double touching = 0, sum = 0, other = 0;
    for (const GuidedGrip& grip : grips) {
      touches.push_back(grip.touch_mask >> j & 1);
      touching += touches.back();
      (touches.back() > 0 ? sum : other) += grip.distance;
    }
    const PointTouch& point = statistics.points[j];
    EXPECT_EQ(static_cast<double>(point.touching), touching);
    if (j == 0) {  // never touches
      EXPECT_STREQ(lack_words(point.correlation.lack), "never");
      EXPECT_TRUE(std::isnan(point.distance_touching));
      continue;
    }
    EXPECT_NEAR(point.distance_touching, sum / touching, ROUNDING);
    EXPECT_NEAR(point.distance_free, other / (1500 - touching), ROUNDING);
    EXPECT_NEAR(*point.correlation.r, *pearson(distances, touches).r, ROUNDING) << j;
  }
}

TEST(GuidanceStatistics, EveryGripIsInOneBinOfRoundWidth) {
  for (const double farthest : {0.004, 0.045, 0.08, 0.3, 12.0}) {
    const auto grips = random_grips(400, farthest);
    const GuidanceStatistics statistics = guidance_statistics(grips);
    ASSERT_FALSE(statistics.bins.empty());
    EXPECT_LE(statistics.bins.size(), MOST_DISTANCE_BINS);
    const double width = 1e3 * (statistics.bins[0].to - statistics.bins[0].from);
    const double digit = width / std::pow(10, std::floor(std::log10(width) + 1e-9));
    EXPECT_TRUE(std::abs(digit - 1) < 1e-9 || std::abs(digit - 2) < 1e-9 || std::abs(digit - 5) < 1e-9) << width;
    std::size_t all = 0;
    for (const DistanceBin& bin : statistics.bins) {
      std::size_t there = 0, by_fingers = 0;
      for (const GuidedGrip& grip : grips) there += grip.distance >= bin.from && grip.distance < bin.to ? 1 : 0;
      for (const std::size_t count : bin.by_fingers) by_fingers += count;
      EXPECT_EQ(bin.grips, there) << bin.from;
      EXPECT_EQ(bin.grips, by_fingers);
      all += bin.grips;
    }
    EXPECT_EQ(all, grips.size());
  }
}

TEST(GuidanceStatistics, OfNoGripAndOfEqualDistances) {
  EXPECT_EQ(guidance_statistics({}).grips, 0u);
  EXPECT_TRUE(guidance_statistics({}).bins.empty());
  const GuidanceStatistics equal = guidance_statistics({{0.02, 3, 1}, {0.02, 4, 3}, {0.02, 5, 1}});
  EXPECT_STREQ(lack_words(equal.fingers.lack), "one distance");
  EXPECT_STREQ(lack_words(equal.points[0].correlation.lack), "always");
  EXPECT_STREQ(lack_words(equal.points[1].correlation.lack), "one distance");
  ASSERT_EQ(equal.bins.size(), 1u);
  EXPECT_EQ(equal.bins[0].grips, 3u);
}

// ---- places ----

// A box beside the axis: its faces are met at x = 10 and 50 mm.
Scene scene_beside_the_axis(Handedness handedness) {
  Scene scene = scene_of({vessel_of_mesh("box", box_mesh({0.01, 0, -0.03}, {0.05, 0.1, 0.03}), 2e-3)});
  scene.hand.handedness = handedness;
  return scene;
}

TEST(GuidancePlace, LiesOnTheOuterSurface) {
  for (const bool is_left : {false, true}) {
    Scene scene = scene_of({beaker1(), beaker2(), shell_of(beaker1())});
    if (is_left) scene.hand.handedness = Handedness::left;
    const auto core = make_core_evaluator(scene);
    for (const double azimuth : {0.0, 0.7, PI, 4.0, -1.2}) {
      const auto expect = [&](std::size_t vessel, double height, double radius) {
        const Triple place = guidance_place(*core, vessel, {height, azimuth});
        EXPECT_NEAR(place[0], radius * std::cos(azimuth), PLACE_TOLERANCE);
        EXPECT_NEAR(place[1], height, ROUNDING);
        EXPECT_NEAR(place[2], -radius * std::sin(azimuth), PLACE_TOLERANCE);
      };
      expect(0, 0.03, 0.04);
      expect(2, 0.03, 0.04);
      // the sphere of 85 mm that stands on its pole
      expect(1, 0.02, std::sqrt(0.0425 * 0.0425 - 0.0225 * 0.0225));
      expect(1, 0.13, 0.017);  // its neck
    }
  }
}

TEST(GuidancePlace, WhereNothingIsMetIsOnTheAxis) {
  const Scene scene = scene_of({beaker1()});
  const auto core = make_core_evaluator(scene);
  for (const double height : {0.2, -0.05}) EXPECT_EQ(guidance_place(*core, 0, {height, 1}), (Triple{0, height, 0}));
}

TEST(GuidancePlace, OnAMeshIsItsOwnForEitherHand) {
  for (const Handedness handedness : {Handedness::right, Handedness::left}) {
    const auto core = make_core_evaluator(scene_beside_the_axis(handedness));
    // the far face where the near side is empty
    for (const auto& [azimuth, x] : {std::pair{0.0, 0.05}, {PI, 0.01}}) {
      const Triple place = guidance_place(*core, 0, {0.04, azimuth});
      EXPECT_NEAR(place[0], x, PLACE_TOLERANCE);
      EXPECT_NEAR(place[2], 0, PLACE_TOLERANCE);
    }
  }
}

// A ray from far away comes to the lattice's box aslant; of a cup it may then pass over the near wall.
TEST(GuidancePlace, OfAHollowMeshIsOnTheNearWall) {
  VesselData shell;
  shell.outline = {line_to(40, 0), line_to(40, 100), line_to(37, 100), line_to(37, 3), line_to(0, 3)};
  const auto core = make_core_evaluator(scene_of({vessel_of_mesh("cup", turned_mesh(shell, 128, 2e-3), 1e-3)}));
  for (int degree = 0; degree < 360; degree += 5) {
    const Triple place = guidance_place(*core, 0, {0.05, radians(degree)});
    // chords: 40 mm (1 - cos(pi / 128)) is 12 um; trilinear over cells of 1 mm: h^2 / (8 r) is 3 um
    EXPECT_NEAR(place[0], 0.04 * std::cos(radians(degree)), 2e-5) << degree;
    EXPECT_NEAR(place[2], -0.04 * std::sin(radians(degree)), 2e-5) << degree;
  }
}

double distance_of(const Scene& scene, const GripInput& grip, const std::vector<Triple>& places) {
  const auto core = make_core_evaluator(scene);
  GripResult result;
  core->grip(0, grip, result);
  EXPECT_EQ(result.reason, Reason::none);
  return guidance_distance(*core, scene, 0, grip, result.midpoint, result.gap, places);
}

TEST(GuidanceDistance, IsFromTheNearerContactOnTheSkin) {
  // level grips of a cylinder touch it at their height, at their azimuth (index finger) and opposite (thumb)
  Scene scene = scene_of({beaker1()});
  constexpr double R = 0.04;
  for (const bool is_left : {false, true}) {
    scene.hand.handedness = is_left ? Handedness::left : Handedness::right;
    for (const double scale : {1.0, 1.1}) {
      for (const double azimuth : {0.0, 0.5, 3.0}) {
        const GripInput grip{0.06, azimuth, 0, radians(-20), 0, scale};
        const auto at = [&](double height, double turn) {
          return Triple{R * std::cos(azimuth + turn), height, -R * std::sin(azimuth + turn)};
        };
        EXPECT_NEAR(distance_of(scene, grip, {at(0.06, 0)}), 0, PLACE_TOLERANCE);
        EXPECT_NEAR(distance_of(scene, grip, {at(0.06, PI)}), 0, PLACE_TOLERANCE);
        EXPECT_NEAR(distance_of(scene, grip, {at(0.085, 0)}), 0.025, PLACE_TOLERANCE);
        EXPECT_NEAR(distance_of(scene, grip, {at(0.03, PI)}), 0.03, PLACE_TOLERANCE);
        // a chord, and the nearest of several
        EXPECT_NEAR(distance_of(scene, grip, {at(0.06, 1)}), 2 * R * std::sin(0.5), PLACE_TOLERANCE);
        EXPECT_NEAR(distance_of(scene, grip, {at(0.1, 1), at(0.07, PI), at(0.06, 1)}), 0.01, PLACE_TOLERANCE);
      }
    }
  }
}

TEST(GuidanceDistance, OnAMeshIsItsOwnForEitherHand) {
  for (const Handedness handedness : {Handedness::right, Handedness::left}) {
    const Scene scene = scene_beside_the_axis(handedness);
    for (const double azimuth : {0.0, PI}) {
      const GripInput grip{0.06, azimuth, 0, radians(-20), 0, 1};
      EXPECT_NEAR(distance_of(scene, grip, {{0.05, 0.06, 0}}), 0, PLACE_TOLERANCE);
      EXPECT_NEAR(distance_of(scene, grip, {{0.01, 0.09, 0}}), 0.03, PLACE_TOLERANCE);
    }
  }
}

TEST(GuidanceDistance, OfObliqueGripsBesideTheAxis) {
  // where the skin touches, the distance to the outline is 0 and the tip's middle lies a radius further out along the normal
  const Scene scene = scene_of({beaker2()});
  const auto core = make_core_evaluator(scene);
  int feasible = 0;
  for (const GripInput& grip : sample_grips(scene.vessels[0], 300, 9)) {
    GripResult result;
    core->grip(0, grip, result);
    if (result.reason != Reason::none) continue;
    ++feasible;
    // nearest points of the surface to the two tips, by the way along the gradient from their middles
    double least = 1;
    const Triple place{0.0425, 0.0425, 0};
    for (const int tip : {THUMB_TIP, INDEX_TIP}) {
      const Triple p = result.posed[tip], n = core->gradient(0, p);
      const double d = core->distance(0, p);
      least = std::min(least, std::hypot(p[0] - d * n[0] - place[0], p[1] - d * n[1] - place[1], p[2] - d * n[2] - place[2]));
    }
    EXPECT_NEAR(guidance_distance(*core, scene, 0, grip, result.midpoint, result.gap, {place}), least, PLACE_TOLERANCE);
  }
  EXPECT_GT(feasible, 50);
}

}  // namespace
}  // namespace wholehand
