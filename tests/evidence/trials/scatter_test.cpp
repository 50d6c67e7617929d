// SPDX-License-Identifier: MIT
// Grips placed with the deviations of [robust].
// sanitizers: address
#include "evidence/trials/scatter.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/numbers/normal.h"
#include "core/core_backend.h"
#include "evidence/trials/tried.h"
#include "sweeps/plan/plan.h"
#include "tests/support/fake_trials.h"
#include "tests/support/xml.h"

namespace wholehand {
namespace {

constexpr std::size_t PLACEMENTS = 128;

// Upright and tilted, in an order of effort.
std::vector<TrialCase> two_cases() {
  std::vector<TrialCase> cases(2);
  for (TrialCase& one : cases) one.fill = 1;
  cases[1].tilt = radians(60);
  return cases;
}

// Says of each case what it is given, whatever the grip.
class ScriptedEngine : public TrialEngine {
 public:
  explicit ScriptedEngine(std::vector<TrialReason> reasons) : reasons_(std::move(reasons)) {}
  std::string name() const override { return "scripted"; }
  std::vector<TrialOutcome> run(std::size_t, const GripInput&, const std::vector<TrialCase>&,
                                std::vector<TrialTrack>*) const override {
    std::vector<TrialOutcome> outcomes;
    for (const TrialReason reason : reasons_) {
      TrialOutcome& one = outcomes.emplace_back();
      one.reason = reason;
      one.discarded = is_discarded(reason);
      one.held = reason == TrialReason::none;
    }
    return outcomes;
  }

 private:
  std::vector<TrialReason> reasons_;
};

class Scatter : public testing::Test {
 protected:
  Scene scene = scene_for_trials();
  void SetUp() override { scene.robust.emplace(); }

  // The stand-in without luck: what it holds hangs on the effort of the place alone.
  GripScatter by_effort() const {
    return {scene, {}, open_fake_engine([](FakeTrialEngine& engine) { engine.spread = 0; })};
  }

  std::size_t held_of(const std::vector<Placement>& placements) const {
    return static_cast<std::size_t>(
        std::count_if(placements.begin(), placements.end(), [](const Placement& one) { return one.held; }));
  }

