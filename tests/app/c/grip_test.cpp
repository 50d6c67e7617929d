// SPDX-License-Identifier: MIT
// One grip through the C face is what the core says of it, to the bit and member by member; and structs of other headers.
// sanitizers: address
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>

#include "app/c/scene.h"
#include "app/c/status.h"
#include "app/c/wholehand/wholehand.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "sweeps/grips/report.h"
#include "tests/app/c/expect_same.h"

namespace wholehand {
namespace {

using wholehand::expect_same;

void expect_same(const wh_grip_result& c, const GripResult& cpp, const GripScore& score) {
  EXPECT_STREQ(c.reason, "");
  EXPECT_EQ(c.is_feasible, 1);
  EXPECT_EQ(c.is_plausible, cpp.plausible ? 1 : 0);
  EXPECT_EQ(c.is_antipodal, cpp.antipodal ? 1 : 0);
  EXPECT_EQ(c.is_grazing, cpp.grazing ? 1 : 0);
  EXPECT_EQ(c.overlaps_itself, cpp.self_overlap ? 1 : 0);
  EXPECT_EQ(c.is_through_table, cpp.through_table ? 1 : 0);
  EXPECT_EQ(c.is_not_held, score.not_held ? 1 : 0);
  EXPECT_EQ(c.touch_mask, cpp.touch_mask);
  EXPECT_EQ(c.used_mask, cpp.used_mask);
  EXPECT_EQ(c.tip_mask, cpp.tip_mask);
  EXPECT_EQ(c.finger_mask, cpp.finger_mask);
  EXPECT_EQ(c.inner_mask, cpp.inner_mask);
  expect_same(c.closure, cpp.closure, "closure");
  expect_same(c.gap, cpp.gap, "gap");
  expect_same(c.thumb_angle, cpp.contact_angles[0], "thumb_angle");
  expect_same(c.index_angle, cpp.contact_angles[1], "index_angle");
  expect_same(c.midpoint, cpp.midpoint, "midpoint");
  for (std::size_t j = 0; j < WH_JOINTS; ++j) {
    expect_same(c.joints[j], cpp.joints[j], "joints");
    expect_same(c.posed[j], cpp.posed[j], "posed");
    expect_same(c.proxies[j], cpp.proxies[j], "proxies");
    expect_same(c.separation[j], cpp.separation[j], "separation");
  }
  expect_same(c.phalanx_depth, cpp.phalanx_depth, "phalanx_depth");
  expect_same(c.palm_depth, cpp.palm_depth, "palm_depth");
  expect_same(c.score, score.score, "score");
  const ScoreTerms& t = score.terms;
  expect_same(c.score_terms, std::array{t.fingers, t.contacts, t.depth, t.posture, t.force, t.hold}, "score_terms");
  EXPECT_EQ(c.is_beyond_wrist, cpp.beyond_wrist ? 1 : 0);
  expect_same(c.wrist_share, cpp.wrist_share, "wrist_share");
  expect_same(c.wrist_flexion, cpp.wrist_angles[0], "wrist_flexion");
  expect_same(c.wrist_deviation, cpp.wrist_angles[1], "wrist_deviation");
  expect_same(c.wrist_pronation, cpp.wrist_angles[2], "wrist_pronation");
}

void expect_same(const wh_grip_state& c, const sweeps::GripState& cpp, const sweeps::StateHold& hold) {
  expect_same(c.fill, cpp.fill, "fill");
  expect_same(c.tilt, cpp.tilt, "tilt");
  expect_same(c.liquid_volume, cpp.liquid.volume, "liquid_volume");
  expect_same(c.liquid_mass, cpp.liquid.mass, "liquid_mass");
  expect_same(c.poured, cpp.liquid.poured, "poured");
  expect_same(c.mass, cpp.state.mass, "mass");
  expect_same(c.center_of_mass, cpp.state.center_of_mass, "center_of_mass");
  expect_same(c.pivot_length, cpp.state.pivot_length, "pivot_length");
  expect_same(c.torque, cpp.state.torque, "torque");
  expect_same(c.exact_torque, cpp.state.exact_torque, "exact_torque");
  expect_same(c.normal_force, cpp.state.normal_force, "normal_force");
  expect_same(c.feedback_force, cpp.state.feedback_force, "feedback_force");
  expect_same(c.hold_force, cpp.state.hold_force, "hold_force");
  expect_same(c.effort, hold.effort, "effort");
  expect_same(c.effort_low, hold.low, "effort_low");
}

TEST(LibraryGrip, IsWhatTheCoreSays) {
  const Scene scene = read_scene_file(find_scene("three_beakers"));
  const std::shared_ptr<const Evaluator> core = make_core_evaluator(scene);
  wh_scene* handle = nullptr;
  ASSERT_EQ(wh_scene_open("three_beakers", &handle), WH_OK) << wh_message();
  const sweeps::GripMethods methods = sweeps::core_grip_methods(scene, core, "core");
  int feasible = 0;
  for (std::size_t vessel = 0; vessel < 3; ++vessel)
    for (const double height : {0.03, 0.05, 0.07, 0.09})
      for (const double roll : {-1.4, -0.6, 0.1}) {
        const GripInput input{height, 0.3, 0.05, roll, 0.002, 0.97};
        wh_grip grip;
        wh_grip_result result;
        wh_grip_state state;
        WH_INIT(&grip);
        WH_INIT(&result);
        WH_INIT(&state);
        std::memcpy(&grip.height, grip_numbers(input).data(), sizeof grip_numbers(input));
        ASSERT_EQ(wh_grip_evaluate(handle, vessel, &grip, &result), WH_OK) << wh_message();
        GripResult found;
        core->grip(vessel, input, found);
        EXPECT_EQ(result.is_feasible, found.reason == Reason::none ? 1 : 0);
        if (found.reason != Reason::none) continue;
        ++feasible;
        expect_same(result, found, core->score(vessel, input, found));
        sweeps::GripReport report = sweeps::make_grip_report(scene, vessel, input, {{0.5}, {1.1}}, methods);
        sweeps::add_holding(report, scene, vessel, *core);
        ASSERT_EQ(wh_grip_hold(handle, vessel, &grip, 0.5, 1.1, &state), WH_OK) << wh_message();
        expect_same(state, report.answer.states.at(0), report.holds.at(0));
        ASSERT_FALSE(HasFailure()) << "vessel " << vessel << ", height " << height << ", roll " << roll;
      }
  EXPECT_GT(feasible, 20);
  wh_scene_free(&handle);
}

// A struct that has grown by a member since the first header.
struct Grown {
  std::size_t size;
  double first, added;
};

}  // namespace

template <>
inline constexpr std::size_t FIRST_SIZE<Grown> = offsetof(Grown, added);

namespace {

TEST(LibraryStructs, OfAnEarlierHeaderAreTaken) {
  struct Earlier {
    std::size_t size;
    double first;
  } given{sizeof given, 7};
  Grown own;
  ASSERT_EQ(take_over(reinterpret_cast<const Grown*>(&given), own, "here"), WH_OK) << wh_message();
  EXPECT_EQ(own.size, sizeof own);
  EXPECT_EQ(own.first, 7);
  EXPECT_EQ(own.added, 0);
  // the answer writes what the earlier struct has, and nothing behind it
  struct {
    Earlier earlier;
    double behind;
  } room{{sizeof(Earlier), 0}, -1};
  auto* out = reinterpret_cast<Grown*>(&room.earlier);
  ASSERT_EQ(check_answer(out, "here"), WH_OK);
  give_back(Grown{sizeof(Grown), 3, 4}, out);
  EXPECT_EQ(room.earlier.size, sizeof(Earlier));
  EXPECT_EQ(room.earlier.first, 3);
  EXPECT_EQ(room.behind, -1);
}

TEST(LibraryStructs, OfOtherSizesAreRefused) {
  EXPECT_EQ(check_size(sizeof(Grown), 16, 24, "here"), WH_OK);
  EXPECT_EQ(check_size(16, 16, 24, "here"), WH_OK);
  for (const std::size_t size : {std::size_t{0}, std::size_t{8}, std::size_t{15}, std::size_t{20}}) {
    EXPECT_EQ(check_size(size, 16, 24, "here"), WH_ARGUMENT);
    EXPECT_EQ(std::string(wh_message()), "here is null, or its size is not set; WH_INIT sets it");
  }
  for (const std::size_t size : {std::size_t{25}, std::size_t{32}, SIZE_MAX}) {
    EXPECT_EQ(check_size(size, 16, 24, "here"), WH_ARGUMENT);
    EXPECT_NE(std::string(wh_message()).find("later header"), std::string::npos);
  }
}

}  // namespace
}  // namespace wholehand
