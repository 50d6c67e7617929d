// SPDX-License-Identifier: MIT
#include "device/simulated/replay_gripper.h"

#include <cstddef>
#include <utility>

namespace wholehand::device {
namespace {

// Where the session ended by itself, its time over or its user done, or by the loop's own doing.
bool ends_there(const Tick& tick) {
  const bool is_of_loop = tick.fault == Fault::late || tick.fault == Fault::ring_full || tick.fault == Fault::interrupted;
  return is_of_loop || (tick.state == SessionState::released && tick.fault == Fault::none);
}

class ReplayGripper : public Gripper {
 public:
  ReplayGripper(std::vector<Tick> ticks, GripperLimits limits) : ticks_(std::move(ticks)), limits_(std::move(limits)) {
    while (end_ < ticks_.size() && !ends_there(ticks_[end_])) ++end_;
  }

  const GripperLimits& limits() const noexcept override { return limits_; }

  // A tick that was not recorded has no measurement.
  ReadOutcome read(GripperState& state, std::int64_t tick) noexcept override {
    while (next_ < end_ && ticks_[next_].number < tick) ++next_;
    takes_force_ = true;
    if (next_ >= end_ || ticks_[next_].number != tick) return ReadOutcome::timeout;
    const Tick& then = ticks_[next_++];
    takes_force_ = then.fault != Fault::write_error;
    replays_zero_ = is_none(then.written) && !is_none(then.wanted);
    if (then.read == ReadOutcome::value) state = then.device;
    return then.read;
  }
  bool write(const GripperForce&) noexcept override { return takes_force_; }
  const char* last_error() const noexcept override { return "as in the recording"; }
  bool is_done() const noexcept override { return next_ >= end_; }
  bool replays_zero() const noexcept override { return replays_zero_; }
  std::int64_t replayed_tick() const noexcept override { return next_ < end_ ? ticks_[next_].number : -1; }

 private:
  std::vector<Tick> ticks_;
  GripperLimits limits_;
  std::size_t next_ = 0, end_ = 0;  // of the ticks that are played
  bool takes_force_ = true, replays_zero_ = false;
};

}  // namespace

std::unique_ptr<Gripper> make_replay(std::vector<Tick> ticks, GripperLimits limits) {
  return std::make_unique<ReplayGripper>(std::move(ticks), std::move(limits));
}

}  // namespace wholehand::device
