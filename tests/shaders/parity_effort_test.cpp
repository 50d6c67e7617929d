// SPDX-License-Identifier: MIT
// The effort kernel on a device against the core. Paths of pivots are not compared: what both say lies within the tolerances of both.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/fields.h"
#include "core/gather.h"
#include "host/grip_backend.h"
#include "host/turns.h"
#include "shaders/status.h"
#include "tests/support/scenes.h"
#include "tests/support/whole_parity.h"

namespace wholehand {
namespace {

// Tolerance of the term 1 / (1 + e), which is finite where an effort is not. Each side solves to half of the tolerance 1e-3 and skips
// states that are worse by up to another half; a single state's effort has all of it: together 2e-3 of e, times the term's slope
// 1 / (1 + e)^2. In float, contacts differ by up to 1e-6 m on arms of 5 mm and more, on both sides: another 4e-4 of e.
double term_tolerance(Precision precision, double effort) {
  const double share = precision == Precision::single ? 2.4e-3 : 2e-3;
  return std::isfinite(effort) ? share * effort / ((1 + effort) * (1 + effort)) : 0;
}

double term_of(double effort) { return 1 / (1 + effort); }

const std::vector<int> KEPT{FIELD_WORST_EFFORT,
                            FIELD_WORST_EFFORT_FILL,
                            FIELD_WORST_EFFORT_TILT,
                            FIELD_TIPS_WORST_EFFORT,
                            FIELD_PUSH,
                            FIELD_FRICTION_NEEDED,
                            FIELD_SAFE_TILT,
                            FIELD_EFFORT,
                            FIELD_SCORE,
                            FIELD_TERMS,
                            FIELD_STATUS,
                            FIELD_TOUCH_MASK};

Scene strong_scene(std::vector<VesselData> vessels, const HandData& hand = paper_hand()) {
  Scene scene = wet_scene(std::move(vessels), Pose::articulated, hand);
  scene.strength = StrengthData{};
  scene.hand.depth_limit = 20e-3;  // most grips are plausible
  scene.force.max = 1e3;           // a safe tilt is up to the effort alone
  return scene;
}

struct Compared {
  int grips = 0, outside = 0, infinite = 0, beyond = 0;  // beyond: with a worst effort above 1
  double worst = 0;
};

// Whether the core's effort of a state is as near to 1 as both sides may be off.
bool is_near_one(double effort) { return std::abs(effort - 1) <= 3e-3; }

// A push is 1 / an effort, to the same tolerance. In float the contacts' places move the limit of what is held, weight and push together.
bool is_same_push(double a, double b, double weight, Precision precision) {
  return std::abs(a - b) <= (precision == Precision::single ? 2.4e-3 * (std::max(a, b) + weight) : 2e-3 * std::max(a, b));
}

// Each side ends up to a step of 1e-3 above a certified bound, and at an effort within 1e-3 of 1. The friction goes with the effort at
// least as its inverse where friction is what limits a hold.
bool is_same_friction(double a, double b) { return a == b || std::abs(a - b) <= 1e-3 + 2.4e-3 * std::max(a, b); }

// A grip's numbers by the device and by the core.
struct Sides {
  const Scene& scene;
  const FieldSet& fields;
  const GatheredPlanes &device, &truth;
  std::size_t i;
  double on_device(int field, int k = 0) const { return device.real(fields.plane[field] + k, i); }
  double on_core(int field, int k = 0) const { return truth.real(fields.plane[field] + k, i); }
};

// Whether the first tilt that one of them calls unsafe is so by another effort than 1, at any fill.
bool differ_in_safe_tilt(const Sides& grip) {
  const std::vector<double>& tilts = grip.scene.tilts;
  bool do_differ = false;
  for (int fill = 0; fill < static_cast<int>(scene_fills(grip.scene)); ++fill) {
    const double a = grip.on_device(FIELD_SAFE_TILT, fill), b = grip.on_core(FIELD_SAFE_TILT, fill);
    if ((std::isnan(a) && std::isnan(b)) || std::abs(a - b) <= 1e-6) continue;
    const double lower = std::isnan(a) || std::isnan(b) ? -1 : std::min(a, b);
    const auto tilt = std::upper_bound(tilts.begin(), tilts.end(), lower + 1e-6) - tilts.begin();
    const int state = fill * static_cast<int>(tilts.size()) + static_cast<int>(tilt);
    do_differ = do_differ || !is_near_one(grip.on_core(FIELD_EFFORT, state));
  }
  return do_differ;
}

// The state that the device names as the worst; -1, and a failure, if it names none of the scene's.
int named_state(const Sides& grip, const std::string& which) {
  const std::vector<double>& tilts = grip.scene.tilts;
  const double named = grip.on_device(FIELD_WORST_EFFORT_TILT), fraction = grip.on_device(FIELD_WORST_EFFORT_FILL);
  const auto tilt = std::find_if(tilts.begin(), tilts.end(), [&](double t) { return std::abs(t - named) < 1e-6; });
  if (tilt == tilts.end()) {
    ADD_FAILURE() << which << ": " << named;
    return -1;
  }
  const std::vector<double> fills = grip.scene.liquid ? grip.scene.liquid->fills : std::vector<double>{fraction};
  const auto fill = std::find_if(fills.begin(), fills.end(), [&](double f) { return std::abs(f - fraction) < 1e-6; });
  if (fill == fills.end()) {
    ADD_FAILURE() << which << ": fill " << fraction;
    return -1;
  }
  return static_cast<int>(fill - fills.begin()) * static_cast<int>(tilts.size()) + static_cast<int>(tilt - tilts.begin());
}

// Each side says itself whether the vessel is held.
void expect_held_as_efforts_say(const Sides& grip, const std::string& which) {
  for (const GatheredPlanes* side : {&grip.device, &grip.truth}) {
    const auto real = [&](int field) { return side->real(grip.fields.plane[field], grip.i); };
    const bool is_not_held = (side->uint(FIELD_STATUS, grip.i) & STATUS_NOT_HELD) != 0;
    EXPECT_EQ(is_not_held, real(FIELD_WORST_EFFORT) > 1) << which;  // not of NaN
    if (is_plausible(side->uint(FIELD_STATUS, grip.i))) {
      EXPECT_EQ(is_not_held, real(FIELD_SCORE) == 0) << which;
    }
  }
}

void compare_grip(const Sides& grip, double weight, Precision precision, const std::string& which, Compared& all) {
  // another contact is another question; the difference of two efforts shows which side of 1 they lie on
  const std::uint32_t other = grip.device.uint(FIELD_STATUS, grip.i) ^ grip.truth.uint(FIELD_STATUS, grip.i);
  if ((other & ~std::uint32_t(STATUS_NOT_HELD)) != 0) return;
  if (grip.device.uint(FIELD_TOUCH_MASK, grip.i) != grip.truth.uint(FIELD_TOUCH_MASK, grip.i)) return;
  const double worst = grip.on_core(FIELD_WORST_EFFORT);
  bool is_outside = false;
  if (!std::isnan(worst)) {
    is_outside = !is_same_push(grip.on_device(FIELD_PUSH), grip.on_core(FIELD_PUSH), weight, precision) ||
                 !is_same_friction(grip.on_device(FIELD_FRICTION_NEEDED), grip.on_core(FIELD_FRICTION_NEEDED));
  }
  for (const int field : {FIELD_WORST_EFFORT, FIELD_TIPS_WORST_EFFORT}) {
    const double a = grip.on_device(field), b = grip.on_core(field);
    EXPECT_EQ(std::isnan(a), std::isnan(b)) << which;
    if (std::isnan(a) || std::isnan(b)) continue;
    const double difference = std::abs(term_of(a) - term_of(b));
    is_outside = is_outside || difference > term_tolerance(precision, b);
    all.worst = std::max(all.worst, difference);
  }
  is_outside = differ_in_safe_tilt(grip) || is_outside;
  expect_held_as_efforts_say(grip, which);
  if (std::isnan(worst)) return;
  // both name a state, whose effort is the worst but for what they pass by
  const int state = named_state(grip, which);
  if (state < 0) return;
  is_outside =
      is_outside || std::abs(term_of(grip.on_core(FIELD_EFFORT, state)) - term_of(worst)) > term_tolerance(precision, worst);
  EXPECT_NEAR(grip.on_device(FIELD_TERMS, 5), term_of(grip.on_device(FIELD_WORST_EFFORT)), 1e-6) << which;
  ++all.grips;
  all.outside += is_outside ? 1 : 0;
  all.infinite += std::isinf(worst) ? 1 : 0;
  all.beyond += worst > 1 ? 1 : 0;
}

Compared compare_efforts(const Scene& scene, Precision precision, int count, const std::string& name) {
  const FieldSet fields = make_field_set(KEPT, scene);
  const auto backend = backend_of(scene, fields, precision);
  const auto core = core_of(scene, precision);
  Compared all;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const auto grips = grips_of(scene, v, count);
    const GatheredPlanes device = gather(*backend, v, grips), truth = gather(*core, fields, v, grips);
    const double weight = core->constants(v).largest_mass * scene.gravity;
    for (std::size_t i = 0; i < grips.size(); ++i) {
      const std::string which = name + " vessel " + std::to_string(v) + " grip " + std::to_string(i);
      compare_grip({scene, fields, device, truth, i}, weight, precision, which, all);
    }
  }
  testing::Test::RecordProperty(name, std::to_string(all.grips) + " grips, " + std::to_string(all.worst));
  return all;
}

// In float a contact at the limit of what holds may take an effort or none: of a hundred grips one at most. Answers the last comparison,
// which is in double.
Compared expect_same_efforts(const Scene& scene, const std::string& name, int count = COUNT) {
  Compared all;
  for (const Precision precision : {Precision::single, Precision::full}) {
    all = compare_efforts(scene, precision, count, name + (precision == Precision::single ? "_float" : "_double"));
    EXPECT_GT(all.grips, count / 10) << name << ": too few plausible grips to tell anything";
    EXPECT_LE(100 * all.outside, precision == Precision::single ? all.grips : 0)
        << name << ": " << all.outside << " of " << all.grips << ", worst " << all.worst;
  }
  return all;
}

TEST(ParityEffort, OfWetVessels) { expect_same_efforts(strong_scene({beaker1(), beaker2(), beaker3(), vase()}), "wet"); }

TEST(ParityEffort, OfALeftHandAndACenterOffTheAxis) {
  expect_same_efforts(strong_scene({lopsided(), beaker2()}, left_hand()), "left");
}

TEST(ParityEffort, OfWeakHandsThatLetGo) {
  Scene scene = strong_scene({beaker1(), beaker3()});
  for (double& digit : scene.strength->digits) digit *= 0.1;
  scene.tilts = linspace(0, PI, 13);
  const Compared all = expect_same_efforts(scene, "weak");
  EXPECT_GT(all.beyond, all.infinite);  // else no safe tilt was searched for
}

// More states than a block of the kernel holds, and states that are left out.
TEST(ParityEffort, OfManyStates) {
  Scene scene = strong_scene({beaker2()});
  for (double& digit : scene.strength->digits) digit *= 0.1;
  scene.tilts = linspace(0, PI, 300);
  scene.until_poured = 0.5;
  expect_same_efforts(scene, "many", 60);
}

TEST(ParityEffort, TheDeviceChoosesNoGripThatDoesNotHold) {
  Scene scene = strong_scene({beaker1()});
  for (double& digit : scene.strength->digits) digit *= 0.05;
  const auto grips = grips_of(scene, 0, COUNT);
  for (const Precision precision : {Precision::single, Precision::full}) {
    const FieldSet fields = make_field_set({FIELD_STATUS}, scene);
    const auto backend = backend_of(scene, fields, precision);
    const GatheredPlanes planes = gather(*backend, 0, grips);
    std::size_t held = 0, not_held = 0;
    for (std::size_t i = 0; i < grips.size(); ++i) {
      held += is_eligible(planes.uint(FIELD_STATUS, i)) ? 1 : 0;
      not_held += is_plausible(planes.uint(FIELD_STATUS, i)) && !is_eligible(planes.uint(FIELD_STATUS, i)) ? 1 : 0;
    }
    EXPECT_GT(not_held, 20u);
    EXPECT_LT(held, std::size_t{host::SELECT_LARGEST});
    RunRequest request;
    request.last = grips.size();
    request.best = host::SELECT_LARGEST;  // room for more than hold
    request.grips = [&](std::size_t, std::uint64_t first, std::size_t count, GripInput* out) {
      std::copy_n(grips.begin() + static_cast<std::ptrdiff_t>(first), count, out);
    };
    const std::vector<Candidate> best = backend->run(request).best;
    EXPECT_EQ(best.size(), held);
    for (const Candidate& one : best) EXPECT_TRUE(is_eligible(planes.uint(FIELD_STATUS, one.index)));
  }
}

// Spheres between joints hold some of these grips.
TEST(ParityEffort, OfAHandWithSpheresBetweenItsJoints) {
  for (const int between : {2, 5}) {
    Scene scene = strong_scene({beaker1(), beaker3()});
    scene.hand.between = between;
    const auto core = make_core_evaluator(scene);
    int pressing = 0;
    for (const GripInput& grip : grips_of(scene, 0, 40)) {
      GripResult result;
      core->grip(0, grip, result);
      if (!result.plausible) continue;
      for (const GripContact& contact : core->contacts(0, result)) pressing += contact.between > 0;
    }
    EXPECT_GT(pressing, 20);
    expect_same_efforts(scene, "between" + std::to_string(between), 100);
  }
}

TEST(ParityEffort, OfDryVessels) {
  Scene scene = strong_scene({beaker1()});
  scene.liquid.reset();
  expect_same_efforts(scene, "dry");
}

TEST(ParityEffort, WithoutGravityNothingIsNeeded) {
  Scene scene = strong_scene({beaker1()});
  scene.gravity = 0;
  expect_same_efforts(scene, "weightless");
}

}  // namespace
}  // namespace wholehand
