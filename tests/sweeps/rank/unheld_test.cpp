// SPDX-License-Identifier: MIT
// A canister that is too heavy: the list is empty, its line is true, and what the line offers holds.
// sanitizers: address
#include "sweeps/rank/unheld.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/gather.h"
#include "core/reader/reader.h"
#include "shaders/status.h"
#include "sweeps/rank/rank.h"
#include "sweeps/result/tally.h"
#include "tests/support/result_reader.h"
#include "tests/support/scene_texts.h"
#include "tests/support/sweep_results.h"

namespace wholehand::sweeps {
namespace {

// 5.5 kg of steel.
const std::string HEAVY = R"([[vessel]]
name = "canister"
shape = "cylinder"
diameter_mm = 75
height_mm = 180
wall_mm = 20
density_kg_m3 = 7800
[table]
[strength]
[liquid]
fills = [0, 1]
[grips]
height_fraction = { from = 0.3, to = 0.9, count = 4 }
roll_deg = { from = -90, to = 0, count = 3 }
[tilts]
deg = [0, 45, 90]
[output]
best = 5
apart_mm = 0
)";

// 3.4 kg empty: a grip holds it then, and full none does.
const std::string LIGHTER = edited(HEAVY, "wall_mm = 20", "wall_mm = 7");
// Held far above its center of mass: up to some tilt.
const std::string AT_THE_TOP =
    edited(edited(edited(HEAVY, "wall_mm = 20", "wall_mm = 4"), "{ from = 0.3, to = 0.9, count = 4 }", "[0.8, 0.9]"),
           "deg = [0, 45, 90]", "deg = [0, 10, 20, 45, 90]");
// So light that the hand has strength to spare for a friction that is too low.
const std::string SLIPPERY = edited(edited(HEAVY, "wall_mm = 20", "wall_mm = 1"), "fills = [0, 1]", "fills = [0]");

struct Nearest {
  LeastBad grip;
  GripCounts counts;
};

Nearest nearest_of(const Scene& scene, const Evaluator& core, const Plan& plan) {
  std::vector<GripInput> grips;
  for (std::uint64_t i = 0; i < plan.grips(); ++i) grips.push_back(plan.grip(0, i));
  const FieldSet fields = make_field_set({FIELD_STATUS, FIELD_WORST_EFFORT, FIELD_FRICTION_NEEDED}, scene);
  const GatheredPlanes planes = gather(core, fields, 0, grips);
  Nearest found;
  count_grips({0, 0, grips.size(), grips.size(), nullptr, planes.reals.data(), planes.uints.data()}, fields, 0, found.counts);
  found.grip = found.counts.least_bad;
  // by hand
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < grips.size(); ++i)
    if (is_plausible(planes.uint(FIELD_STATUS, i))) least = std::min(least, planes.real(fields.plane[FIELD_WORST_EFFORT], i));
  EXPECT_EQ(found.grip.effort, least);
  EXPECT_EQ(planes.real(fields.plane[FIELD_WORST_EFFORT], static_cast<std::size_t>(found.grip.grip)), least);
  return found;
}

bool holds(const Scene& scene, const GripInput& grip) {
  const FieldSet fields = make_field_set({FIELD_STATUS}, scene);
  return is_eligible(gather(*make_core_evaluator(scene), fields, 0, {grip}).uint(FIELD_STATUS, 0));
}

// Each way alone holds, and a little less of it does not.
void expect_ways(const Scene& scene, const Unheld& found, const GripInput& grip) {
  ASSERT_FALSE(holds(scene, grip));
  if (std::isfinite(found.effort))
    for (const double share : {0.997, 1.003}) {
      Scene other = scene;
      for (double& digit : other.strength->digits) digit *= found.effort * share;
      EXPECT_EQ(holds(other, grip), share > 1) << found.effort;
    }
  if (std::isfinite(found.friction_needed))
    for (const double more : {-0.01, 0.005}) {  // found to 1e-3, at an effort to 1e-3
      Scene other = scene;
      other.force.friction = found.friction_needed + more;
      EXPECT_EQ(holds(other, grip), more > 0) << found.friction_needed;
    }
  const std::vector<double> fills = scene.liquid->fills;
  for (std::size_t k = 1; k < fills.size(); ++k) {
    Scene other = scene;
    other.liquid->fills.assign(fills.begin(), fills.begin() + static_cast<std::ptrdiff_t>(k));
    EXPECT_EQ(holds(other, grip), found.fill && fills[k - 1] <= *found.fill) << "up to " << fills[k - 1];
  }
  for (std::size_t k = 1; k < scene.tilts.size(); ++k) {
    Scene other = scene;
    other.tilts.resize(k);
    EXPECT_EQ(holds(other, grip), found.tilt && scene.tilts[k - 1] <= *found.tilt) << "up to " << scene.tilts[k - 1];
  }
}

