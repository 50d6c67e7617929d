// SPDX-License-Identifier: MIT
// Sections of the page that are tables and words.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/charts/html.h"
#include "base/text/readable.h"
#include "core/planes.h"
#include "evidence/trials/cases.h"
#include "evidence/trials/page_parts.h"

namespace wholehand {
namespace {

constexpr std::array<const char*, SCORE_TERM_COUNT> SCORE_TERMS{"fingers", "contacts", "depth", "posture", "force", "hold"};

// "0.25, 0.5, 1" without repeats, in the order in which they come.
std::string listed_values(const std::vector<TrialCase>& cases, TrialProtocol protocol,
                          const std::function<double(const TrialCase&)>& value) {
  std::vector<double> seen;
  std::string text;
  for (const TrialCase& one : cases) {
    if (one.protocol != protocol || std::find(seen.begin(), seen.end(), value(one)) != seen.end()) continue;
    seen.push_back(value(one));
    text += (text.empty() ? "" : ", ") + plain_number(value(one));
  }
  return text;
}

std::string discarded_text(const TrialCount& count) {
  if (count.discarded == 0) return "0";
  return count.diverged == 0 ? fmt::format("{}", count.discarded)
                             : fmt::format("{} ({} diverged)", count.discarded, count.diverged);
}

void write_whole_grips(MarkupWriter& html, const TrialPageSource& source) {
  if (!source.options.fill_tilt) return;
  HtmlTable table(html, "Grips that hold in every trial of fill-tilt", {"vessel", "grips", "held", "discarded"}, {1, 2});
  for (const WholeGrips& row : source.analysis.grips)
    if (row.group.protocol == TrialProtocol::fill_tilt)
      table.row({source.scene.vessels[row.vessel].name, group_text(row.group, source.options.settings), share_text(row.held),
                 fmt::format("{}", row.discarded)});
  table.end();
}

// The same grips at the mass and friction of the scene and at others, side by side.
void write_pushed_grips(MarkupWriter& html, const TrialPageSource& source) {
  if (source.analysis.pushed.empty()) return;
  std::vector<std::string> columns{"vessel", "grips"};
  for (const TrialMaterial& material : source.options.settings.materials) columns.push_back(material_text(material));
  HtmlTable table(html, "Grips that hold in all six directions", columns, {1});
  for (const PushedGrips& row : source.analysis.pushed) {
    std::vector<std::string> cells{source.scene.vessels[row.vessel].name, sample_text(row.sample)};
    for (const WholeGrips& one : row.by_material)
      cells.push_back(share_text(one.held) + (one.discarded > 0 ? fmt::format("; {} discarded", one.discarded) : ""));
    table.row(cells);
  }
  table.end();
}

std::string slipped_text(const TrialCount& count) { return share_text(share_of(count.slipped, count.held.yes)); }

void write_pushes(MarkupWriter& html, const TrialPageSource& source, const TrialGroup& group) {
  HtmlTable table(html, fmt::format("Pushes that are held: {}", group_text(group, source.options.settings)),
                  {"vessel", "fill", "held", "slipped of those held", "discarded"});
  for (const SuccessRow& row : source.analysis.successes)
    if (row.group == group)
      table.row({source.scene.vessels[row.vessel].name, plain_number(row.fill), share_text(row.trials.held),
                 slipped_text(row.trials), discarded_text(row.trials)});
  table.end();
}

// A row for each vessel and fill, a column for each tilt.
void write_states(MarkupWriter& html, const TrialPageSource& source, const TrialGroup& group) {
  std::vector<double> tilts;
  for (const SuccessRow& row : source.analysis.successes)
    if (row.group == group && std::find(tilts.begin(), tilts.end(), row.tilt) == tilts.end()) tilts.push_back(row.tilt);
  std::sort(tilts.begin(), tilts.end());
  std::vector<std::string> columns{"vessel", "fill"};
  for (const double tilt : tilts) columns.push_back(fmt::format("at {:.0f}°", degrees(tilt)));
  columns.insert(columns.end(), {"trials", "slipped of those held", "discarded"});
  HtmlTable table(html, fmt::format("Share of trials held, in %: {}", group_text(group, source.options.settings)), columns);
  const std::vector<SuccessRow>& all = source.analysis.successes;
  for (std::size_t k = 0; k < all.size();) {
    const SuccessRow& first = all[k];
    std::vector<std::string> cells{source.scene.vessels[first.vessel].name, plain_number(first.fill)};
    cells.resize(2 + tilts.size());
    TrialCount sum;
    for (; k < all.size() && all[k].group == first.group && all[k].vessel == first.vessel && all[k].fill == first.fill; ++k) {
      const TrialCount& count = all[k].trials;
      const auto column = static_cast<std::size_t>(std::find(tilts.begin(), tilts.end(), all[k].tilt) - tilts.begin());
      if (first.group == group && count.held.of > 0)
        cells[2 + column] = fmt::format("{:.0f} ({:.0f} to {:.0f})", 100 * count.held.share, 100 * count.held.interval.low,
                                        100 * count.held.interval.high);
      sum.held.of += count.held.of;
      sum.held.yes += count.held.yes;
      sum.slipped += count.slipped;
      sum.discarded += count.discarded;
      sum.diverged += count.diverged;
    }
    cells.insert(cells.end(), {fmt::format("{}", sum.held.of), slipped_text(sum), discarded_text(sum)});
    if (first.group == group) table.row(cells);
  }
  table.end();
}

void write_context(MarkupWriter& html) {
  html.element(
      "p",
      "For context, never for comparison: with an Allegro robot hand and other objects, six-forces at DexGraspBench's mass and "
      "friction is passed by 60.5 % of the grasps of Dexonomy, 49.2 % of those of BODex and 12.1 % of those of DexGraspNet. In a "
      "rerun of that benchmark, the AUC of measures of a grasp against success is 0.85 of dfc, 0.80 of tdg, 0.56 of Q1 and 0.53 "
      "of QP.");
}

}  // namespace

void write_trial_bars(MarkupWriter& html, const TrialPageSource& source) {
  open_trial_section(html, "bars", "The bars");
  if (source.analysis.bars.empty()) {
    html.element("p", "The bars are about the protocol fill-tilt, which was not asked for.").close();
    return;
  }
  HtmlTable table(html, "What the trials are to show", {"bar", "outcome", "at least", "found", "interval of 95 %", "by"}, {1, 5});
  for (const TrialBar& bar : source.analysis.bars) {
    const bool is_known = !std::isnan(bar.found);
    table.row({bar.what, bar.verdict(), shown_number(bar.wanted, 2), is_known ? shown_number(bar.found, 3) : "\u2013",
               is_known && !std::isnan(bar.interval.low)
                   ? fmt::format("{} to {}", shown_number(bar.interval.low, 3), shown_number(bar.interval.high, 3))
                   : "\u2013",
               bar.how});
  }
  table.end();
  html.element("p", fmt::format("An AUC of fewer than {0} grips that hold everywhere, or fewer than {0} that do not, is too few to "
                                "judge. So is a share of fewer than {0} grips.",
                                LEAST_JUDGED));
  html.close();
}

void write_trial_setup(MarkupWriter& html, const TrialPageSource& source) {
  const TrialOptions& options = source.options;
  const TrialSettings& settings = options.settings;
  open_trial_section(html, "tried", "What was tried");
  html.open("dl");
  const auto fact = [&html](const std::string& name, const std::string& text) {
    html.open("div").element("dt", name).element("dd", text).close();
  };
  std::array<std::size_t, 2> samples{};
  for (const TrialGrip& grip : source.tried.grips) ++samples[static_cast<std::size_t>(grip.sample)];
  fact("engine",
       fmt::format("{}, model \u201c{}\u201d: {}", source.engine, TRIAL_MODEL_NAMES[static_cast<std::size_t>(settings.model)],
                   settings.model == TrialModel::hand
                       ? "the hand is a body of bones with joints, whose torques the scene's strength limits"
                       : "each contact is a sphere on a slide along its normal"));
  fact("grips", fmt::format("{} of the stratified sample over all scores, {} of the best; seed {}{}", samples[1], samples[0],
                            options.seed, options.quick ? "; --quick: fewer grips and states" : ""));
  for (std::size_t v = 0; v < source.scene.vessels.size(); ++v) {
    const std::vector<TrialCase>& cases = source.tried.cases[v];
    if (cases.empty()) continue;
    const std::string fills = listed_values(cases, TrialProtocol::fill_tilt, [](const TrialCase& one) { return one.fill; });
    const std::string tilts =
        listed_values(cases, TrialProtocol::fill_tilt, [](const TrialCase& one) { return degrees(one.tilt); });
    const std::string pushed = listed_values(cases, TrialProtocol::six_forces, [](const TrialCase& one) { return one.fill; });
    std::string text = fills.empty() ? "" : fmt::format("fill-tilt at the fills {} and the tilts {}°", fills, tilts);
    if (!pushed.empty()) text += fmt::format("{}six-forces at the fill {}", text.empty() ? "" : "; ", pushed);
    if (v < source.tried.forms.size() && !source.tried.forms[v].empty()) text += "; the vessel is " + source.tried.forms[v];
    fact(source.scene.vessels[v].name, text);
  }
  if (!std::isnan(settings.mass)) fact("mass", fmt::format("{} kg in every state", plain_number(settings.mass)));
  if (!std::isnan(settings.friction)) fact("friction", plain_number(settings.friction));
  fact("held", fmt::format("moved by less than {} mm and turned by less than {}° in the hand",
                           plain_number(1e3 * settings.largest_move), plain_number(degrees(settings.largest_turn))));
  fact("discarded",
       fmt::format("the hand overlaps the vessel by more than {} mm at the start, a finger is more than {} mm in it once "
                   "closed, or the engine diverges; counted, and never a success",
                   plain_number(1e3 * settings.start_overlap), plain_number(1e3 * settings.buried)));
  html.close().close();
}

void write_trial_successes(MarkupWriter& html, const TrialPageSource& source) {
  open_trial_section(html, "success", "How many held");
  html.element(
      "p", fmt::format(
               "A share is of the trials that were not discarded, with Wilson's interval of 95 %. A trial at a tilt that the grip "
               "did not reach, as it had lost the vessel before, counts as not held. A trial slipped where a contact slid by more "
               "than {} mm, "
               "and may be held all the same.",
               plain_number(1e3 * source.options.settings.slip)));
  write_whole_grips(html, source);
  write_pushed_grips(html, source);
  write_success_charts(html, source);
  for (const TrialGroup& group : source.analysis.groups)
    (group.protocol == TrialProtocol::fill_tilt ? write_states : write_pushes)(html, source, group);
  if (source.options.six_forces) write_context(html);
  html.close();
}

namespace {

// A row for each grip of the lists.
void write_placed_grips(MarkupWriter& html, const TrialPageSource& source) {
  HtmlTable table(
      html, "Best grips at their deviations",
      {"vessel", "place in the list", "grip", "score", "robust score", "deviations that hold by effort", "held", "not held by"},
      {7});
  for (std::size_t g = 0; g < source.tried.grips.size(); ++g) {
    const TrialGrip& grip = source.tried.grips[g];
    const GripFinding& found = source.tried.found[g];
    if (grip.sample != TrialSample::best) continue;
    PlacementCount count;
    count.add(found.placements);
    table.row({source.scene.vessels[grip.vessel].name, fmt::format("{}", grip.rank), readable_number(grip.number),
               shown_number(found.prediction.score, 3), shown_number(found.robust.low, 3), shown_number(found.robust.share, 2),
               share_text(share_of(count.held, count.all)), failures_text(count)});
  }
  table.end();
}

void write_weights(MarkupWriter& html, const TrialPageSource& source, const std::optional<WeightTrial>& weights,
                   const char* caption) {
  if (!weights || !weights->fit.is_fitted) return;
  if (weights->fit.has_ridge)
    html.element(
        "p",
        "On these grips the likelihood has no largest place, as successes and failures can be separated or terms depend on one "
        "another. So large coefficients were penalized (a ridge).");
  const std::array<double, 6> given = effective_weights(source.scene);
  HtmlTable table(html, caption, {"term", "the scene's weight", "fitted coefficient", "fitted weight"});
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k)
    table.row({SCORE_TERMS[k], shown_number(given[k], 2), shown_number(weights->fit.coefficients[k], 2),
               shown_number(weights->weights[k], 2) + (weights->fit.is_least[k] ? " (the least)" : "")});
  table.end();
  html.element("p", fmt::format("Fitted on {} grips, judged on the other {}. {}", weights->fitted_on, weights->judged_on,
                                weights_text(*weights)));
}

}  // namespace

