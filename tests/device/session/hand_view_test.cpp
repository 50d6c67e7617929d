// SPDX-License-Identifier: MIT
// The whole hand as it is seen live: the hand of the grip that the session holds, outside of every glass, without jumps; the
// liquid's surface and the stream by closed forms.
// sanitizers: address
#include "device/session/hand_view.h"
#include "core/joints.h"
#include "core/load.h"
#include "core/vectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "core/contact.h"
#include "core/effort.h"
#include "core/evaluator.h"
#include "core/mirror.h"
#include "tests/support/live_script.h"
#include "tests/support/scenes.h"

namespace wholehand::device {
namespace {

using core_f64::Mat3;
using core_f64::Vec3;

double distance_between(const Triple& a, const Triple& b) { return glm::length(to_vec3(a) - to_vec3(b)); }
bool is_tracked(int joint) { return joint == THUMB_TIP || joint == INDEX_TIP; }
bool touches(PointContact contact) { return contact != PointContact::free && contact != PointContact::tracked; }

double radius_of(const LiveScene& live, int joint) {
  const int f = finger_of(joint);
  return live.hand.scale * live.hand.radius[f][joint - finger_start(f)];
}

// The least separation of a drawn point from any vessel, in the scene's own world (right hands).
double least_separation(const LiveScene& live, const VesselPoses& poses, const HandView& view, int joint) {
  double least = 1;
  for (std::size_t v = 0; v < live.vessels.size(); ++v) {
    const Vec3 p = glm::transpose(to_mat3(poses[v].rotation)) * (to_vec3(view.proxies[joint]) - to_vec3(poses[v].place));
    least = std::min(least, core_f64::separation_at(live.vessels[v].vessel, p, radius_of(live, joint)));
  }
  return least;
}

// The gripper's axes of a grip in its vessel's frame (the sweeps' hand, as in PlaceLiveHand.IsTheSweepsHand).
Mat3 gripper_of(const GripInput& grip) {
  const Vec3 d = core_f64::grip_direction(grip.azimuth, grip.obliquity);
  const Vec3 down = glm::normalize(Vec3(0, -1, 0) + d.y * d), side = glm::cross(d, down);
  const Vec3 f2 = std::cos(grip.roll) * down + std::sin(grip.roll) * side;
  return Mat3(d, -f2, -glm::cross(d, f2));
}

// A tick that holds the first vessel by a grip, somewhere and turned somehow. Left hands: grips and results are the scene's, the
// gripper's axes those of the mirrored one.
struct HeldGrip {
  Tick tick;
  VesselPoses poses{};
};
HeldGrip hold(const Scene& scene, const GripInput& grip, const GripResult& result) {
  const bool is_left = scene.hand.handedness == Handedness::left;
  const Mat3 mirror(is_left ? -1 : 1, 0, 0, 0, 1, 0, 0, 0, 1);
  HeldGrip held;
  VesselPose& pose = held.poses[0];
  pose = {{0.2, 0.3, -0.1}, product(turned('y', 0.4), product(turned('x', -1.2), turned('z', 0.3)))};
  const Mat3 turn = to_mat3(pose.rotation);
  const auto out = [&](const Triple& p) { return to_triple(to_vec3(pose.place) + turn * to_vec3(p)); };
  Tick& tick = held.tick;
  tick.state = SessionState::tilt;
  tick.vessel = 0;
  tick.vessel_place = pose.place;
  tick.vessel_rotation = pose.rotation;
  tick.hand_rotation = to_rotation(turn * mirror * gripper_of(mirrored(grip, scene.hand.handedness)) * mirror);
  tick.gap = result.gap;
  tick.closure = result.closure;
  tick.tips = tick.proxies = {out(result.posed[THUMB_TIP]), out(result.posed[INDEX_TIP])};
  tick.middle = to_triple(0.5 * (to_vec3(tick.tips[0]) + to_vec3(tick.tips[1])));
  tick.touch_mask = result.touch_mask;
  return held;
}

TEST(HandView, OfAHeldGripIsTheHandOfTheGrip) {
  int compared = 0;
  for (const Pose pose : {Pose::articulated, Pose::paper, Pose::rigged}) {
    for (const HandData& hand : {paper_hand(), left_hand()}) {
      const Scene scene = scene_of({beaker1()}, pose, hand);
      const LiveScene live(scene);
      const auto evaluator = make_core_evaluator(scene);
      for (const GripInput& grip : sample_grips(scene.vessels[0], 60, 5)) {
        GripResult result;
        evaluator->grip(0, grip, result);
        if (result.reason != Reason::none) continue;
        ++compared;
        const HeldGrip held = hold(scene, grip, result);
        const HandView view = hand_view(live, held.tick, held.poses);
        const Mat3 turn = to_mat3(held.poses[0].rotation);
        EXPECT_EQ(view.vessel, 0);
        for (int j = 0; j < JOINT_COUNT; ++j) {
          const auto seen = [&](const Triple& p) { return to_triple(to_vec3(held.poses[0].place) + turn * to_vec3(p)); };
          // the closure is found to 1e-9 m of the gap; a finger that turns alone may carry that on tenfold
          EXPECT_LT(distance_between(view.rigged[j], seen(result.joints[j])), 1e-7) << j;
          EXPECT_LT(distance_between(view.posed[j], seen(result.posed[j])), 1e-7) << j;
          EXPECT_LT(distance_between(view.proxies[j], seen(result.proxies[j])), 1e-7) << j;
          EXPECT_EQ(touches(view.contact[j]), (result.touch_mask >> j & 1) != 0) << j;
          const bool is_projected = ((result.tip_mask | result.finger_mask | result.inner_mask) >> j & 1) != 0;
          EXPECT_EQ(view.contact[j] == PointContact::projected, is_projected && !is_tracked(j)) << j;
          EXPECT_EQ(view.contact[j] == PointContact::tracked_touching, is_tracked(j)) << j;
        }
      }
    }
  }
  EXPECT_GT(compared, 150);
}

TEST(HandView, FarFromAllGlassIsTheRiggedHand) {
  Scene scene = live_scene();
  scene.hand = odd_hand();
  const LiveScene live(scene);
  Session session(scene, own_gap(scene.hand));
  GripperState state;
  state.position = {1, 1, 1};
  state.rotation = product(turned('y', 0.5), turned('x', 0.7));
  for (const double gap : own_gap(scene.hand)) {
    state.gap = 0.5 * (gap + own_gap(scene.hand)[0]);
    Tick tick;
    session.step(state, state.gap > 0.05 ? 1 : 0, tick);
    const HandView view = hand_view(live, tick, VesselTracker(scene).poses());
    EXPECT_EQ(view.vessel, -1);
    const auto truth = reference_hand(scene.hand, static_cast<long double>(tick.closure));
    for (int j = 0; j < JOINT_COUNT; ++j) {
      EXPECT_LT(distance_between(view.proxies[j], view.rigged[j]), 1e-9) << j;
      EXPECT_EQ(view.contact[j], is_tracked(j) ? PointContact::tracked : PointContact::free);
      // any two joints are as far apart as in the hand by rotation matrices, and all as far from the wrist
      EXPECT_NEAR(distance_between(view.rigged[j], view.wrist), static_cast<double>(length(truth[j])), 1e-9) << j;
      EXPECT_NEAR(distance_between(view.rigged[j], view.rigged[0]), static_cast<double>(length(truth[j] - truth[0])), 1e-9) << j;
      // and where the hand's own frame has them
      Triple there = view.wrist;
      for (int row = 0; row < 3; ++row)
        for (int k = 0; k < 3; ++k) there[row] += view.rotation[3 * row + k] * static_cast<double>(truth[j][k]);
      EXPECT_LT(distance_between(view.posed[j], there), 1e-9) << j;
    }
    EXPECT_LT(distance_between(view.proxies[THUMB_TIP], tick.tips[0]), 1e-12);
    EXPECT_LT(distance_between(view.proxies[INDEX_TIP], tick.tips[1]), 1e-12);
  }
}

struct Seen {
  std::vector<Tick> ticks;
  std::vector<VesselPoses> poses;
  std::vector<HandView> views;
};
Seen watch(const Scene& scene, const std::function<GripperState(std::int64_t)>& at, std::int64_t ticks) {
  Session session(scene, own_gap(scene.hand));
  Seen seen;
  for (std::int64_t n = 0; n < ticks; ++n) {
    Tick tick;
    session.step(at(n), n, tick);
    seen.ticks.push_back(tick);
    seen.poses.push_back(session.poses());
    seen.views.push_back(hand_view(session.live(), tick, session.poses()));
  }
  return seen;
}
Seen watch_script(const Scene& scene) {
  LiveScript script;
  script.vessel = scene.vessels[0].place;
  return watch(
      scene, [&](std::int64_t n) { return script.at(n); }, static_cast<std::int64_t>(script.seconds() * script.rate));
}

// ---- what holding takes of the whole hand ----

// The weight that the vessel has in its own frame, by what sweeps know of glass and liquid.
core_f64::Wrench weight_in(const Scene& scene, const Evaluator& evaluator, const Tick& tick) {
  const VesselConstants glass = evaluator.constants(0);
  const Vec3 up = glm::transpose(to_mat3(tick.vessel_rotation)) * Vec3(0, 1, 0);
  const Vec3 lean = glm::normalize(Vec3(-up.x, 0, -up.z));
  const LiquidResult liquid =
      tick.volume[0] > 0 ? evaluator.liquid(0, tick.volume[0] / glass.capacity, std::acos(up.y)) : LiquidResult{};
  const Vec3 moment = glass.mass * to_vec3(glass.center_of_mass) + liquid.mass * (liquid.lean * lean + Vec3(0, liquid.height, 0));
  const double mass = glass.mass + liquid.mass;
  return core_f64::wrench_at(moment / mass, -mass * scene.gravity * up);
}

// The forces lie in their cones and carry the weight, and no digit presses with more than its share.
void expect_carried(const Scene& scene, const HandHold& hold, double weight) {
  Vec3 sum(0);
  std::array<double, core_f64::DIGITS> pressed{};
  for (const HandPress& press : hold.presses) {
    const Vec3 force = to_vec3(press.force), normal = to_vec3(press.normal);
    const double along = glm::dot(force, normal);
    EXPECT_NEAR(glm::length(normal), 1, 1e-9);
    EXPECT_LE(glm::length(force - along * normal), scene.force.friction * along + 1e-9 * weight);
    pressed[static_cast<std::size_t>(press.digit)] += along;
    sum += force;
  }
  EXPECT_LT(glm::length(sum - Vec3(0, weight, 0)), 1e-9 * weight) << "to the rounding of a solve";
  for (std::size_t f = 0; f < pressed.size(); ++f)
    EXPECT_LE(pressed[f], hold.effort * scene.strength->digits[f] * (1 + 1e-9)) << "digit " << f;
}

TEST(HandView, HoldsWithTheEffortOfTheGrip) {
  int compared = 0, unheld = 0;
  for (const HandData& hand : {paper_hand(), left_hand()}) {
    Scene scene = scene_of({beaker1()}, Pose::articulated, hand);
    scene.liquid = LiquidData{1000, {0.5}, {}, Pour::away};
    scene.strength = StrengthData{{30, 20, 25, 15, 10, 60}, true, {}};
    const LiveScene live(scene);
    const auto evaluator = make_core_evaluator(scene);
    for (const GripInput& grip : sample_grips(scene.vessels[0], 40, 6)) {
      GripResult result;
      evaluator->grip(0, grip, result);
      if (result.reason != Reason::none) continue;
      HeldGrip held = hold(scene, grip, result);
      held.tick.volume[0] = compared % 2 == 0 ? 0 : 0.2 * evaluator->capacity(0);
      const HandView view = hand_view(live, held.tick, held.poses);
      ASSERT_TRUE(view.hold);
      ++compared;
      std::vector<core_f64::ContactPoint> contacts, tips;
      for (const GripContact& contact : evaluator->contacts(0, result)) {
        contacts.push_back({to_vec3(contact.point), to_vec3(contact.normal), contact.digit, contact.is_tip});
        if (is_tracked(contact.joint)) tips.push_back(contacts.back());
      }
      const core_f64::HandStrength strength = core_f64::load_strength(scene, result);
      const core_f64::Wrench weight = weight_in(scene, *evaluator, held.tick);
      const auto effort = core_f64::EffortSolver(contacts, strength, Vec3(0)).solve(weight),
                 of_tips = core_f64::EffortSolver(tips, strength, Vec3(0)).solve(weight);
      EXPECT_NEAR(view.hold->strength, strength.weaker_tip(), 1e-9) << "places are turned into the world and back";
      EXPECT_EQ(std::isinf(view.hold->tips), std::isinf(of_tips.effort));
      if (std::isfinite(of_tips.effort)) {
        EXPECT_NEAR(view.hold->tips / of_tips.effort, 1, 2e-3);  // two brackets of 1e-3
      }
      if (std::isinf(effort.effort)) {
        ++unheld;
        EXPECT_TRUE(std::isinf(view.hold->effort) && std::isinf(view.hold->force()) && view.hold->presses.empty());
        continue;
      }
      EXPECT_NEAR(view.hold->effort / effort.effort, 1, 2e-3);
      EXPECT_LE(view.hold->low, effort.effort);
      EXPECT_GE(view.hold->effort, effort.low * (1 - 1e-6));  // hands that are 1e-7 m apart
      EXPECT_DOUBLE_EQ(view.hold->force(), view.hold->strength * view.hold->effort);
      expect_carried(scene, *view.hold, glm::length(weight.force));
      const Mat3 turn = to_mat3(held.poses[0].rotation);
      for (const HandPress& press : view.hold->presses) {
        const Vec3 place = glm::transpose(turn) * (to_vec3(press.place) - to_vec3(held.poses[0].place));
        EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(), [&](const core_f64::ContactPoint& contact) {
          return contact.digit == press.digit && glm::length(contact.place - place) < 1e-6 &&
                 glm::length(turn * contact.normal - to_vec3(press.normal)) < 1e-4;  // on an arc of 5 mm, and ten times as much
        }));
      }
    }
  }
  EXPECT_GT(compared, 30);
  EXPECT_LT(unheld, compared);
}

