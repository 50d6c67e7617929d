// SPDX-License-Identifier: MIT
#include "sweeps/robust.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/error.h"
#include "core/normal.h"
#include "core/planes.h"
#include "core/sobol.h"
#include "shaders/status.h"
#include "statistics/interval.h"

namespace wholehand {
namespace {

// What a candidate is evaluated as: grips of one vessel, `count` of each list entry, one after the other.
struct RobustGrips {
  std::vector<BestGrip*> best;
  std::vector<std::vector<double>> scores;  // of each
};

// False: stopped.
bool evaluate(Backend& backend, std::size_t vessel, const std::vector<Deviation>& all, std::size_t first, std::size_t last,
              const std::atomic<bool>* stop, const std::function<void()>& look, RobustGrips& grips) {
  const std::size_t each = last - first;
  RunRequest request;
  request.vessel = vessel;
  request.last = grips.best.size() * each;
  request.stop = stop;
  request.grips = [&](std::size_t, std::uint64_t from, std::size_t count, GripInput* out) {
    for (std::size_t i = 0; i < count; ++i) out[i] = deviated(grips.best[(from + i) / each]->grip, all[first + (from + i) % each]);
  };
  const FieldSet& fields = backend.fields();
  request.sink = [&](const PlaneChunk& chunk) {
    for (std::size_t i = 0; i < chunk.count; ++i) {
      const std::uint64_t at = chunk.first + i;
      const std::uint32_t status = chunk.uint(fields.plane[FIELD_STATUS], i);
      grips.scores[at / each][first + at % each] = is_eligible(status) ? chunk.real(fields.plane[FIELD_SCORE], i) : 0;
    }
    if (look) look();
  };
  const RunResult result = backend.run(request);
  if (stop && *stop) return false;
  if (result.done != request.last) {
    throw failure_error(
        fmt::format("{}: evaluated {} of the {} deviations of the best grips", backend.info().device, result.done, request.last));
  }
  return true;
}

}  // namespace

std::vector<Deviation> deviations(const RobustData& robust) {
  std::vector<SobolPoint> points(static_cast<std::size_t>(robust.count));
  Sobol(robust.seed).points(0, points.size(), points.data());
  std::vector<Deviation> all;
  for (const SobolPoint& point : points) {
    const auto of = [&](int axis, double deviation) { return deviation * normal_quantile(point[static_cast<std::size_t>(axis)]); };
    Deviation deviation;
    deviation.added.height = of(AXIS_HEIGHT, robust.height);
    deviation.added.azimuth = of(AXIS_AZIMUTH, robust.azimuth);
    deviation.added.obliquity = of(AXIS_OBLIQUITY, robust.obliquity);
    deviation.added.roll = of(AXIS_ROLL, robust.roll);
    deviation.added.offset = of(AXIS_OFFSET, robust.offset);
    deviation.hand_factor = std::max(LEAST_HAND_FACTOR, 1 + of(AXIS_HAND_SCALE, robust.hand_scale));
    all.push_back(deviation);
  }
  return all;
}

std::vector<double> robust_frictions(const Scene& scene) {
  const double spread = scene.robust->friction;
  if (!(spread > 0)) return {scene.force.friction};
  std::vector<double> levels;
  double squares = 0;
  for (int level = 0; level < FRICTION_LEVELS; ++level) {
    levels.push_back(normal_quantile((level + 0.5) / FRICTION_LEVELS));
    squares += levels.back() * levels.back();
  }
  // the middles of equal parts are nearer to each other than what lies in the parts
  const double own_spread = std::sqrt(squares / FRICTION_LEVELS);
  for (double& level : levels) level = std::max(0.0, scene.force.friction + spread * level / own_spread);
  return levels;
}

GripInput deviated(const GripInput& grip, const Deviation& deviation) {
  const GripInput& added = deviation.added;
  GripInput moved{grip.height + added.height, grip.azimuth + added.azimuth, grip.obliquity + added.obliquity,
                  grip.roll + added.roll,     grip.offset + added.offset,   grip.hand_scale * deviation.hand_factor};
  if (std::abs(moved.obliquity) > PI) moved.obliquity = std::remainder(moved.obliquity, 2 * PI);
  if (std::abs(moved.obliquity) > PI / 2) {
    moved.obliquity = std::copysign(PI, moved.obliquity) - moved.obliquity;
    moved.azimuth += PI;
    moved.roll += PI;
    moved.offset = -moved.offset;
  }
  for (double* angle : {&moved.azimuth, &moved.roll})
    if (std::abs(*angle) > 2 * PI) *angle = std::remainder(*angle, 2 * PI);
  return moved;
}

RobustScore robust_score(std::vector<double> scores) {
  std::sort(scores.begin(), scores.end());
  // about the least one, so that equal scores have this score as their mean
  const double sum =
      std::accumulate(scores.begin(), scores.end(), 0.0, [&](double all, double score) { return all + (score - scores[0]); });
  return {scores[0] + sum / static_cast<double>(scores.size()), percentile_of(scores, 0.1)};
}

bool add_robust_scores(const OpenBackend& open, const Scene& scene, const Plan& plan, const std::atomic<bool>* stop,
                       std::vector<std::vector<BestGrip>>& lists, const std::function<void()>& look) {
  if (!scene.robust) return true;
  const std::vector<Deviation> all = deviations(*scene.robust);
  std::vector<RobustGrips> vessels(scene.vessels.size());
  for (std::size_t list = 0; list < lists.size(); ++list) {
    RobustGrips& grips = vessels[list / plan.hand_scales()];
    for (std::size_t rank = 0; rank < std::min(lists[list].size(), MOST_ROBUST); ++rank) {
      grips.best.push_back(&lists[list][rank]);
      grips.scores.emplace_back(all.size());
    }
  }
  if (std::all_of(vessels.begin(), vessels.end(), [](const RobustGrips& grips) { return grips.best.empty(); })) return true;
  const std::vector<double> frictions = robust_frictions(scene);
  // Not the sweep's own, at any friction: what a sweep keeps may change the last bits of a device's scores, and this
  // keeps the same.
  std::unique_ptr<Backend> backend;
  for (std::size_t level = 0; level < frictions.size(); ++level) {
    Scene other = scene;
    other.force.friction = frictions[level];
    if (stop && *stop) return false;
    if (!backend || !backend->use_friction_of(other)) {
      backend.reset();  // before the next one is opened: never two at once
      backend = open(other, make_field_set({FIELD_SCORE, FIELD_STATUS}, other));
    }
    const std::size_t first = level * all.size() / frictions.size(), last = (level + 1) * all.size() / frictions.size();
    for (std::size_t v = 0; v < vessels.size(); ++v)
      if (!vessels[v].best.empty() && !evaluate(*backend, v, all, first, last, stop, look, vessels[v])) return false;
  }
  for (RobustGrips& grips : vessels)
    for (std::size_t i = 0; i < grips.best.size(); ++i) {
      const RobustScore score = robust_score(grips.scores[i]);
      grips.best[i]->robust_mean = score.mean;
      grips.best[i]->robust_low = score.low;
    }
  return true;
}

}  // namespace wholehand
