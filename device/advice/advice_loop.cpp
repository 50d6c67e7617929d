// SPDX-License-Identifier: MIT
#include "device/advice/advice_loop.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <future>
#include <mutex>
#include <thread>
#include <utility>

#include "base/system/block_signals.h"
#include "base/system/clock.h"
#include "device/advice/moment.h"

namespace wholehand::device {

// Shared by the thread and its owner. The thread keeps it alive if a hanging device is abandoned.
struct AdviceLoop::Shared {
  Shared(const Scene& scene, bool is_followed_in, double patience_in)
      : live(scene), is_followed(is_followed_in), patience(patience_in) {}

  void run(std::promise<void>& opened, const AdviserOpener& open);
  std::unique_ptr<Adviser> open_adviser(std::promise<void>& opened, const AdviserOpener& open);
  void go_on(Adviser& adviser);
  bool wait_for_moment(Tick& moment, VesselPoses& where);
  void put(Advice advice, double began, std::string place);
  void end(const std::string& why);
  bool is_late() const;  // under the mutex

  const LiveScene live;
  const bool is_followed;
  const double patience;  // s
  std::atomic<bool> stop{false};
  ShownGrips shown;

  mutable std::mutex mutex;  // of all below
  std::condition_variable wake, gone;
  bool is_new = false, is_over = false;
  Tick tick;
  VesselPoses poses;
  std::shared_ptr<const Advice> newest;
  std::vector<std::string> warnings;
  AdviceTally tally;
  double last = 0;                // when the previous update was finished, s; 0: it concerned no vessel
  double asked = 0;               // start of the current update, s; 0: none
  bool is_late_reported = false;  // that one is late
};

namespace {

// Lowers the priority of this thread and of the threads that it starts, including the device's.
void take_back_seat() {
  // Linux takes a thread's id here; if the priority may not be lowered, the advice continues unchanged
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())) + ADVICE_NICENESS);
}

// As many grips as fit a part of the time of an update at LEAST_ADVICE_RATE. At most ADVICE_RATE updates a second leave a fifth of the time for the
// machine's other work of the same priority.
std::size_t next_cloud(std::size_t grips, double seconds) {
  const double fits = static_cast<double>(grips) * 0.4 / (LEAST_ADVICE_RATE * std::max(seconds, 1e-6));
  return static_cast<std::size_t>(std::clamp(fits, std::max<double>(LEAST_CLOUD, 0.5 * static_cast<double>(grips)),
                                             std::min<double>(MOST_CLOUD, 2 * static_cast<double>(grips))));
}

}  // namespace

void AdviceLoop::Shared::run(std::promise<void>& opened, const AdviserOpener& open) {
  take_back_seat();
  const std::unique_ptr<Adviser> adviser = open_adviser(opened, open);
  if (!adviser) return;
  try {
    go_on(*adviser);
  } catch (const std::exception& error) {
    end(error.what());
  } catch (...) {
    end("it failed");
  }
}

// None if it cannot be opened; `opened` then carries the reason.
std::unique_ptr<Adviser> AdviceLoop::Shared::open_adviser(std::promise<void>& opened, const AdviserOpener& open) {
  try {
    std::unique_ptr<Adviser> adviser = open(live.scene);
    {
      const std::lock_guard lock(mutex);
      tally.place = adviser->place();
    }
    opened.set_value();
    return adviser;
  } catch (...) {
    opened.set_exception(std::current_exception());
    return nullptr;
  }
}

// Computes an update for each moment, until it must end.
void AdviceLoop::Shared::go_on(Adviser& adviser) {
  Tick moment;
  VesselPoses where;
  std::size_t grips = STEP_CLOUD;
  while (wait_for_moment(moment, where)) {
    const double began = monotonic_now();
    Advice advice = advice_of(live, moment, where, adviser, grips, is_followed, &stop);
    if (stop) return;
    if (is_followed) shown.put(shown_grip(live.scene, advice, adviser));
    if (advice.grips > 0) grips = next_cloud(grips, monotonic_now() - began);
    std::vector<std::string> notes = adviser.notes();
    {
      const std::lock_guard lock(mutex);
      for (std::string& note : notes) warnings.push_back("advice: " + std::move(note));
    }
    put(std::move(advice), began, adviser.place());
  }
}

