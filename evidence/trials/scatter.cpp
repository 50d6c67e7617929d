// SPDX-License-Identifier: MIT
#include "evidence/trials/scatter.h"

#include "base/numbers/random_bits.h"

namespace wholehand {
namespace {

// What a placement comes to over all cases: the first that was discarded says why, else the first that was lost.
Placement placement_of(const std::vector<TrialOutcome>& outcomes) {
  Placement placement{true, true, TrialReason::none};
  for (const TrialOutcome& one : outcomes) {
    if (one.held && !one.discarded) continue;
    if (placement.held || (one.discarded && !is_discarded(placement.reason))) placement.reason = one.reason;
    placement.held = false;
  }
  return placement;
}

}  // namespace

GripScatter::GripScatter(const Scene& scene, const TrialSettings& settings, const OpenTrialEngine& open)
    : robust_(*scene.robust), ranking_(sweeps::deviations(*scene.robust)) {
  for (const double friction : sweeps::robust_frictions(scene)) {
    auto level = std::make_unique<Level>(Level{scene, nullptr, nullptr});
    level->scene.force.friction = friction;
    level->core = make_core_evaluator(level->scene);
    TrialSettings own = settings;
    own.friction = friction;
    level->engine = open(level->scene, *level->core, own);
    levels_.push_back(std::move(level));
  }
}

const GripScatter::Level& GripScatter::level_of(std::size_t deviation, std::size_t count) const {
  return *levels_[deviation * levels_.size() / count];
}

std::vector<Placement> GripScatter::place(const TrialGrip& grip, const std::vector<TrialCase>& cases, std::size_t count,
                                          std::uint64_t seed) const {
  RobustData own = robust_;
  own.count = static_cast<int>(count);
  own.seed = mixed_bits(grip_key(seed, grip.vessel, grip.number));
  std::vector<Placement> placements;
  for (const sweeps::Deviation& deviation : sweeps::deviations(own)) {
    const Level& level = level_of(placements.size(), count);
    const GripInput moved = sweeps::deviated(grip.grip, deviation);
    GripResult found;
    level.core->grip(grip.vessel, moved, found);
    const bool is_possible = found.reason == Reason::none && found.plausible;
    placements.push_back(is_possible ? placement_of(level.engine->run(grip.vessel, moved, cases)) : Placement{});
  }
  return placements;
}

sweeps::RobustScore GripScatter::robust(const TrialGrip& grip) const {
  std::vector<double> scores;
  std::size_t held = 0;
  for (const sweeps::Deviation& deviation : ranking_) {
    const Evaluator& core = *level_of(scores.size(), ranking_.size()).core;
    const GripInput moved = sweeps::deviated(grip.grip, deviation);
    GripResult found;
    core.grip(grip.vessel, moved, found);
    const bool is_possible = found.reason == Reason::none && found.plausible;
    const GripScore score = is_possible ? core.score(grip.vessel, moved, found) : GripScore{};
    scores.push_back(score.score);
    held += is_possible && !score.not_held ? 1 : 0;
  }
  return sweeps::robust_score(scores, held);
}

}  // namespace wholehand
