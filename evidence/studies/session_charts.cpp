// SPDX-License-Identifier: MIT
#include "evidence/studies/session_charts.h"

#include <array>
#include <optional>

#include "base/charts/box_plot.h"
#include "base/charts/markup.h"
#include "evidence/studies/grasp_numbers.h"

namespace wholehand {
namespace {

// What a chart shows of a grasp. `statistic`: whose mean and deviation the paper may give.
struct ShownForce {
  const char *id, *title, *description, *label;
  of_grasp::Number number;
  const char* statistic;
};

constexpr const char* OF_TILTED = "By vessel, of grasps that are tilted by 30 degrees or more.";

const std::array<ShownForce, 4> SHOWN{{
    {"normal-increase", "Increase of the normal force over the tilt", "By vessel, of grasps that have a type.", "increase, N",
     of_grasp::normal_increase, "normal_increase"},
    {"grip-before", "Grip force before the tilt", OF_TILTED, "grip force, N", of_grasp::grip_before, "grip_before"},
    {"grip-after", "Grip force while the tilt is maintained", OF_TILTED, "grip force, N", of_grasp::grip_after, "grip_after"},
    {"response-time", "Response time", "By vessel, of all grasps that come to rest before the tilt.", "response time, s",
     of_grasp::response_time, "response_time"},
}};

// The paper's mean and deviation, where the rows have both.
std::optional<BoxChart::Mark> mark_of(std::span<const StudyRow> rows, const std::string& vessel, const std::string& statistic) {
  std::optional<double> mean, deviation;
  for (const StudyRow& row : rows) {
    if (row.vessel != vessel) continue;
    if (row.statistic == statistic + "_mean") mean = row.paper;
    if (row.statistic == statistic + "_deviation") deviation = row.paper;
  }
  if (!mean || !deviation) return std::nullopt;
  return BoxChart::Mark{*mean, *deviation};
}

std::string chart_of(const ShownForce& shown, std::span<const SessionSubject> subjects, const SessionVessels& vessels,
                     std::span<const StudyRow> rows) {
  BoxChart chart;
  chart.name = {shown.id, shown.title, shown.description};
  chart.y_label = shown.label;
  chart.mark = "the paper: mean and standard deviation";
  for (std::size_t v = 0; v < vessels.size(); ++v) {
    std::vector<double> values;
    for (const SessionSubject& subject : subjects)
      for (const device::GraspReport& grasp : subject.grasps)
        if (static_cast<std::size_t>(grasp.vessel) == vessels[v].place) values.push_back(shown.number(grasp));
    chart.groups.push_back({vessels[v].name, box_of(values), mark_of(rows, vessels[v].name, shown.statistic)});
  }
  MarkupWriter svg;
  svg.element("figcaption", shown.title);
  write_chart(svg, chart);
  return svg.written();
}

}  // namespace

std::vector<std::string> session_charts(std::span<const SessionSubject> subjects, const SessionVessels& vessels,
                                        std::span<const StudyRow> rows) {
  std::vector<std::string> charts;
  for (const ShownForce& shown : SHOWN) charts.push_back(chart_of(shown, subjects, vessels, rows));
  return charts;
}

}  // namespace wholehand
