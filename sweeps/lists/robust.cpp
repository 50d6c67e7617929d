// SPDX-License-Identifier: MIT
#include "sweeps/lists/robust.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "base/numbers/normal.h"
#include "base/numbers/sobol.h"
#include "base/statistics/interval.h"
#include "base/text/error.h"
#include "core/core_backend.h"
#include "core/planes.h"
#include "shaders/status.h"
#include "sweeps/grips/report.h"

namespace wholehand::sweeps {
namespace {

constexpr std::size_t PARTS = 8;  // of the deviations; those of one part have one friction
static_assert(PARTS == FRICTION_LEVELS);

// A grip that may get a place, and the scores at its deviations so far, in their order.
struct Judged {
  std::size_t list = 0;
  BestGrip* grip = nullptr;
  std::vector<double> scores;
  std::size_t held = 0, parts = 0;
};

// Ranks before another: `low` and `mean` may be bounds.
bool is_ahead(const RobustScore& a, const RobustScore& b) { return a.low != b.low ? a.low > b.low : a.mean > b.mean; }

class RobustRanking {
 public:
  RobustRanking(const OpenBackend& open, const Scene& scene, const Plan& plan, std::size_t best, const std::atomic<bool>* stop,
                std::vector<std::vector<BestGrip>>& lists, const std::function<void()>& look)
      : open_(open),
        scene_(scene),
        plan_(plan),
        best_(best),
        places_(std::min(best, MOST_ROBUST)),
        stop_(stop),
        lists_(lists),
        look_(look),
        all_(deviations(*scene.robust)),
        frictions_(robust_frictions(scene)),
        backends_(frictions_.size()) {
    const std::array<double, 6> weights = effective_weights(scene);
    largest_score_ = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (std::size_t list = 0; list < lists.size(); ++list)
      for (std::size_t i = 0; i < std::min(lists[list].size(), judged_grips(best)); ++i)
        judged_.push_back({list, &lists[list][i], {}});
  }

  // False: stopped.
  bool run() {
    std::vector<Judged*> everyone;
    for (Judged& one : judged_) everyone.push_back(&one);
    if (!judge(everyone, 0, 1)) return false;
    // The best so far come first: they soon set what the others have to reach.
    const std::vector<Judged*> likely = likely_ones();
    for (std::size_t part = 1, end; part < PARTS; part = end) {
      for (end = part + 1; end < PARTS && level_of(end) == level_of(part);) ++end;  // at once, so that no thread waits between them
      if (!judge(likely, part, end)) return false;
    }
    for (std::size_t part = 1; part < PARTS; ++part)
      if (!judge(open_ones(part), part, part + 1)) return false;
    return true;
  }

  void rank() {
    std::vector<std::vector<BestGrip>> ranked(lists_.size());
    for (const auto& ones : by_list(true)) {
      if (ones.empty()) continue;
      std::vector<BestGrip>& list = ranked[ones[0]->list];
      for (std::size_t place = 0; place < std::min(places_, ones.size()); ++place) {
        list.push_back(*ones[place]->grip);
        list.back().robust = score_of(*ones[place]);
      }
    }
    for (std::size_t list = 0; list < lists_.size(); ++list) {
      std::set<std::uint64_t> placed;
      for (const BestGrip& grip : ranked[list]) placed.insert(grip.candidate.index);
      for (const BestGrip& grip : lists_[list])
        if (ranked[list].size() < best_ && !placed.contains(grip.candidate.index)) ranked[list].push_back(grip);
    }
    lists_ = std::move(ranked);
  }

 private:
  std::size_t first_of(std::size_t part) const { return part * all_.size() / PARTS; }
  std::size_t level_of(std::size_t part) const { return part * frictions_.size() / PARTS; }
  bool is_done(const Judged& one) const { return one.parts == PARTS; }

  static RobustScore score_of(const Judged& one) { return robust_score(one.scores, one.held); }

  // What a grip has at most once all of its deviations are known.
  RobustScore most_of(const Judged& one) const {
    const double sum = std::accumulate(one.scores.begin(), one.scores.end(), 0.0), count = static_cast<double>(all_.size());
    const double unknown = count - static_cast<double>(one.scores.size());
    RobustScore most;
    most.low = largest_low(one.scores, all_.size());
    most.mean = (sum + unknown * largest_score_) / count * (1 + 1e-12);  // whatever the sum rounds to
    return most;
  }

  // The grips of each list in the order of their scores so far; of equal ones as they were. `whole`: only those whose deviations are all known.
  std::vector<std::vector<Judged*>> by_list(bool whole) {
    std::vector<std::vector<Judged*>> of(lists_.size());
    for (Judged& one : judged_)
      if (!whole || is_done(one)) of[one.list].push_back(&one);
    for (auto& ones : of) {
      std::vector<std::pair<RobustScore, Judged*>> scored;
      for (Judged* one : ones) scored.emplace_back(score_of(*one), one);
      std::stable_sort(scored.begin(), scored.end(), [](const auto& a, const auto& b) { return is_ahead(a.first, b.first); });
      for (std::size_t i = 0; i < ones.size(); ++i) ones[i] = scored[i].second;
    }
    return of;
  }

  std::vector<Judged*> likely_ones() {
    std::vector<Judged*> likely;
    for (const auto& ones : by_list(false)) {
      const std::size_t count = std::min(places_, ones.size());
      likely.insert(likely.end(), ones.begin(), ones.begin() + static_cast<std::ptrdiff_t>(count));
    }
    return likely;
  }

