// SPDX-License-Identifier: MIT
// Sections of the page with charts and drawings.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "base/charts/html.h"
#include "base/charts/lines.h"
#include "evidence/trials/cases.h"
#include "evidence/trials/page_parts.h"
#include "sweeps/grips/states.h"

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

void write_auc_table(MarkupWriter& html, const TrialPageSource& source, const TrialGroup& group) {
  const std::string name = group_text(group, source.options.settings);
  const auto& rows = source.analysis.predictors;
  const bool is_measured = std::any_of(rows.begin(), rows.end(),
                                       [&](const PredictorRow& row) { return row.group == group && !std::isnan(row.auc.auc); });
  if (!is_measured) {
    html.element("p", fmt::format("There is no AUC of the {}: all grips held in it, or none.", name));
    return;
  }
  HtmlTable table(html, "AUC against success: " + name, {"predictor", "AUC", "interval of 95 %", "successes", "failures"});
  for (const PredictorRow& row : rows) {
    if (!(row.group == group)) continue;
    const bool has_interval = !std::isnan(row.auc.interval.low);
    table.row({fmt::format("{}{}", TRIAL_PREDICTOR_NAMES[row.predictor], is_by_trial(row.predictor) ? " (by trial)" : ""),
               shown_number(row.auc.auc, 3),
               has_interval ? fmt::format("{} to {}", shown_number(row.auc.interval.low, 3), shown_number(row.auc.interval.high, 3))
                            : "\u2013",
               fmt::format("{}", row.auc.successes), fmt::format("{}", row.auc.failures)});
  }
  table.end();
}

void write_success_over_tilt(MarkupWriter& html, const TrialPageSource& source, const TrialGroup& group, std::size_t vessel) {
  LineChart chart;
  chart.name = {fmt::format("held{}", vessel + 1), "Share of trials held over the tilt: " + source.scene.vessels[vessel].name, ""};
  chart.x_label = "tilt (°)";
  chart.y_label = "share held";
  chart.x_is_angle = true;
  chart.highest = 1;
  std::vector<const SuccessRow*> rows;
  for (const SuccessRow& row : source.analysis.successes)
    if (row.group == group && row.vessel == vessel) rows.push_back(&row);
  for (const SuccessRow* row : rows) chart.x.push_back(degrees(row->tilt));
  std::sort(chart.x.begin(), chart.x.end());
  chart.x.erase(std::unique(chart.x.begin(), chart.x.end()), chart.x.end());
  if (chart.x.size() < 2) return;
  for (const SuccessRow* row : rows) {
    const std::string label = source.scene.liquid && !source.scene.liquid->volumes.empty()
                                  ? sweeps::fill_text(source.scene, vessel, row->fill)
                                  : fmt::format("fill {}", plain_number(row->fill));
    if (chart.lines.empty() || chart.lines.back().label != label) {
      chart.lines.push_back({label, std::vector<double>(chart.x.size(), std::nan("")), row->fill, {}, false, false});
      chart.name.description += label + ". ";
    }
    const auto place = std::find(chart.x.begin(), chart.x.end(), degrees(row->tilt)) - chart.x.begin();
    chart.lines.back().y[static_cast<std::size_t>(place)] = row->trials.held.share;
    if (row->trials.held.of > 0)
      chart.name.description += fmt::format("At {:.0f}°: {:.0f} %. ", degrees(row->tilt), 100 * row->trials.held.share);
  }
  html.open("div", {{"class", "chart"}}).element("h4", source.scene.vessels[vessel].name);
  write_chart(html, chart);
  html.close();
}

std::string bin_text(const CalibrationBin& bin) {
  return std::isinf(bin.to) ? fmt::format("{} and more", plain_number(bin.from))
                            : fmt::format("{} to {}", plain_number(bin.from), plain_number(bin.to));
}

