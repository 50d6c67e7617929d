// SPDX-License-Identifier: MIT
// Shows a live session at display rate, from the ticks that the recorder's thread passes on. The haptic thread does not know it.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "device/advice/advice.h"
#include "device/session/hand_view.h"

namespace wholehand::device {

constexpr double DISPLAY_RATE = 60;  // Hz

struct DisplayTiming {
  double rate = 0;  // Hz, of the loop; NaN: it has no clock
  double step = 0;  // s; likewise
  std::int64_t missed = 0;
};

// A moment of the session. References hold during the call.
struct DisplayMoment {
  const Tick& tick;
  const VesselPoses& poses;
  const HandView& hand;
  const DisplayTiming& timing;
  const Advice* advice = nullptr;  // null: advice is off; vessel -1: there is none now
};

// The newest advice, or none; from the display loop's thread.
using AdviceSource = std::function<std::shared_ptr<const Advice>()>;

// Shows moments, on the display loop's thread.
class Display {
 public:
  virtual ~Display() = default;
  // Whether anybody watches: otherwise no hand is posed. From any thread.
  virtual bool is_watched() { return true; }
  // Must not wait for long, nor throw.
  virtual void show(const DisplayMoment& moment) noexcept = 0;
  // The session is over; from another thread, after the last moment.
  virtual void end(const std::string& /*reason*/) {}
};

// Shows the newest tick on every display, at most DISPLAY_RATE times a second; poll at that rate. It skips ticks in between, repeats none, and always
// shows the last one.
class DisplayLoop {
 public:
  // `live` and the displays must outlive it. `advice` may be empty.
  DisplayLoop(const LiveScene& live, std::vector<Display*> displays, AdviceSource advice = {});
  // Stops.
  ~DisplayLoop();
  DisplayLoop(const DisplayLoop&) = delete;
  DisplayLoop& operator=(const DisplayLoop&) = delete;

  // Takes all ticks in order, from one thread, with the vessels at `poses` in the last one. Only copies; never waits.
  void look(std::span<const Tick> ticks, const VesselPoses& poses);
  // Shows the last tick, and ends. Call it once; nothing is shown afterwards.
  void stop();

 private:
  void run();
  void show_newest();
  bool is_watched() const;
  double measured_rate(std::int64_t ticks, std::int64_t number);

  const LiveScene& live_;
  std::vector<Display*> displays_;
  AdviceSource advice_;

  using Clock = std::chrono::steady_clock;
  std::mutex mutex_;  // of the next nine
  std::condition_variable wake_;
  bool is_stopping_ = false;
  bool is_new_ = false;  // the newest was not shown
  bool is_due_ = false;  // and is to be
  Clock::time_point due_;
  Tick newest_;
  VesselPoses poses_;
  std::int64_t ticks_ = 0;
  DisplayTiming timing_;

  // Only for the loop's own thread: tick counts of the last second, for the rate.
  struct Count {
    std::int64_t ticks = 0, number = 0;
  };
  std::array<Count, static_cast<std::size_t>(DISPLAY_RATE)> counts_{};
  std::size_t moments_ = 0;

  std::thread thread_;  // declared last: it uses all of the above
};

}  // namespace wholehand::device
