// SPDX-License-Identifier: MIT
#include "evidence/trials/analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/charts/markup.h"
#include "base/text/readable.h"
#include "core/planes.h"
#include "core/score.h"
#include "evidence/trials/cases.h"
#include "evidence/trials/output.h"

namespace wholehand {
namespace {

constexpr double NONE = std::numeric_limits<double>::quiet_NaN();
constexpr double WANTED_EFFORT_AUC = 0.90, WANTED_SCORE_AUC = 0.85, WANTED_HELD = 0.95, SURE_EFFORT = 0.5;
constexpr TrialGroup JUDGED{};  // the stratified sample at fill_tilt

// A grip's result within a group.
struct GripFate {
  std::size_t trials = 0;
  bool held = true, discarded = false;
};

GripFate fate_of(const TriedGrips& tried, std::size_t grip, const TrialGroup& group) {
  GripFate fate;
  for (std::size_t k = 0; k < tried.cases_of(grip).size(); ++k) {
    if (!is_of(group, tried.grips[grip], tried.cases_of(grip)[k])) continue;
    const TrialOutcome& outcome = tried.found[grip].outcomes[k];
    ++fate.trials;
    fate.held = fate.held && outcome.held;
    fate.discarded = fate.discarded || outcome.discarded;
  }
  return fate;
}

// The largest effort on the ways to a grip's cases of the group, of the whole hand or of its tips.
double worst_in(const TriedGrips& tried, std::size_t grip, const TrialGroup& group, bool of_tips) {
  double worst = NONE;
  for (std::size_t k = 0; k < tried.cases_of(grip).size(); ++k) {
    if (!is_of(group, tried.grips[grip], tried.cases_of(grip)[k])) continue;
    const CasePrediction& predicted = tried.found[grip].prediction.cases[k];
    worst = std::fmax(worst, of_tips ? predicted.leg_tips : predicted.leg_effort);
  }
  return worst;
}

double value_of(const TriedGrips& tried, std::size_t grip, const TrialGroup& group, std::size_t predictor) {
  const GripPrediction& predicted = tried.found[grip].prediction;
  switch (predictor) {
    case BY_WORST_EFFORT:
      return -worst_in(tried, grip, group, false);
    case BY_SCENE_WORST_EFFORT:
      return -predicted.scene_worst_effort;
    case BY_TIPS_EFFORT:
      return -worst_in(tried, grip, group, true);
    case BY_PUSH:
      return predicted.push;
    case BY_FRICTION_NEEDED:
      return -predicted.friction_needed;
    case BY_EPSILON:
      return predicted.epsilon;
    default:
      return predicted.score;
  }
}

void count_trial(TrialCount& count, const TrialOutcome& outcome, const TrialSettings& settings, std::size_t& held,
                 std::size_t& all) {
  if (outcome.discarded) {
    ++count.discarded;
    count.diverged += outcome.reason == TrialReason::diverged ? 1 : 0;
    return;
  }
  ++all;
  held += outcome.held ? 1 : 0;
  count.slipped += outcome.held && has_slipped(outcome, settings) ? 1 : 0;
}

// A row for each fill and tilt of a vessel, or one for the pushes.
void add_successes(const TriedGrips& tried, const TrialSettings& settings, const TrialGroup& group, std::size_t vessel,
                   std::vector<SuccessRow>& rows) {
  const std::vector<TrialCase>& cases = tried.cases[vessel];
  std::vector<std::array<double, 2>> seen;
  for (const TrialCase& one : cases) {
    if (one.protocol != group.protocol || (one.protocol == TrialProtocol::six_forces && one.material != group.material)) continue;
    const std::array<double, 2> state{one.fill, one.tilt};
    if (std::find(seen.begin(), seen.end(), state) != seen.end()) continue;
    seen.push_back(state);
    SuccessRow row{group, vessel, one.fill, one.tilt, {}};
    std::size_t held = 0, all = 0;
    for (std::size_t g = 0; g < tried.grips.size(); ++g) {
      if (tried.grips[g].vessel != vessel || tried.grips[g].sample != group.sample) continue;
      for (std::size_t k = 0; k < cases.size(); ++k)
        if (is_of(group, tried.grips[g], cases[k]) && cases[k].fill == one.fill && cases[k].tilt == one.tilt)
          count_trial(row.trials, tried.found[g].outcomes[k], settings, held, all);
    }
    row.trials.held = share_of(held, all);
    rows.push_back(row);
  }
}

// The trials of a vessel in the group that were held and slipped.
Share slipped_of(const TriedGrips& tried, const TrialSettings& settings, const TrialGroup& group, std::size_t vessel) {
  std::size_t slipped = 0, held = 0;
  for (std::size_t g = 0; g < tried.grips.size(); ++g) {
    if (tried.grips[g].vessel != vessel) continue;
    for (std::size_t k = 0; k < tried.cases_of(g).size(); ++k) {
      const TrialOutcome& outcome = tried.found[g].outcomes[k];
      if (!outcome.held || !is_of(group, tried.grips[g], tried.cases_of(g)[k])) continue;
      ++held;
      slipped += has_slipped(outcome, settings) ? 1 : 0;
    }
  }
  return share_of(slipped, held);
}

std::optional<WholeGrips> whole_grips(const TriedGrips& tried, const TrialSettings& settings, const TrialGroup& group,
                                      std::size_t vessel) {
  WholeGrips row{group, vessel, {}, 0, {}};
  std::size_t held = 0, all = 0;
  for (std::size_t g = 0; g < tried.grips.size(); ++g) {
    if (tried.grips[g].vessel != vessel) continue;
    const GripFate fate = fate_of(tried, g, group);
    if (fate.trials == 0) continue;
    row.discarded += fate.discarded ? 1 : 0;
    all += fate.discarded ? 0 : 1;
    held += !fate.discarded && fate.held ? 1 : 0;
  }
  if (all + row.discarded == 0) return std::nullopt;
  row.held = share_of(held, all);
  row.slipped = slipped_of(tried, settings, group, vessel);
  return row;
}

std::vector<PushedGrips> pushed_of(const std::vector<WholeGrips>& grips) {
  std::vector<PushedGrips> pushed;
  for (const WholeGrips& row : grips) {
    if (row.group.protocol != TrialProtocol::six_forces) continue;
    const auto same = std::find_if(pushed.begin(), pushed.end(), [&](const PushedGrips& one) {
      return one.sample == row.group.sample && one.vessel == row.vessel;
    });
    PushedGrips& one = same != pushed.end() ? *same : pushed.emplace_back(PushedGrips{row.group.sample, row.vessel, {}});
    one.by_material.push_back(row);
  }
  return pushed;
}

GroupEfforts efforts_of(const TriedGrips& tried, const TrialGroup& group) {
  GroupEfforts efforts{group, {}, {}, 0, 0};
  std::vector<EffortTrial> trials;
  for (std::size_t g = 0; g < tried.grips.size(); ++g)
    for (std::size_t k = 0; k < tried.cases_of(g).size(); ++k) {
      if (!is_of(group, tried.grips[g], tried.cases_of(g)[k])) continue;
      const TrialOutcome& outcome = tried.found[g].outcomes[k];
      if (outcome.discarded)
        ++efforts.discarded;
      else if (!is_conclusive(outcome))
        ++efforts.earlier;
      else
        trials.push_back({tried.found[g].prediction.cases[k].leg_effort, outcome.held});
    }
  efforts.bins = calibration_bins(trials);
  efforts.confusion = confusion_of(trials);
  return efforts;
}

std::vector<TrialGroup> groups_of(const TriedGrips& tried, const TrialOptions& options) {
  std::vector<TrialGroup> groups;
  for (const TrialSample sample : {TrialSample::stratified, TrialSample::best}) {
    std::vector<TrialGroup> of_sample;
    if (options.fill_tilt) of_sample.push_back({sample, TrialProtocol::fill_tilt, 0});
    for (std::size_t m = 0; options.six_forces && m < options.settings.materials.size(); ++m)
      of_sample.push_back({sample, TrialProtocol::six_forces, static_cast<int>(m)});
    const bool is_there =
        std::any_of(tried.grips.begin(), tried.grips.end(), [&](const TrialGrip& grip) { return grip.sample == sample; });
    if (is_there) groups.insert(groups.end(), of_sample.begin(), of_sample.end());
  }
  return groups;
}

// The ratio that separates them, possibly infinite.
double contradiction(const Disagreement& one) { return std::abs(std::log(one.effort)); }

std::vector<Disagreement> find_disagreements(const TriedGrips& tried) {
  std::array<std::vector<Disagreement>, 2> found;  // lost though effort <= 1; held though more. The worst of each grip
  for (std::size_t g = 0; g < tried.grips.size(); ++g) {
    std::array<std::optional<Disagreement>, 2> worst;
    for (std::size_t k = 0; k < tried.cases_of(g).size(); ++k) {
      const TrialOutcome& outcome = tried.found[g].outcomes[k];
      const Disagreement one{g, k, tried.found[g].prediction.cases[k].leg_effort};
      if (!is_conclusive(outcome) || outcome.held == (one.effort <= 1)) continue;
      auto& known = worst[outcome.held ? 1 : 0];
      if (!known || contradiction(one) > contradiction(*known)) known = one;
    }
    for (std::size_t kind = 0; kind < 2; ++kind)
      if (worst[kind]) found[kind].push_back(*worst[kind]);
  }
  const auto is_worse = [](const Disagreement& a, const Disagreement& b) { return contradiction(a) > contradiction(b); };
  std::vector<Disagreement> chosen;
  for (std::size_t kind = 0; kind < 2; ++kind) {
    std::stable_sort(found[kind].begin(), found[kind].end(), is_worse);
    const std::size_t half = MOST_DISAGREEMENTS / 2, others = found[1 - kind].size();
    const std::size_t room = MOST_DISAGREEMENTS - std::min(others, half);  // what the other kind does not need
    found[kind].resize(std::min(found[kind].size(), room));
    chosen.insert(chosen.end(), found[kind].begin(), found[kind].end());
  }
  std::stable_sort(chosen.begin(), chosen.end(), is_worse);
  return chosen;
}

// The best grips of a vessel that hold in every trial whose effort is at most SURE_EFFORT. A grip without such a trial does not count.
struct SurelyHeld {
  Share held;
  std::size_t discarded = 0, without = 0;  // excluded grips: a trial was discarded, or none is sure
};

SurelyHeld surely_held(const TriedGrips& tried, std::size_t vessel) {
  SurelyHeld found;
  std::size_t held = 0, all = 0;
  const TrialGroup best{TrialSample::best, TrialProtocol::fill_tilt, 0};
  for (std::size_t g = 0; g < tried.grips.size(); ++g) {
    if (tried.grips[g].vessel != vessel || tried.grips[g].sample != TrialSample::best) continue;
    const GripFate fate = fate_of(tried, g, best);
    if (fate.trials == 0) continue;
    if (fate.discarded) {
      ++found.discarded;
      continue;
    }
    bool is_held = true, has_sure = false;
    for (std::size_t k = 0; k < tried.cases_of(g).size(); ++k) {
      const TrialOutcome& outcome = tried.found[g].outcomes[k];
      const bool is_sure = is_of(best, tried.grips[g], tried.cases_of(g)[k]) && is_conclusive(outcome) &&
                           tried.found[g].prediction.cases[k].leg_effort <= SURE_EFFORT;
      has_sure = has_sure || is_sure;
      is_held = is_held && (!is_sure || outcome.held);
    }
    found.without += has_sure ? 0 : 1;
    all += has_sure ? 1 : 0;
    held += has_sure && is_held ? 1 : 0;
  }
  found.held = share_of(held, all);
  return found;
}

std::vector<ScatterRow> scatter_rows(const Scene& scene, const TriedGrips& tried) {
  std::vector<ScatterRow> rows;
  for (const auto& [sample, is_first] :
       {std::pair{TrialSample::best, true}, {TrialSample::best, false}, {TrialSample::stratified, false}})
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      ScatterRow row{sample, v, is_first, {}, {}};
      for (std::size_t g = 0; g < tried.grips.size(); ++g) {
        const TrialGrip& grip = tried.grips[g];
        if (grip.vessel == v && grip.sample == sample && (!is_first || grip.rank <= FIRST_GRIPS))
          row.count.add(tried.found[g].placements);
      }
      row.held = share_of(row.count.held, row.count.all);
      if (row.count.all > 0) rows.push_back(row);
    }
  return rows;
}

std::vector<TrialBar> bars_of(const Scene& scene, const TriedGrips& tried, const TrialAnalysis& analysis) {
  std::vector<TrialBar> bars;
  const auto add_auc = [&](const char* what, double wanted, std::size_t predictor) {
    TrialBar bar{what, wanted, NONE, {}, "no grips"};
    for (const PredictorRow& row : analysis.predictors) {
      if (!(row.group == JUDGED) || row.predictor != predictor) continue;
      bar.found = row.auc.auc;
      bar.interval = row.auc.interval;
      bar.how = fmt::format("{} held everywhere, {} did not", counted(row.auc.successes, "grip"), row.auc.failures);
      bar.is_judged = std::min(row.auc.successes, row.auc.failures) >= LEAST_JUDGED;
    }
    bars.push_back(bar);
  };
  add_auc("AUC of the worst effort, stratified sample, fill-tilt", WANTED_EFFORT_AUC, BY_WORST_EFFORT);
  add_auc("AUC of the score, stratified sample, fill-tilt", WANTED_SCORE_AUC, BY_SCORE);
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const auto [share, discarded, without] = surely_held(tried, v);
    if (share.of + discarded + without == 0) continue;
    bars.push_back({fmt::format("best grips of {} that hold wherever effort is at most {}", scene.vessels[v].name, SURE_EFFORT),
                    WANTED_HELD, share.share, share.interval,
                    fmt::format("{} of {}; left out: {} with a discarded trial, {} without such an effort", share.yes,
                                counted(share.of, "grip"), discarded, without),
                    share.of >= LEAST_JUDGED});
  }
  for (const ScatterRow& row : analysis.scatter ? analysis.scatter->rows : std::vector<ScatterRow>{}) {
    if (!row.is_first) continue;
    const std::string failures = failures_text(row.count);
    bars.push_back(
        {fmt::format("first {} grips of {} that hold where a person's hand may be", FIRST_GRIPS, scene.vessels[row.vessel].name),
         WANTED_HELD, row.held.share, row.held.interval,
         fmt::format("{} of {}{}", row.held.yes, counted(row.held.of, "placement"), failures.empty() ? "" : "; " + failures),
         row.held.of >= LEAST_JUDGED});
  }
  return bars;
}

