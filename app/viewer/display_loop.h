// SPDX-License-Identifier: MIT
// What a live session shows, at display rate: from the ticks that the recorder's thread hands on to whoever displays them. The haptic thread
// knows nothing of it.
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

#include "app/viewer/frame.h"
#include "device/advice/advice.h"
#include "device/session/hand_view.h"

namespace wholehand {

constexpr double DISPLAY_RATE = 60;  // Hz

// A moment of the session. References hold during the call.
struct DisplayMoment {
  const Tick& tick;
  const VesselPoses& poses;
  const HandView& hand;
  const ViewFrame::Timing& timing;
  const Advice* advice = nullptr;  // null: nobody was asked; vessel -1: there is none now
};

// The newest advice, or none; from the display loop's thread.
using AdviceSource = std::function<std::shared_ptr<const Advice>()>;

// Shows moments, on the display loop's thread.
class Display {
 public:
  virtual ~Display() = default;
  // Whether anybody looks: without that no hand is posed. From any thread.
  virtual bool is_watched() { return true; }
  // Must not wait for long, nor throw.
  virtual void show(const DisplayMoment& moment) noexcept = 0;
};

// Shows the newest tick on every display, DISPLAY_RATE times a second at most: best polled just so often. Ticks between are not shown,
// none twice, the last one always.
class DisplayLoop {
 public:
  // `live` and the displays must outlive it. `advice` may be empty.
  DisplayLoop(const LiveScene& live, std::vector<Display*> displays, AdviceSource advice = {});
  // Stops.
  ~DisplayLoop();
  DisplayLoop(const DisplayLoop&) = delete;
  DisplayLoop& operator=(const DisplayLoop&) = delete;

  // Ticks in their order, all of them, from one thread. Waits for nothing but what is copied.
  void look(std::span<const Tick> ticks);
  // Shows the last tick that came, and ends. Once; then nothing is shown any more.
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
  VesselTracker tracker_;
  std::int64_t ticks_ = 0;
  ViewFrame::Timing timing_;

  // Belongs to the loop's own thread: ticks counted at the last moments, a second of them, for the rate.
  struct Count {
    std::int64_t ticks = 0, number = 0;
  };
  std::array<Count, static_cast<std::size_t>(DISPLAY_RATE)> counts_{};
  std::size_t moments_ = 0;

  std::thread thread_;  // last: it uses all of the above
};

}  // namespace wholehand
