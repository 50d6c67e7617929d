// SPDX-License-Identifier: MIT
#include "studies/session_charts.h"

#include <array>
#include <cmath>

#include "charts/box_plot.h"
#include "charts/markup.h"

namespace wholehand {
namespace {

// What a chart shows of a grasp, and the paper's mean and deviation by vessel; a NaN mean: it is not known.
struct ShownForce {
  const char *id, *title, *description, *label;
  double (*number)(const GraspReport&);
  std::array<BoxChart::Mark, 3> paper;
};

constexpr double ABSENT = std::numeric_limits<double>::quiet_NaN();
constexpr BoxChart::Mark UNKNOWN{ABSENT, ABSENT};

bool is_steep(const GraspReport& grasp) { return grasp.largest_tilt >= LEAST_ANALYSED; }
double if_tilted(const GraspReport& grasp, double value) { return is_steep(grasp) ? value : ABSENT; }

const std::array<ShownForce, 4> SHOWN{{
    {"normal-increase",
     "Increase of the normal force over the tilt",
     "By vessel, of grasps that have a type.",
     "increase, N",
     [](const GraspReport& grasp) { return grasp.course == GripCourse::not_analysed ? ABSENT : grasp.normal_increase; },
     {{{0.56, 0.29}, {1.02, 0.54}, {2.33, 0.34}}}},
    {"grip-before",
     "Grip force before the tilt",
     "By vessel, of grasps that are tilted by 30 degrees or more.",
     "grip force, N",
     [](const GraspReport& grasp) { return if_tilted(grasp, grasp.before.mean); },
     {{{3.84, 1.84}, {3.38, 1.33}, {4.63, 1.96}}}},
    {"grip-after",
     "Grip force while the tilt is maintained",
     "By vessel, of grasps that are tilted by 30 degrees or more.",
     "grip force, N",
     [](const GraspReport& grasp) { return if_tilted(grasp, grasp.after.mean); },
     {{UNKNOWN, UNKNOWN, UNKNOWN}}},
    {"response-time",
     "Response time",
     "By vessel, of all grasps that come to rest before the tilt.",
     "response time, s",
     [](const GraspReport& grasp) { return grasp.response_time; },
     {{UNKNOWN, UNKNOWN, UNKNOWN}}},
}};

std::string chart_of(const ShownForce& shown, std::span<const SessionSubject> subjects, const SessionVessels& vessels) {
  BoxChart chart;
  chart.name = {shown.id, shown.title, shown.description};
  chart.y_label = shown.label;
  chart.mark = "the paper: mean and standard deviation";
  for (std::size_t v = 0; v < vessels.size(); ++v) {
    std::vector<double> values;
    for (const SessionSubject& subject : subjects)
      for (const GraspReport& grasp : subject.grasps)
        if (static_cast<std::size_t>(grasp.vessel) == vessels[v].place) values.push_back(shown.number(grasp));
    BoxChart::Group group{vessels[v].name, box_of(values), std::nullopt};
    if (!std::isnan(shown.paper[v].mean)) group.mark = shown.paper[v];
    chart.groups.push_back(group);
  }
  MarkupWriter svg;
  svg.element("figcaption", shown.title);
  write_chart(svg, chart);
  return svg.written();
}

}  // namespace

std::vector<std::string> session_charts(std::span<const SessionSubject> subjects, const SessionVessels& vessels) {
  std::vector<std::string> charts;
  for (const ShownForce& shown : SHOWN) charts.push_back(chart_of(shown, subjects, vessels));
  return charts;
}

}  // namespace wholehand