// By whole grips, or by their placements. Grips that do not hold by their effort are left out, because they score 0 with any weights.
std::optional<WeightTrial> weights_by_trials(const Scene& scene, const TriedGrips& tried, std::uint64_t seed,
                                             std::size_t placements) {
  std::vector<TermedGrip> grips;
  for (std::size_t g = 0; g < tried.grips.size(); ++g) {
    const GripPrediction& predicted = tried.found[g].prediction;
    const GripFate fate = fate_of(tried, g, JUDGED);
    if (fate.trials == 0 || !core_f64::effort_holds(predicted.scene_worst_effort)) continue;
    if (placements == 0) grips.push_back({predicted.terms, fate.held && !fate.discarded, fate.discarded});
    for (const Placement& one : tried.found[g].placements)
      if (placements > 0) grips.push_back({predicted.terms, one.held, !one.is_possible || is_discarded(one.reason)});
  }
  if (grips.empty()) return std::nullopt;
  return try_weights(grips, effective_weights(scene), seed, std::max<std::size_t>(placements, 1));
}

ScatterAnalysis analyze_scatter(const Scene& scene, const TriedGrips& tried, const TrialOptions& options) {
  ScatterAnalysis analysis;
  analysis.rows = scatter_rows(scene, tried);
  for (const TrialSample sample : {TrialSample::stratified, TrialSample::best}) {
    ScatterPredictors row{sample, {}, {}};
    std::array<std::vector<Prediction>, SCATTER_PREDICTORS> predicted;
    for (std::size_t k = 0; k < SCATTER_PREDICTORS; ++k) {
      predicted[k] = scatter_predictions(tried, sample, k);
      row.aucs[k] = auc_with_interval(predicted[k], options.seed);
    }
    row.robust_gain = auc_difference(predicted[BY_ROBUST_RANK], predicted[BY_OWN_SCORE], options.seed);
    if (!predicted[0].empty()) analysis.predictors.push_back(row);
  }
  analysis.weights = weights_by_trials(scene, tried, options.seed, options.scatter);
  return analysis;
}

}  // namespace