TEST(Unheld, WhatIsSaidToHoldHolds) {
  struct Case {
    std::string text, says;
    double friction;
    bool has_fill = false, has_tilt = false;
  };
  for (const Case& one : {Case{HEAVY, "strength of the hand fails first", 0.6},
                          Case{LIGHTER, "an empty vessel or keeping it upright would hold it", 0.6, true, true},
                          Case{AT_THE_TOP, "deg would hold it", 0.6, false, true}, Case{HEAVY, "friction fails first", 0},
                          Case{SLIPPERY, "friction fails first", 0.05}}) {
    Scene scene = scene_from(one.text);
    scene.force.friction = one.friction;
    const auto core = make_core_evaluator(scene);
    const Plan plan(scene, false);
    const Nearest nearest = nearest_of(scene, *core, plan);
    ASSERT_TRUE(nearest.counts.none_holds()) << counts_line(nearest.counts, true, 1);
    const GripInput grip = plan.grip(0, nearest.grip.grip);
    const Unheld found = what_would_hold(*core, scene, 0, grip);
    EXPECT_EQ(found.effort, nearest.grip.effort);
    EXPECT_EQ(found.fill.has_value(), one.has_fill);
    EXPECT_EQ(found.tilt.has_value(), one.has_tilt);
    expect_ways(scene, found, grip);
    const std::string line = unheld_line(*core, scene, plan, 0, nearest.grip);
    EXPECT_EQ(line.find('\n'), std::string::npos);
    EXPECT_NE(line.find(one.says), std::string::npos) << line;
  }
}

TEST(Unheld, WhereNothingHoldsNothingIsListedUnlessTheLeastBadAreAskedFor) {
  const SweptScene swept(HEAVY);
  EXPECT_TRUE(swept.result->best(0).empty());
  const auto ranked = [&](const RankRequest& request) {
    return rank_grips(*swept.result, swept.scene, *swept.plan, request, [&] { return make_core_evaluator(swept.scene); });
  };
  const Ranking none = ranked({"", {}, 100});
  EXPECT_TRUE(none.lists[0].empty());
  EXPECT_GT(none.plausible[0], 3u);
  EXPECT_EQ(none.not_held[0], none.plausible[0]);
  const Ranking least_bad = ranked({"", {}, 100, 0, 0, true});
  // by hand
  const auto plausible = read_values(swept.path, "plausible"), not_held = read_values(swept.path, "not_held"),
             efforts = read_values(swept.path, "worst_effort"), scores = read_values(swept.path, "score");
  std::vector<std::pair<double, std::uint64_t>> wanted;
  for (std::size_t i = 0; i < swept.plan->grips(); ++i) {
    if (plausible[i] != 1) continue;
    EXPECT_EQ(not_held[i], 1);
    EXPECT_EQ(scores[i], 0);
    wanted.emplace_back(efforts[i], i);
  }
  std::sort(wanted.begin(), wanted.end());
  ASSERT_EQ(least_bad.lists[0].size(), wanted.size());
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    EXPECT_EQ(least_bad.lists[0][k].candidate.index, wanted[k].second);
    EXPECT_EQ(least_bad.lists[0][k].score, 0);
    EXPECT_EQ(least_bad.lists[0][k].efforts.worst, wanted[k].first);
  }
}

TEST(Unheld, WhereSomeHoldTheListIsTheirsAlone) {
  const std::string text = edited(HEAVY, "wall_mm = 20", "wall_mm = 1");
  const SweptScene swept(text);
  const auto not_held = read_values(swept.path, "not_held");
  const auto best = swept.result->best(0);
  ASSERT_FALSE(best.empty());
  for (const Candidate& one : best) {
    EXPECT_EQ(not_held[one.index], 0);
    EXPECT_GT(one.score, 0);
  }
  const auto listed = [&](bool least_bad) {
    const Ranking ranking = rank_grips(*swept.result, swept.scene, *swept.plan, {"", {}, 100, 0, 0, least_bad},
                                       [&] { return make_core_evaluator(swept.scene); });
    std::vector<std::uint64_t> numbers;
    for (const BestGrip& grip : ranking.lists[0]) numbers.push_back(grip.candidate.index);
    return numbers;
  };
  EXPECT_EQ(listed(true), listed(false));
}

// A sweep does not keep the friction that its grips need.
TEST(Unheld, WhereNoForceHoldsItIsTheGripOfLeastFriction) {
  Scene scene = scene_from(HEAVY);
  scene.force.friction = 0;
  const auto core = make_core_evaluator(scene);
  const Plan plan(scene, false);
  const LeastBad known = nearest_of(scene, *core, plan).grip;
  ASSERT_EQ(known.effort, LeastBad::ENDLESS);
  ASSERT_LT(known.friction, 10);
  const LeastBad blind{LeastBad::ENDLESS, LeastBad::ENDLESS, known.grip == 0 ? 1u : 0u};
  EXPECT_EQ(with_least_friction(*core, scene, plan, 0, blind), known);
  const LeastBad weak{1.5, LeastBad::ENDLESS, 3};
  EXPECT_EQ(with_least_friction(*core, scene, plan, 0, weak), weak) << "strength fails";
}

}  // namespace
}  // namespace wholehand::sweeps
