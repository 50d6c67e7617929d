// SPDX-License-Identifier: MIT
// The wrist of a hand that holds: its angles in closed form, the arm that they belong to, what a range decides, and that it changes
// nothing else.
#include "core/wrist.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/fields.h"
#include "core/gather.h"
#include "core/joints.h"
#include "core/touch.h"
#include "core/vectors.h"
#include "tests/support/hard_scene.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using core_f64::ArmReach;
using core_f64::Wrist;

core_f64::Vessel vessel_with_arm() {
  Scene scene = scene_of({beaker1()});
  scene.arm.emplace();
  core_f64::Vessel vessel = ready_vessel(beaker1());
  vessel.arm = core_f64::load_arm(scene, scene.vessels[0]);
  return vessel;
}

core_f64::Vec3 column(const LongRotation& r, std::size_t k) {
  return {static_cast<double>(r[0][k]), static_cast<double>(r[1][k]), static_cast<double>(r[2][k])};
}
core_f64::Mat3 loaded(const LongRotation& r) { return {column(r, 0), column(r, 1), column(r, 2)}; }

// A straight arm that points to -z: the thumb is up where the little finger's side is down, so that the back of the hand is on the right.
constexpr ArmReach AHEAD{{0, 0, -1}, {0, -1, 0}, {1, 0, 0}, 1, 0};
const LongRotation THUMB_UP{{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}};

// The hand turned by these angles, in degrees, one joint after the other: the forearm turns, and the wrist deviates and bends.
LongRotation turned_hand(double pronation, double ulnar, double flexion) {
  // about the forearm, that is -z: the thumb comes to the left, and the palm faces down
  return rotation_z(radians(pronation)) * THUMB_UP * rotation_y(-radians(ulnar)) * rotation_x(-radians(flexion));
}

Wrist wrist_of(const core_f64::Vessel& vessel, const LongRotation& hand) {
  Wrist wrist;
  ease_wrist(vessel, loaded(hand), {0.1, 0.2, 0.3}, AHEAD, 0, wrist);
  return wrist;
}

TEST(Wrist, AHandTurnedByKnownAnglesHasTheseAngles) {
  const core_f64::Vessel vessel = vessel_with_arm();
  for (const double pronation : {-170.0, -82.0, -30.0, 0.0, 45.0, 76.0, 150.0})
    for (const double ulnar : {-60.0, -22.0, 0.0, 18.0, 36.0, 80.0})
      for (const double flexion : {-160.0, -75.0, -10.0, 0.0, 38.0, 76.0, 120.0}) {
        const Wrist wrist = wrist_of(vessel, turned_hand(pronation, ulnar, flexion));
        // rad: roundings, and those of an arc sine near its end
        EXPECT_NEAR(wrist.pronation, radians(pronation), 1e-13);
        EXPECT_NEAR(wrist.deviation, radians(ulnar), 1e-13);
        EXPECT_NEAR(wrist.flexion, radians(flexion), 1e-13);
        const double share = std::max({pronation / 76, -pronation / 82, ulnar / 36, -ulnar / 22, flexion / 76, -flexion / 75});
        EXPECT_NEAR(wrist.share, share, 1e-12);
      }
}

// What the angles are called: the palm down, the little finger aside, the fingers to the palm.
TEST(Wrist, AnglesHaveTheNamesOfAnatomy) {
  const core_f64::Vessel vessel = vessel_with_arm();
  const auto palm = [](const LongRotation& hand) { return -column(hand, 1); };
  const auto fingers = [](const LongRotation& hand) { return -column(hand, 2); };
  EXPECT_NEAR(palm(turned_hand(0, 0, 0)).x, -1, 1e-15) << "a right hand with the thumb up has its palm on the left";
  EXPECT_NEAR(palm(turned_hand(90, 0, 0)).y, -1, 1e-15) << "pronation turns the palm down";
  EXPECT_NEAR(fingers(turned_hand(90, 0, 40)).y, -std::sin(radians(40)), 1e-15) << "flexion turns the fingers to the palm";
  EXPECT_NEAR(fingers(turned_hand(0, 30, 0)).y, -std::sin(radians(30)), 1e-15) << "ulnar deviation, to the little finger";
}