const std::array<const char*, TRIAL_PREDICTORS> TRIAL_PREDICTOR_NAMES{
    "worst effort", "worst effort of the scene", "worst tips effort",     "push", "friction needed", "epsilon",
    "score",        "effort of the way",         "tips effort of the way"};

const std::array<const char*, SCATTER_PREDICTORS> SCATTER_PREDICTOR_NAMES{"score", "robust rank", "share of deviations that hold"};

bool is_of(const TrialGroup& group, const TrialGrip& grip, const TrialCase& one) {
  return grip.sample == group.sample && one.protocol == group.protocol &&
         (one.protocol == TrialProtocol::fill_tilt || one.material == group.material);
}

std::vector<Prediction> predictions_of(const TriedGrips& tried, const TrialGroup& group, std::size_t predictor) {
  std::vector<Prediction> predictions;
  for (std::size_t g = 0; g < tried.grips.size(); ++g) {
    if (!is_by_trial(predictor)) {
      const GripFate fate = fate_of(tried, g, group);
      if (fate.trials == 0 || fate.discarded) continue;
      const double value = value_of(tried, g, group, predictor);
      if (!std::isnan(value)) predictions.push_back({value, fate.held, g});
      continue;
    }
    for (std::size_t k = 0; k < tried.cases_of(g).size(); ++k) {
      const TrialOutcome& outcome = tried.found[g].outcomes[k];
      if (!is_of(group, tried.grips[g], tried.cases_of(g)[k]) || !is_conclusive(outcome)) continue;
      const CasePrediction& predicted = tried.found[g].prediction.cases[k];
      predictions.push_back({-(predictor == BY_LEG_EFFORT ? predicted.leg_effort : predicted.leg_tips), outcome.held, g});
    }
  }
  return predictions;
}

