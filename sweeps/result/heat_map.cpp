// SPDX-License-Identifier: MIT
#include "sweeps/result/heat_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text/error.h"
#include "shaders/status.h"
#include "sweeps/plan/variables.h"

namespace wholehand::sweeps {
namespace {

constexpr double NO_GRIP = std::numeric_limits<double>::quiet_NaN();

}  // namespace

MapAxis::MapAxis(const PlanAxis& axis, std::uint64_t points) {
  constexpr double POINTS_IN_CELL = 16;
  if (axis.kind == AxisKind::range) {
    const auto wanted = static_cast<std::size_t>(std::sqrt(static_cast<double>(points) / POINTS_IN_CELL));
    const std::size_t cells = std::clamp<std::size_t>(wanted, 1, LARGEST_SOBOL);
    for (std::size_t i = 0; i <= cells; ++i) {
      edges_.push_back(axis.low + (axis.high - axis.low) * static_cast<double>(i) / static_cast<double>(cells));
    }
    return;
  }
  std::vector<double> values = axis.values;
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  const std::size_t cells = std::min(values.size(), LARGEST_MAP);
  const double margin = values.size() > 1 ? 0 : std::max(0.02 * std::abs(values[0]), 1e-3);
  const auto first_of = [&](std::size_t cell) { return cell * values.size() / cells; };  // its first value
  for (std::size_t cell = 1; cell < cells; ++cell) edges_.push_back(0.5 * (values[first_of(cell) - 1] + values[first_of(cell)]));
  const double low = margin > 0 ? margin : 0.5 * (values[1] - values[0]);
  const double high = margin > 0 ? margin : 0.5 * (values.back() - values[values.size() - 2]);
  edges_.insert(edges_.begin(), values.front() - low);
  edges_.push_back(values.back() + high);
}

std::size_t MapAxis::cell(double value) const {
  const auto above = std::upper_bound(edges_.begin() + 1, edges_.end() - 1, value);
  return static_cast<std::size_t>(above - edges_.begin()) - 1;
}

HeatMap::HeatMap(const Plan& plan)
    : heights_(plan.axes()[PLACE_HEIGHT], plan.grips()),
      rolls_(plan.axes()[PLACE_ROLL], plan.grips()),
      scores_(heights_.cells() * rolls_.cells(), NO_GRIP) {}

void HeatMap::add(const Plan& plan, const PlaneChunk& chunk, const FieldSet& fields) {
  height_values_.resize(chunk.count);
  roll_values_.resize(chunk.count);
  plan.coordinates(PLACE_HEIGHT, chunk.first, chunk.count, height_values_.data());
  plan.coordinates(PLACE_ROLL, chunk.first, chunk.count, roll_values_.data());
  for (std::size_t i = 0; i < chunk.count; ++i) {
    if (!is_feasible(chunk.uint(fields.plane[FIELD_STATUS], i))) continue;
    const double score = chunk.real(fields.plane[FIELD_SCORE], i);
    raise(heights_.cell(height_values_[i]) * rolls_.cells() + rolls_.cell(roll_values_[i]), score);
  }
}

void HeatMap::raise(std::size_t cell, double score) {
  double& best = scores_.at(cell);
  if (!(best >= score)) best = score;
}

void HeatMap::restore(const std::vector<double>& scores) {
  if (scores.size() != scores_.size())
    throw failure_error("the heat map in the progress mark has another size; start again without --resume");
  scores_ = scores;
}

}  // namespace wholehand::sweeps
