// SPDX-License-Identifier: MIT
#include "sweeps/lists/refine.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "base/numbers/parallel.h"
#include "core/planes.h"
#include "shaders/status.h"

namespace wholehand::sweeps {
namespace {

using Coordinates = std::array<double, REFINED_COORDINATES>;

constexpr double SCORE_OF_NONE = -1;  // the score of one that is not eligible

std::pair<double, double> half_way_to_neighbors(std::vector<double> values, double value) {
  std::sort(values.begin(), values.end());
  const auto place = std::lower_bound(values.begin(), values.end(), value);
  const double below = place == values.begin() ? value : *(place - 1);
  const auto next = std::upper_bound(values.begin(), values.end(), value);
  const double above = next == values.end() ? value : *next;
  return {value + 0.5 * (below - value), value + 0.5 * (above - value)};
}

// Scores by the core of what a score needs, and of no more.
class CoreScore {
 public:
  CoreScore(const Evaluator& core, const Scene& scene)
      : core_(core),
        fields_(make_field_set({FIELD_SCORE, FIELD_STATUS}, scene)),
        reals_(static_cast<std::size_t>(fields_.real_planes)),
        uints_(static_cast<std::size_t>(fields_.uint_planes)) {}

  double operator()(std::size_t vessel, const GripInput& grip) {
    core_.planes(vessel, &grip, 1, fields_, 1, reals_.data(), uints_.data());
    const std::uint32_t status = uints_[static_cast<std::size_t>(fields_.plane[FIELD_STATUS])];
    return is_eligible(status) ? reals_[static_cast<std::size_t>(fields_.plane[FIELD_SCORE])] : SCORE_OF_NONE;
  }

 private:
  const Evaluator& core_;
  FieldSet fields_;
  std::vector<double> reals_;
  std::vector<std::uint32_t> uints_;
};

void refine(CoreScore score, const Plan& plan, std::size_t vessel, BestGrip& best) {
  const RefineBox box = refine_box(plan, vessel, best.candidate.index);
  const RefinedPlace found = search_box(
      coordinates_of(best.grip), box, [&](const Coordinates& place) { return score(vessel, with_coordinates(best.grip, place)); });
  if (found.score == SCORE_OF_NONE) return;
  best.refined = with_coordinates(best.grip, found.place);
  best.refined_score = found.score;
}

}  // namespace

Coordinates coordinates_of(const GripInput& grip) { return {grip.height, grip.azimuth, grip.obliquity, grip.roll, grip.offset}; }

GripInput with_coordinates(const GripInput& grip, const Coordinates& coordinates) {
  return {coordinates[0], coordinates[1], coordinates[2], coordinates[3], coordinates[4], grip.hand_scale};
}

RefineBox refine_box(const Plan& plan, std::size_t vessel, std::uint64_t grip) {
  const auto ranges =
      std::count_if(plan.axes().begin(), plan.axes().end(), [](const PlanAxis& axis) { return axis.kind == AxisKind::range; });
  const double steps = std::pow(static_cast<double>(plan.grips()), 1.0 / static_cast<double>(std::max<std::ptrdiff_t>(1, ranges)));
  RefineBox box;
  for (std::size_t k = 0; k < REFINED_PLACES.size(); ++k) {
    const PlanAxis& axis = plan.axes()[static_cast<std::size_t>(REFINED_PLACES[k])];
    double value = 0;
    plan.coordinates(REFINED_PLACES[k], grip, 1, &value);
    std::pair<double, double> ends{value, value};
    const bool changes_nothing = REFINED_PLACES[k] == PLACE_AZIMUTH && plan.is_symmetric();
    if (changes_nothing) {
      // stays
    } else if (axis.kind == AxisKind::range) {
      const double half = 0.5 * (axis.high - axis.low) / steps;
      ends = {std::max(axis.low, value - half), std::min(axis.high, value + half)};
    } else {
      ends = half_way_to_neighbors(axis.values, value);
    }
    const auto meters = [&](double end) { return REFINED_PLACES[k] == PLACE_HEIGHT ? plan.height(vessel, end) : end; };
    box.low[k] = meters(ends.first);
    box.high[k] = meters(ends.second);
  }
  return box;
}

RefinedPlace search_box(const Coordinates& start, const RefineBox& box, const std::function<double(const Coordinates&)>& score) {
  RefinedPlace found{start, score(start), 1};
  // True where a step scored more, which then is the place.
  const auto tries = [&](std::size_t k, double share) {
    const double length = share < 0 ? start[k] - box.low[k] : box.high[k] - start[k];
    Coordinates place = found.place;
    place[k] = std::clamp(place[k] + share * length, box.low[k], box.high[k]);
    if (place[k] == found.place[k] || found.evaluations == REFINE_EVALUATIONS) return false;
    const double there = score(place);
    ++found.evaluations;
    if (!(there > found.score)) return false;
    found.place = place;
    found.score = there;
    return true;
  };
  for (double step = 0.5; step >= SMALLEST_REFINE_STEP && found.evaluations < REFINE_EVALUATIONS;) {
    bool is_better = false;
    for (std::size_t k = 0; k < start.size(); ++k) is_better = tries(k, step) || tries(k, -step) || is_better;
    if (!is_better) step *= 0.5;
  }
  return found;
}

bool refine_lists(const Evaluator& core, const Scene& scene, const Plan& plan, int threads,
                  std::vector<std::vector<BestGrip>>& lists, const std::function<bool()>& is_asked_to_end) {
  std::vector<std::pair<std::size_t, std::size_t>> all;  // list, rank
  for (std::size_t list = 0; list < lists.size(); ++list)
    for (std::size_t rank = 0; rank < std::min(lists[list].size(), MOST_REFINED); ++rank) all.emplace_back(list, rank);
  const CoreScore score(core, scene);
  std::atomic<bool> is_whole{true};
  in_parallel(all.size(), threads, [&](std::size_t i) {
    if (is_whole && is_asked_to_end && is_asked_to_end()) is_whole = false;
    if (is_whole) refine(score, plan, all[i].first / plan.hand_scales(), lists[all[i].first][all[i].second]);
  });
  return is_whole;
}

}  // namespace wholehand::sweeps