std::vector<Prediction> scatter_predictions(const TriedGrips& tried, TrialSample sample, std::size_t predictor) {
  std::vector<std::pair<double, double>> ranked;  // as lists are: by the 10th percentile, then by the mean
  for (const GripFinding& found : tried.found) ranked.emplace_back(found.robust.low, found.robust.mean);
  std::sort(ranked.begin(), ranked.end());
  std::vector<Prediction> predictions;
  for (std::size_t g = 0; g < tried.grips.size(); ++g) {
    const GripFinding& found = tried.found[g];
    if (tried.grips[g].sample != sample) continue;
    const auto rank = std::lower_bound(ranked.begin(), ranked.end(), std::pair(found.robust.low, found.robust.mean));
    const std::array<double, SCATTER_PREDICTORS> predicted{found.prediction.score, static_cast<double>(rank - ranked.begin()),
                                                           found.robust.share};
    for (const Placement& one : found.placements) predictions.push_back({predicted[predictor], one.held, g});
  }
  return predictions;
}

TrialAnalysis analyze_trials(const Scene& scene, const TriedGrips& tried, const TrialOptions& options) {
  TrialAnalysis analysis;
  analysis.groups = groups_of(tried, options);
  for (const TrialGroup& group : analysis.groups) {
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      add_successes(tried, options.settings, group, v, analysis.successes);
      if (const auto row = whole_grips(tried, options.settings, group, v)) analysis.grips.push_back(*row);
    }
    for (std::size_t predictor = 0; predictor < TRIAL_PREDICTORS; ++predictor)
      analysis.predictors.push_back({group, predictor, auc_with_interval(predictions_of(tried, group, predictor), options.seed)});
    analysis.efforts.push_back(efforts_of(tried, group));
  }
  analysis.pushed = pushed_of(analysis.grips);
  if (options.fill_tilt) analysis.weights = weights_by_trials(scene, tried, options.seed, 0);
  if (options.scatter > 0) analysis.scatter = analyze_scatter(scene, tried, options);
  if (options.fill_tilt) analysis.bars = bars_of(scene, tried, analysis);
  analysis.disagreements = find_disagreements(tried);
  return analysis;
}