TEST(Wrist, TheElbowIsWhereTheArmsLengthsPutIt) {
  const core_f64::Vessel vessel = vessel_with_arm();
  const core_f64::Vec3 shoulder(0.2, 0.35, 0.4), wrist(-0.05, 0.1, 0.08);
  for (const double turn : {0.0, 0.4, -1.0}) {
    const core_f64::Vec3 side(std::cos(turn), 0, std::sin(turn));
    const ArmReach reach = reach_wrist(vessel, wrist, shoulder, side);
    EXPECT_NEAR(glm::dot(reach.along, reach.low), 0, 1e-15);
    EXPECT_NEAR(glm::dot(reach.along, reach.aside), 0, 1e-15);
    EXPECT_GT(glm::dot(reach.aside, side), 0.5);
    EXPECT_LT(reach.low.y, -0.5) << "an arm that hangs has its elbow below";
    for (const core_f64::Vec3& bend : {reach.low, reach.aside}) {
      const core_f64::Vec3 elbow = wrist - vessel.arm.forearm * (reach.straight * reach.along - reach.bent * bend);
      EXPECT_NEAR(glm::length(elbow - shoulder), vessel.arm.upper_arm, 1e-15);
      EXPECT_GT(glm::dot(elbow - shoulder, bend), 0);
    }
  }
}

TEST(Wrist, AnArmThatIsTooShortIsStraightAndNothingIsNaN) {
  const core_f64::Vessel vessel = vessel_with_arm();
  const core_f64::Vec3 wrist(0.1, 0.2, 0.3), side(1, 0, 0);
  const ArmReach far = reach_wrist(vessel, wrist, wrist + core_f64::Vec3(0, 0, 2), side);
  EXPECT_EQ(far.straight, 1);
  EXPECT_EQ(far.bent, 0);
  EXPECT_EQ(far.along.z, -1);
  for (const core_f64::Vec3& away :
       {core_f64::Vec3(0), core_f64::Vec3(0.3, 0, 0), core_f64::Vec3(-0.3, 0, 0), core_f64::Vec3(0, 1e-12, 0)}) {
    Wrist found;
    ease_wrist(vessel, core_f64::Mat3(1), wrist, reach_wrist(vessel, wrist, wrist + away, side), 0.5, found);
    EXPECT_TRUE(std::isfinite(found.share) && found.share < 100) << found.share;
  }
}

TEST(Wrist, AForearmThroughTheTableIsBeyondByItsDepth) {
  core_f64::Vessel vessel = vessel_with_arm();
  vessel.on_table = true;
  for (const double height : {0.2, 0.0451, 0.04, 0.0, -0.1}) {
    Wrist wrist;
    ease_wrist(vessel, loaded(turned_hand(0, 0, 0)), {0, height, 0}, AHEAD, 0, wrist);
    EXPECT_NEAR(wrist.share, height > 0.045 ? 0 : 1 + (0.045 - height) / 0.045, 1e-12) << height;
  }
}

// ---- whole grips ----

Scene scene_with_arm(Scene scene) {
  scene.arm.emplace();
  return scene;
}

// The hand's frame from three metacarpal bases, which no closure moves.
core_f64::Mat3 frame_of(const core_f64::Vec3& a, const core_f64::Vec3& b, const core_f64::Vec3& c) {
  const core_f64::Vec3 along = glm::normalize(b - a), up = glm::normalize(glm::cross(along, c - a));
  return {along, glm::cross(up, along), up};
}

struct NearestArm {
  double miss = 1e9;   // of the upper arm's length, m, or of the forearm's direction
  bool leans = false;  // the arm is too short and straight, as the holder leans
};

// The arm that fits a forearm at one of the azimuths of the shoulder.
NearestArm nearest_arm(const Scene& scene, const GripInput& grip, const core_f64::Vec3& wrist, const core_f64::Vec3& forearm) {
  const ArmData& arm = *scene.arm;
  const core_f64::Vec3 elbow = wrist - arm.forearm * forearm;
  NearestArm nearest;
  const int azimuths = arm_azimuths(scene, scene.vessels[0]);
  for (int k = 0; k < azimuths; ++k) {
    const double turn = 2 * PI * k / azimuths - (azimuths > 1 ? grip.azimuth : 0);
    const core_f64::Vec3 shoulder(std::cos(turn) * arm.shoulder[0] - std::sin(turn) * arm.shoulder[2], arm.shoulder[1],
                                  std::sin(turn) * arm.shoulder[0] + std::cos(turn) * arm.shoulder[2]);
    const double reach = glm::length(wrist - shoulder);
    const bool is_short = reach > arm.upper_arm + arm.forearm;
    const double miss =
        is_short ? glm::length((wrist - shoulder) / reach - forearm) : std::abs(glm::length(elbow - shoulder) - arm.upper_arm);
    if (miss < nearest.miss) nearest = {miss, is_short};
  }
  return nearest;
}

