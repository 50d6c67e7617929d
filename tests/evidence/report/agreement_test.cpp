// SPDX-License-Identifier: MIT
// The file's numbers beside the core's: what is right holds in either precision, and every wrong number is found.
// sanitizers: none
#include "evidence/report/agreement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/support/result_reader.h"
#include "tests/support/sweep_results.h"

namespace wholehand {
namespace {

std::set<std::string> quantities(const Agreement& agreement) {
  std::set<std::string> names;
  for (const Comparison& row : agreement.rows) names.insert(row.quantity);
  return names;
}

std::string written_agreement(const SweptScene& swept, std::size_t vessel) {
  MarkupWriter html;
  write_agreement(html, *swept.source, vessel, "v");
  EXPECT_TRUE(html.is_closed());
  return html.written();
}

TEST(Agreement, OfTheCoresOwnSweepIsExact) {
  // azimuths that were not computed but repeated differ by rounding
  const SweptScene swept(edited(RESULT_SCENE, "azimuth_deg = [0, 60, 120]", "azimuth_deg = 0"));
  for (std::size_t v = 0; v < 2; ++v) {
    const Agreement agreement = compare_with_core(*swept.source, v);
    EXPECT_TRUE(agreement.holds());
    EXPECT_EQ(agreement.grips, swept.plan->stored_grips()) << "all, as there are few";
    EXPECT_GT(agreement.feasible, 30u);
    EXPECT_EQ(agreement.excluded, 0u);
    for (const Comparison& row : agreement.rows) EXPECT_EQ(row.worst, 0) << row.quantity;
  }
}

TEST(Agreement, OfSinglePrecisionIsWithinItsTolerance) {
  const SweptScene swept(RESULT_SCENE, Precision::single);
  const Agreement agreement = compare_with_core(*swept.source, 0);
  EXPECT_TRUE(agreement.holds());
  const bool differs =
      std::any_of(agreement.rows.begin(), agreement.rows.end(), [](const Comparison& row) { return row.worst > 0; });
  EXPECT_TRUE(differs) << "floats are no doubles";
}

TEST(Agreement, ComparesWhatTheFileHoldsAndNamesWhatItDoesNot) {
  const SweptScene usual(RESULT_SCENE);
  const Agreement all = compare_with_core(*usual.source, 0);
  EXPECT_EQ(quantities(all), (std::set<std::string>{"gap", "closure", "contact angle", "phalanx depth", "palm depth",
                                                    "peak feedback", "largest hold", "terms", "score"}));
  EXPECT_EQ(all.outcomes.size(), 9u);
  const auto left = [&all](const char* name) {
    return std::find(all.uncompared.begin(), all.uncompared.end(), name) != all.uncompared.end();
  };
  EXPECT_TRUE(left("peak_feedback_tilt") && left("largest_safe_tilt") && left("fingers_used"));
  EXPECT_FALSE(left("score") || left("touch_mask"));

  const SweptScene some(edited(RESULT_SCENE, "best = 5", "best = 5\nkeep = [\"gap\", \"score_depth\", \"used_mask\"]"));
  const Agreement few = compare_with_core(*some.source, 1);
  EXPECT_TRUE(few.holds());
  EXPECT_EQ(quantities(few), (std::set<std::string>{"gap", "terms"}));
  EXPECT_EQ(few.outcomes, (std::vector<std::string>{"used_mask"}));
}

TEST(Agreement, WithAllStatesTheTiltsAreComparedToo) {
  const SweptScene swept(edited(RESULT_SCENE, "best = 5",
                                "best = 5\nkeep = [\"feedback_force\", \"normal_force\", \"hold_force\", \"peak_feedback_tilt\", "
                                "\"largest_safe_tilt\", \"posed\"]"),
                         Precision::single);
  const Agreement agreement = compare_with_core(*swept.source, 0);
  EXPECT_TRUE(agreement.holds());
  EXPECT_TRUE(quantities(agreement).count("force short of peak") && quantities(agreement).count("force beyond safe"));
  EXPECT_TRUE(agreement.uncompared.empty());
}

TEST(Agreement, FindsAWrongNumber) {
  SweptScene swept(RESULT_SCENE, Precision::single);
  for (const auto& [variable, quantity] :
       {std::pair{"gap", "gap"}, {"score", "score"}, {"score_hold", "terms"}, {"largest_hold_force", "largest hold"}}) {
    const std::vector<double> before = read_values(swept.path, variable);
    // the first feasible grip's, by a thousandth
    std::vector<double> after = before;
    std::size_t at = 0;
    while (!(std::isfinite(before[at]) && before[at] > 0)) ++at;
    after[at] *= 1.001;
    swept.change(variable, after);
    const Agreement agreement = compare_with_core(*swept.source, 0);
    EXPECT_FALSE(agreement.holds()) << variable;
    EXPECT_EQ(agreement.outside, 1u) << variable;
    for (const Comparison& row : agreement.rows) EXPECT_EQ(row.outside, row.quantity == quantity ? 1u : 0u) << row.quantity;
    EXPECT_NE(written_agreement(swept, 0).find("do NOT agree"), std::string::npos);
    swept.change(variable, before);
    EXPECT_TRUE(compare_with_core(*swept.source, 0).holds());
  }
}

TEST(Agreement, FindsAWrongOutcome) {
  SweptScene swept(RESULT_SCENE);
  const auto reasons = read_values(swept.path, "reason");
  const auto feasible = static_cast<std::size_t>(std::find(reasons.begin(), reasons.end(), 0) - reasons.begin());
  for (const char* variable :
       {"touch_mask", "used_mask", "plausible", "antipodal", "blocked_mask", "projected_tip_mask", "reason"}) {
    const std::vector<double> before = read_values(swept.path, variable);
    std::vector<double> after = before;
    after[feasible] = before[feasible] == 1 ? 0 : 1;
    swept.change(variable, after);
    const Agreement agreement = compare_with_core(*swept.source, 0);
    EXPECT_EQ(agreement.flipped, 1u) << variable;
    EXPECT_FALSE(agreement.holds()) << variable;
    swept.change(variable, before);
  }
}

// The rule of `wholehand check`: few outcomes that differ within the margin are no evidence, many are.
TEST(Agreement, ManyOutcomesWithinTheMarginDoNotHold) {
  Agreement agreement;
  agreement.allowed = allowed_flips(SAMPLED_GRIPS);
  agreement.excluded = agreement.allowed;
  EXPECT_GT(agreement.allowed, 1u);
  EXPECT_TRUE(agreement.holds());
  ++agreement.excluded;
  EXPECT_FALSE(agreement.holds());
  EXPECT_EQ(compare_with_core(*SweptScene(RESULT_SCENE).source, 0).allowed, allowed_flips(216));
}

TEST(Agreement, OfManyGripsTakesASampleAndAllThatAreListed) {
  SweptScene swept(edited(RESULT_SCENE, "count = 12", "count = 30"));
  const std::vector<std::uint64_t> sample = sample_places(swept.plan->stored_grips(), SAMPLED_GRIPS);
  std::vector<std::uint64_t> others;
  for (const Candidate& best : swept.result->best(0))
    if (std::find(sample.begin(), sample.end(), best.index) == sample.end()) others.push_back(best.index);
  ASSERT_FALSE(others.empty());
  const Agreement agreement = compare_with_core(*swept.source, 0);
  EXPECT_TRUE(agreement.holds());
  EXPECT_EQ(agreement.grips, SAMPLED_GRIPS + others.size());
  EXPECT_NE(written_agreement(swept, 0).find(std::to_string(agreement.grips) + " of 540 grips"), std::string::npos);
  std::vector<double> gaps = read_values(swept.path, "gap");
  gaps[others.back()] *= 1.001;
  swept.change("gap", gaps);
  EXPECT_EQ(compare_with_core(*swept.source, 0).outside, 1u);
  swept.source->lists = sweeps::GripLists(2);
  EXPECT_TRUE(compare_with_core(*swept.source, 0).holds()) << "a page that lists none";
}

TEST(Agreement, IsToldInWords) {
  const std::string html = written_agreement(SweptScene(RESULT_SCENE), 0);
  EXPECT_NE(html.find("The core computed all 216 grips again"), std::string::npos);
  EXPECT_NE(html.find("no device was compared with it"), std::string::npos);
  EXPECT_EQ(html.find("agrees within its tolerance"), std::string::npos) << "the core is compared with itself";
  EXPECT_EQ(html.find("class=\"good\""), std::string::npos) << "no tick for that";
  EXPECT_NE(html.find("Reasons, flags and masks are equal in"), std::string::npos);
  EXPECT_NE(written_agreement(SweptScene(edited(RESULT_SCENE, "best = 5", "best = 5\nkeep = []")), 0).find("nothing to compare"),
            std::string::npos);
  SweptScene swept(RESULT_SCENE);
  swept.source->core = nullptr;
  swept.source->no_core = "no mesh";
  EXPECT_NE(written_agreement(swept, 0).find("This part is left out: no mesh."), std::string::npos);
}

TEST(SamplePlaces, AreOnceEachAndTheSameEachTime) {
  for (const std::uint64_t all :
       {std::uint64_t{1}, std::uint64_t{256}, std::uint64_t{257}, std::uint64_t{9216}, std::uint64_t{100000000000}}) {
    const auto places = sample_places(all, 256);
    EXPECT_EQ(places.size(), std::min<std::uint64_t>(all, 256));
    EXPECT_EQ(std::set<std::uint64_t>(places.begin(), places.end()).size(), places.size());
    EXPECT_LT(*std::max_element(places.begin(), places.end()), all);
    EXPECT_EQ(places, sample_places(all, 256));
  }
}

TEST(StoredGrip, OfARepeatedAzimuthHasItsOwn) {
  const SweptScene swept(RESULT_SCENE);
  ASSERT_EQ(swept.plan->copies(), 3u);
  const std::uint64_t grips = swept.plan->grips();
  for (const std::uint64_t place : {std::uint64_t{7}, grips + 7, 2 * grips + 7}) {
    const GripInput grip = stored_grip(*swept.plan, swept.scene, 1, place);
    EXPECT_EQ(grip.azimuth, radians(60.0 * static_cast<double>(place / grips)));
    EXPECT_EQ(grip.height, swept.plan->grip(1, 7).height);
  }
}

}  // namespace
}  // namespace wholehand
