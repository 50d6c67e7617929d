// SPDX-License-Identifier: MIT
#include "evidence/report/guidance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "base/charts/field.h"
#include "base/text/readable.h"
#include "base/text/text.h"
#include "core/joints.h"
#include "shaders/status.h"

namespace wholehand {
namespace {

std::string r_text(const Correlation& correlation) {
  return correlation.r ? shown_number(*correlation.r, 2) : std::string("none, ") + lack_words(correlation.lack);
}

std::string in_mm(double meters, int digits = 1) { return shown_number(meters * 1e3, digits); }

// A field over the bins of the distance.
FieldChart distance_chart(const GuidanceStatistics& statistics) {
  FieldChart chart;
  chart.x_label = "distance from the guidance point (mm)";
  for (const DistanceBin& bin : statistics.bins) chart.x_edges.push_back(bin.from * 1e3);
  chart.x_edges.push_back(statistics.bins.back().to * 1e3);
  return chart;
}

void put_value(FieldChart& chart, const DistanceBin& bin, std::size_t count) {
  chart.kinds.push_back(bin.grips == 0 ? CellKind::absent : CellKind::filled);
  chart.values.push_back(bin.grips == 0 ? 0 : 100.0 * static_cast<double>(count) / static_cast<double>(bin.grips));
}

bool has_empty_bin(const GuidanceStatistics& statistics) {
  return std::any_of(statistics.bins.begin(), statistics.bins.end(), [](const DistanceBin& bin) { return bin.grips == 0; });
}

// The highest of a chart's shares, rounded up to a whole ten, so that small ones remain distinct.
double highest_share(const FieldChart& chart) {
  const double highest = *std::max_element(chart.values.begin(), chart.values.end());
  return std::max(10.0, 10 * std::ceil(highest / 10));
}

FieldChart fingers_chart(const GuidanceStatistics& statistics) {
  FieldChart chart = distance_chart(statistics);
  chart.y_label = "fingers used";
  chart.row_height = 22;
  for (int count = 0; count <= FINGER_COUNT; ++count) {
    chart.rows.push_back(count == 1 ? "1 finger" : fmt::format("{} fingers", count));
    chart.y_edges.push_back(count);
    for (const DistanceBin& bin : statistics.bins) put_value(chart, bin, bin.by_fingers[static_cast<std::size_t>(count)]);
  }
  chart.y_edges.push_back(FINGER_COUNT + 1);
  chart.scale = {"share of grips (%)", 0, highest_share(chart), 0, 0};
  chart.mark = "mean";
  for (const DistanceBin& bin : statistics.bins) {
    double sum = 0;
    for (int count = 0; count <= FINGER_COUNT; ++count)
      sum += count * static_cast<double>(bin.by_fingers[static_cast<std::size_t>(count)]);
    // the middle of a row is its number
    if (bin.grips > 0) chart.marks.push_back({0.5e3 * (bin.from + bin.to), sum / static_cast<double>(bin.grips) + 0.5, false});
  }
  return chart;
}

FieldChart points_chart(const GuidanceStatistics& statistics) {
  FieldChart chart = distance_chart(statistics);
  chart.y_label = "point of the hand";
  chart.scale = {"touches in (%)", 0, 100, 0, 0};
  // the thumb on top
  for (int joint = JOINT_COUNT - 1; joint >= 0; --joint) {
    chart.rows.push_back(JOINT_NAMES[joint].paper);
    chart.y_edges.push_back(JOINT_COUNT - 1 - joint);
    for (const DistanceBin& bin : statistics.bins) put_value(chart, bin, bin.touching[joint]);
  }
  chart.y_edges.push_back(JOINT_COUNT);
  return chart;
}

void write_charts(MarkupWriter& html, const GuidanceStatistics& statistics, const std::string& name, const std::string& id) {
  FieldChart fingers = fingers_chart(statistics), points = points_chart(statistics);
  fingers.name = {id + "-guided-fingers", name + ": fingers used over the distance from the guidance point",
                  fmt::format("For each range of distance: the share of grips by the number of fingers used, and the mean number. "
                              "A grip uses {} fingers on average; correlation with the distance: {}.",
                              shown_number(statistics.mean_fingers, 2), r_text(statistics.fingers))};
  points.name = {id + "-guided-points", name + ": points touching over the distance from the guidance point",
                 "For each range of distance: the share of grips in which each of the hand's 24 points touches. The table shows "
                 "the share over all distances and the correlation of each point."};
  if (has_empty_bin(statistics)) fingers.absent = points.absent = "no grip";
  std::vector<std::string> counts;
  for (const DistanceBin& bin : statistics.bins)
    counts.push_back(fmt::format("{}\u2013{} mm: {}", in_mm(bin.from, 0), in_mm(bin.to, 0), readable_number(bin.grips)));
  html.open("figure").open("div", {{"class", "charts"}});
  html.open("div", {{"class", "chart"}});
  write_chart(html, fingers);
  html.element("p", fmt::format("Grips in each range of distance: {}.", joined(counts, ", ")), {{"class", "note"}}).close();
  html.open("div", {{"class", "chart"}});
  write_chart(html, points);
  html.close().close();
  html.element(
      "figcaption",
      "The share of grips by the number of fingers used, and the share in which each point touches, for each range of distance.");
  html.close();
}

void write_point_table(MarkupWriter& html, const GuidanceStatistics& statistics, const std::string& name) {
  HtmlTable table(html, fmt::format("Points that touch {}, and the distance, n = {}", name, readable_number(statistics.grips)),
                  {"point", "touches (%)", "mean distance when touching (mm)", "mean distance when free (mm)", "point-biserial r"});
  for (int j = 0; j < JOINT_COUNT; ++j) {
    const PointTouch& point = statistics.points[j];
    table.row({JOINT_NAMES[j].paper,
               shown_number(100.0 * static_cast<double>(point.touching) / static_cast<double>(statistics.grips), 1),
               in_mm(point.distance_touching), in_mm(point.distance_free),
               point.correlation.r ? shown_number(*point.correlation.r, 2) : lack_words(point.correlation.lack)});
  }
  table.end();
}

}  // namespace

GuidedSample guided_grips(const ReportSource& source, std::size_t vessel) {
  GuidedSample sample;
  const std::vector<std::uint64_t> places = sample_places(source.plan.stored_grips(), GUIDED_GRIPS);
  sample.looked_at = places.size();
  const sweeps::SweepResult& result = source.result;
  const sweeps::Variable *reason = result.find("reason"), *plausible = result.find("plausible"), *touch = result.find("touch_mask"),
                         *used = result.find("used_mask");
  const bool knows_plausible = reason && plausible, knows_touching = touch && used;
  std::vector<std::uint64_t> wanted = places;
  if (knows_plausible) {
    const std::vector<double> reasons = result.pick(*reason, vessel, 0, places),
                              is_plausible = result.pick(*plausible, vessel, 0, places);
    wanted.clear();
    for (std::size_t i = 0; i < places.size(); ++i)
      if (reasons[i] == 0 && is_plausible[i] == 1) wanted.push_back(places[i]);
  }
  sample.is_by_core = !knows_plausible || !knows_touching;
  if (wanted.empty()) return sample;
  std::vector<GripInput> grips;
  for (const std::uint64_t place : wanted) grips.push_back(stored_grip(source.plan, source.scene, vessel, place));
  const GatheredPlanes planes =
      planes_by_core(source, vessel, grips, {FIELD_GAP, FIELD_MIDPOINT, FIELD_STATUS, FIELD_TOUCH_MASK, FIELD_USED_MASK});
  std::vector<double> touch_masks, used_masks;
  if (knows_touching) {
    touch_masks = result.pick(*touch, vessel, 0, wanted);
    used_masks = result.pick(*used, vessel, 0, wanted);
  }
  std::vector<Triple> points;
  for (const GuidancePoint& point : source.scene.vessels[vessel].guidance)
    points.push_back(guidance_place(*source.core, vessel, point));
  for (std::size_t i = 0; i < grips.size(); ++i) {
    if (!knows_plausible && !is_plausible(planes.uint(FIELD_STATUS, i))) continue;
    const int at = planes.fields.plane[FIELD_MIDPOINT];
    const double distance = guidance_distance(*source.core, source.scene, vessel, grips[i],
                                              {planes.real(at, i), planes.real(at + 1, i), planes.real(at + 2, i)},
                                              planes.real(planes.fields.plane[FIELD_GAP], i), points);
    if (!std::isfinite(distance)) continue;  // infeasible by the core
    const auto mask = [&](const std::vector<double>& file, int field) {
      return knows_touching ? static_cast<std::uint32_t>(std::max(0.0, file[i])) : planes.uint(field, i);
    };
    sample.grips.push_back({distance, std::popcount(mask(used_masks, FIELD_USED_MASK)), mask(touch_masks, FIELD_TOUCH_MASK)});
  }
  return sample;
}

void write_guidance(MarkupWriter& html, const ReportSource& source, std::size_t vessel, const std::string& id) {
  const VesselData& data = source.scene.vessels[vessel];
  html.element("h3", "Touching, and the distance from a guidance point", {{"id", id + "-guidance"}});
  if (data.guidance.empty()) {
    html.element("p", "The scene gives this vessel no guidance points (guidance_mm), so there is no distance to them.");
    return;
  }
  if (!source.core) {
    html.element("p", fmt::format("This part is left out: {}.", source.no_core));
    return;
  }
  const GuidedSample sample = guided_grips(source, vessel);
  std::vector<std::string> points;
  for (const GuidancePoint& point : data.guidance)
    points.push_back(fmt::format("{} mm, {}°", in_mm(point.height), shown_number(degrees(point.azimuth), 0)));
  const GuidanceStatistics statistics = guidance_statistics(sample.grips);
  std::string text = fmt::format(
      "Guidance points (height, azimuth): {}. The distance of a grip is measured from the nearer of its two contacts, on the skin, "
      "to the nearest guidance point. n = {}",
      joined(points, "; "), counted(statistics.grips, "feasible and plausible grip"));
  text += sample.looked_at < source.plan.stored_grips()
              ? fmt::format(" of {}, of {} in all.", counted(sample.looked_at, "examined grip"),
                            counted(source.plan.stored_grips(), "grip"))
              : fmt::format(" of {}.", readable_number(sample.looked_at));
  if (sample.is_by_core) text += " The file lacks some of the points that touch, so the core computed them.";
  html.element("p", text);
  if (statistics.grips == 0) {
    html.element("p", "There is no such grip, so there is nothing to count.");
    return;
  }
  html.element("p",
               fmt::format("Distances go from {} to {} mm; {} fingers are used on average. Fingers used and distance: {}.",
                           in_mm(statistics.nearest), in_mm(statistics.farthest), shown_number(statistics.mean_fingers, 2),
                           statistics.fingers.r ? fmt::format("Pearson's r = {}", shown_number(*statistics.fingers.r, 2))
                                                : std::string("no correlation (") + lack_words(statistics.fingers.lack) + ")"));
  write_charts(html, statistics, data.name, id);
  write_point_table(html, statistics, data.name);
  html.element("p",
               "A point that always touches or never touches has no correlation. The grips come from a sweep: they are evenly "
               "spread, and nobody chose them. The coefficients describe these grips and are not a test of significance.",
               {{"class", "note"}});
}

}  // namespace wholehand
