// SPDX-License-Identifier: MIT
// sanitizers: address
#include "evidence/trials/analysis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/numbers/random_bits.h"
#include "evidence/trials/output.h"
#include "tests/support/fake_trials.h"

namespace wholehand {
namespace {

const TrialGroup SAMPLE{};

// One vessel at tilts 0 and 1; grips with efforts there, and whether they held.
struct Made {
  Scene scene = scene_for_trials();
  TriedGrips tried;
  TrialOptions options;

  Made() {
    tried.cases.resize(scene.vessels.size());
    for (const double tilt : {0.0, 1.0}) {
      TrialCase one;
      one.fill = 1;
      one.tilt = tilt;
      tried.cases[0].push_back(one);
    }
  }

  void add(std::array<double, 2> efforts, std::array<bool, 2> held, TrialSample sample = TrialSample::stratified) {
    TrialGrip grip;
    grip.number = tried.grips.size();
    grip.sample = sample;
    tried.grips.push_back(grip);
    GripFinding found;
    for (std::size_t k = 0; k < 2; ++k) {
      found.prediction.cases.push_back({efforts[k], 2 * efforts[k], efforts[k], 2 * efforts[k]});
      TrialOutcome outcome;
      outcome.held = held[k];
      if (!held[k]) outcome.reason = k == 1 && !held[0] ? TrialReason::earlier : TrialReason::turned;
      found.outcomes.push_back(outcome);
    }
    found.prediction.push = 1 / efforts[1];
    found.prediction.score = 1 / (1 + efforts[1]);
    tried.found.push_back(found);
  }

