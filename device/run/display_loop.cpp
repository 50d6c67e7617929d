// SPDX-License-Identifier: MIT
#include "device/run/display_loop.h"

#include <algorithm>

#include "base/system/block_signals.h"

namespace wholehand::device {
namespace {

constexpr std::chrono::microseconds PERIOD{static_cast<std::int64_t>(1e6 / DISPLAY_RATE)};

}  // namespace

DisplayLoop::DisplayLoop(const LiveScene& live, std::vector<Display*> displays, AdviceSource advice)
    : live_(live), displays_(std::move(displays)), advice_(std::move(advice)) {
  const BlockSignals inherited;
  thread_ = std::thread([this] { run(); });
}

DisplayLoop::~DisplayLoop() { stop(); }

void DisplayLoop::look(std::span<const Tick> ticks, const VesselPoses& poses) {
  if (ticks.empty()) return;
  {
    const std::lock_guard lock(mutex_);
    for (const Tick& tick : ticks) {
      if (ticks_ > 0) timing_.missed += std::max<std::int64_t>(0, tick.number - newest_.number - 1);
      timing_.step = std::max(timing_.step, tick.step_time);
      newest_.number = tick.number;
      ++ticks_;
    }
    newest_ = ticks.back();
    poses_ = poses;
    is_new_ = true;
    // a few that come right behind others wait for the next
    const Clock::time_point now = Clock::now();
    if (now < due_) return;
    due_ = now + PERIOD / 2;
    is_due_ = true;
  }
  if (is_watched()) wake_.notify_one();
}

void DisplayLoop::stop() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    is_stopping_ = true;
  }
  wake_.notify_one();
  thread_.join();
  try {
    show_newest();
  } catch (...) {
  }
}

void DisplayLoop::run() {
  for (Clock::time_point next = Clock::now();; next = Clock::now() + PERIOD * 9 / 10) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return is_stopping_ || is_due_; });
      wake_.wait_until(lock, next, [this] { return is_stopping_; });
      if (is_stopping_) return;
    }
    try {
      show_newest();
    } catch (...) {  // no memory for this moment; the session goes on
    }
  }
}

void DisplayLoop::show_newest() {
  Tick tick;
  VesselPoses poses;
  DisplayTiming timing;
  std::int64_t ticks = 0;
  {
    const std::lock_guard lock(mutex_);
    is_due_ = false;
    if (!is_new_) return;
    is_new_ = false;
    tick = newest_;
    poses = poses_;
    timing = timing_;
    timing_.step = 0;
    ticks = ticks_;
  }
  timing.rate = measured_rate(ticks, tick.number);
  if (!is_watched()) return;
  const HandView hand = hand_view(live_, tick, poses);
  const std::shared_ptr<const Advice> advice = advice_ ? advice_() : nullptr;
  static const Advice NO_ADVICE;
  const Advice* const shown = advice ? advice.get() : advice_ ? &NO_ADVICE : nullptr;
  for (Display* display : displays_) display->show({tick, poses, hand, timing, shown});
}

bool DisplayLoop::is_watched() const {
  return std::any_of(displays_.begin(), displays_.end(), [](Display* display) { return display->is_watched(); });
}

// Over the last moments: the session's rate, minus the share of periods without a tick.
double DisplayLoop::measured_rate(std::int64_t ticks, std::int64_t number) {
  const std::size_t at = moments_ % counts_.size();
  const Count before = moments_ < counts_.size() ? counts_[0] : counts_[at];
  const bool is_first = moments_ == 0;
  counts_[at] = {ticks, number};
  ++moments_;
  if (is_first || number <= before.number) return live_.scene.live.rate;
  return live_.scene.live.rate * static_cast<double>(ticks - before.ticks) / static_cast<double>(number - before.number);
}

}  // namespace wholehand::device
