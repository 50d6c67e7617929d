// SPDX-License-Identifier: MIT
// The advice of a session without a clock, in step with its ticks, so that a repeated session gets the same advice.
#pragma once

#include <memory>
#include <mutex>

#include "device/advice/advice_loop.h"

namespace wholehand::device {

// Every 1 / LEAST_ADVICE_RATE s of session time, computes advice for that tick with STEP_CLOUD grips. The advice appears at the next such tick: it
// counts as having taken that long.
class SteppedAdvice final : public LiveAdvice, public ShownGripSource {
 public:
  struct Options {
    int threads = 0;          // of the core; 0: all
    bool while_held = true;   // also about a held vessel
    bool keeps_line = false;  // as an AdviceQuestion
    std::size_t grips = STEP_CLOUD;
  };
  // Opens the device; throws Error as Adviser and LiveScene do.
  SteppedAdvice(const Scene& scene, const std::string& on, const Options& options);
  // With a custom adviser.
  SteppedAdvice(const Scene& scene, const AdviceLoop::AdviserOpener& open, const Options& options);

  // Takes all ticks on the loop's thread, which waits. A device that fails ends the advice.
  void look(const Tick& tick, const VesselPoses& poses) noexcept override;
  // For the same thread.
  bool take(std::int64_t tick, ShownGrip& grip) noexcept override;

  ShownGripSource& shown() override { return *this; }
  std::shared_ptr<const Advice> newest() const override;
  std::vector<std::string> take_warnings() override;
  AdviceTally tally() const override;  // has no times

 private:
  void ask(const Tick& tick, const VesselPoses& poses);

  const LiveScene live_;
  Options options_;
  std::unique_ptr<Adviser> adviser_;  // none after a failure
  std::int64_t period_;               // ticks
  std::int64_t due_ = 0;
  std::shared_ptr<const Advice> coming_;  // shown at the next moment
  ShownGrip coming_grip_, grip_;
  bool is_grip_new_ = false;

  mutable std::mutex mutex_;  // of all below
  std::shared_ptr<const Advice> newest_;
  std::vector<std::string> news_;
  AdviceTally tally_;
};

}  // namespace wholehand::device