// The angles of a grip belong to an arm of the scene: put together from them, forearm and elbow are an upper arm away from the shoulder,
// which stands at one of the azimuths, and above the table.
TEST(Wrist, AnglesBelongToAnArmThatReachesTheHand) {
  int feasible = 0, within = 0, beyond = 0, straight = 0;
  for (Scene scene : {scene_of({beaker1()}), scene_of({lopsided()})}) {
    scene.table.emplace();
    scene = scene_with_arm(scene);
    scene.vessels[0].base = 0;
    const ArmData& arm = *scene.arm;
    const auto core = make_core_evaluator(scene);
    const auto at_home = reference_hand(scene.hand, 0);
    const auto base = [&](int f) {
      const Long3& p = at_home[static_cast<std::size_t>(finger_start(f))];
      return core_f64::Vec3(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
    };
    for (const GripInput& grip : sample_grips(scene.vessels[0], 150, 41)) {
      GripResult result;
      core->grip(0, grip, result);
      if (result.reason != Reason::none) {
        EXPECT_TRUE(std::isnan(result.wrist_share));
        EXPECT_FALSE(result.beyond_wrist);
        continue;
      }
      ++feasible;
      EXPECT_EQ(result.beyond_wrist, result.wrist_share > 1);
      EXPECT_FALSE(result.beyond_wrist && result.plausible);
      (result.beyond_wrist ? beyond : within) += 1;
      const auto placed = [&](int f) { return to_vec3<double>(result.joints[static_cast<std::size_t>(finger_start(f))]); };
      const core_f64::Mat3 hand = frame_of(placed(0), placed(1), placed(4)) * glm::transpose(frame_of(base(0), base(1), base(4)));
      const core_f64::Vec3 wrist = placed(1) - hand * base(1);
      const auto [flexion, ulnar, pronation] = result.wrist_angles;
      const double share = std::max({flexion / arm.flexion, -flexion / arm.extension, ulnar / arm.ulnar, -ulnar / arm.radial,
                                     pronation / arm.pronation, -pronation / arm.supination});
      if (!result.beyond_wrist) {
        EXPECT_NEAR(share, result.wrist_share, 1e-9);
      }
      EXPECT_LE(share, result.wrist_share + 1e-9);
      const core_f64::Vec3 forearm =
          hand * core_f64::Vec3(-std::sin(ulnar), std::cos(ulnar) * std::sin(flexion), -std::cos(ulnar) * std::cos(flexion));
      const core_f64::Vec3 elbow = wrist - arm.forearm * forearm;
      const auto [miss, leans] = nearest_arm(scene, grip, wrist, forearm);
      EXPECT_NEAR(miss, 0, 1e-9);
      straight += leans ? 1 : 0;
      if (!result.beyond_wrist) {
        EXPECT_GT(elbow.y - arm.elbow_radius, scene.table->clearance - 1e-9);
        EXPECT_GT(wrist.y - arm.wrist_radius, scene.table->clearance - 1e-9);
      }
    }
  }
  EXPECT_GT(feasible, 100);
  EXPECT_GT(within, 50);
  EXPECT_GT(beyond, 20);
  EXPECT_LT(straight, feasible / 2);
}

TEST(Wrist, ALeftHandTurnsAsFarAsTheRight) {
  for (const VesselData& vessel : {beaker3(), lopsided()}) {
    const Scene right = scene_with_arm(scene_of({vessel}));
    Scene left = right;
    left.hand.handedness = Handedness::left;
    left.arm->shoulder[0] = -left.arm->shoulder[0];
    left.vessels[0].center_of_mass[0] = -left.vessels[0].center_of_mass[0];
    int feasible = 0;
    for (const GripInput& grip : sample_grips(vessel, 40, 3)) {
      const GripInput mirrored = mirrored_grip(grip);
      GripResult of_right, of_left;
      make_core_evaluator(right)->grip(0, grip, of_right);
      make_core_evaluator(left)->grip(0, mirrored, of_left);
      ASSERT_EQ(of_left.reason, of_right.reason);
      if (of_right.reason != Reason::none) continue;
      ++feasible;
      EXPECT_NEAR(of_left.wrist_share, of_right.wrist_share, 1e-7);
    }
    EXPECT_GT(feasible, 15);
  }
}

// A body of revolution is taken from any side; another as it stands: from the far side no arm reaches it.
TEST(Wrist, TheSideFromWhichAVesselIsTakenCountsWhereItsSidesDiffer) {
  const auto share_at = [](const VesselData& vessel, double azimuth) {
    GripResult result;
    make_core_evaluator(scene_with_arm(scene_of({vessel})))->grip(0, {80e-3, azimuth, 0, radians(-20), 0, 1}, result);
    EXPECT_EQ(result.reason, Reason::none);
    return result.wrist_share;
  };
  double least = 1e9, most = 0;
  for (int k = 0; k < ARM_AZIMUTHS; ++k) {
    const double azimuth = 2 * PI * k / ARM_AZIMUTHS;
    for (const double off : {0.0, radians(3), radians(7.5)})
      EXPECT_NEAR(share_at(beaker1(), azimuth + off), share_at(beaker1(), 0), 1e-9) << k << " " << off;
    least = std::min(least, share_at(lopsided(), azimuth));
    most = std::max(most, share_at(lopsided(), azimuth));
  }
  EXPECT_NEAR(least, share_at(beaker1(), 0), 1e-9) << "the best side of all";
  EXPECT_GT(most, 1.5) << "the fingers point to the holder";
}

// Beside the glass and above it a hand comes from a person in front; from below, with the palm up, it does not.
TEST(Wrist, HandsFromBesideAndFromAboveAreWithinReachAndPalmsUpAreNot) {
  Scene scene = scene_of({beaker1()});
  scene.table.emplace();
  const auto with = make_core_evaluator(scene_with_arm(scene));
  for (const double roll : {-120, -90, -60, -30, 0, 45, 90, 135, 180}) {
    GripResult result;
    with->grip(0, {100e-3, 0, 0, radians(roll), 0, 1}, result);
    ASSERT_EQ(result.reason, Reason::none);
    EXPECT_EQ(result.beyond_wrist, roll > 10) << roll << ": " << result.wrist_share;
    EXPECT_EQ((result.status & STATUS_BEYOND_WRIST) != 0, result.beyond_wrist);
    if (!result.beyond_wrist) continue;
    EXPECT_FALSE(result.plausible);
    EXPECT_EQ(with->score(0, {100e-3, 0, 0, radians(roll), 0, 1}, result).score, 0);
  }
}

// ---- what it leaves alone ----

TEST(Wrist, ChangesOnlyWhetherAGripIsPlausibleAndThePostureTerm) {
  for (const Pose pose : {Pose::articulated, Pose::paper}) {
    Scene bare = hard_scene();
    bare.pose = pose;
    const Scene arm = scene_with_arm(bare);
    const FieldSet without = all_fields(bare), with = all_fields(arm);
    EXPECT_FALSE(without.has(FIELD_WRIST_SHARE));
    ASSERT_TRUE(with.has(FIELD_WRIST_SHARE));
    EXPECT_EQ(with.real_planes, without.real_planes + 1);
    int beyond = 0, within = 0;
    for (std::size_t v = 0; v < bare.vessels.size(); ++v) {
      const auto grips = grips_with_hopeless_ones(bare.vessels[v], v, 60);
      const GatheredPlanes a = gather(*make_core_evaluator(bare), without, v, grips);
      const GatheredPlanes b = gather(*make_core_evaluator(arm), with, v, grips);
      for (std::size_t i = 0; i < grips.size(); ++i) {
        const auto real = [&](const GatheredPlanes& planes, int field, int k = 0) {
          return planes.real(planes.fields.plane[field] + k, i);
        };
        const std::uint32_t status = b.uint(FIELD_STATUS, i), before = a.uint(FIELD_STATUS, i);
        const bool is_beyond = (status & STATUS_BEYOND_WRIST) != 0;
        EXPECT_EQ(before & STATUS_BEYOND_WRIST, 0u);
        EXPECT_EQ(status, is_beyond ? (before & ~std::uint32_t(STATUS_PLAUSIBLE)) | STATUS_BEYOND_WRIST : before);
        for (const Field& row : real_fields()) {
          if (!without.has(row.number) || row.number == FIELD_SCORE) continue;
          for (int k = 0; k < field_planes(row.number, bare); ++k) {
            if (row.number == FIELD_TERMS && k == 3) continue;
            const double x = real(a, row.number, k), y = real(b, row.number, k);
            EXPECT_TRUE(x == y || (std::isnan(x) && std::isnan(y))) << row.label << " " << k << ": " << x << " and " << y;
          }
        }
        if ((status & STATUS_REASON_MASK) != REASON_NONE) continue;
        (is_beyond ? beyond : within) += 1;
        const double share = real(b, FIELD_WRIST_SHARE), posture = real(a, FIELD_TERMS, 3);
        EXPECT_EQ(is_beyond, share > 1);
        EXPECT_NEAR(real(b, FIELD_TERMS, 3), (posture + 1 - std::min(1.0, share)) / 2, 1e-15);
        GripResult result;
        const auto core = make_core_evaluator(arm);
        core->grip(v, grips[i], result);
        EXPECT_EQ(core->score(v, grips[i], result).score, real(b, FIELD_SCORE));
        EXPECT_EQ(result.wrist_share, share);
      }
    }
    EXPECT_GT(beyond, 20);
    EXPECT_GT(within, 20);
  }
}

}  // namespace
}  // namespace wholehand