  // Feasible, plausible grips of a vessel.
  std::vector<TrialGrip> grips_of(std::size_t vessel) const {
    const sweeps::Plan plan(scene, false);
    const auto core = make_core_evaluator(scene);
    std::vector<TrialGrip> grips;
    for (std::uint64_t number = 0; number < plan.grips(); ++number) {
      GripResult found;
      core->grip(vessel, plan.grip(vessel, number), found);
      if (found.reason == Reason::none && found.plausible) grips.push_back({vessel, number, plan.grip(vessel, number)});
    }
    return grips;
  }
};

TEST_F(Scatter, WithTinyDeviationsEveryPlacementIsTheGripItself) {
  scene.robust->height = 1e-12;
  scene.robust->roll = 1e-12;
  const GripScatter scatter = by_effort();
  FakeTrialEngine engine(scene);
  engine.spread = 0;
  std::array<int, 2> seen{};
  for (const TrialGrip& grip : grips_of(1)) {
    const auto outcomes = engine.run(grip.vessel, grip.grip, two_cases(), nullptr);
    const bool holds = std::all_of(outcomes.begin(), outcomes.end(), [](const TrialOutcome& one) { return one.held; });
    ++seen[holds ? 1 : 0];
    EXPECT_EQ(held_of(scatter.place(grip, two_cases(), 16, 1)), holds ? 16u : 0u) << grip.number;
  }
  EXPECT_GT(seen[0], 0);
  EXPECT_GT(seen[1], 0);
}

// A height of which some deviations miss the vessel, or take more than the hand has: the share is that of the normal distribution, here
// asked at the middles of many equally likely parts.
TEST_F(Scatter, TheShareOfAMarginalGripIsThatOfItsDistribution) {
  scene.robust->height = 15e-3;
  const GripScatter scatter = by_effort();
  const auto core = make_core_evaluator(scene);
  FakeTrialEngine engine(scene);
  engine.spread = 0;
  std::size_t marginal = 0;
  const std::vector<TrialGrip> grips = grips_of(0);
  for (std::size_t g = 0; g < grips.size(); g += 3) {
    const TrialGrip& grip = grips[g];
    constexpr int PARTS = 100;
    int held = 0, impossible = 0;
    for (int k = 0; k < PARTS; ++k) {
      GripInput moved = grip.grip;
      moved.height += 15e-3 * normal_quantile((k + 0.5) / PARTS);
      GripResult found;
      core->grip(grip.vessel, moved, found);
      if (found.reason != Reason::none || !found.plausible) {
        ++impossible;
        continue;
      }
      const auto outcomes = engine.run(grip.vessel, moved, two_cases(), nullptr);
      held += std::all_of(outcomes.begin(), outcomes.end(), [](const TrialOutcome& one) { return one.held; }) ? 1 : 0;
    }
    PlacementCount count;
    count.add(scatter.place(grip, two_cases(), PLACEMENTS, 1));
    EXPECT_EQ(count.all, PLACEMENTS);
    EXPECT_NEAR(static_cast<double>(count.held) / PLACEMENTS, static_cast<double>(held) / PARTS, 0.03) << grip.number;
    EXPECT_NEAR(static_cast<double>(count.impossible) / PLACEMENTS, static_cast<double>(impossible) / PARTS, 0.03) << grip.number;
    marginal += impossible > PARTS / 20 && held > PARTS / 20 ? 1 : 0;
  }
  EXPECT_GT(marginal, 1u) << "else it shows little";
}

TEST_F(Scatter, EachGripHasItsOwnDeviationsAndTheSeedRepeats) {
  scene.robust->height = 15e-3;
  const GripScatter scatter = by_effort();
  TrialGrip grip;
  const auto pattern = [&](std::uint64_t seed) {
    std::string text;
    for (const Placement& one : scatter.place(grip, two_cases(), 64, seed)) text += one.is_possible ? (one.held ? '+' : '-') : '.';
    return text;
  };
  std::string first;
  for (const TrialGrip& one : grips_of(0)) {
    grip = one;
    first = pattern(1);
    if (count_of(first, ".") > 8 && count_of(first, "+") > 8) break;
  }
  EXPECT_EQ(pattern(1), first);
  EXPECT_NE(pattern(2), first);
  ++grip.number;
  EXPECT_NE(pattern(1), first);
}

TEST_F(Scatter, OneCaseThatIsNotHeldIsEnough) {
  scene.robust->height = 1e-9;
  const TrialGrip grip = grips_of(0).front();
  const auto outcome_of = [&](const std::vector<TrialReason>& reasons) {
    const GripScatter scatter(
        scene, {}, [&](const Scene&, const Evaluator&, const TrialSettings&) { return std::make_unique<ScriptedEngine>(reasons); });
    return scatter.place(grip, two_cases(), 1, 1).front();
  };
  using enum TrialReason;
  EXPECT_TRUE(outcome_of({none, none}).held);
  EXPECT_FALSE(outcome_of({none, moved}).held);
  EXPECT_EQ(outcome_of({turned, moved}).reason, turned) << "the first";
  EXPECT_EQ(outcome_of({turned, buried}).reason, buried) << "a discarded one says more";
  EXPECT_EQ(outcome_of({overlap, buried}).reason, overlap);
  EXPECT_FALSE(outcome_of({overlap, none}).held);
}

// The robust score of a grip is the one by which a sweep ranks it, of deviations of friction too.
TEST_F(Scatter, RobustScoresAreThoseOfASweep) {
  scene.robust->height = 5e-3;
  scene.robust->roll = radians(10);
  scene.robust->friction = 0.1;
  scene.robust->hand_scale = 0.03;
  const sweeps::Plan plan(scene, false);
  const GripScatter scatter = by_effort();
  const sweeps::OpenBackend open = [](const Scene& other, const FieldSet& fields) {
    return std::make_unique<CoreBackend>(make_core_evaluator(other), other, fields, Precision::full, 1);
  };
  double varied = 0;
  for (const TrialGrip& grip : grips_of(1)) {
    std::vector<std::vector<sweeps::BestGrip>> lists(scene.vessels.size());
    lists[1].push_back(sweeps::bare_grip(plan, 1, {0, grip.number}));
    ASSERT_TRUE(sweeps::rank_robustly(open, scene, plan, 1, nullptr, lists));
    const sweeps::RobustScore expected = lists[1][0].robust, found = scatter.robust(grip);
    EXPECT_NEAR(found.low, expected.low, 1e-12);
    EXPECT_NEAR(found.mean, expected.mean, 1e-12);
    EXPECT_EQ(found.share, expected.share);
    varied = std::max(varied, found.share * (1 - found.share));
  }
  EXPECT_GT(varied, 0.1) << "some deviations hold, and some do not";
}

}  // namespace
}  // namespace wholehand
