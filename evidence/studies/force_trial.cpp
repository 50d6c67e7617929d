// SPDX-License-Identifier: MIT
#include "evidence/studies/force_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "evidence/studies/simulated_session.h"

namespace wholehand {

const std::array<ForceChoice, FORCE_CHOICES> PAPER_CHOICES{{{0, 0, 0},
                                                            {0.4, 0, 0},
                                                            {0.8, 0, 0},
                                                            {1.2, 0, 5},
                                                            {1.6, 0, 3},
                                                            {2.2, 0, 5},
                                                            {0, 2, 0},
                                                            {0.4, 2, 1},
                                                            {0.8, 3, 1},
                                                            {0.8, 4, 1},
                                                            {1.2, 3, 1},
                                                            {1.2, 4, 2},
                                                            {1.6, 3, 4},
                                                            {1.6, 4, 4},
                                                            {2.2, 2, 4}}};

std::string choice_name(const ForceChoice& choice) {
  return choice.range == 0 ? fmt::format("{:g}", choice.base) : fmt::format("{:g}-{:g}", choice.base, choice.base + choice.range);
}

void ForceWatch::begin(const device::Tick& tick) {
  outcome_.has_gripped = true;
  since_ = tick.number;
  still_ = 0;
  gap_ = tick.device.gap;
  most_ = 0;
  window_.clear();
}

bool ForceWatch::take(const device::Tick& tick) {
  if (is_over_) return false;
  const bool held = device::is_held(tick.state);
  if (held && !was_held_) begin(tick);
  if (was_held_ && !held && most_ > device::FELT) ++outcome_.losses;  // what succeeds is over before it ends
  was_held_ = held;
  if (!held) return true;
  most_ = std::max(most_, tick.feedback);
  outcome_.opening = std::max(outcome_.opening, tick.device.gap - gap_);
  const bool is_settled = static_cast<double>(tick.number - since_) >= SETTLED * rate_;
  if (tick.state == device::SessionState::tilt || !is_settled) {
    window_.clear();
  } else {
    watch_swings(tick.feedback);
  }
  still_ = tick.state == device::SessionState::maintain ? still_ + 1 : 0;
  is_over_ = outcome_.has_succeeded = static_cast<double>(still_) >= HELD_STILL * rate_;
  return !is_over_;
}

// Windows follow one another; an incomplete last one is ignored.
void ForceWatch::watch_swings(double force) {
  window_.push_back(force);
  if (static_cast<double>(window_.size()) < SWING_WINDOW * rate_) return;
  const double mean = std::accumulate(window_.begin(), window_.end(), 0.0) / static_cast<double>(window_.size());
  const double least = std::max(SWING_SHARE * mean, LEAST_SWING);
  int side = 0, swings = 0;
  for (const double value : window_) {
    if (std::abs(value - mean) <= least) continue;
    const int now = value > mean ? 1 : -1;
    swings += side != 0 && now != side ? 1 : 0;
    side = now;
  }
  outcome_.oscillates = outcome_.oscillates || swings >= SWINGS;
  window_.clear();
}

Scene force_scene(const Scene& scene, std::size_t vessel) {
  Scene one = scene;
  one.vessels = {scene.vessels[vessel]};
  one.task.reset();
  if (!(scene.live.slide && scene.live.slide_by == SlideBy::hand)) one.strength.reset();
  one.robust.reset();
  one.arm.reset();
  one.tilts.clear();
  one.until_poured.reset();
  return one;
}

ForceOutcome try_forces(Scene scene, const std::vector<device::SimJob>& jobs, const Participant& person, const ForceChoice& choice,
                        std::uint64_t seed, const std::atomic<bool>& stop) {
  scene.force.base = choice.base;
  scene.force.range = choice.range;
  scene.vessels.front().force_range.reset();
  ForceWatch watch(scene.live.rate);
  if (jobs.empty()) return watch.outcome();
  run_simulated(
      {scene, person, seed, jobs}, [&watch](const device::Tick& tick, const device::Session&) { return watch.take(tick); }, stop);
  return watch.outcome();
}

}  // namespace wholehand