const char* TrialBar::verdict() const {
  if (std::isnan(found)) return "not measured";
  if (!is_judged) return "too few to judge";
  return found >= wanted ? "met" : "missed";
}

std::string sample_text(TrialSample sample) { return sample == TrialSample::best ? "best grips" : "stratified sample"; }

std::string scatter_row_text(const ScatterRow& row) {
  return row.is_first ? fmt::format("first {} grips", FIRST_GRIPS) : sample_text(row.sample);
}

std::string group_text(const TrialGroup& group, const TrialSettings& settings) {
  const std::string sample = sample_text(group.sample);
  if (group.protocol == TrialProtocol::fill_tilt) return fmt::format("{}, fill-tilt", sample);
  return fmt::format("{}, six-forces, {}", sample, material_text(settings.materials[static_cast<std::size_t>(group.material)]));
}

std::string material_text(const TrialMaterial& material) {
  return fmt::format("mass and friction of {}", material.name == "scene" ? "the scene" : material.name);
}

std::string weights_text(const WeightTrial& weights) {
  const auto contest = [](const WeightContest& one) {
    return fmt::format("the fitted weights have an AUC of {}, and the scene's weights {}; the difference is {}",
                       interval_text(one.fitted.auc, one.fitted.interval, 3), interval_text(one.given.auc, one.given.interval, 3),
                       interval_text(one.difference.difference, one.difference.interval, 3));
  };
  std::string text = fmt::format("On the other half {}: {}.", contest(weights.all),
                                 weights.is_better() ? "the fitted weights are better by more than the interval"
                                                     : "the fitted weights are not better by more than the interval");
  if (!std::isnan(weights.tried.difference.difference))
    text += fmt::format(" Without the discarded grips {}.", contest(weights.tried));
  return text;
}