// On an upright wall, with the tips level on either side of the axis, two tips need what kernel 7 says. All others help.
TEST(HandView, TwoTipsHoldAsKernelSevenSays) {
  Scene scene = live_scene();
  scene.strength.emplace();
  const double glass = make_core_evaluator(scene)->empty_mass(0);
  const Seen seen = watch_script(scene);
  int held = 0;
  double least = 1;
  for (std::size_t n = 0; n < seen.ticks.size(); n += 23) {
    const Tick& tick = seen.ticks[n];
    const std::optional<HandHold>& hold = seen.views[n].hold;
    ASSERT_EQ(hold.has_value(), is_held(tick.state)) << n;
    if (!hold) continue;
    ++held;
    EXPECT_NEAR(hold->tips_force() / tick.hold_force, 1, 2e-3) << n;  // the bracket, and fingertips that are not quite level
    EXPECT_LE(hold->low, hold->tips) << n;
    least = std::min(least, hold->effort / hold->tips);
    expect_carried(scene, *hold, (glass + 1000 * tick.volume[0]) * scene.gravity);
  }
  EXPECT_GT(held, 50);
  EXPECT_LT(least, 0.9) << "the other fingers help";
}

// A weightless vessel takes no effort, and smooth tips hold no weight: both give numbers all the same.
TEST(HandView, HoldsAtTheEdges) {
  Scene scene = scene_of({beaker1()});
  scene.strength.emplace();
  const auto evaluator = make_core_evaluator(scene);
  Scene weightless = scene, smooth = scene;
  weightless.gravity = 0;
  smooth.force.friction = 0;
  const LiveScene afloat(weightless), slippery(smooth);
  int compared = 0;
  for (const GripInput& grip : sample_grips(scene.vessels[0], 40, 7)) {
    GripResult result;
    evaluator->grip(0, grip, result);
    if (result.reason != Reason::none) continue;
    ++compared;
    const HeldGrip held = hold(scene, grip, result);
    const HandView light = hand_view(afloat, held.tick, held.poses), sliding = hand_view(slippery, held.tick, held.poses);
    ASSERT_TRUE(light.hold && sliding.hold);
    EXPECT_EQ(light.hold->effort, 0);
    EXPECT_EQ(light.hold->tips_force(), 0);
    EXPECT_TRUE(light.hold->presses.empty());
    EXPECT_EQ(sliding.hold->tips_force(), std::numeric_limits<double>::infinity());
    EXPECT_GE(sliding.hold->force(), 0);
    EXPECT_EQ(sliding.hold->presses.empty(), std::isinf(sliding.hold->effort));
  }
  EXPECT_GT(compared, 10);
}

