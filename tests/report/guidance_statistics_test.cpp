// SPDX-License-Identifier: MIT
// Correlations against closed forms and sums in long double; distances from guidance points against geometry.
// sanitizers: address
#include "report/guidance_statistics.h"

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

// Two passes in long double, from the definition.
double reference_r(const std::vector<double>& x, const std::vector<double>& y) {
  long double mean_x = 0, mean_y = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i];
    mean_y += y[i];
  }
  mean_x /= static_cast<long double>(x.size());
  mean_y /= static_cast<long double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return static_cast<double>(xy / std::sqrt(xx * yy));
}

TEST(Pearson, OfALineIsOne) {
  const std::vector<double> x{0, 1, 2, 5}, up{3, 5, 7, 13}, down{4, 3, 2, -1};
  EXPECT_NEAR(*pearson(x, up).r, 1, ROUNDING);
  EXPECT_NEAR(*pearson(x, down).r, -1, ROUNDING);
}

TEST(Pearson, OfKnownPairs) {
  // sums of squares 10 and 10, of products 8
  EXPECT_NEAR(*pearson(std::vector<double>{1, 2, 3, 4, 5}, std::vector<double>{2, 1, 4, 3, 5}).r, 0.8, ROUNDING);
  // symmetric about the middle
  EXPECT_NEAR(*pearson(std::vector<double>{-1, 0, 1}, std::vector<double>{1, 0, 1}).r, 0, ROUNDING);
}

TEST(Pearson, IsTheDefinitionsOnRandomPairs) {
  Random random(3);
  for (const double far : {0.0, 1e3}) {
    std::vector<double> x, y;
    for (int i = 0; i < 2000; ++i) {
      x.push_back(far + random.uniform(0, 1));
      y.push_back(0.3 * x.back() + random.uniform(-1, 1));
    }
    // deviations of a thousandth of the values lose three digits
    EXPECT_NEAR(*pearson(x, y).r, reference_r(x, y), 1e-11);
  }
}

TEST(Pearson, OfWhatDoesNotVaryThereIsNone) {
  const std::vector<double> x{1, 2, 3}, same{0.1, 0.1, 0.1}, nearly{0.1, 0.1 + 1e-12, 0.1};
  for (const auto& flat : {same, nearly}) {
    EXPECT_FALSE(pearson(flat, x).r);
    EXPECT_FALSE(pearson(x, flat).r);
    EXPECT_FALSE(pearson(x, flat).why.empty());
  }
  const std::vector<double> two{1, 2};
  EXPECT_FALSE(pearson(two, two).r);
  EXPECT_FALSE(pearson({}, {}).r);
}

TEST(PointBiserial, OfKnownGroups) {
  // means 2.5 and 0.5, deviation sqrt(1.25), shares a half each
  EXPECT_NEAR(*point_biserial(std::vector<double>{0, 1, 2, 3}, std::vector<char>{0, 0, 1, 1}).r, 2 / std::sqrt(1.25) * 0.5,
              ROUNDING);
  // one yes of four at 4, the others at 0: 4 / sqrt(3) sqrt(3) / 4
  EXPECT_NEAR(*point_biserial(std::vector<double>{4, 0, 0, 0}, std::vector<char>{1, 0, 0, 0}).r, 1, ROUNDING);
  EXPECT_NEAR(*point_biserial(std::vector<double>{1, 3, 1, 3}, std::vector<char>{1, 1, 0, 0}).r, 0, ROUNDING);
}

TEST(PointBiserial, IsPearsonsOfZeroAndOne) {
  Random random(5);
  for (const double share : {0.01, 0.3, 0.98}) {
    std::vector<double> x, number;
    std::vector<char> yes;
    for (int i = 0; i < 3000; ++i) {
      yes.push_back(random.uniform(0, 1) < share ? 1 : 0);
      number.push_back(yes.back());
      x.push_back(random.uniform(0, 0.05) + 0.01 * number.back());
    }
    EXPECT_NEAR(*point_biserial(x, yes).r, reference_r(x, number), 1e-11) << share;
    EXPECT_NEAR(*point_biserial(x, yes).r, *pearson(x, number).r, 1e-11) << share;
  }
}

TEST(PointBiserial, TurnsWithTheSignAndKeepsItsSizeUnderScale) {
  const std::vector<double> x{1, 4, 2, 8, 5, 7};
  const std::vector<char> yes{0, 1, 0, 1, 1, 0}, no{1, 0, 1, 0, 0, 1};
  std::vector<double> scaled;
  for (const double value : x) scaled.push_back(1e-3 * value + 0.2);
  EXPECT_NEAR(*point_biserial(x, yes).r, -*point_biserial(x, no).r, ROUNDING);
  EXPECT_NEAR(*point_biserial(x, yes).r, *point_biserial(scaled, yes).r, 1e-11);
}

TEST(PointBiserial, OfAlwaysAndNeverThereIsNone) {
  const std::vector<double> x{1, 2, 3}, flat{2, 2, 2};
  EXPECT_EQ(point_biserial(x, std::vector<char>{1, 1, 1}).why, "always");
  EXPECT_EQ(point_biserial(x, std::vector<char>{0, 0, 0}).why, "never");
  EXPECT_EQ(point_biserial(flat, std::vector<char>{0, 1, 0}).why, "one distance");
  EXPECT_FALSE(point_biserial(std::vector<double>{1, 2}, std::vector<char>{0, 1}).r);
}

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
  EXPECT_NEAR(*statistics.fingers.r, reference_r(distances, fingers), ROUNDING);
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
      EXPECT_EQ(point.correlation.why, "never");
      EXPECT_TRUE(std::isnan(point.distance_touching));
      continue;
    }
    EXPECT_NEAR(point.distance_touching, sum / touching, ROUNDING);
    EXPECT_NEAR(point.distance_free, other / (1500 - touching), ROUNDING);
    EXPECT_NEAR(*point.correlation.r, reference_r(distances, touches), ROUNDING) << j;
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
  EXPECT_EQ(equal.fingers.why, "one distance");
  EXPECT_EQ(equal.points[0].correlation.why, "always");
  EXPECT_EQ(equal.points[1].correlation.why, "one distance");
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
