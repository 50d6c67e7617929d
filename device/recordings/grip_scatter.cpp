// SPDX-License-Identifier: MIT
#include "device/recordings/grip_scatter.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "base/statistics/distributions.h"
#include "base/text/readable.h"
#include "base/text/text.h"

namespace wholehand::device {

const std::array<ScatterKey, 5> SCATTER_KEYS{
    {{"height_mm", "height_m", &GripInput::height, false, ranges::LENGTH_DEVIATION},
     {"offset_mm", "offset_m", &GripInput::offset, false, ranges::LENGTH_DEVIATION},
     {"obliquity_deg", "obliquity_rad", &GripInput::obliquity, false, ranges::ANGLE_DEVIATION},
     {"roll_deg", "roll_rad", &GripInput::roll, true, ranges::ANGLE_DEVIATION},
     {"azimuth_deg", "azimuth_rad", &GripInput::azimuth, true, ranges::ANGLE_DEVIATION}}};

namespace {

// About the mean. Angles without ends first become differences from their mean direction, so that 179 and -179 degrees are 2 apart.
double squares_about_mean(std::vector<double> values, bool turns) {
  if (turns) {
    double sine = 0, cosine = 0;
    for (const double value : values) {
      sine += std::sin(value);
      cosine += std::cos(value);
    }
    const double direction = std::atan2(sine, cosine);
    for (double& value : values) value = std::remainder(value - direction, 2 * PI);
  }
  MeanSum sum;
  for (const double value : values) sum.add(value);
  const MeanDeviation result = sum.result();
  return result.deviation * result.deviation * static_cast<double>(result.count - 1);
}

constexpr double LEAST_SHOWN = 0.005;  // mm or degrees: less is 0 in two decimals

double in_unit(double value, Unit unit) { return unit == Unit::mm ? value * 1e3 : degrees(value); }

bool is_azimuth(const ScatterKey& key) { return key.number == &GripInput::azimuth; }

// Bodies of revolution have no use for the azimuth.
bool is_taken(const ScatterKey& key, const ScatterDeviation& deviation) {
  return !is_azimuth(key) && in_unit(deviation.value, key.range.unit) <= key.range.high;
}

// A comment where the table does not take it.
std::string table_line(const ScatterKey& key, const ScatterDeviation& deviation) {
  const double value = in_unit(deviation.value, key.range.unit);
  const char* remark = is_azimuth(key)            ? "; for vessels that are no bodies of revolution"
                       : is_taken(key, deviation) ? ""
                                                  : "; more than [robust] takes";
  return fmt::format("{}{} = {:.2f}  # {:.2f} to {:.2f}{}\n", is_taken(key, deviation) ? "" : "# ", key.name, value,
                     in_unit(deviation.interval.low, key.range.unit), in_unit(deviation.interval.high, key.range.unit), remark);
}

}  // namespace

void GripScatter::add(std::span<const GraspReport> grasps) {
  // Numbers of guidance points go on after a vessel's last one, so one point may be several groups, which costs degrees of freedom and biases nothing.
  std::map<std::pair<int, int>, std::vector<const GripInput*>> groups;
  for (const GraspReport& grasp : grasps)
    if (grasp.grip) groups[{grasp.vessel, grasp.guidance}].push_back(&*grasp.grip);
  const std::size_t before = groups_;
  for (const auto& [group, grips] : groups) {
    if (grips.size() < 2) continue;
    ++groups_;
    grasps_ += grips.size();
    vessels_.insert(group.first);
    for (std::size_t k = 0; k < SCATTER_KEYS.size(); ++k) {
      std::vector<double> values;
      for (const GripInput* grip : grips) values.push_back(grip->*SCATTER_KEYS[k].number);
      squares_[k] += squares_about_mean(std::move(values), SCATTER_KEYS[k].turns);
    }
  }
  people_ += groups_ > before ? 1 : 0;
}

std::array<ScatterDeviation, 5> GripScatter::deviations() const {
  std::array<ScatterDeviation, 5> all;
  const auto free = static_cast<double>(freedom());
  const double most = chi_square_quantile(0.975, free), least = chi_square_quantile(0.025, free);
  for (std::size_t k = 0; k < all.size(); ++k)
    all[k] = {std::sqrt(squares_[k] / free), {std::sqrt(squares_[k] / most), std::sqrt(squares_[k] / least)}};
  return all;
}

std::string GripScatter::table() const {
  if (!is_enough())
    return fmt::format(
        "No [robust] table: the scatter of the grips needs {} grasps in all beyond the first at each vessel and shown point, in "
        "one or "
        "more recordings "
        "of a person; there {} {}\n",
        LEAST_FREEDOM, freedom() == 1 ? "is" : "are", freedom());
  const std::array<ScatterDeviation, 5> all = deviations();
  bool has_spread = false;
  for (std::size_t k = 0; k < all.size(); ++k)
    has_spread =
        has_spread || (is_taken(SCATTER_KEYS[k], all[k]) && in_unit(all[k].value, SCATTER_KEYS[k].range.unit) >= LEAST_SHOWN);
  if (!has_spread) return "No [robust] table: it needs a deviation above 0 that its keys take\n";
  std::string text = fmt::format("[robust]  # scatter of {} of {}{}, with 95 % intervals; replaces [robust] of a scene\n",
                                 counted(grasps(), "grasp"), counted(vessels(), "vessel"),
                                 people_ > 1 ? fmt::format(" by {} people", people_) : "");
  for (std::size_t k = 0; k < all.size(); ++k) text += table_line(SCATTER_KEYS[k], all[k]);
  return text;
}

}  // namespace wholehand::device
