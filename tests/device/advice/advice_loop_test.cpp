// SPDX-License-Identifier: MIT
// Advice in a thread of its own: it comes, it follows the ticks, it ends when asked or where its device fails, and nobody waits
// for it.
// sanitizers: thread
#include "device/advice/advice_loop.h"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "tests/support/advised_session.h"

namespace wholehand::device {
namespace {

// One tick of a played session, as a session gives it.
void look(AdviceLoop& loop, const Scene& scene, const std::vector<Tick>& record, std::size_t at) {
  loop.look(record[at], VesselHistory(scene, record).at(at));
}

constexpr auto PATIENCE = std::chrono::seconds(60);

// Whether `is_true` becomes so.
template <class Condition>
bool comes(const Condition& is_true) {
  const auto end = std::chrono::steady_clock::now() + PATIENCE;
  while (!is_true()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

TEST(AdviceLoop, FollowsTheNewestTick) {
  const Scene scene = advised_session_scene();
  const std::vector<Tick> record = play_session(scene, script_for(scene));
  const double no_end = 1e9;  // s: however slow the machine is, nothing is late
  AdviceLoop loop(
      scene, [](const Scene& own) { return std::make_unique<Adviser>(own, "core", 1); }, false, no_end);
  EXPECT_EQ(loop.tally().place, "core, 1 thread");
  EXPECT_FALSE(loop.newest());
  const std::size_t at = last_free_tick(record);
  look(loop, scene, record, at);
  ASSERT_TRUE(comes([&] { return loop.newest() && loop.newest()->tick == record[at].number; }));
  EXPECT_FALSE(loop.newest()->is_held);
  EXPECT_EQ(loop.newest()->vessel, 0);
  look(loop, scene, record, at + 1);
  ASSERT_TRUE(comes([&] { return loop.newest()->is_held; }));
  EXPECT_TRUE(loop.newest()->ahead);
  const AdviceTally tally = loop.tally();
  EXPECT_GE(tally.updates, 2u);
  EXPECT_GE(tally.grips, tally.updates * LEAST_CLOUD);
  EXPECT_TRUE(loop.take_warnings().empty());
}

TEST(AdviceLoop, TellsWhatCannotBeOpenedBeforeItStarts) {
  EXPECT_THROW(AdviceLoop(advised_session_scene(), "no such device", 1), Error);
  EXPECT_THROW(AdviceLoop(live_scene(), "core", 1), Error) << "without [strength]";
}

// A failing device ends the advice with one line, and leaves the session running.
TEST(AdviceLoop, EndsWithALineWhereItsDeviceFails) {
  const Scene scene = advised_session_scene();
  const std::vector<Tick> record = play_session(scene, script_for(scene));
  AdviceLoop loop(scene, dying_adviser(1), true);
  const std::size_t at = last_free_tick(record);
  look(loop, scene, record, at);
  ASSERT_TRUE(comes([&] { return loop.newest() != nullptr; }));
  look(loop, scene, record, at);
  std::vector<std::string> warnings;
  ASSERT_TRUE(comes([&] { return !(warnings = loop.take_warnings()).empty(); }));
  EXPECT_EQ(warnings, std::vector<std::string>{"advice: the device is gone; the session goes on without advice"});
  EXPECT_FALSE(loop.newest()) << "what was advised is no longer of this moment";
  ShownGrip shown;
  shown.vessel = 0;
  ASSERT_TRUE(loop.shown().take(0, shown));
  EXPECT_EQ(shown.vessel, -1) << "nor is it followed";
  look(loop, scene, record, at);  // goes nowhere
}

// Where a device that hangs is held.
struct Gate {
  bool wait_until_in() {
    std::unique_lock lock(mutex);
    return wake.wait_for(lock, PATIENCE, [this] { return is_in; });
  }
  void open() {
    const std::lock_guard lock(mutex);
    is_open = true;
    wake.notify_all();
  }
  void pass() {
    std::unique_lock lock(mutex);
    is_in = true;
    wake.notify_all();
    wake.wait(lock, [this] { return is_open; });
  }

 private:
  std::mutex mutex;
  std::condition_variable wake;
  bool is_in = false, is_open = false;
};

// The core, which after `good` runs does not answer until the gate is opened.
class HangingBackend final : public Backend {
 public:
  HangingBackend(std::shared_ptr<Gate> gate, const Scene& scene, const FieldSet& fields, int good)
      : core_(make_core_evaluator(scene), scene, fields, Precision::full, 1), gate_(std::move(gate)), good_(good) {}
  const BackendInfo& info() const override { return core_.info(); }
  const FieldSet& fields() const override { return core_.fields(); }
  RunResult run(const RunRequest& request) override {
    if (--good_ < 0) gate_->pass();
    return core_.run(request);
  }
  std::vector<LiquidResult> liquid(std::size_t vessel) override { return core_.liquid(vessel); }
  bool use_fills_of(const Scene& other) override { return core_.use_fills_of(other); }

 private:
  CoreBackend core_;
  std::shared_ptr<Gate> gate_;
  int good_;
};

AdviceLoop::AdviserOpener hanging(const std::shared_ptr<Gate>& gate, int good) {
  return [gate, good](const Scene& own) {
    return std::make_unique<Adviser>(own, [gate, good](const Scene& asked, const FieldSet& fields) -> std::unique_ptr<Backend> {
      return std::make_unique<HangingBackend>(gate, asked, fields, good);
    });
  };
}

// A device that hangs is left behind: the session's end does not wait for it.
TEST(AdviceLoop, LeavesADeviceThatHangs) {
  const Scene scene = advised_session_scene();
  const std::vector<Tick> record = play_session(scene, script_for(scene));
  const auto gate = std::make_shared<Gate>();
  {
    AdviceLoop loop(scene, hanging(gate, 0));
    look(loop, scene, record, last_free_tick(record));
    ASSERT_TRUE(gate->wait_until_in());
  }              // this ends
  gate->open();  // so that the thread ends before the test's program does
}

// While a device does not answer, its earlier advice is too old to show; one line says so.
TEST(AdviceLoop, SaysWhereItsDeviceHangsAndGoesOnAfterwards) {
  const Scene scene = advised_session_scene();
  const std::vector<Tick> record = play_session(scene, script_for(scene));
  const auto gate = std::make_shared<Gate>();
  const double patience = 0.05;  // s
  AdviceLoop loop(scene, hanging(gate, 1), false, patience);
  const std::size_t at = last_free_tick(record);
  look(loop, scene, record, at - 1);
  ASSERT_TRUE(comes([&] { return loop.newest() != nullptr; }));
  look(loop, scene, record, at);
  ASSERT_TRUE(gate->wait_until_in());
  EXPECT_TRUE(comes([&] { return !loop.newest(); }));
  EXPECT_EQ(loop.take_warnings(),
            std::vector<std::string>{"advice: the device has not answered for 0.05 s; there is no advice until it does"});
  EXPECT_TRUE(loop.take_warnings().empty());
  gate->open();
  ASSERT_TRUE(comes([&] { return loop.newest() && loop.newest()->tick == record[at].number; }));
}

}  // namespace
}  // namespace wholehand::device
