// SPDX-License-Identifier: MIT
// Sections of the page with charts and drawings.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "charts/lines.h"
#include "report/html.h"
#include "trials/cases.h"
#include "trials/page_parts.h"

namespace wholehand {
namespace {

constexpr int ROC_STEPS = 100;

// The curve at even steps of the failures' share: where it rises straight up, its top.
std::vector<double> curve_at_steps(const std::vector<RocPoint>& curve) {
  std::vector<double> heights;
  for (int step = 0; step <= ROC_STEPS; ++step) {
    const double x = static_cast<double>(step) / ROC_STEPS;
    std::size_t after = 0;
    while (after < curve.size() && curve[after].failures <= x) ++after;
    if (after == curve.size()) {
      heights.push_back(1);
      continue;
    }
    const RocPoint &a = curve[after - 1], &b = curve[after];
    heights.push_back(a.successes + (b.successes - a.successes) * (x - a.failures) / (b.failures - a.failures));
  }
  return heights;
}

void write_roc(MarkupWriter& html, const TrialPageSource& source, const TrialGroup& group, const char* title,
               const std::vector<std::size_t>& predictors) {
  LineChart chart;
  chart.name = {fmt::format("roc-{}", predictors[0]), title, "Share of the grips that hold against share of those that do not. "};
  chart.x_label = "failures that are taken for successes";
  chart.y_label = "successes that are found";
  chart.highest = 1;
  for (int step = 0; step <= ROC_STEPS; ++step) chart.x.push_back(static_cast<double>(step) / ROC_STEPS);
  for (std::size_t k = 0; k < predictors.size(); ++k) {
    const auto curve = roc_curve(predictions_of(source.tried, group, predictors[k]));
    if (curve.empty()) continue;
    LineChart::Line line;
    line.label = TRIAL_PREDICTOR_NAMES[predictors[k]];
    line.y = curve_at_steps(curve);
    line.shade = static_cast<double>(k) / static_cast<double>(predictors.size());
    line.is_dashed = k % 2 == 1;
    chart.lines.push_back(line);
    const double auc = auc_of(predictions_of(source.tried, group, predictors[k]));
    chart.name.description += fmt::format("{}: AUC {:.2f}. ", line.label, auc);
  }
  if (chart.lines.empty()) return;
  html.open("div", {{"class", "chart"}}).element("h4", title);
  write_chart(html, chart);
  html.close();
}

void write_auc_table(MarkupWriter& html, const TrialPageSource& source) {
  const TrialAnalysis& analysis = source.analysis;
  std::vector<std::string> columns{"predictor"};
  for (const TrialGroup& group : analysis.groups) columns.push_back(group_text(group, source.options.settings));
  HtmlTable table(html, "AUC against success, with intervals of 95 %", columns);
  for (std::size_t predictor = 0; predictor < TRIAL_PREDICTORS; ++predictor) {
    std::vector<std::string> cells{
        fmt::format("{}{}", TRIAL_PREDICTOR_NAMES[predictor], is_by_trial(predictor) ? " (by trial)" : "")};
    for (const TrialGroup& group : analysis.groups)
      for (const PredictorRow& row : analysis.predictors)
        if (row.group == group && row.predictor == predictor)
          cells.push_back(
              fmt::format("{}; {} : {}", interval_text(row.auc.auc, row.auc.interval, 2), row.auc.successes, row.auc.failures));
    table.row(cells);
  }
  table.end();
}

std::string bin_text(const CalibrationBin& bin) {
  return std::isinf(bin.to) ? fmt::format("{} and more", plain_number(bin.from))
                            : fmt::format("{} to {}", plain_number(bin.from), plain_number(bin.to));
}

void write_calibration(MarkupWriter& html, const GroupEfforts& efforts, const std::string& name, std::size_t number) {
  LineChart chart;
  chart.name = {fmt::format("calibration{}", number), "Share of trials held over effort: " + name, "By bins of effort. "};
  chart.x_label = "effort (mean of the bin)";
  chart.y_label = "share held";
  chart.highest = 1;
  std::array<LineChart::Line, 3> lines;
  lines[0].label = "held";
  lines[1].label = "interval";
  lines[1].is_dashed = lines[2].is_dashed = true;
  lines[1].shade = lines[2].shade = 0.5;
  for (const CalibrationBin& bin : efforts.bins) {
    if (bin.held.of == 0 || std::isinf(bin.to) || std::isnan(bin.mean)) continue;
    chart.x.push_back(bin.mean);
    lines[0].y.push_back(bin.held.share);
    lines[1].y.push_back(bin.held.interval.low);
    lines[2].y.push_back(bin.held.interval.high);
    chart.name.description += fmt::format("{}: {:.0f} %. ", bin_text(bin), 100 * bin.held.share);
  }
  if (chart.x.size() < 2) return;
  chart.lines.assign(lines.begin(), lines.end());
  html.open("div", {{"class", "chart"}}).element("h4", name);
  write_chart(html, chart);
  html.close();
}

void write_effort_tables(MarkupWriter& html, const GroupEfforts& efforts, const std::string& name) {
  HtmlTable bins(html, "Trials held by bins of effort: " + name, {"effort", "held"});
  for (const CalibrationBin& bin : efforts.bins)
    if (bin.held.of > 0) bins.row({bin_text(bin), share_text(bin.held)});
  bins.end();
  const Confusion& c = efforts.confusion;
  HtmlTable table(html, "Effort up to 1 against held: " + name, {"effort", "held", "lost"});
  table.row({"up to 1", fmt::format("{}", c.held_as_said), fmt::format("{}", c.lost_though_said)});
  table.row({"above 1", fmt::format("{}", c.held_though_not), fmt::format("{}", c.lost_as_said)});
  table.end();
  html.element("p", fmt::format("Effort is right in {}. {} trials were not reached, {} were discarded.", share_text(c.right()),
                                efforts.earlier, efforts.discarded));
}

std::string grip_words(const TrialPageSource& source, const Disagreement& which) {
  const TrialGrip& grip = source.tried.grips[which.grip];
  const TrialCase& one = source.tried.cases_of(which.grip)[which.place];
  const std::string state = one.protocol == TrialProtocol::fill_tilt
                                ? fmt::format("filled to {:.0f} %, tilted by {:.0f}°", 100 * one.fill, degrees(one.tilt))
                                : fmt::format("pushed along {}, {}", FORCE_DIRECTION_NAMES[static_cast<std::size_t>(one.direction)],
                                              group_text({grip.sample, one.protocol, one.material}, source.options.settings));
  return fmt::format("{}, grip {} ({}), {}", source.scene.vessels[grip.vessel].name, grip.number,
                     TRIAL_SAMPLE_NAMES[static_cast<std::size_t>(grip.sample)], state);
}

void write_disagreement(MarkupWriter& html, const TrialPageSource& source, const ShownDisagreement& shown, std::size_t number) {
  const GripFinding& found = source.tried.found[shown.which.grip];
  const TrialCase& one = source.tried.cases_of(shown.which.grip)[shown.which.place];
  const std::string words = grip_words(source, shown.which), effort = shown_number(shown.which.effort, 2);
  html.open("div", {{"class", "drawing"}});
  if (!shown.drawing.empty())
    html.empty("img",
               {{"src", svg_address(shown.drawing)},
                {"alt", fmt::format("Front and side view of the hand on {}.{}", words,
                                    shown.forces.empty() ? "" : " Arrows show the forces of the hand: " + shown.forces + ".")}});
  html.open("p").element("strong", fmt::format("{}: effort {}. ", number, effort)).text(words + ". ");
  html.text(outcome_text(one, found.outcomes[shown.which.place])).close();
  if (shown.recording.empty())
    html.element("p", fmt::format("There is no recording: {}.", shown.trouble));
  else
    html.open("p")
        .element("a", shown.recording, {{"href", shown.recording}})
        .text(": `wholehand view " + shown.recording + "` plays it.")
        .close();
  html.close();
}

}  // namespace

void write_trial_predictors(MarkupWriter& html, const TrialPageSource& source) {
  open_trial_section(html, "predictors", "What predicts success");
  html.element(
      "p",
      "Success of a grip is to hold in every trial of its group; grips with a discarded trial are left out. The two predictors "
      "\u201cby trial\u201d are judged trial by trial, without those whose state was not reached. After each AUC stand its "
      "interval, and "
      "the numbers of successes and failures.");
  if (!source.analysis.groups.empty()) {
    const TrialGroup& group = source.analysis.groups[0];
    html.open("figure").open("div", {{"class", "charts"}});
    write_roc(html, source, group, "By efforts and forces", {BY_WORST_EFFORT, BY_TIPS_EFFORT, BY_PUSH, BY_FRICTION_NEEDED});
    write_roc(html, source, group, "By scores and epsilon", {BY_SCORE, BY_SCORE_0_1, BY_EPSILON});
    html.close();
    html.element("figcaption",
                 fmt::format("ROC curves of the grips of the {}. The nearer a curve to the upper left corner, the better.",
                             group_text(group, source.options.settings)));
    html.close();
  }
  write_auc_table(html, source);
  html.close();
}

void write_trial_efforts(MarkupWriter& html, const TrialPageSource& source) {
  open_trial_section(html, "efforts", "Is effort right?");
  html.element("p",
               "An effort up to 1 says that the hand holds the state. Trials whose state was not reached, and discarded ones, are "
               "left out.");
  html.open("figure").open("div", {{"class", "charts"}});
  for (std::size_t k = 0; k < source.analysis.efforts.size(); ++k)
    write_calibration(html, source.analysis.efforts[k], group_text(source.analysis.efforts[k].group, source.options.settings),
                      k + 1);
  html.close().element(
      "figcaption",
      "Share of the trials that held, over their effort, with Wilson's intervals of 95 %. Efforts of 4 and more are in "
      "the tables alone.");
  html.close();
  for (const GroupEfforts& efforts : source.analysis.efforts)
    write_effort_tables(html, efforts, group_text(efforts.group, source.options.settings));
  html.close();
}

void write_trial_disagreements(MarkupWriter& html, const TrialPageSource& source) {
  open_trial_section(html, "disagreements", "Where effort and engine disagree");
  if (source.disagreements.empty()) {
    html.element("p", "They disagree in no trial.").close();
    return;
  }
  html.element("p",
               "The largest efforts that held, and the smallest that did not: the farther from 1, the earlier in the list, and of "
               "each grip the "
               "worst trial.");
  html.open("figure").open("div", {{"class", "drawings"}});
  for (std::size_t k = 0; k < source.disagreements.size(); ++k) write_disagreement(html, source, source.disagreements[k], k + 1);
  html.close().element(
      "figcaption",
      "Seen from the side of the hand and from its right, as the hand grips. Arrows show the forces that kernel 10 finds for this "
      "state.");
  html.close().close();
}

}  // namespace wholehand
