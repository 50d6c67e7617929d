// SPDX-License-Identifier: MIT
// sanitizers: thread
#include "device/session/newest.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <thread>

namespace wholehand::device {
namespace {

TEST(Newest, GivesTheNewestOnceAndNothingBefore) {
  Newest<int> newest;
  int value = 7;
  EXPECT_FALSE(newest.take(value));
  EXPECT_EQ(value, 7) << "left alone";
  newest.put(1);
  ASSERT_TRUE(newest.take(value));
  EXPECT_EQ(value, 1);
  EXPECT_FALSE(newest.take(value));
  for (int k = 2; k < 20; ++k) newest.put(k);
  ASSERT_TRUE(newest.take(value));
  EXPECT_EQ(value, 19) << "what came between is gone";
  EXPECT_FALSE(newest.take(value));
  EXPECT_EQ(value, 19);
}

// Every order of puts and takes: three places are never one too few.
TEST(Newest, HoldsInEveryOrder) {
  for (unsigned order = 0; order < 1u << 12; ++order) {
    Newest<int> newest;
    int put = 0, taken = 0;
    for (int k = 0; k < 12; ++k) {
      if ((order >> k & 1u) != 0) {
        newest.put(++put);
      } else {
        const int before = taken;
        ASSERT_EQ(newest.take(taken), put > before) << order;
        ASSERT_EQ(taken, put) << order;
      }
    }
  }
}

// Two threads at full speed: no value is half of one and half of another, none is older than one before, and the last one arrives.
TEST(Newest, IsWholeBetweenTwoThreads) {
  constexpr std::int64_t COUNT = 300000;
  using Values = std::array<std::int64_t, 24>;
  Newest<Values> newest;
  std::thread putting([&newest] {
    Values values;
    for (std::int64_t k = 1; k <= COUNT; ++k) {
      values.fill(k);
      newest.put(values);
    }
  });
  std::int64_t wrong = 0, last = 0;
  Values values{};
  while (last < COUNT) {
    if (!newest.take(values)) {
      std::this_thread::yield();
      continue;
    }
    for (const std::int64_t value : values) wrong += value != values[0];
    wrong += values[0] <= last;
    last = values[0];
  }
  putting.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace wholehand::device
