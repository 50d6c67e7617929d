// SPDX-License-Identifier: MIT
// Lists of grips in a scene with an arm: hands that no arm reaches are in none, whatever range of roll is asked for.
// sanitizers: address
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "sweeps/rank/rank.h"
#include "sweeps/result/tally.h"
#include "tests/support/result_reader.h"
#include "tests/support/sweep_results.h"

namespace wholehand::sweeps {
namespace {

// Rolls all the way round, so that there are hands from below with the palm up.
const std::string ALL_ROLLS = R"([[vessel]]
name = "beaker"
shape = "cylinder"
diameter_mm = 70
height_mm = 120
wall_mm = 1.5
[table]
[liquid]
fills = [0, 0.7]
[grips]
height_fraction = [0.5, 0.7, 0.9]
roll_deg = { from = -165, to = 180, count = 24 }
[tilts]
deg = [0, 60]
[output]
best = 10
apart_mm = 0
)";

TEST(BeyondWrist, NoListHasAHandThatNoArmReaches) {
  const SweptScene bare(ALL_ROLLS), swept(edited(ALL_ROLLS, "[liquid]", "[arm]\n[liquid]"));
  const auto beyond = read_values(swept.path, "beyond_wrist"), plausible = read_values(swept.path, "plausible"),
             shares = read_values(swept.path, "wrist_share"), scores = read_values(swept.path, "score");
  std::size_t count = 0;
  for (std::size_t i = 0; i < beyond.size(); ++i) {
    EXPECT_EQ(beyond[i] == 1, shares[i] > 1) << i;
    if (beyond[i] != 1) continue;
    ++count;
    EXPECT_EQ(plausible[i], 0);
    EXPECT_EQ(scores[i], 0);
  }
  EXPECT_GT(count, beyond.size() / 4);
  // both files have the same grips
  EXPECT_EQ(beyond[bare.result->best(0).front().index], 1) << "without an arm the first hand is one that nobody has";
  const auto best = swept.result->best(0);
  ASSERT_EQ(best.size(), 10u);
  for (const Candidate& one : best) EXPECT_EQ(beyond[one.index], 0);
  const Ranking ranking =
      rank_grips(*swept.result, swept.scene, *swept.plan, {"", {}, 100, 0}, [&] { return make_core_evaluator(swept.scene); });
  EXPECT_EQ(ranking.lists[0].front().candidate.index, best.front().index);
  for (const BestGrip& grip : ranking.lists[0]) EXPECT_EQ(grip.wrist_share, shares[grip.candidate.index]);
  const std::string csv = best_csv(swept.scene, *swept.plan, ranking.lists, {});
  EXPECT_NE(csv.find(",wrist_share,grip,result,sweep\n"), std::string::npos) << csv.substr(0, csv.find('\n'));
  for (const BestGrip& grip : ranking.lists[0]) EXPECT_EQ(beyond[grip.candidate.index], 0);
  const Ranking easy = rank_grips(*swept.result, swept.scene, *swept.plan, {"", {"wrist_share < 0.3"}, 100, 0},
                                  [&] { return make_core_evaluator(swept.scene); });
  ASSERT_FALSE(easy.lists[0].empty());
  EXPECT_LT(easy.lists[0].size(), ranking.lists[0].size());
  for (const BestGrip& grip : easy.lists[0]) EXPECT_LT(shares[grip.candidate.index], 0.3);
}

}  // namespace
}  // namespace wholehand::sweeps