TEST(HandView, WithoutStrengthsNothingIsSolved) {
  const Seen seen = watch_script(live_scene());
  for (const HandView& view : seen.views) ASSERT_FALSE(view.hold);
}

// The hand that the gripper moves is one body with its wrist; the posed hand, whose tips the glass keeps apart, has its own
// elsewhere.
TEST(HandView, TheRiggedHandHasItsOwnWrist) {
  const Scene scene = live_scene();
  const Seen seen = watch_script(scene);
  double farthest = 0;
  for (std::size_t n = 0; n < seen.views.size(); n += 97) {
    const HandView& view = seen.views[n];
    const auto truth = reference_hand(scene.hand, static_cast<long double>(seen.ticks[n].closure));
    for (int j = 0; j < JOINT_COUNT; ++j)
      EXPECT_NEAR(distance_between(view.rigged[j], view.rigged_wrist), static_cast<double>(length(truth[j])), 1e-9)
          << j << " at tick " << n;
    farthest = std::max(farthest, distance_between(view.wrist, view.rigged_wrist));
  }
  EXPECT_GT(farthest, 1e-4) << "m: somewhere it is squeezed";
}

TEST(HandView, NothingIsInsideTheGlassThroughoutASession) {
  for (const Surface surface : {Surface::solid, Surface::shell}) {
    Scene scene = live_scene();
    for (VesselData& vessel : scene.vessels) vessel.surface = surface;
    const LiveScene live(scene);
    const Seen seen = watch_script(scene);
    for (std::size_t n = 0; n < seen.views.size(); ++n) {
      const HandView& view = seen.views[n];
      for (int j = 0; j < JOINT_COUNT; ++j) {
        // to what a proxy is found (1e-9), and 1e-8 of the tips' own
        EXPECT_GT(least_separation(live, seen.poses[n], view, j), -2e-8) << "joint " << j << " at tick " << n;
        if (!is_held(seen.ticks[n].state)) continue;
        EXPECT_EQ(touches(view.contact[j]), (seen.ticks[n].touch_mask >> j & 1) != 0) << j;
      }
      if (seen.ticks[n].state == SessionState::slipped) continue;  // there the vessel comes through the tips
      EXPECT_LT(distance_between(view.proxies[THUMB_TIP], seen.ticks[n].proxies[0]), 1e-7) << n;
      EXPECT_LT(distance_between(view.proxies[INDEX_TIP], seen.ticks[n].proxies[1]), 1e-7) << n;
    }
  }
}