std::string failures_text(const PlacementCount& count) {
  std::string text;
  const auto add = [&](std::size_t number, const char* name) {
    if (number > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", readable_number(number), name);
  };
  for (std::size_t k = 0; k < count.reasons.size(); ++k) add(count.reasons[k], TRIAL_REASON_NAMES[k]);
  add(count.impossible, "impossible");
  return text;
}

std::string outcome_text(const TrialCase& one, const TrialOutcome& outcome) {
  const std::string motion = fmt::format("it moved by {:.1f} mm and turned by {:.1f}° in the hand, and a contact slid by {:.1f} mm",
                                         1e3 * outcome.move, degrees(outcome.turn), 1e3 * outcome.slip);
  if (outcome.discarded)
    return outcome.reason == TrialReason::overlap  ? "Discarded: the hand began too deep in the vessel."
           : outcome.reason == TrialReason::buried ? "Discarded: a finger was too deep in the vessel once the hand had closed."
                                                   : fmt::format("Discarded: the engine diverged. {}", outcome.detail);
  if (outcome.held) return fmt::format("The vessel was held: at most {}.", motion);
  if (outcome.reason == TrialReason::earlier) return "The vessel was lost at a smaller tilt.";
  if (outcome.reason == TrialReason::release) return fmt::format("The vessel was lost as it was released: {}.", motion);
  const char* how = outcome.reason == TrialReason::turned ? "it turned too far" : "it moved too far";
  if (one.protocol == TrialProtocol::six_forces)
    return fmt::format("The vessel was lost {:.2f} s after the release, as {}: {}.", outcome.when, how, motion);
  return fmt::format("The vessel was lost {:.2f} s after the release, at a tilt of {:.0f}°, as {}: {}.", outcome.when,
                     degrees(outcome.tilt_lost), how, motion);
}

std::string interval_text(double value, const Interval& interval, int digits) {
  if (std::isnan(value)) return "\u2013";
  if (std::isnan(interval.low)) return shown_number(value, digits);
  return fmt::format("{} ({} to {})", shown_number(value, digits), shown_number(interval.low, digits),
                     shown_number(interval.high, digits));
}

}  // namespace wholehand
