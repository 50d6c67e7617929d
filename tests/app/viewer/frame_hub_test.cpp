// SPDX-License-Identifier: MIT
// Frames from one who makes them to many who watch.
// sanitizers: thread
#include "app/viewer/frame_hub.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace wholehand {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds LONG{20000};  // nothing waits so long

TEST(FrameHub, AFrameIsThereForAllWhoWatch) {
  FrameHub hub(2);
  hub.publish("a");
  for (int viewer = 0; viewer < 2; ++viewer) {
    const auto update = hub.wait(0, LONG);
    ASSERT_TRUE(update.frame);
    EXPECT_EQ(*update.frame, "a");
    EXPECT_EQ(update.number, 1u);
    EXPECT_FALSE(update.is_over);
  }
}

TEST(FrameHub, WhoIsSlowGetsTheNewest) {
  FrameHub hub(1);
  for (const char* frame : {"a", "b", "c"}) hub.publish(frame);
  const auto update = hub.wait(1, LONG);
  ASSERT_TRUE(update.frame);
  EXPECT_EQ(*update.frame, "c");
  EXPECT_EQ(update.number, 3u);
}

TEST(FrameHub, NoFrameIsGivenTwice) {
  FrameHub hub(1);
  hub.publish("a");
  EXPECT_FALSE(hub.wait(1, milliseconds(1)).frame);
}

// A viewer counts from the moment it joins: were it asked for the newest number later, a frame in between would be seen by nobody.
TEST(FrameHub, WhoJoinsMissesNoFrameFromThenOn) {
  FrameHub hub(2);
  EXPECT_EQ(hub.join(), 0u) << "there is none yet";
  hub.publish("old");
  const auto seen = hub.join();
  ASSERT_EQ(seen, 1u);
  hub.publish("new");
  const auto update = hub.wait(*seen, LONG);
  ASSERT_TRUE(update.frame);
  EXPECT_EQ(*update.frame, "new");
}

TEST(FrameHub, ThereAreNoMoreViewersThanThereMayBe) {
  FrameHub hub(2);
  EXPECT_TRUE(hub.join());
  EXPECT_TRUE(hub.join());
  EXPECT_FALSE(hub.join());
  hub.leave();
  EXPECT_EQ(hub.viewers(), 1);
  EXPECT_TRUE(hub.join());
}

TEST(FrameHub, WhoWaitsIsToldThatItIsOverAndWhy) {
  FrameHub hub(1);
  std::thread viewer([&] {
    const auto update = hub.wait(0, LONG);
    EXPECT_TRUE(update.is_over);
    EXPECT_FALSE(update.frame);
    EXPECT_EQ(update.reason, "unplugged");
  });
  hub.close("unplugged");
  hub.close("later");
  viewer.join();
  hub.publish("never seen");
  EXPECT_FALSE(hub.wait(0, LONG).frame);
  EXPECT_EQ(hub.wait(0, LONG).reason, "unplugged");
}

TEST(FrameHub, TheLastFrameIsSeenWithTheEnd) {
  FrameHub hub(1);
  hub.publish("last");
  hub.close("done");
  const auto update = hub.wait(0, LONG);
  ASSERT_TRUE(update.frame);
  EXPECT_EQ(*update.frame, "last");
  EXPECT_TRUE(update.is_over);
}

TEST(FrameHub, ManyViewersSeeAscendingFramesAndAllTheLast) {
  FrameHub hub(4);
  std::atomic<int> ended{0};
  std::vector<std::thread> viewers;
  for (int k = 0; k < 4; ++k) {
    viewers.emplace_back([&] {
      std::uint64_t seen = 0;
      std::string last;
      for (;;) {
        const auto update = hub.wait(seen, LONG);
        if (update.frame) {
          EXPECT_GT(update.number, seen);
          EXPECT_EQ(*update.frame, std::to_string(update.number));
          last = *update.frame;
        }
        seen = update.number;
        if (update.is_over) break;
      }
      EXPECT_EQ(last, "500");
      ++ended;
    });
  }
  for (int k = 1; k <= 500; ++k) hub.publish(std::to_string(k));
  hub.close("done");
  for (std::thread& viewer : viewers) viewer.join();
  EXPECT_EQ(ended, 4);
}

}  // namespace
}  // namespace wholehand
