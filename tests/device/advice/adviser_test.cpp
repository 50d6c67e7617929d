// SPDX-License-Identifier: MIT
// Advised grips are better by the core, within reach, for the actual liquid, and the same for the same question.
// sanitizers: address
#include "device/advice/adviser.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/text/error.h"
#include "core/core_backend.h"
#include "core/mirror.h"
#include "core/vectors.h"
#include "device/advice/cloud.h"
#include "tests/support/scenes.h"

namespace wholehand::device {
namespace {

Scene advised_scene(const VesselData& vessel = beaker1()) {
  Scene scene = scene_of({vessel});
  scene.strength = StrengthData{};
  scene.table = TableData{};
  scene.liquid = LiquidData{};
  scene.liquid->fills = {0, 1};
  scene.tilts = {0, radians(30), radians(60), radians(90), radians(120), radians(150)};
  scene.vessels[0].liquid_fill = 0.6;
  return scene;
}

// A grip near the top, far from the best one.
AdviceQuestion high_grip(const Scene& scene, double fill) {
  AdviceQuestion question;
  question.grip.height = 0.095;
  question.grip.roll = radians(-20);
  question.volume = fill * make_core_evaluator(scene)->capacity(0);
  return question;
}

// The worst effort by an evaluator of its own, over the states of the scene that is advised about: no code of the adviser's.
double effort_by_core(const Scene& scene, const GripInput& grip, double fill) {
  Scene own = scene;
  own.liquid->fills = {fill};
  own.until_poured = 0.95;
  const auto core = make_core_evaluator(own);
  const FieldSet fields = make_field_set({FIELD_WORST_EFFORT, FIELD_STATUS}, own);
  std::vector<double> reals(static_cast<std::size_t>(fields.real_planes));
  std::vector<std::uint32_t> uints(static_cast<std::size_t>(fields.uint_planes));
  core->planes(0, &grip, 1, fields, 1, reals.data(), uints.data());
  return reals[static_cast<std::size_t>(fields.plane[FIELD_WORST_EFFORT])];
}

class AdviserOn : public testing::TestWithParam<const char*> {};

TEST_P(AdviserOn, TheAdvisedGripIsBetterByTheCore) {
  const Scene scene = advised_scene();
  Adviser adviser(scene, GetParam(), 1);
  const AdviceQuestion question = high_grip(scene, 0.6);
  const Advice advice = adviser.advise(question, STEP_CLOUD);
  ASSERT_TRUE(advice.best && advice.is_better);
  EXPECT_EQ(advice.grips, STEP_CLOUD);
  ASSERT_TRUE(advice.present.is_possible);
  EXPECT_EQ(advice.best->effort, effort_by_core(scene, advice.best->grip, 0.6));
  EXPECT_EQ(advice.present.effort, effort_by_core(scene, question.grip, 0.6));
  EXPECT_LT(advice.best->effort, 0.95 * advice.present.effort);
  GripResult posed;
  make_core_evaluator(scene)->grip(0, advice.best->grip, posed);
  EXPECT_TRUE(posed.plausible);
  EXPECT_EQ(advice.posed.posed, posed.posed);
  EXPECT_TRUE(reach_of(scene.vessels[0], question.grip).has(advice.best->grip));
}

TEST_P(AdviserOn, FollowsTheLiquidWithoutBeingOpenedAgain) {
  const Scene scene = advised_scene();
  Adviser adviser(scene, GetParam(), 1);
  const double rounding = 1e-12;  // of a fill that has been a volume
  for (const double fill : {0.6, 0.3, 0.0, 0.6}) {
    const Advice advice = adviser.advise(high_grip(scene, fill), STEP_CLOUD);
    ASSERT_TRUE(advice.best) << fill;
    EXPECT_EQ(advice.volume, high_grip(scene, fill).volume);
    EXPECT_NEAR(advice.best->effort, effort_by_core(scene, advice.best->grip, fill), rounding) << fill;
    EXPECT_NEAR(advice.present.effort, effort_by_core(scene, advice.present.grip, fill), rounding) << fill;
  }
}

TEST_P(AdviserOn, TheSameQuestionsHaveTheSameAnswers) {
  const Scene scene = advised_scene();
  std::vector<GripInput> first;
  for (int run = 0; run < 2; ++run) {
    Adviser adviser(scene, GetParam(), run + 1);
    for (int k = 0; k < 4; ++k) {
      const Advice advice = adviser.advise(high_grip(scene, 0.6 - 0.1 * k), 256);
      ASSERT_TRUE(advice.best);
      if (run == 0) {
        first.push_back(advice.best->grip);
      } else {
        EXPECT_EQ(advice.best->grip.height, first[static_cast<std::size_t>(k)].height);
        EXPECT_EQ(advice.best->grip.roll, first[static_cast<std::size_t>(k)].roll);
      }
    }
  }
}

// A session has no rules about the table or the depth limit: it holds the vessel with a hand that closes through the table or too deep, and the
// advice states this effort. The grips advised for a standing vessel keep these rules; a held vessel has left the table.
TEST_P(AdviserOn, ASweepsRulesAreForWhatIsAdvisedAlone) {
  Scene scene = advised_scene();
  scene.hand.depth_limit = 3e-3;
  Scene bare = scene;
  bare.table.reset();
  Scene lenient = bare;
  lenient.hand.depth_limit = 1;
  const auto core = make_core_evaluator(scene);
  const auto result_of = [&](const GripInput& grip) {
    GripResult result;
    core->grip(0, grip, result);
    return result;
  };
  AdviceQuestion low = high_grip(scene, 0.6), deep = low;
  low.grip.height = 0.03;
  low.grip.roll = radians(20);
  deep.grip.height = 0.045;
  deep.grip.roll = radians(-60);
  ASSERT_TRUE(result_of(low.grip).through_table);
  ASSERT_GT(result_of(deep.grip).phalanx_depth, scene.hand.depth_limit);
  for (AdviceQuestion question : {low, deep}) {
    const double effort = effort_by_core(lenient, question.grip, 0.6);
    ASSERT_LE(effort, 1);
    for (const bool is_held : {false, true}) {
      question.is_held = is_held;
      Adviser adviser(scene, GetParam(), 1), without(bare, GetParam(), 1);
      const Advice advice = adviser.advise(question, STEP_CLOUD), right = without.advise(question, STEP_CLOUD);
      EXPECT_TRUE(advice.present.is_possible);
      EXPECT_EQ(advice.present.effort, effort);
      ASSERT_TRUE(advice.best && right.best);
      if (is_held) {
        EXPECT_LT(way_between(advice.best->grip, right.best->grip), 1e-9);
      } else {
        EXPECT_EQ(advice.is_better, result_of(advice.best->grip).plausible) << "else it is the hand's own";
      }
    }
  }
  Adviser bare_adviser(bare, GetParam(), 1);
  EXPECT_TRUE(result_of(bare_adviser.advise(low, STEP_CLOUD).best->grip).through_table) << "it would be the best one";
}

// Only the present grip is possible, and it goes through the table: the advice keeps it.
TEST(Adviser, TheOnlyGripIsGood) {
  Scene scene = advised_scene();
  scene.table->clearance = 0.1;  // no hand keeps above it
  AdviceQuestion question = high_grip(scene, 0.6);
  Adviser adviser(scene, "core", 1);
  const Advice advice = adviser.advise(question, LEAST_CLOUD);
  ASSERT_TRUE(advice.best && advice.present.is_possible);
  EXPECT_FALSE(advice.is_better);
  EXPECT_EQ(way_between(advice.best->grip, question.grip), 0);
  question.grip.height = 0.3;  // over the vessel
  const Advice none = adviser.advise(question, LEAST_CLOUD);
  EXPECT_FALSE(none.best || none.present.is_possible);
}

INSTANTIATE_TEST_SUITE_P(Adviser, AdviserOn, testing::Values("core", "vulkan"));

// A hand that stays gets one answer: it stands until another is clearly better, and never gets worse by more than that. The
// hand trembles about the axis, which changes nothing on a beaker.
TEST(Adviser, Settles) {
  const Scene scene = advised_scene();
  Adviser adviser(scene, "core", 1);
  int changes = 0;
  GripInput before;
  for (int k = 0; k < 12; ++k) {
    AdviceQuestion question = high_grip(scene, 0.6);
    question.grip.azimuth = radians(k % 3 * 0.05);
    const Advice advice = adviser.advise(question, STEP_CLOUD);
    ASSERT_TRUE(advice.best);
    before.azimuth = advice.best->grip.azimuth;
    EXPECT_EQ(before.azimuth, question.grip.azimuth);
    if (k >= 6 && way_between(before, advice.best->grip) > 0) ++changes;
    before = advice.best->grip;
  }
  EXPECT_LE(changes, 1);
}

// Among equally good grips, the advice takes the one nearest to a hand that has come in, however far beside the vessel the hand
// still is.
TEST(Adviser, AHandBesideTheVesselIsAdvisedAsOneThatHasComeIn) {
  const Scene scene = advised_scene();
  Adviser beside(scene, "core", 1), in(scene, "core", 1);
  AdviceQuestion question = high_grip(scene, 0.6);
  for (const double offset : {0.15, -0.12, 0.1}) {
    question.grip.offset = 0;
    const Advice right = in.advise(question, STEP_CLOUD);
    question.grip.offset = offset;
    const Advice advice = beside.advise(question, STEP_CLOUD);
    ASSERT_TRUE(advice.best && right.best);
    EXPECT_EQ(way_between(advice.best->grip, right.best->grip), 0) << offset;
  }
}

// The advice to a hand that has gone to the advised grip is to stay.
TEST(Adviser, AGripThatIsGoodNeedsNoOther) {
  const Scene scene = advised_scene();
  Adviser adviser(scene, "core", 1);
  AdviceQuestion question = high_grip(scene, 0.6);
  bool is_there = false;
  for (int k = 0; k < 10 && !is_there; ++k) {
    const Advice advice = adviser.advise(question, MOST_CLOUD);
    ASSERT_TRUE(advice.best);
    is_there = !advice.is_better;
    question.grip = advice.best->grip;
  }
  EXPECT_TRUE(is_there);
}

// For a user who can follow no other line: the advised grip neither turns about the axis nor moves off it, although on this vessel
// that would be better.
TEST(Adviser, KeepsTheLineOfWhoAsksForIt) {
  const Scene scene = advised_scene(lopsided());
  AdviceQuestion question = high_grip(scene, 0.6);
  question.grip.azimuth = 0.3;
  for (const bool keeps_line : {false, true}) {
    Adviser adviser(scene, "core", 1);
    question.keeps_line = keeps_line;
    const Advice advice = adviser.advise(question, STEP_CLOUD);
    ASSERT_TRUE(advice.best && advice.is_better);
    EXPECT_EQ(advice.best->grip.offset == 0, keeps_line);
    EXPECT_EQ(advice.best->grip.azimuth == question.grip.azimuth, keeps_line);
  }
}

// A left hand in the mirrored place has the same grip: the six numbers are those of the scene, and so are the joints of the ghost.
TEST_P(AdviserOn, ALeftHandIsAdvisedInTheWorldOfTheScene) {
  Scene scene = advised_scene();
  scene.hand.handedness = Handedness::left;
  Adviser adviser(scene, GetParam(), 1);
  AdviceQuestion question = high_grip(scene, 0.6);
  question.grip = mirrored(question.grip, Handedness::left);
  const Advice advice = adviser.advise(question, STEP_CLOUD);
  ASSERT_TRUE(advice.best && advice.is_better && advice.present.is_possible);
  EXPECT_EQ(advice.best->effort, effort_by_core(scene, advice.best->grip, 0.6));
  const Scene right = advised_scene();
  const double rounding = 1e-9;  // of an azimuth that is pi less itself
  EXPECT_NEAR(advice.present.effort, effort_by_core(right, high_grip(right, 0.6).grip, 0.6), rounding);
  EXPECT_NEAR(advice.best->effort, effort_by_core(right, mirrored(advice.best->grip, Handedness::left), 0.6), rounding);
  GripResult posed;
  make_core_evaluator(right)->grip(0, mirrored(advice.best->grip, Handedness::left), posed);
  for (std::size_t j = 0; j < posed.posed.size(); ++j)
    EXPECT_LT(distance(advice.posed.posed[j], mirrored(posed.posed[j], Handedness::left)), 1e-9) << j;
}

// The core behind a backend that does not take other fills, because its device is lost or never does.
class FixedBackend final : public Backend {
 public:
  FixedBackend(const Scene& scene, const FieldSet& fields, bool is_lost)
      : core_(make_core_evaluator(scene), scene, fields, Precision::full, 1), is_lost_(is_lost) {
    info_ = core_.info();
    info_.backend = "fixed";
  }
  const BackendInfo& info() const override { return info_; }
  const FieldSet& fields() const override { return core_.fields(); }
  RunResult run(const RunRequest& request) override { return core_.run(request); }
  std::vector<LiquidResult> liquid(std::size_t vessel) override { return core_.liquid(vessel); }
  bool use_fills_of(const Scene& /*other*/) override {
    if (is_lost_) throw failure_error("device lost");
    return false;
  }

