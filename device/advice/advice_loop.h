// SPDX-License-Identifier: MIT
// The advice of a session that has a clock: a thread of its own, which the haptic thread knows nothing of.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "device/advice/moment.h"
#include "device/simulated/shown_grip.h"

namespace wholehand {

constexpr double ADVICE_RATE = 10;       // Hz at most
constexpr double LEAST_ADVICE_RATE = 5;  // Hz: clouds become smaller where an update takes longer than its share of the time
constexpr double ANSWER_PATIENCE = 1;    // s: an update that takes longer is late, and the advice before it too old
constexpr int ADVICE_NICENESS = 10;      // of its threads beside those of the loop

// The advice in a session's report.
struct AdviceTally {
  std::string place;            // what it is computed on
  std::uint64_t updates = 0;    // with a vessel near
  std::uint64_t grips = 0;      // asked for in them
  double longest = 0;           // s between two such updates that follow one another
  double seconds = 0;           // s of such updates, from one to the next
  std::uint64_t intervals = 0;  // number of times from one to the next

  double rate() const { return seconds > 0 ? static_cast<double>(intervals) / seconds : 0; }  // updates a second
};

class AdviceLoop {
 public:
  // Opens the device in a thread of lower priority, and returns when it is open: before the session starts, as pipelines take
  // seconds. Throws Error as Adviser does. Later faults end the advice, and not the session. `is_followed`: by a simulated user,
  // to whom shown() gives the grips.
  AdviceLoop(const Scene& scene, const std::string& on, int threads, bool is_followed = false);
  // With an adviser of one's own, which is made in the thread. `patience`: s that an update may take.
  using AdviserOpener = std::function<std::unique_ptr<Adviser>(const Scene&)>;
  AdviceLoop(const Scene& scene, AdviserOpener open, bool is_followed = false, double patience = ANSWER_PATIENCE);
  // Stops. A device that does not answer within STOP_PATIENCE is left behind with its thread.
  ~AdviceLoop();
  AdviceLoop(const AdviceLoop&) = delete;
  AdviceLoop& operator=(const AdviceLoop&) = delete;

  // Ticks in their order, all of them, from one thread. Waits for nothing but what is copied.
  void look(std::span<const Tick> ticks);
  // The newest advice; from any thread. Nothing before the first, while an update takes longer than the patience, and once
  // there is none any more. The same object until the next.
  std::shared_ptr<const Advice> newest() const;
  // Lines that the user must see, each once; from any thread: the device failed, and the advice has ended or goes on; or it does
  // not answer.
  std::vector<std::string> take_warnings();
  // For the haptic thread.
  ShownGripSource& shown();
  // What it is computed on, as Adviser::place.
  std::string place() const;
  AdviceTally tally() const;

  static constexpr double STOP_PATIENCE = 2;  // s

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace wholehand
