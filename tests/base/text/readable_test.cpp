// SPDX-License-Identifier: MIT
#include "base/text/readable.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

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

TEST(Readable, NumbersFromAThousandOnHaveCommas) {
  EXPECT_EQ(fixed_text(5438.7, 1), "5,438.7");
  EXPECT_EQ(fixed_text(-1234567.25, 2), "-1,234,567.25");
  EXPECT_EQ(fixed_text(999.4, 0), "999");
  EXPECT_EQ(fixed_text(999.6, 0), "1,000");
  EXPECT_EQ(fixed_text(0.12345, 5), "0.12345") << "not behind the point";
  EXPECT_EQ(plain_text(1000), "1,000");
  EXPECT_EQ(plain_text(4277.3, 4), "4,277");
  EXPECT_EQ(plain_text(1.5e6), "1,500,000");
  EXPECT_EQ(plain_text(80123.4, 4), "80,120");
  EXPECT_EQ(plain_text(-2.5e17), "-2.5e+17");
  EXPECT_EQ(plain_text(-2500), "-2,500");
}

TEST(Readable, OneThingIsOne) {
  EXPECT_EQ(counted(0, "grip"), "0 grips");
  EXPECT_EQ(counted(1, "grip"), "1 grip");
  EXPECT_EQ(counted(9216, "grip"), "9,216 grips");
  EXPECT_EQ(counted(1, "person", "people"), "1 person");
  EXPECT_EQ(counted(1200, "person", "people"), "1,200 people");
}

TEST(Readable, NumbersHaveNoNegativeZero) {
  const double none = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(fixed_text(-1e-9, 4), "0.0000");
  EXPECT_EQ(fixed_text(-0.0, 0), "0");
  EXPECT_EQ(fixed_text(-0.06, 1), "-0.1");
  EXPECT_EQ(fixed_text(0.08, 2), "0.08");
  EXPECT_EQ(fixed_text(none, 2), "-");
  EXPECT_EQ(fixed_text(infinite, 2), "inf");
  EXPECT_EQ(fixed_text(-infinite, 2), "-inf");
  EXPECT_EQ(plain_text(-0.0), "0");
  EXPECT_EQ(plain_text(22.5), "22.5");
  EXPECT_EQ(plain_text(250.0000001), "250");
  EXPECT_EQ(plain_text(none), "-");
  EXPECT_EQ(range_text(150, true), "150+");
  EXPECT_EQ(range_text(150, false), "150");
  EXPECT_EQ(range_text(none, true), "-");
}

TEST(Readable, DigitsAreThoseThatAreKnown) {
  EXPECT_EQ(known_digits(0, 3), 3) << "exact";
  EXPECT_EQ(known_digits(std::nan(""), 3), 3);
  EXPECT_EQ(known_digits(1e-6, 3), 3);
  EXPECT_EQ(known_digits(0.02, 3), 2);
  EXPECT_EQ(known_digits(0.2, 3), 1);
  EXPECT_EQ(known_digits(1, 3), 0);
  EXPECT_EQ(known_digits(30, 3), 0);
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
