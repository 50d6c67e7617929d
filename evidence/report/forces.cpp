// SPDX-License-Identifier: MIT
#include "evidence/report/forces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/charts/lines.h"
#include "base/text/readable.h"
#include "sweeps/grips/holding.h"
#include "sweeps/grips/methods.h"
#include "sweeps/grips/report.h"
#include "sweeps/grips/states.h"

namespace wholehand {
namespace {

constexpr std::size_t MOST_LINES = 8;

// One fill's line in words, for screen readers.
std::string line_text(const Scene& scene, const std::string& fill, const std::vector<double>& values) {
  const auto largest = std::max_element(values.begin(), values.end());
  return fmt::format("{}: {} N at {}°, at most {} N at {}°", fill, shown_number(values.front(), 2),
                     shown_number(degrees(scene.tilts.front()), 0), shown_number(*largest, 2),
                     shown_number(degrees(scene.tilts[static_cast<std::size_t>(largest - values.begin())]), 0));
}

LineChart force_chart(const ReportSource& source, std::size_t vessel, const std::vector<FillForces>& forces,
                      std::vector<double> FillForces::*member, const std::vector<double>& pouring) {
  const Scene& scene = source.scene;
  LineChart chart;
  chart.x_label = "tilt (°)";
  chart.x_is_angle = true;
  for (const double tilt : scene.tilts) chart.x.push_back(degrees(tilt));
  const std::vector<std::size_t> shown = shown_fills(forces.size());
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const FillForces& fill = forces[shown[k]];
    LineChart::Line line;
    line.label = sweeps::fill_text(scene, vessel, fill.fill);
    line.y = fill.*member;
    line.shade = shown.size() > 1 ? static_cast<double>(k) / static_cast<double>(shown.size() - 1) : 0.3;
    if (shown[k] < pouring.size() && std::isfinite(pouring[shown[k]])) line.marked_x = degrees(pouring[shown[k]]);
    chart.name.description += line_text(scene, line.label, fill.*member) + ". ";
    chart.lines.push_back(line);
  }
  return chart;
}

// The range of the hold force over all fills and tilts.
struct HoldExtent {
  double highest = 0;  // of the finite ones, N
  bool is_finite_once = false, is_finite_always = true;
};

HoldExtent hold_extent(const std::vector<FillForces>& forces) {
  HoldExtent extent;
  for (const FillForces& fill : forces) {
    for (const double hold : fill.hold) {
      if (std::isnan(hold)) continue;  // left out
      const bool is_finite = std::isfinite(hold);
      if (is_finite) extent.highest = std::max(extent.highest, hold);
      extent.is_finite_once = extent.is_finite_once || is_finite;
      extent.is_finite_always = extent.is_finite_always && is_finite;
    }
  }
  return extent;
}

double highest_feedback(const std::vector<FillForces>& forces) {
  double highest = 0;
  for (const FillForces& fill : forces) highest = std::max(highest, *std::max_element(fill.feedback.begin(), fill.feedback.end()));
  return highest;
}

const char* strength_name_of(const Scene& scene) { return scene.strength ? "strength of the weaker tip" : "grip strength"; }

std::string forces_caption(const Scene& scene, const std::vector<FillForces>& forces, const HoldExtent& extent) {
  std::string caption =
      "The feedback force is what the gripper renders. The hold force is what each finger must press with to hold the vessel.";
  const double limit = scene.force.max, strength = forces.front().strength;
  const char* strength_name = strength_name_of(scene);
  if (highest_feedback(forces) < limit) caption += fmt::format(" The device's limit of {} N is not reached.", plain_number(limit));
  if (!extent.is_finite_once) {
    caption += " No force of two fingers holds the vessel in this grip, so the hold force has no chart.";
  } else {
    if (!extent.is_finite_always)
      caption += " Where a line of the hold force is missing, no force of two fingers holds the vessel.";
    if (extent.highest < strength)
      caption += fmt::format(" The {} of {} N is not reached.", strength_name, shown_number(strength, 1));
    if (extent.highest > 2 * strength)
      caption += fmt::format(" The hold force goes up to {} N; its chart ends at twice the {}.", shown_number(extent.highest, 0),
                             strength_name);
  }
  const bool leaves_out =
      std::any_of(forces.begin(), forces.end(), [](const FillForces& fill) { return std::isnan(fill.feedback.back()); });
  if (scene.until_poured && leaves_out)
    caption +=
        fmt::format(" A line ends at the first tilt at which {}\u00a0% of its fill has poured; the tilts beyond are left out.",
                    plain_number(100 * *scene.until_poured));
  const std::size_t shown = shown_fills(forces.size()).size();
  if (shown < forces.size())
    caption += fmt::format(" {} of {} fills are drawn.", readable_number(shown), readable_number(forces.size()));
  return caption;
}

void write_force_table(MarkupWriter& html, const Scene& scene, std::size_t vessel, const std::vector<FillForces>& forces) {
  const std::string& name = scene.vessels[vessel].name;
  html.open("details").element("summary", "The same as numbers");
  std::vector<std::string> columns{"tilt (°)"};
  for (const char* force : {"feedback", "hold"})
    for (const FillForces& fill : forces)
      columns.push_back(fmt::format("{}, {} (N)", force, sweeps::fill_text(scene, vessel, fill.fill)));
  HtmlTable table(html, fmt::format("Feedback and hold force of the best grip of {}", name), columns);
  for (std::size_t t = 0; t < scene.tilts.size(); ++t) {
    std::vector<std::string> cells{shown_number(degrees(scene.tilts[t]), 1)};
    for (const FillForces& fill : forces) cells.push_back(shown_number(fill.feedback[t], 3));
    for (const FillForces& fill : forces) cells.push_back(shown_number(fill.hold[t], 2));
    table.row(cells);
  }
  table.end();
  html.close();
}

}  // namespace