 private:
  CoreBackend core_;
  BackendInfo info_;
  bool is_lost_;
};

// The device's grips would have another liquid than the grips that the core rates. So the core takes over, with one line.
TEST(Adviser, ADeviceThatDoesNotTakeOtherLiquidGivesWayToTheCore) {
  const Scene scene = advised_scene();
  for (const bool is_lost : {false, true}) {
    Adviser adviser(scene, [is_lost](const Scene& own, const FieldSet& fields) -> std::unique_ptr<Backend> {
      return std::make_unique<FixedBackend>(own, fields, is_lost);
    });
    Adviser core(scene, "core", 1);
    ASSERT_TRUE(adviser.place().starts_with("fixed"));
    for (const double fill : {0.6, 0.3, 0.2}) {
      const Advice advice = adviser.advise(high_grip(scene, fill), LEAST_CLOUD),
                   right = core.advise(high_grip(scene, fill), LEAST_CLOUD);
      ASSERT_TRUE(advice.best && right.best);
      // a warm-up has taken no turn of the cloud
      EXPECT_EQ(way_between(advice.best->grip, right.best->grip), 0) << fill;
      EXPECT_EQ(advice.best->effort, right.best->effort);
    }
    EXPECT_TRUE(adviser.place().starts_with("core")) << adviser.place();
    const std::string why = is_lost ? "device lost" : "the device does not take the liquid that is left";
    EXPECT_EQ(adviser.notes(), std::vector<std::string>{why + "; the core goes on"});
  }
}

TEST(Adviser, RefusesASceneWithoutStrength) {
  Scene scene = advised_scene();
  scene.strength.reset();
  try {
    Adviser adviser(scene, "core", 1);
    FAIL() << "it was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("[strength]"), std::string::npos);
  }
  EXPECT_THROW(Adviser(advised_scene(), "no such device", 1), Error);
}

TEST(AdviceScene, HasTiltsWhereTheSceneHasNone) {
  Scene scene = advised_scene();
  scene.tilts.clear();
  const Scene own = advice_scene(scene);
  ASSERT_EQ(own.tilts.size(), 16u);
  EXPECT_NEAR(own.tilts.back(), radians(150), 1e-12);
  EXPECT_EQ(own.vessels[0].fills, std::vector<double>{0.6});
}

}  // namespace
}  // namespace wholehand::device