// False: it is to end.
bool AdviceLoop::Shared::wait_for_moment(Tick& moment, VesselPoses& where) {
  std::unique_lock lock(mutex);
  wake.wait(lock, [this] { return stop || is_new; });
  if (stop) return false;
  is_new = false;
  moment = tick;
  where = poses;
  asked = monotonic_now();
  return true;
}

void AdviceLoop::Shared::put(Advice advice, double began, std::string place) {
  const bool is_near = advice.vessel >= 0;
  const std::uint64_t grips = advice.grips;
  auto made = std::make_shared<const Advice>(std::move(advice));
  const double now = monotonic_now();
  std::unique_lock lock(mutex);
  newest = std::move(made);
  asked = 0;
  tally.place = std::move(place);
  if (is_near) {
    ++tally.updates;
    tally.grips += grips;
    if (last > 0) {
      tally.longest = std::max(tally.longest, now - last);
      tally.seconds += now - last;
      ++tally.intervals;
    }
  }
  last = is_near ? now : 0;
  const auto rest = std::chrono::duration<double>(std::max(0.0, began + 1 / ADVICE_RATE - now));
  wake.wait_for(lock, rest, [this] { return stop.load(); });
}

void AdviceLoop::Shared::end(const std::string& why) {
  if (is_followed) shown.put({});
  const std::lock_guard lock(mutex);
  newest.reset();
  asked = 0;
  warnings.push_back(fmt::format("advice: {}; the session goes on without advice", why));
}

bool AdviceLoop::Shared::is_late() const { return asked > 0 && monotonic_now() - asked > patience; }

AdviceLoop::AdviceLoop(const Scene& scene, const std::string& on, int threads, bool is_followed)
    : AdviceLoop(
          scene, [on, threads](const Scene& own) { return std::make_unique<Adviser>(own, on, threads); }, is_followed) {}

AdviceLoop::AdviceLoop(const Scene& scene, AdviserOpener open, bool is_followed, double patience)
    : shared_(std::make_shared<Shared>(scene, is_followed, patience)) {
  std::promise<void> opened;
  std::future<void> is_open = opened.get_future();
  {
    const BlockSignals inherited;
    std::thread([shared = shared_, opened = std::move(opened), open = std::move(open)]() mutable {
      shared->run(opened, open);
      const std::lock_guard lock(shared->mutex);
      shared->is_over = true;
      shared->gone.notify_all();
    }).detach();
  }
  is_open.get();
}

AdviceLoop::~AdviceLoop() {
  std::unique_lock lock(shared_->mutex);
  shared_->stop = true;
  shared_->wake.notify_all();
  shared_->gone.wait_for(lock, std::chrono::duration<double>(STOP_PATIENCE), [this] { return shared_->is_over; });
}

void AdviceLoop::look(const Tick& tick, const VesselPoses& poses) {
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->tick = tick;
    shared_->poses = poses;
    shared_->is_new = true;
  }
  shared_->wake.notify_all();
}

std::shared_ptr<const Advice> AdviceLoop::newest() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->is_late() ? nullptr : shared_->newest;
}

std::vector<std::string> AdviceLoop::take_warnings() {
  const std::lock_guard lock(shared_->mutex);
  std::vector<std::string> warnings = std::exchange(shared_->warnings, {});
  if (shared_->is_late() && !std::exchange(shared_->is_late_reported, true)) {
    warnings.push_back(
        fmt::format("advice: the device has not answered for {:g} s; there is no advice until it does", shared_->patience));
  }
  return warnings;
}

ShownGripSource& AdviceLoop::shown() { return shared_->shown; }

AdviceTally AdviceLoop::tally() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->tally;
}

}  // namespace wholehand::device
