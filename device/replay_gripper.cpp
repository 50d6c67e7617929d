#include "device/replay_gripper.h"

#include <cstddef>
#include <utility>

namespace wholehand {
namespace {

bool is_of_loop(Fault fault) { return fault == Fault::late || fault == Fault::ring_full || fault == Fault::interrupted; }

class ReplayGripper : public Gripper {
 public:
  ReplayGripper(std::vector<Tick> ticks, GripperLimits limits) : ticks_(std::move(ticks)), limits_(std::move(limits)) {
    while (end_ < ticks_.size() && !is_of_loop(ticks_[end_].fault)) ++end_;
  }

  const GripperLimits& limits() const noexcept override { return limits_; }

  // A tick that was not recorded has no measurement.
  ReadOutcome read(GripperState& state, std::int64_t tick) noexcept override {
    while (next_ < end_ && ticks_[next_].number < tick) ++next_;
    takes_force_ = true;
    if (next_ >= end_ || ticks_[next_].number != tick) return ReadOutcome::timeout;
    const Tick& then = ticks_[next_++];
    takes_force_ = then.fault != Fault::write_error;
    if (then.read == ReadOutcome::value) state = then.device;
    return then.read;
  }
  bool write(const GripperForce&) noexcept override { return takes_force_; }
  const char* trouble() const noexcept override { return "as in the recording"; }
  bool is_done() const noexcept override { return next_ >= end_; }
  std::int64_t dictated_tick() const noexcept override { return next_ < end_ ? ticks_[next_].number : -1; }

 private:
  std::vector<Tick> ticks_;
  GripperLimits limits_;
  std::size_t next_ = 0, end_ = 0;  // of the ticks that are played
  bool takes_force_ = true;
};

}  // namespace

std::unique_ptr<Gripper> make_replay(std::vector<Tick> ticks, GripperLimits limits) {
  return std::make_unique<ReplayGripper>(std::move(ticks), std::move(limits));
}

}  // namespace wholehand