TEST(HandView, NothingIsInsideTheGlassWhereverAFreeHandIs) {
  Scene scene = live_scene();
  scene.vessels[1].place = {0.13, 0, -0.03};  // two near each other
  const LiveScene live(scene);
  const VesselPoses poses = VesselTracker(scene).poses();
  Random random(3);
  for (int k = 0; k < 500; ++k) {
    Session session(scene, own_gap(scene.hand));
    GripperState state;
    state.position = {random.uniform(-0.1, 0.25), random.uniform(0, 0.2), random.uniform(-0.1, 0.1)};
    state.rotation = product(turned('y', random.uniform(-PI, PI)), turned('x', random.uniform(-PI, PI)));
    state.gap = random.uniform(0.03, 0.12);
    Tick tick;
    session.step(state, 0, tick);
    if (tick.vessel >= 0) continue;
    const HandView view = hand_view(live, tick, poses);
    for (int j = 0; j < JOINT_COUNT; ++j) {
      // a point between two vessels is out of the second, which was left last
      if (finger_of(j) == 0 || finger_of(j) == 1) continue;
      EXPECT_GT(least_separation(live, poses, view, j), -2e-8) << "joint " << j << ", hand " << k;
    }
  }
}

// The script's hand goes by less than 0.5 mm a tick, a fingertip, which is further out, by less than 1 mm: none comes to the glass
// at once. When the vessel slips away through the fingers they may.
TEST(HandView, FingersComeToTheGlassWithoutAJump) {
  const Seen seen = watch_script(live_scene());
  for (std::size_t n = 1; n < seen.views.size() && seen.ticks[n].state != SessionState::slipped; ++n) {
    for (int j = 0; j < JOINT_COUNT; ++j)
      EXPECT_LT(distance_between(seen.views[n].proxies[j], seen.views[n - 1].proxies[j]), 1e-3)
          << "joint " << j << " at tick " << n;
  }
  bool is_closed = false;
  for (std::size_t n = 0; n < seen.views.size() && !is_closed; ++n)
    is_closed = is_held(seen.ticks[n].state) && std::popcount(seen.ticks[n].touch_mask) > 5;
  EXPECT_TRUE(is_closed) << "more than the tips touch";
}

