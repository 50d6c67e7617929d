// SPDX-License-Identifier: MIT
#include "evidence/report/holding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/charts/lines.h"
#include "core/vectors.h"
#include "sweeps/grips/states.h"

namespace wholehand {
namespace {

constexpr double LEAST_EXTENT = 1.2;  // of the chart of efforts: shows where the strength ends
constexpr double MOST_EXTENT = 3;     // beyond it the whole hand's line would lie flat on the axis

const char* digit_name(std::size_t digit) { return digit < FINGER_COUNT ? FINGER_NAMES[digit] : "palm"; }

// The largest finite value; 0 where there is none.
double largest_finite(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values)
    if (std::isfinite(value)) largest = std::max(largest, value);
  return largest;
}

bool any_infinite(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return std::isinf(value); });
}

bool any_finite(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

std::string fullest_text(const Scene& scene, std::size_t vessel) {
  if (!scene.liquid) return "empty";
  return (scene.liquid->volumes.empty() ? "filled to " : "filled with ") +
         sweeps::fill_text(scene, vessel, vessel_fills(scene, scene.vessels[vessel]).back());
}

// A line in words, for those who do not see it.
std::string effort_text(const Scene& scene, const std::string& subject, const std::vector<double>& efforts) {
  if (!any_finite(efforts)) return fmt::format("{}: no force holds the vessel at any tilt. ", subject);
  const std::string range = fmt::format("{}: {} at {}°, at most {}", subject, shown_number(efforts.front(), 2),
                                        shown_number(degrees(scene.tilts.front()), 0), shown_number(largest_finite(efforts), 2));
  return range + (any_infinite(efforts) ? " where a force holds the vessel, and infinite elsewhere. " : ". ");
}

LineChart effort_chart(const Scene& scene, const TiltEfforts& efforts) {
  LineChart chart;
  chart.x_label = "tilt (°)";
  chart.x_is_angle = true;
  chart.y_label = "effort (share of the strength)";
  for (const double tilt : scene.tilts) chart.x.push_back(degrees(tilt));
  for (const bool is_whole : {true, false}) {
    LineChart::Line line;
    line.label = is_whole ? "whole hand" : "two tips";
    line.y = is_whole ? efforts.whole : efforts.tips;
    line.shade = is_whole ? 0.1 : 0.7;
    line.is_dashed = !is_whole;
    line.marks_ends = true;
    chart.name.description += effort_text(scene, is_whole ? "Whole hand" : "Two tips", line.y);
    chart.lines.push_back(line);
  }
  chart.limit = LineChart::Limit{1, "all of the strength"};
  chart.highest =
      std::clamp(1.1 * std::max(largest_finite(efforts.whole), largest_finite(efforts.tips)), LEAST_EXTENT, MOST_EXTENT);
  return chart;
}

std::string efforts_caption(const TiltEfforts& efforts) {
  std::string caption =
      "The effort is the share of its strength that the digit nearest to its limit must give. Up to 1 the vessel is held. The "
      "whole line is that of all contacts of the hand, and the dashed line that of the tips of thumb and index finger alone.";
  if (!any_finite(efforts.tips)) {
    caption += " No force of the two tips holds the vessel at any tilt, so they have no line.";
  } else if (any_infinite(efforts.tips) || any_infinite(efforts.whole)) {
    caption += " A cross marks where a line ends because no force holds the vessel beyond.";
  }
  if (!any_finite(efforts.whole)) caption += " No force of the whole hand holds the vessel at any tilt.";
  const double highest = std::max(largest_finite(efforts.whole), largest_finite(efforts.tips));
  if (highest > MOST_EXTENT)
    caption += fmt::format(" The efforts go up to {}; the chart ends at {}.", shown_number(highest, 1), plain_number(MOST_EXTENT));
  return caption;
}

void write_effort_table(MarkupWriter& html, const Scene& scene, const std::string& name, const TiltEfforts& efforts) {
  html.open("details").element("summary", "The same as numbers");
  HtmlTable table(html, fmt::format("Efforts of the best grip of {} over the tilt", name),
                  {"tilt (°)", "whole hand", "two tips", "two tips over whole hand"});
  for (std::size_t t = 0; t < scene.tilts.size(); ++t) {
    const double whole = efforts.whole[t], tips = efforts.tips[t];
    table.row({shown_number(degrees(scene.tilts[t]), 1), shown_number(whole, 3), shown_number(tips, 3),
               shown_number(whole > 0 ? tips / whole : std::nan(""), 1)});
  }
  table.end();
  html.close();
}

}  // namespace

bool reports_efforts(const Scene& scene) { return scene.strength && !scene.tilts.empty(); }

sweeps::GripReport grip_with_holding(const ReportSource& source, std::size_t vessel, const GripInput& grip) {
  sweeps::GripReport report = sweeps::make_grip_report(source.scene, vessel, grip, sweeps::scene_axes(source.scene, vessel),
                                                       sweeps::core_grip_methods(source.scene, source.core, "core"));
  sweeps::add_holding(report, source.scene, vessel, *source.core);
  return report;
}

