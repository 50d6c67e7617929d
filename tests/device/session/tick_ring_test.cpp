// SPDX-License-Identifier: MIT
// sanitizers: thread
#include "device/session/tick_ring.h"

#include <gtest/gtest.h>

#include <thread>

namespace wholehand::device {
namespace {

Tick numbered(std::int64_t number) {
  Tick tick;
  tick.number = number;
  tick.step_time = static_cast<double>(number) * 0.5;
  tick.spilled.back() = static_cast<double>(-number);
  return tick;
}

TEST(TickRing, GivesBackInOrderWhatItTook) {
  TickRing ring(4);
  Tick tick = numbered(99);
  EXPECT_FALSE(ring.pop(tick));
  EXPECT_EQ(tick.number, 99) << "an empty ring leaves the tick alone";
  for (int round = 0; round < 5; ++round) {
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(ring.push(numbered(10 * round + k)));
    EXPECT_EQ(ring.size(), 3u);
    for (int k = 0; k < 3; ++k) {
      ASSERT_TRUE(ring.pop(tick));
      EXPECT_EQ(tick.number, 10 * round + k);
      EXPECT_EQ(tick.spilled.back(), -(10.0 * round + k)) << "the whole tick";
    }
    EXPECT_FALSE(ring.pop(tick));
    EXPECT_EQ(ring.size(), 0u);
  }
}

TEST(TickRing, RefusesWhatItHasNoRoomFor) {
  TickRing ring(4);
  EXPECT_EQ(ring.capacity(), 4u);
  for (int k = 0; k < 4; ++k) EXPECT_TRUE(ring.push(numbered(k)));
  EXPECT_FALSE(ring.push(numbered(4)));
  EXPECT_EQ(ring.size(), 4u);
  Tick tick;
  ASSERT_TRUE(ring.pop(tick));
  EXPECT_EQ(tick.number, 0);
  EXPECT_TRUE(ring.push(numbered(5)));
  EXPECT_FALSE(ring.push(numbered(6)));
  for (const std::int64_t number : {1, 2, 3, 5}) {
    ASSERT_TRUE(ring.pop(tick));
    EXPECT_EQ(tick.number, number);
  }
  EXPECT_FALSE(ring.pop(tick));
}

TEST(TickRing, RoundsItsCapacityUp) {
  EXPECT_EQ(TickRing(0).capacity(), 1u);
  EXPECT_EQ(TickRing(1).capacity(), 1u);
  EXPECT_EQ(TickRing(5).capacity(), 8u);
}

// Two threads at full speed through a small ring: every tick arrives once, in order, and none of them half written.
TEST(TickRing, LosesNothingBetweenTwoThreads) {
  constexpr std::int64_t COUNT = 200000;
  TickRing ring(64);
  std::thread pushing([&ring] {
    for (std::int64_t k = 0; k < COUNT;) {
      if (ring.push(numbered(k))) {
        ++k;
      } else {
        std::this_thread::yield();
      }
    }
  });
  std::int64_t wrong = 0, expected = 0;
  Tick tick;
  while (expected < COUNT) {
    if (!ring.pop(tick)) {
      std::this_thread::yield();
      continue;
    }
    const auto as_number = static_cast<double>(expected);
    wrong += tick.number != expected || tick.step_time != as_number * 0.5 || tick.spilled.back() != -as_number;
    if (ring.size() > ring.capacity()) ++wrong;
    ++expected;
  }
  pushing.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_FALSE(ring.pop(tick));
}

}  // namespace
}  // namespace wholehand::device