TEST(HandView, ALeftHandIsTheRightHandOfTheMirroredScene) {
  const Scene right = live_scene();
  Scene left = right;
  left.hand.handedness = Handedness::left;
  for (VesselData& vessel : left.vessels) vessel.place[0] = -vessel.place[0];
  const LiveScript script = [&] {
    LiveScript s;
    s.vessel = right.vessels[0].place;
    return s;
  }();
  const auto mirrored_state = [&](std::int64_t n) {
    GripperState state = script.at(n);
    state.position[0] = -state.position[0];
    for (const int k : {1, 2, 3, 6}) state.rotation[k] = -state.rotation[k];
    return state;
  };
  const Seen a = watch(
      right, [&](std::int64_t n) { return script.at(n); }, 4000);
  const Seen b = watch(left, mirrored_state, 4000);
  for (std::size_t n = 0; n < a.views.size(); n += 25) {
    ASSERT_EQ(a.ticks[n].state, b.ticks[n].state);
    for (int j = 0; j < JOINT_COUNT; ++j) {
      Triple p = b.views[n].proxies[j];
      p[0] = -p[0];
      EXPECT_LT(distance_between(p, a.views[n].proxies[j]), 1e-9) << "joint " << j << " at tick " << n;
      EXPECT_EQ(a.views[n].contact[j], b.views[n].contact[j]) << j;
    }
  }
}

