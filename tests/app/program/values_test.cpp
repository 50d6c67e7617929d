// SPDX-License-Identifier: MIT
// Numbers of a command line.
#include "app/program/values.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/refusal.h"

namespace wholehand {
namespace {

TEST(Values, ConvertsToSi) {
  EXPECT_EQ(parse_quantity("22.5", "--x", {0, 100, Unit::mm}), 22.5e-3);
  EXPECT_EQ(parse_quantity("-90", "--x", {-90, 90, Unit::deg}), radians(-90));
  EXPECT_EQ(parse_quantity("1e1", "--x", {0, 100}), 10);
  EXPECT_EQ(parse_triple("1,-2.5,3e1", "--x", {-100, 100, Unit::mm}), (Triple{1e-3, -2.5e-3, 30e-3}));
  EXPECT_EQ(parse_integer("42", "--x", {0, 100}), 42);
  EXPECT_EQ(parse_precision("float"), Precision::single);
  EXPECT_EQ(parse_precision("double"), Precision::full);
}

TEST(Values, DurationsAreSecondsOrWhatClocksShow) {
  EXPECT_EQ(parse_duration("90", "--t"), 90);
  EXPECT_EQ(parse_duration("1:30", "--t"), 90);
  EXPECT_EQ(parse_duration("0:01:30", "--t"), 90);
  EXPECT_EQ(parse_duration("120:00", "--t"), 7200);
  EXPECT_EQ(parse_duration("99999:00:00", "--t"), 99999 * 3600.0);
  for (const char* text :
       {"", "0", "-1", "1:2", "1:60", "1:00:60", "1:60:00", ":30", "1:", "1:00:00:00", "1.5", "x", "100000:00:00", "1:-5"})
    EXPECT_EQ(refusal_line([&] { parse_duration(text, "--t"); }),
              "--t '" + std::string(text) + "'; allowed: seconds, M:SS or H:MM:SS, of 1 s or more");
}

TEST(Values, RefusesWhatIsNotWhollyANumber) {
  for (const char* text : {"", " 1", "1 ", "1x", "x", "1,5", "nan", "inf", "-inf", "0x10", "1e999", "--1", "+1", "101", "-1"}) {
    EXPECT_EQ(refusal_line([&] {
                parse_quantity(text, "--x", {0, 100});
              }),
              "--x '" + std::string(text) + "'; allowed: a number, 0 to 100")
        << text;
  }
  for (const char* text : {"", "1.0", "1e1", "0x1", "-1", "101", "99999999999999999999", "1 "}) {
    EXPECT_EQ(refusal_line([&] {
                parse_integer(text, "--x", {0, 100});
              }),
              "--x '" + std::string(text) + "'; allowed: a whole number, 0 to 100")
        << text;
  }
  for (const char* text : {"", "1,2", "1,2,3,4", "1,2,", ",1,2", "1, 2, 3", "1,2,nan", "1,2,200"}) {
    EXPECT_EQ(refusal_line([&] {
                parse_triple(text, "--x", {0, 100});
              }).find("--x '" + std::string(text) + "'; allowed: three numbers x,y,z"),
              0u)
        << text;
  }
  EXPECT_EQ(refusal_line([] { parse_precision("half"); }), "--precision 'half'; allowed: float or double");
}

}  // namespace
}  // namespace wholehand