std::vector<std::size_t> shown_fills(std::size_t count) {
  std::vector<std::size_t> shown;
  const std::size_t lines = std::min(count, MOST_LINES);
  for (std::size_t k = 0; k < lines; ++k) shown.push_back(lines > 1 ? k * (count - 1) / (lines - 1) : 0);
  return shown;
}

std::vector<FillForces> forces_of(const ReportSource& source, std::size_t vessel, const GripInput& grip) {
  std::vector<FillForces> forces;
  const sweeps::StateAxes axes = sweeps::scene_axes(source.scene, vessel);
  const sweeps::GripFindings answer = sweeps::core_grip_methods(source.scene, source.core, "core").answer(vessel, grip, axes);
  if (answer.states.empty()) return forces;
  const double strength = !source.scene.strength ? source.scene.force.grip_strength
                                                 : sweeps::Holding(source.scene, *source.core, vessel, answer.result,
                                                                   sweeps::pour_direction(source.scene, grip))
                                                       .strength()
                                                       .weaker_tip();
  for (std::size_t f = 0; f < axes.fills.size(); ++f) {
    FillForces fill{axes.fills[f], strength, {}, {}};
    for (std::size_t t = 0; t < axes.tilts.size(); ++t) {
      const StateResult& state = answer.states[f * axes.tilts.size() + t].state;
      fill.feedback.push_back(state.feedback_force);
      fill.hold.push_back(state.hold_force);
    }
    forces.push_back(fill);
  }
  return forces;
}

void write_forces(MarkupWriter& html, const ReportSource& source, std::size_t vessel, const GripInput& grip,
                  const std::string& id) {
  const Scene& scene = source.scene;
  html.element("h3", "Forces over the tilt", {{"id", id + "-forces"}});
  if (scene.tilts.empty() || !source.core) {
    html.element("p", scene.tilts.empty() ? "The scene has no tilts, so there are no forces."
                                          : fmt::format("This part is left out: {}.", source.no_core));
    return;
  }
  const std::vector<FillForces> forces = forces_of(source, vessel, grip);
  if (forces.empty()) {
    html.element("p", "The core finds that the best grip is not feasible; see the agreement below.");
    return;
  }
  const std::string& name = scene.vessels[vessel].name;
  const std::vector<double> pouring = scene.liquid ? source.result.pouring_tilts(vessel) : std::vector<double>{};
  const HoldExtent extent = hold_extent(forces);
  html.element(
      "p",
      fmt::format("The forces of the best grip: {}. {}", grip_text(source.plan, grip),
                  !scene.liquid ? "The vessel is empty."
                  : scene.liquid->volumes.empty()
                      ? "Each line is one fill, as a share of what the vessel holds. The dot on a line shows where pouring starts."
                      : "Each line is one fill. The dot on a line shows where pouring starts."));
  html.open("figure").open("div", {{"class", "charts"}});
  LineChart feedback = force_chart(source, vessel, forces, &FillForces::feedback, pouring);
  feedback.name.id = id + "-feedback";
  feedback.name.title = name + ": feedback force over the tilt";
  feedback.y_label = "feedback force (N)";
  feedback.limit = LineChart::Limit{scene.force.max, fmt::format("device {} N", plain_number(scene.force.max))};
  LineChart hold = force_chart(source, vessel, forces, &FillForces::hold, pouring);
  hold.name.id = id + "-hold";
  hold.name.title = name + ": hold force over the tilt";
  hold.y_label = "hold force per finger (N)";
  const double strength = forces.front().strength;
  hold.limit = LineChart::Limit{strength, fmt::format("{} {} N", strength_name_of(scene), shown_number(strength, 1))};
  if (extent.highest > 2 * strength) hold.highest = 2 * strength;
  for (const LineChart* chart : {&feedback, &hold}) {
    if (chart == &hold && !extent.is_finite_once) continue;
    html.open("div", {{"class", "chart"}});
    write_chart(html, *chart);
    html.close();
  }
  html.close().element("figcaption", forces_caption(scene, forces, extent)).close();
  write_force_table(html, scene, vessel, forces);
}

void write_pouring(MarkupWriter& html, const ReportSource& source, std::size_t vessel, const std::string& id) {
  const Scene& scene = source.scene;
  html.element("h3", "Where pouring starts", {{"id", id + "-pouring"}});
  if (!scene.liquid) {
    html.element("p", "The scene has no liquid.");
    return;
  }
  const std::vector<double> tilts = source.result.pouring_tilts(vessel);
  const double capacity = source.core && scene.vessels[vessel].has_cavity() ? source.core->capacity(vessel) : std::nan("");
  if (std::none_of(tilts.begin(), tilts.end(), [](double tilt) { return std::isfinite(tilt); })) {
    html.element("p", "This vessel has nothing to pour.");
    return;
  }
  HtmlTable table(html, fmt::format("Tilt at which {} starts to pour", scene.vessels[vessel].name),
                  {"fill", "liquid (mL)", "pours from (°)"});
  for (std::size_t f = 0; f < tilts.size(); ++f) {
    const double fill = vessel_fills(scene, scene.vessels[vessel])[f];
    table.row({sweeps::share_text(scene, fill), shown_number(capacity * fill * 1e6, 0),
               std::isfinite(tilts[f]) ? shown_number(degrees(tilts[f]), 1) : "nothing to pour"});
  }
  table.end();
}

}  // namespace wholehand
