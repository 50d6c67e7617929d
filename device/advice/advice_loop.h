// SPDX-License-Identifier: MIT
// The advice of a session with a clock. It runs on its own thread, independent of the haptic thread.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "device/advice/live_advice.h"
#include "device/advice/moment.h"

namespace wholehand::device {

constexpr double ADVICE_RATE = 10;       // Hz at most
constexpr double LEAST_ADVICE_RATE = 5;  // Hz: clouds shrink if an update takes longer than its share of the time
constexpr double ANSWER_PATIENCE = 1;    // s: a longer update is late, and the previous advice is then too old
constexpr int ADVICE_NICENESS = 10;      // its threads, besides those of the loop

class AdviceLoop final : public LiveAdvice {
 public:
  // Opens the device on a thread of lower priority, and returns when it is open. Construct it before the session starts, because pipelines take
  // seconds. Throws Error as Adviser does. Later faults end the advice, not the session. `is_followed`: a simulated user follows it, and gets the
  // grips through shown().
  AdviceLoop(const Scene& scene, const std::string& on, int threads, bool is_followed = false);
  // With a custom adviser, which is made on the thread. `patience`: s that an update may take.
  using AdviserOpener = std::function<std::unique_ptr<Adviser>(const Scene&)>;
  AdviceLoop(const Scene& scene, AdviserOpener open, bool is_followed = false, double patience = ANSWER_PATIENCE);
  // Stops. A device that does not answer within STOP_PATIENCE is abandoned with its thread.
  ~AdviceLoop() override;
  AdviceLoop(const AdviceLoop&) = delete;
  AdviceLoop& operator=(const AdviceLoop&) = delete;

  // Takes the newest tick. Only copies; never waits.
  void look(const Tick& tick, const VesselPoses& poses) override;
  // Nothing before the first, while an update exceeds the patience, and after the advice has ended.
  std::shared_ptr<const Advice> newest() const override;
  // The device failed, and the advice has ended or continues; or the device does not answer.
  std::vector<std::string> take_warnings() override;
  ShownGripSource& shown() override;
  AdviceTally tally() const override;

  static constexpr double STOP_PATIENCE = 2;  // s

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace wholehand::device
