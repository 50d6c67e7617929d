// SPDX-License-Identifier: MIT
// Limits of single precision: messages name them, and float is still enough at each limit.
// sanitizers: none
#include "core/domain.h"
#include "core/hand_size.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/hand_size.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "evidence/check/compare.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using namespace float_domain;

std::string only_warning(const Scene& scene) {
  const auto warnings = domain_warnings(scene, Precision::single);
  EXPECT_EQ(warnings.size(), 1u);
  return warnings.empty() ? "" : warnings.front();
}

// A barrel of 100 mm whose wall is an arc of a radius in m.
VesselData barrel(double radius_m) {
  VesselData vessel = vessel_of("barrel", {line_to(35, 0), arc_to(35, 100, 35 - radius_m * 1e3, 50), line_to(0, 100)}, 0);
  vessel.mass = 0.5;
  vessel.center_of_mass = {0, 0.05, 0};
  return vessel;
}

// A pole as thick as a beaker.
VesselData pole(double height_m) { return cylinder("pole", 60, height_m * 1e3, 2); }

Scene tilted(std::vector<VesselData> vessels, const HandData& hand = paper_hand()) {
  Scene scene = scene_of(std::move(vessels), Pose::articulated, hand);
  scene.tilts = {0, radians(30), radians(90), radians(120), PI};
  return scene;
}

TEST(Domain, ShippedScenesAreWithin) {
  for (const std::string& name : shipped_scenes())
    EXPECT_TRUE(domain_warnings(read_scene_file(find_scene(name)), Precision::single).empty()) << name;
}

TEST(Domain, DoubleHasNoLimits) {
  Scene scene = tilted({pole(10), barrel(25)});
  scene.hand.scale = 0.05;
  EXPECT_EQ(domain_warnings(scene, Precision::single).size(), 3u);
  EXPECT_TRUE(domain_warnings(scene, Precision::full).empty());
}

TEST(Domain, WarningsNameTheLimit) {
  Scene scene = tilted({beaker1()});
  scene.grips.hand_scale.values = {1, 0.09};
  EXPECT_EQ(only_warning(scene), "hand scale 0.09: beyond a smallest of 0.1 float may be more than 10 um or 10 mN from double");
  scene.grips.hand_scale = {{1, 6}, true};
  scene.hand.scale = 20;
  EXPECT_EQ(only_warning(scene).find("hand scale 120: beyond a largest of 100 "), 0u);
  EXPECT_EQ(only_warning(tilted({barrel(17)})).find("vessel 'barrel' has coordinates of 17 m: beyond 10 m "), 0u);
  EXPECT_EQ(only_warning(tilted({beaker1(), pole(5)})).find("vessel 'pole' is held by up to 1.7e+04 N: beyond 5000 N "), 0u);
}

// The inner wall of a shell is touched, that of a solid vessel is not.
TEST(Domain, TheInnerWallOfAShellCounts) {
  VesselData vessel = vessel_of("bowl", {line_to(35, 0), line_to(35, 100), line_to(0, 100)}, 0);
  const double center = std::sqrt(17e3 * 17e3 - 48.0 * 48.0);  // an arc of 17 m over 96 mm of height
  vessel.inner = {line_to(0, 4), line_to(30, 4), arc_to(30, 100, 30 - center, 52)};
  vessel.wall = 4e-3;
  EXPECT_TRUE(domain_warnings(tilted({vessel}), Precision::single).empty());
  vessel.surface = Surface::shell;
  EXPECT_EQ(only_warning(tilted({vessel})).find("vessel 'bowl' has coordinates of 17 m: beyond 10 m "), 0u);
}

// A tolerance of 0 sets no limit: a finger rests so near to the wall that it touches in either precision.
TEST(Domain, ToleranceOfNothingHasNoLimit) {
  Scene scene = tilted({beaker1()});
  scene.hand.contact_tolerance = 0;
  scene.hand.depth_limit = 0;
  EXPECT_TRUE(domain_warnings(scene, Precision::single).empty());
}

TEST(Domain, ForcesThatNobodyAsksForHaveNoLimit) {
  Scene scene = tilted({pole(5)});
  scene.tilts.clear();
  EXPECT_TRUE(domain_warnings(scene, Precision::single).empty());
  scene = tilted({pole(5)});
  scene.force.friction = 0;
  EXPECT_TRUE(domain_warnings(scene, Precision::single).empty());
}

// The value that a share of the sorted ones do not pass.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

struct Cost {
  double separation = 0, joint = 0, force = 0, flips = 0;  // m, m, N, share of the grips
  std::size_t unflagged = 0;                               // flips of grips that no flag calls undecided
};