void write_calibration(MarkupWriter& html, const GroupEfforts& efforts, const std::string& name, std::size_t number) {
  LineChart chart;
  chart.name = {fmt::format("calibration{}", number), "Share of trials held over effort: " + name, "By bins of effort. "};
  chart.x_label = "effort of the way (mean of the bin)";
  chart.y_label = "share held";
  chart.highest = 1;
  std::array<LineChart::Line, 3> lines;
  lines[0].label = "held";
  lines[1].label = "lower end";
  lines[2].label = "upper end";
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
  const Confusion& c = efforts.confusion;
  const bool has_both = c.held_as_said + c.held_though_not > 0 && c.lost_as_said + c.lost_though_said > 0;
  if (chart.x.size() < 2 || !has_both) return;  // a level line shows nothing that the table does not
  chart.lines.assign(lines.begin(), lines.end());
  html.open("div", {{"class", "chart"}}).element("h4", name);
  write_chart(html, chart);
  html.close();
}

void write_effort_tables(MarkupWriter& html, const TrialPageSource& source) {
  const std::vector<GroupEfforts>& all = source.analysis.efforts;
  HtmlTable table(html, "Effort up to 1 against held",
                  {"trials", "up to 1, held", "up to 1, lost", "above 1, held", "above 1, lost", "effort is right", "not reached",
                   "discarded"});
  for (const GroupEfforts& efforts : all) {
    const Confusion& c = efforts.confusion;
    std::vector<std::string> cells{group_text(efforts.group, source.options.settings)};
    for (const std::size_t count : {c.held_as_said, c.lost_though_said, c.held_though_not, c.lost_as_said})
      cells.push_back(fmt::format("{}", count));
    cells.insert(cells.end(), {share_text(c.right()), fmt::format("{}", efforts.earlier), fmt::format("{}", efforts.discarded)});
    table.row(cells);
  }
  table.end();
  for (std::size_t k = 0; k < all.size(); ++k) {
    const GroupEfforts& efforts = all[k];
    if (k == 1) html.open("details").element("summary", "The same of the other groups");
    HtmlTable bins(html, "Trials held by bins of effort: " + group_text(efforts.group, source.options.settings),
                   {"effort", "mean of the finite ones", "held"});
    for (const CalibrationBin& bin : efforts.bins)
      if (bin.held.of > 0) bins.row({bin_text(bin), shown_number(bin.mean, 2), share_text(bin.held)});
    bins.end();
  }
  if (all.size() > 1) html.close();
}

std::string grip_words(const TrialPageSource& source, const Disagreement& which) {
  const TrialGrip& grip = source.tried.grips[which.grip];
  const TrialCase& one = source.tried.cases_of(which.grip)[which.place];
  const std::string& material = source.options.settings.materials[static_cast<std::size_t>(one.material)].name;
  const std::string state = one.protocol == TrialProtocol::fill_tilt
                                ? fmt::format("fill {}, tilted by {}°", sweeps::fill_text(source.scene, grip.vessel, one.fill),
                                              plain_number(degrees(one.tilt)))
                                : fmt::format("pushed along {} at the mass and friction of {}",
                                              FORCE_DIRECTION_NAMES[static_cast<std::size_t>(one.direction)],
                                              material == "scene" ? "the scene" : material);
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
  html.open("p").element("strong", fmt::format("{}: effort of the way {}. ", number, effort)).text(words + ". ");
  html.text(outcome_text(one, found.outcomes[shown.which.place])).close();
  if (shown.recording.empty()) {
    html.element("p", fmt::format("There is no recording: {}.", shown.error));
  } else {
    html.open("p").element("a", shown.recording, {{"href", shown.recording}});
    html.text(", played by ").element("code", "wholehand view " + shown.recording).close();
  }
  html.close();
}

// A figure of charts side by side, with one caption; nothing where nothing can be drawn, of too few grips or states.
void write_charts(MarkupWriter& html, const std::string& caption, const std::function<void(MarkupWriter& charts)>& draw) {
  MarkupWriter charts;
  draw(charts);
  if (charts.written().empty()) return;
  html.open("figure").open("div", {{"class", "charts"}}).markup(charts.written()).close();
  html.element("figcaption", caption).close();
}

}  // namespace