void write_trial_scatter(MarkupWriter& html, const TrialPageSource& source) {
  if (!source.analysis.scatter) return;
  const ScatterAnalysis& scatter = *source.analysis.scatter;
  open_trial_section(html, "scatter", "Where a person's hand may be");
  html.element("p", fmt::format("Each grip was tried at {} of the scene's [robust]. It is held there if it is held in every "
                                "trial. Where it is infeasible or implausible (impossible), or discarded, it is not held.",
                                counted(source.options.scatter, "random deviation")));
  HtmlTable table(html, "Deviations at which grips are held", {"vessel", "grips", "held", "not held by"}, {1, 2, 3});
  for (const ScatterRow& row : scatter.rows)
    table.row({source.scene.vessels[row.vessel].name, scatter_row_text(row), share_text(row.held), failures_text(row.count)});
  table.end();
  HtmlTable aucs(html, "AUC against being held at a deviation", {"grips", "by", "AUC"}, {1, 2});
  for (const ScatterPredictors& row : scatter.predictors) {
    for (std::size_t k = 0; k < SCATTER_PREDICTORS; ++k)
      aucs.row({sample_text(row.sample), SCATTER_PREDICTOR_NAMES[k], interval_text(row.aucs[k].auc, row.aucs[k].interval, 3)});
    aucs.row({sample_text(row.sample), "robust rank less score",
              interval_text(row.robust_gain.difference, row.robust_gain.interval, 3)});
  }
  aucs.end();
  write_placed_grips(html, source);
  html.close();
}