  // The grips whose next part is this one, and that may still get ahead of the last whole grip with a place.
  std::vector<Judged*> open_ones(std::size_t part) {
    const std::vector<std::vector<Judged*>> whole = by_list(true);
    std::vector<Judged*> open;
    for (Judged& one : judged_) {
      if (one.parts != part) continue;
      const std::vector<Judged*>& ahead = whole[one.list];
      if (ahead.size() < places_ || !is_ahead(score_of(*ahead[places_ - 1]), most_of(one))) open.push_back(&one);
    }
    return open;
  }

  Backend& backend(std::size_t part) {
    std::unique_ptr<Backend>& opened = backends_[level_of(part)];
    if (!opened) {
      Scene other = scene_;
      other.force.friction = frictions_[level_of(part)];
      opened = open_(other, make_field_set({FIELD_SCORE, FIELD_STATUS}, other));
    }
    return *opened;
  }

  // Parts from `part` to before `end`, which have one friction.
  bool judge(const std::vector<Judged*>& ones, std::size_t part, std::size_t end) {
    for (std::size_t vessel = 0; vessel < scene_.vessels.size(); ++vessel) {
      std::vector<Judged*> own;
      for (Judged* one : ones)
        if (one->list / plan_.hand_scales() == vessel) own.push_back(one);
      if (!own.empty() && !evaluate(vessel, own, part, end)) return false;
    }
    return true;
  }

  bool evaluate(std::size_t vessel, const std::vector<Judged*>& ones, std::size_t part, std::size_t end) {
    if (stop_ && *stop_) return false;
    const std::size_t first = first_of(part), each = first_of(end) - first;
    Backend& used = backend(part);
    const FieldSet& fields = used.fields();
    RunRequest request;
    request.vessel = vessel;
    request.last = ones.size() * each;
    request.stop = stop_;
    request.grips = [&](std::size_t, std::uint64_t from, std::size_t count, GripInput* out) {
      for (std::size_t i = 0; i < count; ++i)
        out[i] = deviated(ones[(from + i) / each]->grip->grip, all_[first + (from + i) % each]);
    };
    request.sink = [&](const PlaneChunk& chunk) {  // in ascending order
      for (std::size_t i = 0; i < chunk.count; ++i) {
        Judged& one = *ones[(chunk.first + i) / each];
        const std::uint32_t status = chunk.uint(fields.plane[FIELD_STATUS], i);
        const bool is_held = is_eligible(status);
        one.scores.push_back(is_held ? chunk.real(fields.plane[FIELD_SCORE], i) : 0);
        one.held += is_held ? 1 : 0;
      }
      if (look_) look_();
    };
    const RunResult result = used.run(request);
    if (stop_ && *stop_) return false;
    if (result.done != request.last) {
      throw failure_error(
          fmt::format("{}: evaluated {} of the {} deviations of the best grips", used.info().device, result.done, request.last));
    }
    for (Judged* one : ones) one->parts = end;
    return true;
  }

  const OpenBackend& open_;
  const Scene& scene_;
  const Plan& plan_;
  std::size_t best_, places_;
  const std::atomic<bool>* stop_;
  std::vector<std::vector<BestGrip>>& lists_;
  const std::function<void()>& look_;
  std::vector<Deviation> all_;
  std::vector<double> frictions_;
  std::vector<std::unique_ptr<Backend>> backends_;  // of each friction, once it is needed
  double largest_score_ = 0;
  std::vector<Judged> judged_;
};

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

RobustScore robust_score(std::vector<double> scores, std::size_t held) {
  std::sort(scores.begin(), scores.end());
  // about the least one, so that equal scores have this score as their mean
  const double sum =
      std::accumulate(scores.begin(), scores.end(), 0.0, [&](double all, double score) { return all + (score - scores[0]); });
  return {scores[0] + sum / static_cast<double>(scores.size()), percentile_of(scores, 0.1),
          static_cast<double>(held) / static_cast<double>(scores.size())};
}

double largest_low(std::vector<double> known, std::size_t count) {
  const double place = 0.1 * static_cast<double>(count - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t needed = std::min(below + 2, count);
  if (known.size() < needed) return std::numeric_limits<double>::infinity();
  std::sort(known.begin(), known.end());
  // what is not known may be as large as it likes
  known.resize(std::max(count, known.size()), known.back());
  return percentile_of(known, 0.1);
}

std::size_t judged_grips(std::size_t best) {
  return best == 0 ? 0 : ROBUST_CANDIDATES * std::clamp(best, LEAST_ROBUST, MOST_ROBUST);
}

std::size_t robust_candidates(const Scene& scene, std::size_t best) {
  return scene.robust ? std::max(best, judged_grips(best)) : best;
}

bool rank_robustly(const OpenBackend& open, const Scene& scene, const Plan& plan, std::size_t best, const std::atomic<bool>* stop,
                   std::vector<std::vector<BestGrip>>& lists, const std::function<void()>& look) {
  if (!scene.robust) return true;
  RobustRanking ranking(open, scene, plan, best, stop, lists, look);
  if (!ranking.run()) return false;
  ranking.rank();
  return true;
}

std::unique_ptr<Backend> open_core_for(const Scene& scene, const FieldSet& fields) {
  return std::make_unique<CoreBackend>(make_core_evaluator(scene), scene, fields, Precision::full, 0);
}

void add_held_share(GripReport& report, const Scene& scene, std::size_t vessel) {
  if (!scene.robust || !report.answer.result.plausible) return;
  const Plan plan(scene, false);
  std::vector<std::vector<BestGrip>> lists(scene.vessels.size() * plan.hand_scales());
  const std::size_t own = vessel * plan.hand_scales();
  lists[own].emplace_back().grip = report.grip;
  rank_robustly(open_core_for, scene, plan, 1, nullptr, lists);
  report.held_share = lists[own].front().robust.share;
}

}  // namespace wholehand::sweeps
