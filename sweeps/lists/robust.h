// SPDX-License-Identifier: MIT
// What a grip scores when a person does not grip exactly where the plan says: its score over random deviations of the grip, of the friction
// and of the hand's size. Lists are ranked by it.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "core/backend.h"
#include "core/scene.h"
#include "sweeps/lists/best.h"
#include "sweeps/plan/plan.h"

namespace wholehand {

struct GripReport;  // sweeps/grips/report.h

constexpr int FRICTION_LEVELS = 8;            // values that a friction with a deviation takes, all equally likely
constexpr double LEAST_HAND_FACTOR = 0.1;     // of the hand's size, however large its deviation
constexpr std::size_t MOST_ROBUST = 100;      // places of a list that robust scores decide
constexpr std::size_t ROBUST_CANDIDATES = 8;  // grips that are judged for each of these places
constexpr std::size_t LEAST_ROBUST = 20;      // a shorter list is the start of one with so many places

// One deviation: what is added to a grip's coordinates (m, rad), and by what its hand scale is multiplied.
struct Deviation {
  GripInput added{0, 0, 0, 0, 0, 0};  // but for hand_scale
  double hand_factor = 1;
};

// The `count` deviations of a scene, the same for every grip: Sobol points shifted by the seed, each coordinate through normal_quantile. With a
// deviation of the friction those from `level` * count / FRICTION_LEVELS on have the friction of that level, see robust_frictions.
std::vector<Deviation> deviations(const RobustData& robust);
// The friction of each level, not below 0: mu plus its deviation times the quantile of the middle of that eighth, over the standard
// deviation of these eight quantiles (0.9225), so that the levels have the deviation that the scene asks for. One level where
// the friction has no deviation.
std::vector<double> robust_frictions(const Scene& scene);
// The same hand beyond an obliquity of 90 degrees is named from the other side: azimuth and roll half a turn on, and the offset
// with its other sign. Angles of many turns lose them, since devices take sines of up to 16 rad.
GripInput deviated(const GripInput& grip, const Deviation& deviation);

// The percentile of n ascending scores, counted from 0, lies at 0.1 (n - 1), between two of them linearly. `held` counts the scores of eligible
// grips (shaders/status.h).
RobustScore robust_score(std::vector<double> scores, std::size_t held);

// The largest 10th percentile that `count` scores can have, of which these are some; infinite where too few are known.
double largest_low(std::vector<double> known, std::size_t count);

// How many grips are judged for a list of `best`: ROBUST_CANDIDATES for each place that robust scores decide, and never fewer than a list of
// LEAST_ROBUST has.
std::size_t judged_grips(std::size_t best);

// How many grips a list keeps, so that robust scores choose `best` of them. `best` in a scene without [robust].
std::size_t robust_candidates(const Scene& scene, std::size_t best);

// Opens what evaluates grips of a scene that differs from the sweep's in its friction alone.
using OpenBackend = std::function<std::unique_ptr<Backend>(const Scene&, const FieldSet&)>;

// In a scene with [robust], ranks each list by the 10th percentile of its grips, then by their mean, then as it was: the first min(best, MOST_ROBUST)
// places, for
// which the first judged_grips(best) grips of the list are judged. The grips on these places get their robust scores. What follows keeps its
// order, and the list ends with `best` grips. A deviation that is not eligible scores 0. A grip whose deviations so far
// leave it no place is not judged further, which changes no list. The same bits however many grips the backend takes at once. `stop` may
// be null; false: it was set, and no list has changed. `look` is called after each chunk and may set it. Throws Error (failure)
// where the backend delivers fewer.
bool rank_robustly(const OpenBackend& open, const Scene& scene, const Plan& plan, std::size_t best, const std::atomic<bool>* stop,
                   std::vector<std::vector<BestGrip>>& lists, const std::function<void()>& look = {});

// An OpenBackend: the core, on all threads.
std::unique_ptr<Backend> open_core_for(const Scene& scene, const FieldSet& fields);

// Sets the share of the deviations of a report's grip that hold, by the core. Does nothing for a grip that is not plausible, and without [robust].
void add_held_share(GripReport& report, const Scene& scene, std::size_t vessel);

}  // namespace wholehand