void write_trial_weights(MarkupWriter& html, const TrialPageSource& source) {
  open_trial_section(html, "weights", "Weights of the score");
  const auto& weights = source.analysis.weights;
  if (!weights || !weights->fit.is_fitted) {
    html.element("p", "No weights were fitted: the stratified sample at fill-tilt lacks successes or failures.").close();
    return;
  }
  html.element("p", fmt::format("A logistic regression of holding everywhere on the six terms of the score was fitted on half of "
                                "the grips of the stratified sample that hold by their effort; others score 0 with any weights. A "
                                "discarded grip counts as one that did not hold, so that few of them come into a list of best "
                                "grips. Each weight is at least {} of the sum.",
                                LEAST_WEIGHT));
  write_weights(html, source, weights, "Weights that the trials would choose");
  if (source.analysis.scatter)
    write_weights(html, source, source.analysis.scatter->weights, "Weights that the trials at deviations would choose");
  html.close();
}

void write_trial_words(MarkupWriter& html) {
  open_trial_section(html, "words", "The words");
  html.open("dl");
  const auto word = [&html](const char* name, const char* meaning) {
    html.open("div").element("dt", name).element("dd", meaning).close();
  };
  word("fill-tilt", "gravity turns at 25° a second to each tilt and stays there for 1 s, once for each fill");
  word("six-forces",
       "without weight, a force of 10 m/s² times the mass acts for 2 s along each of six directions, each from a fresh start");
  word("stratified sample", "grips drawn in equal numbers from ten equal parts of the range of scores");
  word("best", "the best different grips of each vessel by their score; none of them is in the sample too");
  word(
      "effort",
      "least share of its strength that the digit nearest to its limit must give so that the hand holds the load; up to 1 the hand "
      "holds; of thumb and index tip alone: tips effort");
  word("effort of the way",
       "largest effort of the states that a trial goes through on the way to its own, since the tilt before or since the release: "
       "at "
       "every 5° and at both ends; of a push, its effort");
  word("worst effort",
       "largest effort of the ways to the states that were tried; of the scene: of all fills and tilts of the scene");
  word("push", "force that may push the full, upright vessel along any axis while the effort stays up to 1");
  word("friction needed", "least friction with which the worst effort of the scene is up to 1");
  word("epsilon", "radius of the largest ball of wrenches that the contacts resist (Ferrari and Canny), the middle of its bracket");
  word("AUC",
       "how often a success has a better value than a failure: 1 is perfect, 0.5 is chance. Its interval is by a bootstrap that "
       "draws "
       "grips, not trials");
  word("state not reached", "the vessel was lost at a smaller tilt of the same fill");
  html.close().close();
}

}  // namespace wholehand
