// SPDX-License-Identifier: MIT
#include "device/advice/stepped_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "device/advice/moment.h"

namespace wholehand::device {

SteppedAdvice::SteppedAdvice(const Scene& scene, const std::string& on, const Options& options)
    : SteppedAdvice(
          scene, [&](const Scene& own) { return std::make_unique<Adviser>(own, on, options.threads); }, options) {}

SteppedAdvice::SteppedAdvice(const Scene& scene, const AdviceLoop::AdviserOpener& open, const Options& options)
    : live_(scene),
      options_(options),
      adviser_(open(scene)),
      period_(std::max<std::int64_t>(1, std::llround(scene.live.rate / LEAST_ADVICE_RATE))) {
  tally_.place = adviser_->place();
}

void SteppedAdvice::look(const Tick& tick, const VesselPoses& poses) noexcept {
  if (tick.number < due_ || !adviser_) return;
  due_ = (tick.number / period_ + 1) * period_;
  try {
    ask(tick, poses);
  } catch (const std::exception& error) {
    adviser_.reset();
    coming_.reset();
    grip_ = coming_grip_ = {};
    is_grip_new_ = true;
    const std::lock_guard lock(mutex_);
    newest_.reset();
    news_.push_back(fmt::format("advice: {}; the session goes on without advice", error.what()));
  }
}

// The answer to the question of the last moment is there now.
void SteppedAdvice::ask(const Tick& tick, const VesselPoses& poses) {
  auto found = std::make_shared<const Advice>(is_held(tick.state) && !options_.while_held
                                                  ? Advice{}
                                                  : advice_of(live_, tick, poses, *adviser_, options_.grips, options_.keeps_line));
  std::swap(grip_, coming_grip_);
  is_grip_new_ = coming_ != nullptr;
  coming_grip_ = shown_grip(live_.scene, *found, *adviser_);
  std::vector<std::string> notes = adviser_->notes();
  std::string place = adviser_->place();
  const std::lock_guard lock(mutex_);
  newest_ = std::exchange(coming_, found);
  for (std::string& note : notes) news_.push_back("advice: " + std::move(note));
  tally_.place = std::move(place);
  if (found->vessel < 0) return;
  ++tally_.updates;
  tally_.grips += found->grips;
}

bool SteppedAdvice::take(std::int64_t /*tick*/, ShownGrip& grip) noexcept {
  if (!is_grip_new_) return false;
  is_grip_new_ = false;
  grip = grip_;
  return true;
}

std::shared_ptr<const Advice> SteppedAdvice::newest() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

std::vector<std::string> SteppedAdvice::take_warnings() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, {});
}

AdviceTally SteppedAdvice::tally() const {
  const std::lock_guard lock(mutex_);
  return tally_;
}

}  // namespace wholehand::device
