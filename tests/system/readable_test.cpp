// SPDX-License-Identifier: MIT
#include "system/readable.h"

#include <gtest/gtest.h>

namespace wholehand {
namespace {

TEST(Readable, BytesAndCounts) {
  EXPECT_EQ(readable_bytes(0), "0 B");
  EXPECT_EQ(readable_bytes(999), "999 B");
  EXPECT_EQ(readable_bytes(1500), "1.5 kB");
  EXPECT_EQ(readable_bytes(123456789), "123 MB");
  EXPECT_EQ(readable_bytes(181e12), "181 TB");
  EXPECT_EQ(readable_count(7), "7");
  EXPECT_EQ(readable_count(1234), "1,234");
  EXPECT_EQ(readable_count(27648 * 1e3), "27,648,000");
  EXPECT_EQ(readable_count(1e12), "1.0e+12");
}

TEST(Readable, Durations) {
  EXPECT_EQ(readable_duration(0), "0 s");
  EXPECT_EQ(readable_duration(10.2), "11 s");
  EXPECT_EQ(readable_duration(119.5), "2 min 0 s");
  EXPECT_EQ(readable_duration(503.2), "8 min 24 s");
  EXPECT_EQ(readable_duration(7500), "2 h 5 min");
}

}  // namespace
}  // namespace wholehand
