// SPDX-License-Identifier: MIT
// The score of a grip if a person does not grip exactly as planned: over random deviations of the grip, the friction and the hand's size. Lists are
// ranked by it.
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

namespace wholehand::sweeps {

struct GripReport;  // sweeps/grips/report.h

constexpr int FRICTION_LEVELS = 8;            // values of a friction with a deviation, all equally likely
constexpr double LEAST_HAND_FACTOR = 0.1;     // lower limit of the hand's size, however large its deviation
constexpr std::size_t MOST_ROBUST = 100;      // places of a list that robust scores decide
constexpr std::size_t ROBUST_CANDIDATES = 8;  // grips that are judged for each of these places
constexpr std::size_t LEAST_ROBUST = 20;      // a shorter list is the start of a list with so many places

// One deviation: addends for a grip's coordinates (m, rad), and a factor for its hand scale.
struct Deviation {
  GripInput added{0, 0, 0, 0, 0, 0};  // but for hand_scale
  double hand_factor = 1;
};

// The `count` deviations of a scene, the same for every grip: Sobol points shifted by the seed, each coordinate through normal_quantile. If the
// friction has a deviation, those from `level` * count / FRICTION_LEVELS on have the friction of that level, see robust_frictions.
std::vector<Deviation> deviations(const RobustData& robust);
// The friction of each level, at least 0: mu plus its deviation times the quantile of the middle of that eighth, over the standard deviation of these
// eight quantiles (0.9225), so that the levels have the scene's deviation. One level if the friction has no deviation.
std::vector<double> robust_frictions(const Scene& scene);
// An obliquity beyond 90 degrees names the same hand from the other side: azimuth and roll change by half a turn, and the offset changes sign. Angles
// lose full turns, because devices take sines of up to 16 rad.
GripInput deviated(const GripInput& grip, const Deviation& deviation);

// The percentile of n ascending scores, counted from 0, lies at 0.1 (n - 1), interpolated linearly. `held` counts the scores of eligible grips
// (shaders/status.h).
RobustScore robust_score(std::vector<double> scores, std::size_t held);

// The largest 10th percentile that `count` scores can have if they include these; infinite if too few are known.
double largest_low(std::vector<double> known, std::size_t count);

// How many grips are judged for a list of `best`: ROBUST_CANDIDATES for each place that robust scores decide, and at least as many as for a list of
// LEAST_ROBUST.
std::size_t judged_grips(std::size_t best);

// How many grips a list keeps so that robust scores choose `best` of them. `best` in a scene without [robust].
std::size_t robust_candidates(const Scene& scene, std::size_t best);

// Opens a backend for a scene that differs from the sweep's only in its friction.
using OpenBackend = std::function<std::unique_ptr<Backend>(const Scene&, const FieldSet&)>;

// In a scene with [robust], ranks the first min(best, MOST_ROBUST) places of each list by the 10th percentile of robust scores, then by their mean,
// then by the old order. For these places the first judged_grips(best) grips of the list are judged, and the chosen grips get their robust scores.
// The rest keeps its order, and the list is cut to `best` grips. A deviation that is not eligible scores 0. A grip whose deviations so far leave it
// no place is not judged further, which changes no list. The bits do not depend on how many grips the backend takes at once. `stop` may be null;
// false: it was set, and no list has changed. `look` is called after each chunk and may set it. Throws Error (failure) if the backend delivers fewer
// grips.
bool rank_robustly(const OpenBackend& open, const Scene& scene, const Plan& plan, std::size_t best, const std::atomic<bool>* stop,
                   std::vector<std::vector<BestGrip>>& lists, const std::function<void()>& look = {});

// An OpenBackend: the core, on all threads.
std::unique_ptr<Backend> open_core_for(const Scene& scene, const FieldSet& fields);

// Sets the share of the deviations of a report's grip that hold, by the core. Does nothing for an implausible grip, or without [robust].
void add_held_share(GripReport& report, const Scene& scene, std::size_t vessel);

}  // namespace wholehand::sweeps
