// SPDX-License-Identifier: MIT
#include "sweeps/grips/forces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/charts/colors.h"
#include "sweeps/grips/states.h"

namespace wholehand::sweeps {
namespace {

constexpr double PAPER_ARROW = 15;      // mm, the largest force
constexpr double SHORTEST_ARROW = 1.5;  // mm of paper
constexpr double ARROW_HEAD = 2.4;      // mm of paper
constexpr double HEAD_SHARE = 0.6;      // of an arrow, at most
constexpr double HEAD_SLOPE = 0.36;     // half its width over its length
constexpr double ARROW_SHAFT = 0.25;    // mm of paper, half its width

Triple tail_of(const Triple& head, const Triple& along, double length) {
  return {head[0] - length * along[0], head[1] - length * along[1], head[2] - length * along[2]};
}

// A shaft with a filled head, as one shape that begins at its point.
void draw_arrow(std::string& svg, const Flat& tail, const Flat& head, double unit) {
  const double length = std::hypot(head[0] - tail[0], head[1] - tail[1]);
  const Flat along{(head[0] - tail[0]) / length, (head[1] - tail[1]) / length};
  const double point = std::min(ARROW_HEAD * unit, HEAD_SHARE * length), half = HEAD_SLOPE * point;
  const double shaft = std::min(ARROW_SHAFT * unit, 0.5 * half);
  const auto at = [&](double back, double aside) {
    return point_text({head[0] - back * along[0] - aside * along[1], head[1] - back * along[1] + aside * along[0]});
  };
  svg += fmt::format("<path class=\"force\" d=\"M{}L{}L{}L{}L{}L{}L{}Z\"/>\n", point_text(head), at(point, half), at(point, shaft),
                     at(length, shaft), at(length, -shaft), at(point, -shaft), at(point, -half));
}

}  // namespace

DrawnForces::DrawnForces(const GripReport& report) {
  const auto place = hardest_state(report);
  if (!place || !std::isfinite(report.holds[*place].effort)) return;
  const auto& contacts = report.holds[*place].contacts;
  double largest = 0;
  for (const HeldContact& contact : contacts) largest = std::max(largest, norm(contact.force));
  if (!(largest > 0)) return;
  for (const HeldContact& contact : contacts) {
    const Triple& f = contact.force;
    if (f != Triple{}) arrows_.push_back({contact.point, {f[0] / largest, f[1] / largest, f[2] / largest}});
  }
  std::stable_sort(arrows_.begin(), arrows_.end(), [](const Arrow& a, const Arrow& b) { return norm(a.along) > norm(b.along); });
  const GripState& state = report.answer.states[*place];
  words_ = fmt::format("longest arrow {:.2f} N, {}tilt {:.1f}\u00b0", largest,
                       report.has_liquid ? fill_words(report, state.fill) + ", " : "", degrees(state.tilt));
}

void DrawnForces::widen(std::array<double, 2>& extent, const Triple& axis, double unit) const {
  for (const Arrow& arrow : arrows_) {
    const double tail = 1e3 * dot(axis, tail_of(arrow.head, arrow.along, 1e-3 * PAPER_ARROW * unit));
    extent = {std::min(extent[0], tail), std::max(extent[1], tail)};
  }
}

void DrawnForces::draw(std::string& svg, const DrawnView& view, double unit) const {
  for (const Arrow& arrow : arrows_) {
    const Flat head = view.flat(arrow.head), tail = view.flat(tail_of(arrow.head, arrow.along, 1e-3 * PAPER_ARROW * unit));
    if (std::hypot(head[0] - tail[0], head[1] - tail[1]) >= SHORTEST_ARROW * unit) draw_arrow(svg, tail, head, unit);
  }
}

Flat DrawnForces::draw_longest(std::string& svg, const Flat& tail, double unit) {
  const Flat head{tail[0] + PAPER_ARROW * unit, tail[1]};
  draw_arrow(svg, tail, head, unit);
  return head;
}

std::string DrawnForces::style(double line) {
  return fmt::format(".force {{ fill: {}; stroke: #ffffff; stroke-width: {:.3f}; paint-order: stroke }}\n",
                     color_text(okabe_ito::GREEN), 1.6 * line);
}

}  // namespace wholehand::sweeps