TEST(HandView, ASessionThatIsOverKeepsTheHandThatItHad) {
  const Scene scene = live_scene();
  const LiveScene live(scene);
  const Seen seen = watch_script(scene);
  for (std::size_t n = 0; n < seen.ticks.size(); n += 50) {
    if (!is_held(seen.ticks[n].state)) continue;
    Tick tick = seen.ticks[n];
    tick.state = SessionState::released;
    const HandView view = hand_view(live, tick, seen.poses[n]);
    for (int j = 0; j < JOINT_COUNT; ++j) EXPECT_EQ(view.proxies[j], seen.views[n].proxies[j]);
  }
}

// ---- liquid ----

// beaker1's cavity: radius 38.5 mm from 1.5 mm up.
constexpr double INNER = 38.5e-3, FLOOR = 1.5e-3;

std::optional<LiquidSurface> surface_in(const LiveScene& live, double volume, const Rotation& rotation) {
  return liquid_surface(live.vessels[0].vessel, live.quadrature, volume, rotation);
}

TEST(LiquidSurface, OfACylinderStandsAtItsVolumeOverTheFloor) {
  const LiveScene live(live_scene());
  for (const double volume : {1e-6, 100e-6, 400e-6}) {
    const double level = FLOOR + volume / (PI * INNER * INNER);
    const auto upright = surface_in(live, volume, NO_ROTATION);
    ASSERT_TRUE(upright);
    EXPECT_EQ(upright->up, (Triple{0, 1, 0}));
    EXPECT_NEAR(upright->level, level, 1e-9);
    if (volume < 50e-6) continue;
    // tilted so little that the plane cuts neither floor nor lip it goes through the same point of the axis
    for (const double tilt : {0.05, 0.2}) {
      const Rotation turn = product(turned('y', 1), turned('x', -tilt));
      const auto tilted = surface_in(live, volume, turn);
      ASSERT_TRUE(tilted);
      EXPECT_NEAR(tilted->level, level * std::cos(tilt), 1e-9);
      // up in the vessel's frame
      const Vec3 up = to_mat3(turn) * to_vec3(tilted->up);
      EXPECT_LT(glm::length(up - Vec3(0, 1, 0)), 1e-15);
    }
  }
}