// The errors of float over 3,000 random grips, with 0.85 to 1 times `scale` times the scene's hand.
Cost cost_of(const Scene& scene, double scale = 1) {
  const FieldSet fields = all_fields(scene);
  auto grips = sample_grips(scene.vessels[0], 3000, 5);
  Random random(6);
  for (GripInput& grip : grips) grip.hand_scale = scale * random.uniform(0.85, 1.0);
  const GatheredPlanes a = gather(*make_core_float_evaluator(scene), fields, 0, grips),
                       b = gather(*make_core_evaluator(scene), fields, 0, grips);
  std::vector<double> separations, joints, forces;
  std::size_t flips = 0, unflagged = 0;
  for (std::size_t i = 0; i < grips.size(); ++i) {
    const std::uint32_t both = a.uint(FIELD_STATUS, i) | b.uint(FIELD_STATUS, i);
    if ((both & STATUS_GRAZING) != 0) continue;
    if (a.uint(FIELD_STATUS, i) != b.uint(FIELD_STATUS, i) || a.uint(FIELD_TOUCH_MASK, i) != b.uint(FIELD_TOUCH_MASK, i)) {
      ++flips;
      unflagged += (both & STATUS_CONTACT_UNDECIDED) == 0 ? 1 : 0;
      continue;
    }
    if ((both & STATUS_REASON_MASK) != REASON_NONE) continue;
    const auto largest = [&](int field) {
      double most = 0;
      for (int p = 0; p < field_planes(field, scene_fills(scene), scene.tilts.size()); ++p) {
        const double x = a.real(fields.plane[field] + p, i), y = b.real(fields.plane[field] + p, i);
        if (x != y) most = std::max(most, std::abs(x - y));
      }
      return most;
    };
    separations.push_back(largest(FIELD_SEPARATION));
    joints.push_back(largest(FIELD_POSED));
    forces.push_back(std::max(largest(FIELD_FEEDBACK_FORCE), largest(FIELD_HOLD_FORCE)));
  }
  EXPECT_GT(separations.size(), 2000u);
  return {quantile(separations, 0.999), quantile(joints, 0.99), quantile(forces, 0.999),
          static_cast<double>(flips) / static_cast<double>(grips.size()), unflagged};
}

void expect_within(const Cost& cost, const char* what, bool forces = true, double most_flips = 0.0015) {
  EXPECT_LE(cost.separation, FLOAT_LENGTH) << what;
  EXPECT_LE(cost.joint, FLOAT_LENGTH) << what;
  EXPECT_TRUE(!forces || cost.force <= FLOAT_FORCE) << what;
  EXPECT_LE(cost.flips, most_flips) << what;  // 0 to 3 of 3,000
}

// A glass of 0.1 kg is 0.98 N.
TEST(Domain, StrengthsAndTorsionsOfEffortsHaveLimits) {
  VesselData vessel = cylinder("glass", 70, 100, 2);
  vessel.mass = 0.1;
  vessel.center_of_mass = {0, 0.05, 0};
  Scene scene = tilted({vessel});
  scene.liquid.reset();
  scene.strength = StrengthData{};
  const auto warnings = [](const Scene& asked) { return domain_warnings(asked, Precision::single); };
  EXPECT_TRUE(warnings(scene).empty());
  Scene strong = scene;
  for (double& digit : strong.strength->digits) digit *= 0.98 * 3000 / 80;  // the palm's is 80 N
  EXPECT_TRUE(warnings(strong).empty());
  for (double& digit : strong.strength->digits) digit *= 1.01;
  ASSERT_EQ(warnings(strong).size(), 1u);
  EXPECT_NE(warnings(strong).front().find("weighs 0.981 N"), std::string::npos) << warnings(strong).front();
  strong.gravity = 0;  // nothing is lifted
  EXPECT_TRUE(warnings(strong).empty());
  Scene thin = scene;
  thin.force.torsion = 1e-3;
  EXPECT_TRUE(warnings(thin).empty());
  thin.force.torsion = 0.99e-3;
  ASSERT_EQ(warnings(thin).size(), 1u);
  EXPECT_NE(warnings(thin).front().find("0.99 mm"), std::string::npos) << warnings(thin).front();
  thin.force.torsion = 0;  // no arm at all
  EXPECT_TRUE(warnings(thin).empty());
  thin.force.torsion = 0.5e-3;
  thin.strength.reset();
  EXPECT_TRUE(warnings(thin).empty()) << "nobody asks for efforts";
}

TEST(Domain, AtItsLimitsFloatIsEnough) {
  HandData small, thin = paper_hand(), large;
  for (HandData* hand : {&small, &thin}) {
    hand->scale = SMALLEST_HAND / 0.85;  // the smallest of the grips' hands
    hand->contact_tolerance *= hand->scale;
  }
  expect_within(cost_of(tilted({scaled(beaker1(), thin.scale)}, thin)), "smallest hand with thin fingers");
  // thicker fingers are near the wall in more grips, and a flag names each that rounding decides
  const Cost thick = cost_of(tilted({scaled(beaker1(), small.scale)}, small));
  expect_within(thick, "smallest hand", true, 1);
  EXPECT_EQ(thick.unflagged, 0u);
  large.scale = 20;
  expect_within(cost_of(tilted({cylinder("tower", 8000, 10000, 50)}, large), LARGEST_HAND / 20), "largest hand", false);
  expect_within(cost_of(tilted({barrel(LARGEST_COORDINATE)})), "largest coordinate");
  const Scene heaviest = tilted({pole(2.72)});
  EXPECT_TRUE(domain_warnings(heaviest, Precision::single).empty());
  EXPECT_EQ(domain_warnings(tilted({pole(2.75)}), Precision::single).size(), 1u) << "at the limit itself";
  expect_within(cost_of(heaviest), "largest hold");
  HandData fine;
  fine.contact_tolerance = 0;
  fine.depth_limit = 0;
  expect_within(cost_of(tilted({beaker1()}, fine)), "no contact tolerance, no depth");
}

// The limits are not arbitrary: a little beyond each, float is no longer enough.
TEST(Domain, BeyondItsLimitsFloatIsNot) {
  EXPECT_GT(cost_of(tilted({barrel(17)})).flips, 0.05);
  EXPECT_GT(cost_of(tilted({pole(4)})).force, FLOAT_FORCE);
  HandData large;
  large.scale = 20;
  EXPECT_GT(cost_of(tilted({cylinder("tower", 10000, 10000, 50)}, large), 2 * LARGEST_HAND / 20).joint, FLOAT_LENGTH);
}

}  // namespace
}  // namespace wholehand
