// SPDX-License-Identifier: MIT
// Advice in a thread of its own: it comes, it follows the ticks, it ends when asked or where its device fails, and nobody waits
// for it.
// sanitizers: address thread
#include "advice/advice_loop.h"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "tests/support/advised_session.h"

namespace wholehand {
namespace {

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
  AdviceLoop loop(scene, "core", 1);
  EXPECT_EQ(loop.place(), "core, 1 thread");
  EXPECT_FALSE(loop.newest());
  const std::size_t at = last_free_tick(record);
  loop.look(std::span(record).first(at + 1));
  ASSERT_TRUE(comes([&] { return loop.newest() && loop.newest()->tick == record[at].number; }));
  EXPECT_FALSE(loop.newest()->is_held);
  EXPECT_EQ(loop.newest()->vessel, 0);
  loop.look(std::span(record).subspan(at + 1, 1));
  ASSERT_TRUE(comes([&] { return loop.newest()->is_held; }));
  EXPECT_TRUE(loop.newest()->ahead);
  const AdviceTally tally = loop.tally();
  EXPECT_GE(tally.updates, 2u);
  EXPECT_GE(tally.grips, tally.updates * LEAST_CLOUD);
  EXPECT_TRUE(loop.news().empty());
}

TEST(AdviceLoop, TellsWhatCannotBeOpenedBeforeItStarts) {
  EXPECT_THROW(AdviceLoop(advised_session_scene(), "no such device", 1), Error);
  EXPECT_THROW(AdviceLoop(live_scene(), "core", 1), Error) << "without [strength]";
}

// A device that fails ends the advice, with one line, and not its owner.
TEST(AdviceLoop, EndsWithALineWhereItsDeviceFails) {
  const Scene scene = advised_session_scene();
  const std::vector<Tick> record = play_session(scene, script_for(scene));
  AdviceLoop loop(scene, [](const Scene& own) {
    return std::make_unique<Adviser>(own, [](const Scene& asked, const FieldSet& fields) -> std::unique_ptr<Backend> {
      return std::make_unique<DyingBackend>(asked, fields, 1);
    });
  });
  const std::size_t at = last_free_tick(record);
  loop.look(std::span(record).first(at + 1));
  ASSERT_TRUE(comes([&] { return loop.newest() != nullptr; }));
  loop.look(std::span(record).subspan(at, 1));
  std::vector<std::string> news;
  ASSERT_TRUE(comes([&] { return !(news = loop.news()).empty(); }));
  EXPECT_EQ(news, std::vector<std::string>{"advice: the device is gone; the session goes on without advice"});
  EXPECT_FALSE(loop.newest()) << "what was advised is no longer of this moment";
  loop.look(std::span(record).subspan(at, 1));  // goes nowhere
}

// A device that hangs is left behind: the session's end does not wait for it.
TEST(AdviceLoop, LeavesADeviceThatHangs) {
  struct Gate {
    std::mutex mutex;
    std::condition_variable wake;
    bool is_in = false, is_open = false;
  };
  const auto gate = std::make_shared<Gate>();
  class Hanging final : public Backend {
   public:
    Hanging(std::shared_ptr<Gate> held, const FieldSet& fields) : gate_(std::move(held)), fields_(fields) {
      info_.backend = "core";
    }
    const BackendInfo& info() const override { return info_; }
    const FieldSet& fields() const override { return fields_; }
    RunResult run(const RunRequest&) override {
      std::unique_lock lock(gate_->mutex);
      gate_->is_in = true;
      gate_->wake.notify_all();
      gate_->wake.wait(lock, [this] { return gate_->is_open; });
      return {};
    }
    std::vector<LiquidResult> liquid(std::size_t) override { return {}; }

   private:
    std::shared_ptr<Gate> gate_;
    BackendInfo info_;
    FieldSet fields_;
  };
  const Scene scene = advised_session_scene();
  const std::vector<Tick> record = play_session(scene, script_for(scene));
  {
    AdviceLoop loop(scene, [gate](const Scene& own) {
      return std::make_unique<Adviser>(own, [gate](const Scene&, const FieldSet& fields) -> std::unique_ptr<Backend> {
        return std::make_unique<Hanging>(gate, fields);
      });
    });
    loop.look(std::span(record).first(last_free_tick(record) + 1));
    std::unique_lock lock(gate->mutex);
    ASSERT_TRUE(gate->wake.wait_for(lock, PATIENCE, [&] { return gate->is_in; }));
  }  // this ends
  const std::lock_guard lock(gate->mutex);
  gate->is_open = true;  // so that the thread ends before the test's program does
  gate->wake.notify_all();
}

}  // namespace
}  // namespace wholehand