  void discard_last(std::size_t k, TrialReason reason) {
    TrialOutcome& outcome = tried.found.back().outcomes[k];
    outcome.discarded = true;
    outcome.held = false;
    outcome.reason = reason;
  }
};

const PredictorRow& row_of(const TrialAnalysis& analysis, const TrialGroup& group, std::size_t predictor) {
  return *std::find_if(analysis.predictors.begin(), analysis.predictors.end(),
                       [&](const PredictorRow& row) { return row.group == group && row.predictor == predictor; });
}

TEST(TrialAnalysis, CountsByHand) {
  Made made;
  made.add({0.1, 0.2}, {true, true});
  made.add({0.1, 0.8}, {true, false});
  made.add({0.9, 2}, {false, false});  // the second was not reached
  made.add({0.3, 0.4}, {true, true});
  made.discard_last(1, TrialReason::diverged);
  const TrialAnalysis found = analyze_trials(made.scene, made.tried, made.options);
  ASSERT_EQ(found.successes.size(), 2u);
  EXPECT_EQ(found.successes[0].trials.held.yes, 3u);
  EXPECT_EQ(found.successes[0].trials.held.of, 4u);
  EXPECT_EQ(found.successes[1].trials.held.yes, 1u) << "lost at a smaller tilt is not held";
  EXPECT_EQ(found.successes[1].trials.held.of, 3u);
  EXPECT_EQ(found.successes[1].trials.discarded, 1u);
  EXPECT_EQ(found.successes[1].trials.diverged, 1u);
  ASSERT_EQ(found.grips.size(), 1u);
  EXPECT_EQ(found.grips[0].held.yes, 1u);
  EXPECT_EQ(found.grips[0].held.of, 3u);
  EXPECT_EQ(found.grips[0].discarded, 1u);
  const Confusion& confusion = found.efforts[0].confusion;
  EXPECT_EQ(confusion.all(), 6u) << "neither the discarded nor the one that was not reached";
  EXPECT_EQ(confusion.held_as_said, 4u);
  EXPECT_EQ(confusion.lost_though_said, 2u);
  EXPECT_EQ(found.efforts[0].earlier, 1u);
  EXPECT_EQ(found.efforts[0].discarded, 1u);
}

TEST(TrialAnalysis, PredictorsOfGripsAndOfTrials) {
  Made made;
  made.add({0.1, 0.2}, {true, true});
  made.add({0.5, 0.1}, {true, true});
  made.add({0.1, 0.8}, {true, false});
  made.add({0.3, 3}, {true, false});
  const TrialAnalysis found = analyze_trials(made.scene, made.tried, made.options);
  EXPECT_DOUBLE_EQ(row_of(found, SAMPLE, BY_WORST_EFFORT).auc.auc, 1);
  EXPECT_EQ(row_of(found, SAMPLE, BY_WORST_EFFORT).auc.successes, 2u);
  EXPECT_DOUBLE_EQ(row_of(found, SAMPLE, BY_PUSH).auc.auc, 1);
  EXPECT_DOUBLE_EQ(row_of(found, SAMPLE, BY_EPSILON).auc.auc, 0.5) << "all are alike";
  const Auc& by_trial = row_of(found, SAMPLE, BY_LEG_EFFORT).auc;
  EXPECT_EQ(by_trial.successes, 6u);
  EXPECT_EQ(by_trial.failures, 2u);
  EXPECT_DOUBLE_EQ(by_trial.auc, 1);
}

// A loss between two tilts is one of the way, whatever the effort where the way ends.
TEST(TrialAnalysis, ALossOnTheWayIsJudgedByItsEffort) {
  Made made;
  made.add({0.1, 0.2}, {true, true});
  made.add({0.1, 0.2}, {true, false});
  CasePrediction& said = made.tried.found.back().prediction.cases[1];
  said.leg_effort = 3;
  said.leg_tips = 6;
  made.tried.found.back().outcomes[1].tilt_lost = 0.7;
  const TrialAnalysis found = analyze_trials(made.scene, made.tried, made.options);
  const Confusion& confusion = found.efforts[0].confusion;
  EXPECT_EQ(confusion.held_as_said, 3u);
  EXPECT_EQ(confusion.lost_as_said, 1u);
  EXPECT_EQ(confusion.lost_though_said, 0u);
  EXPECT_TRUE(found.disagreements.empty());
  for (const std::size_t predictor : {BY_WORST_EFFORT, BY_TIPS_EFFORT, BY_LEG_EFFORT, BY_LEG_TIPS})
    EXPECT_DOUBLE_EQ(row_of(found, SAMPLE, predictor).auc.auc, 1) << predictor;
  EXPECT_EQ(found.successes[1].trials.held.yes, 1u) << "by its state it is lost as before";
}

// The bar of the best counts grips, and only trials that effort is sure of.
TEST(TrialAnalysis, BarsOfTheBestGrips) {
  Made made;
  for (int k = 0; k < 18; ++k) made.add({0.1, 0.2}, {true, true}, TrialSample::best);
  made.add({0.1, 0.9}, {true, false}, TrialSample::best);  // effort was not sure
  made.add({0.1, 0.4}, {true, false}, TrialSample::best);
  made.add({0.7, 0.9}, {true, true}, TrialSample::best);
  made.add({0.1, 0.2}, {true, true}, TrialSample::best);
  made.discard_last(1, TrialReason::buried);
  const TrialAnalysis found = analyze_trials(made.scene, made.tried, made.options);
  const TrialBar& bar = found.bars.back();
  EXPECT_DOUBLE_EQ(bar.found, 0.95) << "of 20: the one without a sure trial shows nothing";
  EXPECT_EQ(bar.how, "19 of 20 grips; left out: 1 with a discarded trial, 1 without such an effort");
  EXPECT_STREQ(bar.verdict(), "met");
  EXPECT_STREQ(found.bars[0].verdict(), "not measured") << "no stratified sample";
  EXPECT_TRUE(std::isnan(found.bars[0].found));
  made.add({0.1, 0.4}, {true, false}, TrialSample::best);
  EXPECT_STREQ(analyze_trials(made.scene, made.tried, made.options).bars.back().verdict(), "missed");
}

TEST(TrialAnalysis, ABarThatNoGripCanShowIsNotMet) {
  Made made;
  made.add({0.7, 0.9}, {true, true}, TrialSample::best);
  const TrialAnalysis found = analyze_trials(made.scene, made.tried, made.options);
  EXPECT_TRUE(std::isnan(found.bars.back().found));
  EXPECT_STREQ(found.bars.back().verdict(), "not measured");
}

// A bar is judged from ten grips on, and an AUC from ten of either kind on.
TEST(TrialAnalysis, BarsOfTooFewGripsAreNotJudged) {
  Made made;
  const auto verdict = [&made](std::size_t bar) {
    const TrialAnalysis found = analyze_trials(made.scene, made.tried, made.options);
    return std::string(bar < found.bars.size() ? found.bars[bar].verdict() : found.bars.back().verdict());
  };
  constexpr std::size_t LAST = 99;
  for (int k = 0; k < 9; ++k) made.add({0.1, 0.2}, {true, true}, TrialSample::best);
  EXPECT_EQ(verdict(LAST), "too few to judge");
  made.add({0.1, 0.2}, {true, true}, TrialSample::best);
  EXPECT_EQ(verdict(LAST), "met");
  for (int k = 0; k < 20; ++k) made.add({0.1, 0.2}, {true, true});
  for (int k = 0; k < 9; ++k) made.add({0.1, 3}, {true, false});
  EXPECT_EQ(verdict(0), "too few to judge");
  made.add({0.1, 3}, {true, false});
  EXPECT_EQ(verdict(0), "met");
  EXPECT_EQ(verdict(1), "met");
}

// The engine's slip against the settings', of held trials alone.
TEST(TrialAnalysis, CountsSlipsOfHeldTrials) {
  Made made;
  made.add({0.1, 0.2}, {true, true});
  made.tried.found.back().outcomes[1].slip = 2.1e-3;
  made.add({0.1, 0.2}, {true, true});
  made.tried.found.back().outcomes[1].slip = 1.9e-3;
  made.add({0.1, 0.2}, {true, false});
  made.tried.found.back().outcomes[1].slip = 9e-3;
  const TrialAnalysis found = analyze_trials(made.scene, made.tried, made.options);
  EXPECT_EQ(found.successes[0].trials.slipped, 0u);
  EXPECT_EQ(found.successes[1].trials.slipped, 1u);
  EXPECT_EQ(found.grips[0].slipped.yes, 1u);
  EXPECT_EQ(found.grips[0].slipped.of, 5u);
}

// One grip under two materials: side by side, each with its own outcome.
TEST(TrialAnalysis, PushesOfBothMaterialsStandSideBySide) {
  Made made;
  made.options.six_forces = true;
  made.options.fill_tilt = false;
  for (std::size_t k = 0; k < 2; ++k) {
    made.tried.cases[0][k].protocol = TrialProtocol::six_forces;
    made.tried.cases[0][k].material = static_cast<int>(k);
  }
  made.add({0.1, 0.2}, {true, true});
  made.add({0.1, 0.2}, {true, false});
  const auto pushed = analyze_trials(made.scene, made.tried, made.options).pushed;
  ASSERT_EQ(pushed.size(), 1u);
  ASSERT_EQ(pushed[0].by_material.size(), 2u);
  EXPECT_EQ(pushed[0].by_material[0].held.yes, 2u);
  EXPECT_EQ(pushed[0].by_material[1].held.yes, 1u);
  EXPECT_EQ(pushed[0].by_material[1].held.of, 2u);
}

TEST(TrialAnalysis, DisagreementsAreTheWorstOfEachKind) {
  Made made;
  for (int k = 0; k < 12; ++k) made.add({0.5, 0.9 - 0.05 * k}, {true, false});  // lost though said
  made.add({0.1, INFINITY}, {true, true});
  made.add({3, 5}, {true, true});
  made.add({0.1, 0.2}, {true, true});
  const auto found = analyze_trials(made.scene, made.tried, made.options).disagreements;
  ASSERT_EQ(found.size(), MOST_DISAGREEMENTS);
  EXPECT_EQ(found[0].grip, 12u) << "infinite";
  const auto held = std::count_if(found.begin(), found.end(), [](const Disagreement& one) { return one.effort > 1; });
  EXPECT_EQ(held, 2) << "each grip once, with its worst trial";
  for (std::size_t k = 1; k < found.size(); ++k)
    EXPECT_GE(std::abs(std::log(found[k - 1].effort)), std::abs(std::log(found[k].effort)));
  for (const Disagreement& one : found)
    if (one.grip == 13) {
      EXPECT_EQ(one.effort, 5);
    }
}

TEST(TrialAnalysis, WithoutBothOutcomesThereIsNoAuc) {
  Made made;
  made.add({0.1, 0.2}, {true, true});
  made.add({0.2, 0.2}, {true, true});
  const TrialAnalysis found = analyze_trials(made.scene, made.tried, made.options);
  EXPECT_TRUE(std::isnan(row_of(found, SAMPLE, BY_WORST_EFFORT).auc.auc));
  EXPECT_FALSE(found.weights->fit.is_fitted);
  EXPECT_TRUE(found.disagreements.empty());
}

// ---- placements ----

void place_last(Made& made, std::size_t held, std::size_t overlaps, std::size_t impossible, double score, double low) {
  GripFinding& found = made.tried.found.back();
  found.placements.assign(held, {true, true, TrialReason::none});
  found.placements.insert(found.placements.end(), overlaps, {true, false, TrialReason::overlap});
  found.placements.insert(found.placements.end(), impossible, Placement{});
  found.prediction.score = score;
  found.robust.low = std::floor(low / 3);  // many alike: then the mean decides
  found.robust.mean = low;
  found.robust.share = 1;
  made.options.scatter = found.placements.size();
}

TEST(TrialAnalysis, PlacementsOfTheFirstGripsHaveABar) {
  Made made;
  for (std::size_t rank = 1; rank <= 7; ++rank) {
    made.add({0.1, 0.2}, {true, true}, TrialSample::best);
    made.tried.grips.back().rank = rank;
    if (rank <= 5) place_last(made, 19, 1, 0, 0.9, 0.8);
    if (rank > 5) place_last(made, 0, 18, 2, 0.9, 0.8);
  }
  const TrialAnalysis found = analyze_trials(made.scene, made.tried, made.options);
  ASSERT_TRUE(found.scatter);
  ASSERT_EQ(found.scatter->rows.size(), 2u);
  EXPECT_TRUE(found.scatter->rows[0].is_first);
  EXPECT_EQ(found.scatter->rows[0].held.yes, 95u);
  EXPECT_EQ(found.scatter->rows[0].held.of, 100u);
  EXPECT_EQ(found.scatter->rows[1].held.of, 140u) << "what cannot be tried counts";
  EXPECT_EQ(failures_text(found.scatter->rows[1].count), "41 overlap, 4 impossible");
  const TrialBar& bar = found.bars.back();
  EXPECT_EQ(bar.found, 0.95);
  EXPECT_STREQ(bar.verdict(), "met");
  EXPECT_EQ(bar.how, "95 of 100 placements; 5 overlap");
  made.tried.found[4].placements[0].held = false;
  EXPECT_STREQ(analyze_trials(made.scene, made.tried, made.options).bars.back().verdict(), "missed");
}

// Against a count over all pairs of a placement that was held and one that was not.
TEST(TrialAnalysis, PlacementsAreJudgedOneByOne) {
  Made made;
  std::uint64_t state = 5;
  const auto drawn = [&](double of) { return std::floor(of * unit_interval(split_mix(state))); };
  for (int k = 0; k < 30; ++k) {
    made.add({0.1, 0.2}, {true, true});
    const auto held = static_cast<std::size_t>(drawn(9));
    place_last(made, held, 8 - held, 0, drawn(5), static_cast<double>(held) + drawn(4));
  }
  made.add({0.1, 0.2}, {true, true}, TrialSample::best);
  place_last(made, 0, 8, 0, 9, 9);  // another sample
  const TrialAnalysis found = analyze_trials(made.scene, made.tried, made.options);
  const auto expected = [&](const std::function<double(const GripFinding&)>& value) {
    double won = 0, pairs = 0;
    for (std::size_t a = 0; a < 30; ++a)
      for (std::size_t b = 0; b < 30; ++b)
        for (const Placement& one : made.tried.found[a].placements)
          for (const Placement& other : made.tried.found[b].placements) {
            if (!one.held || other.held) continue;
            const double more = value(made.tried.found[a]) - value(made.tried.found[b]);
            won += more > 0 ? 1 : more == 0 ? 0.5 : 0;
            ++pairs;
          }
    return won / pairs;
  };
  const ScatterPredictors& row = found.scatter->predictors.at(0);
  const double score = expected([](const GripFinding& one) { return one.prediction.score; });
  const double robust = expected([](const GripFinding& one) { return one.robust.mean; });
  EXPECT_NEAR(row.aucs[BY_OWN_SCORE].auc, score, 1e-12);
  EXPECT_NEAR(row.aucs[BY_ROBUST_RANK].auc, robust, 1e-12);
  EXPECT_EQ(row.aucs[BY_ROBUST_SHARE].auc, 0.5) << "all alike";
  EXPECT_NEAR(row.robust_gain.difference, robust - score, 1e-12);
  EXPECT_GT(row.robust_gain.interval.low, 0);
  EXPECT_EQ(row.aucs[0].successes + row.aucs[0].failures, 240u);
  // 30 grips and not 240: an interval of single placements would be narrower
  EXPECT_GT(row.aucs[BY_ROBUST_RANK].interval.high - row.aucs[BY_ROBUST_RANK].interval.low, 0.05);
}

TEST(TrialAnalysis, WeightsAreFittedToPlacementsOfGripsThatHoldByEffort) {
  Made made;
  for (std::size_t k = 0; k < 60; ++k) {
    made.add({0.1, 0.2}, {true, true});
    place_last(made, k % 9, 8 - k % 9, 0, 0.5, 0.5);
    const double other = static_cast<double>(k * 7 % 11) / 11;  // says nothing
    made.tried.found.back().prediction.terms = {0.5, 0.5, other, 0.1 * static_cast<double>(k % 9), 0.5, 0.5};
  }
  for (std::size_t k = 0; k < 20; ++k) {
    made.add({0.1, 3}, {true, false});
    place_last(made, 8, 0, 0, 0, 0);
    made.tried.found.back().prediction.scene_worst_effort = 3;
  }
  const TrialAnalysis found = analyze_trials(made.scene, made.tried, made.options);
  ASSERT_TRUE(found.scatter && found.scatter->weights && found.scatter->weights->fit.is_fitted);
  const WeightTrial& weights = *found.scatter->weights;
  EXPECT_EQ(weights.fitted_on + weights.judged_on, 60u) << "grips, of those that hold";
  EXPECT_EQ(weights.all.fitted.successes + weights.all.fitted.failures, 8 * weights.judged_on);
  EXPECT_GT(weights.weights[3], 0.8) << "posture tells all here, and most of the weight given is on depth";
  EXPECT_TRUE(weights.is_better());
}

// What cannot be tried is a failure for the fit, though it is none for an AUC.
TEST(TrialAnalysis, DiscardedGripsAreInTheFitOfWeights) {
  Made made;
  for (int k = 0; k < 60; ++k) {
    const bool is_held = k % 3 != 0;
    made.add({0.1, is_held ? 0.3 : 3.0}, {true, is_held});
    made.tried.found.back().prediction.terms = {0.5, 0.5, 1, 0.5, 0.5, is_held ? 0.9 - 0.01 * k : 0.6 - 0.005 * k};
    if (k % 6 != 1) continue;
    made.discard_last(0, TrialReason::overlap);
    made.tried.found.back().prediction.terms[2] = 0.3;
  }
  const TrialAnalysis found = analyze_trials(made.scene, made.tried, made.options);
  ASSERT_TRUE(found.weights && found.weights->fit.is_fitted);
  EXPECT_EQ(found.weights->fitted_on + found.weights->judged_on, 60u);
  const WeightContest &all = found.weights->all, &tried = found.weights->tried;
  EXPECT_EQ(all.fitted.failures, tried.fitted.failures + 5) << "half of the ten that are discarded";
  EXPECT_EQ(all.fitted.successes, tried.fitted.successes);
  EXPECT_GT(found.weights->weights[2], LEAST_WEIGHT) << "depth tells them";
  EXPECT_EQ(row_of(found, SAMPLE, BY_WORST_EFFORT).auc.failures, 20u) << "without them";
}

TEST(TrialAnalysis, WordsOfAnOutcome) {
  TrialCase one;
  TrialOutcome outcome;
  outcome.held = true;
  outcome.move = 2e-3;
  EXPECT_EQ(outcome_text(one, outcome),
            "The vessel was held: at most it moved by 2.0 mm and turned by 0.0° in the hand, and a contact slid by 0.0 mm.");
  outcome.held = false;
  outcome.reason = TrialReason::turned;
  outcome.when = 1.25;
  outcome.tilt_lost = radians(40);
  EXPECT_TRUE(outcome_text(one, outcome)
                  .starts_with("The vessel was lost 1.25 s after the release, at a tilt of 40°, as it turned too far"));
}

}  // namespace
}  // namespace wholehand