void write_success_charts(MarkupWriter& html, const TrialPageSource& source) {
  const auto& groups = source.analysis.groups;
  const auto group =
      std::find_if(groups.begin(), groups.end(), [](const TrialGroup& one) { return one.protocol == TrialProtocol::fill_tilt; });
  if (group == groups.end()) return;
  const std::string caption = fmt::format("Share of the trials that held over the tilt, a line for each fill: {}.",
                                          group_text(*group, source.options.settings));
  write_charts(html, caption, [&](MarkupWriter& charts) {
    for (std::size_t v = 0; v < source.scene.vessels.size(); ++v) write_success_over_tilt(charts, source, *group, v);
  });
}

void write_trial_predictors(MarkupWriter& html, const TrialPageSource& source) {
  open_trial_section(html, "predictors", "What predicts success");
  html.element(
      "p",
      "Success of a grip is to hold in every trial of its group; grips with a discarded trial are left out. The two predictors "
      "\u201cby trial\u201d are judged trial by trial, without those whose state was not reached. After each AUC stand its "
      "interval, and the numbers of successes and failures. With few grips, or few of either, the intervals of AUCs are too "
      "narrow: "
      "a bootstrap knows no other grips than those that it has.");
  if (!source.analysis.groups.empty()) {
    const TrialGroup& group = source.analysis.groups[0];
    const std::string caption =
        fmt::format("ROC curves of the grips of the {}. The nearer a curve to the upper left corner, the better.",
                    group_text(group, source.options.settings));
    write_charts(html, caption, [&](MarkupWriter& charts) {
      write_roc(charts, source, group, "By efforts and forces", {BY_WORST_EFFORT, BY_TIPS_EFFORT, BY_PUSH, BY_FRICTION_NEEDED});
      write_roc(charts, source, group, "By scores and epsilon", {BY_SCORE, BY_EPSILON});
    });
  }
  for (const TrialGroup& group : source.analysis.groups) write_auc_table(html, source, group);
  html.close();
}

void write_trial_efforts(MarkupWriter& html, const TrialPageSource& source) {
  open_trial_section(html, "efforts", "Is effort right?");
  html.element(
      "p",
      "An effort up to 1 says that the hand holds the state. A trial goes through all tilts from the one before, or from "
      "upright at the release, to its own, and may lose the vessel on this way. So the largest effort on the way is taken, "
      "looked at every 5°. Trials whose state was not reached, and discarded ones, are left out.");
  const char* caption =
      "Share of the trials that held, over their effort, with Wilson's intervals of 95 %. Efforts of 4 and more are in the tables "
      "alone.";
  write_charts(html, caption, [&](MarkupWriter& charts) {
    for (std::size_t k = 0; k < source.analysis.efforts.size(); ++k)
      write_calibration(charts, source.analysis.efforts[k], group_text(source.analysis.efforts[k].group, source.options.settings),
                        k + 1);
  });
  write_effort_tables(html, source);
  html.close();
}

void write_trial_disagreements(MarkupWriter& html, const TrialPageSource& source) {
  open_trial_section(html, "disagreements", "Where effort and engine disagree");
  if (source.disagreements.empty()) {
    html.element("p", "They disagree in no trial.").close();
    return;
  }
  html.element(
      "p",
      "The largest efforts that held, and the smallest that did not, each of the way to its state: the farther from 1, the "
      "earlier in the list, and of each grip the worst trial.");
  html.open("figure").open("div", {{"class", "drawings"}});
  for (std::size_t k = 0; k < source.disagreements.size(); ++k) write_disagreement(html, source, source.disagreements[k], k + 1);
  html.close().element("figcaption",
                       "Seen from the side of the hand and from its right, as the hand grips. Arrows show the forces that kernel "
                       "10 finds for this state; for a push, those that hold the upright vessel.");
  html.close().close();
}

}  // namespace wholehand