std::array<DigitLoad, FINGER_COUNT + 1> digit_loads(const sweeps::StateHold& hold) {
  std::array<DigitLoad, FINGER_COUNT + 1> loads{};
  for (const sweeps::HeldContact& contact : hold.contacts)
    loads[static_cast<std::size_t>(contact.digit)].force += dot(contact.force, contact.normal);
  for (std::size_t digit = 0; digit < loads.size(); ++digit) {
    if (!std::isfinite(hold.effort)) loads[digit].force = std::nan("");
    loads[digit].share = loads[digit].force / hold.strength.digits[digit];
  }
  return loads;
}

void write_digits(MarkupWriter& html, const Scene& scene, const std::vector<RankedReport>& grips, const std::string& name) {
  std::vector<std::string> columns{"digit", "strength (N)"};
  std::vector<std::array<DigitLoad, FINGER_COUNT + 1>> loads;
  for (const auto& [rank, report] : grips) {
    const auto hardest = sweeps::hardest_state(report);
    if (!hardest) continue;
    loads.push_back(digit_loads(report.holds[*hardest]));
    columns.push_back(fmt::format("grip {} (N)", rank));
    columns.push_back(fmt::format("grip {} (%)", rank));
  }
  if (loads.empty()) return;
  HtmlTable table(
      html, "Normal force of each digit, and its share of the strength at the opening of the grip, in the hardest state of " + name,
      columns);
  for (std::size_t digit = 0; digit <= FINGER_COUNT; ++digit) {
    std::vector<std::string> cells{digit_name(digit), plain_number(scene.strength.value().digits[digit])};
    for (const auto& grip : loads) {
      cells.push_back(shown_number(grip[digit].force, 1));
      cells.push_back(shown_number(100 * grip[digit].share, 0));
    }
    table.row(cells);
  }
  table.end();
}

TiltEfforts efforts_over_tilt(const ReportSource& source, std::size_t vessel, const GripInput& grip) {
  TiltEfforts efforts;
  const Scene& scene = source.scene;
  const sweeps::StateAxes axes = sweeps::scene_axes(scene, vessel);
  if (!reports_efforts(scene)) return efforts;
  const sweeps::GripFindings answer = sweeps::core_grip_methods(scene, source.core, "core").answer(vessel, grip, axes);
  if (answer.result.reason != Reason::none) return efforts;
  const sweeps::Holding holding(scene, *source.core, vessel, answer.result, sweeps::pour_direction(scene, grip));
  for (std::size_t t = 0; t < axes.tilts.size(); ++t) {
    const sweeps::StateHold hold = holding.state(answer.states[(axes.fills.size() - 1) * axes.tilts.size() + t]);
    efforts.whole.push_back(hold.effort);
    efforts.tips.push_back(hold.tips);
  }
  return efforts;
}

void write_efforts(MarkupWriter& html, const ReportSource& source, std::size_t vessel, const GripInput& grip,
                   const std::string& id) {
  const Scene& scene = source.scene;
  if (!reports_efforts(scene)) return;
  html.element("h3", "Effort over the tilt", {{"id", id + "-efforts"}});
  if (!source.core) {
    html.element("p", fmt::format("This part is left out: {}.", source.no_core));
    return;
  }
  const TiltEfforts efforts = efforts_over_tilt(source, vessel, grip);
  if (efforts.whole.empty()) {
    html.element("p", "The core finds that the best grip is not feasible; see the agreement below.");
    return;
  }
  const std::string& name = scene.vessels[vessel].name;
  html.element("p", fmt::format("What holding takes in the best grip ({}), with the vessel {}.", grip_text(source.plan, grip),
                                fullest_text(scene, vessel)));
  html.open("figure").open("div", {{"class", "charts"}}).open("div", {{"class", "chart"}});
  LineChart chart = effort_chart(scene, efforts);
  chart.name.id = id + "-effort";
  chart.name.title = name + ": effort over the tilt";
  write_chart(html, chart);
  html.close().close().element("figcaption", efforts_caption(efforts)).close();
  write_effort_table(html, scene, name, efforts);
}

void write_protocols(MarkupWriter& html) {
  html.open("section", {{"aria-labelledby", "protocols"}});
  html.element("h2", "What others call a held grasp", {{"id", "protocols"}});
  html.element(
      "p",
      "Effort 1 is a limit of mechanics, and no simulation. Benchmarks of robot hands simulate a grasp and count successes. "
      "Their numbers are context and no comparison: the hands, the objects and the question differ.");
  html.open("ul");
  html.element(
      "li",
      "DexGraspBench (Chen, Ke and Wang 2025, arXiv:2412.16490) pushes an object of 0.1 kg with 10 m/s² times its mass along "
      "six directions, for 2 s each. Its friction is 0.6. A grasp succeeds if the object moves less than 5 cm and turns "
      "less than 15° in all six.");
  html.element(
      "li",
      "By that protocol, with the Allegro hand, Dexonomy (Chen, Ke, Peng and Wang 2025, arXiv:2504.18829) reports success of "
      "60.5 % of its grasps, 49.2 % for BODex (arXiv:2412.16490) and 12.1 % for DexGraspNet (Wang et al. 2023, "
      "arXiv:2210.02697).");
  html.close().close();
}

}  // namespace wholehand