TEST(LiquidSurface, IsAtTheLipWhereMoreIsInItThanThatHoldsBack) {
  const LiveScene live(live_scene());
  const double tilt = radians(70), most = live.vessels[0].vessel.capacity;
  const auto surface = surface_in(live, most, turned('x', -tilt));
  ASSERT_TRUE(surface);
  EXPECT_NEAR(surface->level, live.vessels[0].vessel.mouth_height * std::cos(tilt) - INNER * std::sin(tilt), 1e-9);
  EXPECT_FALSE(surface_in(live, 0, NO_ROTATION)) << "empty";
  EXPECT_FALSE(surface_in(live, most, turned('x', PI))) << "upside down it holds nothing";
}

TEST(PouringStream, FallsFromTheLipsLowestPoint) {
  const Scene scene = live_scene();
  const LiveScene live(scene);
  const Seen seen = watch_script(scene);
  int pouring = 0, into_target = 0;
  for (std::size_t n = 0; n < seen.ticks.size(); ++n) {
    const Tick& tick = seen.ticks[n];
    const auto stream = pouring_stream(live, tick, 0);
    ASSERT_EQ(stream.has_value(), tick.flow > 0) << n;
    if (!stream) continue;
    ++pouring;
    EXPECT_EQ(stream->flow, tick.flow);
    // no point of the mouth's circle is lower
    const core_f64::Vessel& glass = live.vessels[0].vessel;
    double lowest = 1;
    for (int k = 0; k < 720; ++k) {
      const double angle = k * PI / 360;
      const Vec3 rim(glass.mouth_radius * std::cos(angle), glass.mouth_height, glass.mouth_radius * std::sin(angle));
      lowest = std::min(lowest, (to_vec3(tick.vessel_place) + to_mat3(tick.vessel_rotation) * rim).y);
    }
    // half a degree of the circle at most beside it: r (1 - cos 0.25 deg)
    EXPECT_LE(stream->from[1], lowest + 1e-12);
    EXPECT_GT(stream->from[1], lowest - 1e-6);
    EXPECT_EQ(stream->from[0], stream->to[0]);
    EXPECT_EQ(stream->from[2], stream->to[2]);
    const Triple& mouth = scene.task->target_place;
    const bool hits = std::hypot(stream->to[0] - mouth[0], stream->to[2] - mouth[2]) <= 0.5 * scene.task->target_diameter;
    if (hits) ++into_target;
    const double level = target_volume(scene, tick) / (PI * 0.025 * 0.025);
    EXPECT_NEAR(stream->to[1], hits ? std::min(level, mouth[1]) : 0, 1e-12);
  }
  EXPECT_GT(pouring, 100);
  EXPECT_GT(into_target, 100);
}

TEST(TableHeight, IsUnderTheLowestVessel) {
  Scene scene = live_scene();
  EXPECT_EQ(table_height(scene), 0);
  scene.vessels[1].place[1] = -0.2;
  EXPECT_EQ(table_height(scene), -0.2);
  scene.vessels[1].base = -0.05;
  EXPECT_EQ(table_height(scene), -0.25);
}

}  // namespace
}  // namespace wholehand::device
