// SPDX-License-Identifier: MIT
// Improves a grip: moves it between the neighboring values of the axes to where it scores best.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "core/evaluator.h"
#include "sweeps/lists/best.h"
#include "sweeps/plan/plan.h"

namespace wholehand::sweeps {

constexpr int REFINED_COORDINATES = 5;  // height, azimuth, obliquity, roll, offset: the hand stays
constexpr std::array<PlanPlace, REFINED_COORDINATES> REFINED_PLACES{PLACE_HEIGHT, PLACE_AZIMUTH, PLACE_OBLIQUITY, PLACE_ROLL,
                                                                    PLACE_OFFSET};
constexpr int REFINE_EVALUATIONS = 60;             // of a grip at most
constexpr std::size_t MOST_REFINED = 100;          // grips of a list, from the best one on
constexpr double SMALLEST_REFINE_STEP = 1.0 / 16;  // of the way to an end of the box

// The coordinates of a grip in that order; and the grip with other coordinates.
std::array<double, REFINED_COORDINATES> coordinates_of(const GripInput& grip);
GripInput with_coordinates(const GripInput& grip, const std::array<double, REFINED_COORDINATES>& coordinates);

// The range of each coordinate of a grip: half-way to the neighboring values of its axis, m and rad. An axis with one value stays, and so does
// azimuth if it changes nothing. No grip leaves the span of its axis. Sobol points have no neighbors on a range; there a step is its length /
// count^(1/d), with d ranges.
struct RefineBox {
  std::array<double, REFINED_COORDINATES> low{}, high{};
};
RefineBox refine_box(const Plan& plan, std::size_t vessel, std::uint64_t grip);

// The best place that a pattern search finds in a box, starting at `start`: it tries a step in each coordinate, both ways, keeps improvements, and
// halves the step if there are none. The same on every machine, with at most REFINE_EVALUATIONS calls of `score`. Never below the start's score.
struct RefinedPlace {
  std::array<double, REFINED_COORDINATES> place{};
  double score = 0;
  int evaluations = 0;
};
RefinedPlace search_box(const std::array<double, REFINED_COORDINATES>& start, const RefineBox& box,
                        const std::function<double(const std::array<double, REFINED_COORDINATES>&)>& score);

// Sets `refined` and `refined_score` of the first MOST_REFINED grips of each list, always by the core in double precision, whatever computed their
// scores. They stay NaN if the core finds no feasible, plausible grip in the box. The order of the lists stays. `is_asked_to_end`, set by any thread,
// is checked before each grip. False: it was true, and some are not refined.
bool refine_lists(const Evaluator& core, const Scene& scene, const Plan& plan, int threads,
                  std::vector<std::vector<BestGrip>>& lists, const std::function<bool()>& is_asked_to_end = {});

}  // namespace wholehand::sweeps
