// SPDX-License-Identifier: MIT
// Conditions on grips: what they mean, and where the errors of wrong ones point.
// sanitizers: address
#include "sweeps/rank/where.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/text/error.h"
#include "core/scene.h"

namespace wholehand::sweeps {
namespace {

const std::vector<WhereName> NAMES{
    {"fingers_used", "1", WhereKind::number, WhereUnit::own, "", "", 0},
    {"palm_depth", "m", WhereKind::number, WhereUnit::own, "", "", 1},
    {"palm_depth_mm", "m", WhereKind::number, WhereUnit::mm, "", "", 1},
    {"gap_mm", "m", WhereKind::number, WhereUnit::mm, "", "", 2},
    {"roll_deg", "rad", WhereKind::number, WhereUnit::deg, "", "", 3},
    {"touch_mask", "1", WhereKind::mask, WhereUnit::own, "", "", 4},
    {"antipodal", "1", WhereKind::truth, WhereUnit::own, "", "", 5},
    {"peak_force", "N", WhereKind::number, WhereUnit::own, "fill", "", 6},
    {"joints", "m", WhereKind::number, WhereUnit::own, "joint and xyz", "is a vector", 7},
};

// Whether it holds of a grip with 4 fingers, a palm 1.5 mm deep, a gap of 80 mm, a roll of -30 degrees, bits 3 and 23, antipodal,
// peak 5.
bool met(const std::string& text, double depth = 1.5 / 1e3) {
  const std::vector<double> grip{4, depth, 80 / 1e3, radians(-30), static_cast<double>((1 << 3) | (1 << 23)), 1, 5};
  const Where where({text}, NAMES);
  std::vector<double> values;
  for (const WhereValue& value : where.values()) values.push_back(grip[value.source]);
  return where.holds(values.data());
}

std::string where_refusal(const std::string& text) {
  try {
    const Where where({text}, NAMES);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    return error.what();
  }
  return "accepted";
}

TEST(Where, ComparisonsAreThoseOfNumbers) {
  for (const char* text : {"fingers_used < 5", "fingers_used <= 4", "fingers_used > 3.5", "fingers_used >= 4", "fingers_used == 4",
                           "fingers_used != 5", "3 < fingers_used", "fingers_used < inf", "-1<fingers_used", "fingers_used>-1",
                           "(fingers_used) == (4e0)"})
    EXPECT_TRUE(met(text)) << text;
  for (const char* text : {"fingers_used < 4", "fingers_used <= 3", "fingers_used > 4", "fingers_used >= 4.5", "fingers_used == 5",
                           "fingers_used != 4", "4 < fingers_used"})
    EXPECT_FALSE(met(text)) << text;
}

TEST(Where, AndBindsBeforeOrAndNotBeforeBoth) {
  // f: false, t: true
  const std::string f = "fingers_used == 0", t = "fingers_used == 4";
  EXPECT_TRUE(met(t + " or " + f + " and " + f));
  EXPECT_FALSE(met("(" + t + " or " + f + ") and " + f));
  EXPECT_FALSE(met("not " + t + " and " + f));
  EXPECT_TRUE(met("not (" + t + " and " + f + ")"));
  EXPECT_TRUE(met("not not " + t));
  EXPECT_FALSE(met("not " + t + " or " + f));
}

TEST(Where, UnitsAreThoseOfTheScene) {
  EXPECT_TRUE(met("palm_depth_mm < 2 and palm_depth < 2e-3 and palm_depth_mm == 1.5"));
  EXPECT_TRUE(met("roll_deg == -30")) << "as the scene's own number became radians";
  EXPECT_TRUE(met("-30 <= roll_deg and roll_deg <= -30"));
  EXPECT_TRUE(met("gap_mm > palm_depth_mm"));
  EXPECT_NE(where_refusal("gap_mm > palm_depth").find("different units"), std::string::npos);
  EXPECT_NE(where_refusal("gap_mm > roll_deg").find("different units"), std::string::npos);
}

TEST(Where, MasksAndTruths) {
  EXPECT_TRUE(met("touch_mask & 8 and antipodal"));
  EXPECT_FALSE(met("touch_mask & 16"));
  EXPECT_TRUE(met("touch_mask & 24 == 8")) << "& binds before ==";
  EXPECT_TRUE(met("(touch_mask & 8388608) != 0"));
  EXPECT_TRUE(met("touch_mask"));
  EXPECT_FALSE(met("not antipodal"));
  EXPECT_TRUE(met("antipodal == 1"));
}

TEST(Where, WhatDoesNotExistMeetsNoComparison) {
  const double none = std::nan("");
  for (const char* text : {"palm_depth < 1", "palm_depth >= 0", "palm_depth == 0", "palm_depth != 0"})
    EXPECT_FALSE(met(text, none));
  EXPECT_TRUE(met("not palm_depth < 1", none));
  EXPECT_TRUE(met("palm_depth == inf", std::numeric_limits<double>::infinity()));
}

TEST(Where, ValuesAreAskedForOnceAndFolded) {
  const Where where({"max(peak_force) < 8 and min(peak_force) > 1 and max(peak_force) > 2 and max(fingers_used) > 0"}, NAMES);
  ASSERT_EQ(where.values().size(), 3u);
  EXPECT_EQ(where.values()[0], (WhereValue{6, WhereFold::largest}));
  EXPECT_EQ(where.values()[1], (WhereValue{6, WhereFold::least}));
  EXPECT_EQ(where.values()[2], (WhereValue{0, WhereFold::none})) << "it has one";
}

TEST(Where, WhatIsWrongIsToldWithItsColumn) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "column 1: found the end; expected a name or a number"},
      {"fingers_used >", "column 15: found the end; expected a name"},
      {"fingers_used", "column 1: fingers_used is a number and not a condition; compare it: fingers_used > 0"},
      {"3", "column 1: 3 is a number"},
      {"fingers == 5", "column 1: there is no value 'fingers'; the nearest is 'fingers_used'; known: fingers_used, palm_depth, "},
      {"antipodal and fingrs_used > 3", "column 15: there is no value 'fingrs_used'"},
      {"1 < fingers_used < 5", "column 18: two comparisons in a row"},
      {"fingers_used = 5", "column 14: '=' is written '=='"},
      {"antipodal && antipodal", "column 11: '&&' is written 'and'"},
      {"antipodal || antipodal", "column 11: '||' is written 'or'"},
      {"!antipodal", "column 1: '!' is written 'not'"},
      {"fingers_used + 1 > 3", "column 14: '+' means nothing here"},
      {"(antipodal", "column 11: found the end; expected the ')' for the '(' of column 1"},
      {"antipodal)", "column 10: found ')'; expected 'and', 'or' or the end"},
      {"antipodal fingers_used > 3", "column 11: found 'fingers_used'; expected 'and'"},
      {"(antipodal and antipodal) > 0", "column 1: a condition cannot be compared"},
      {"fingers_used & 1", "column 14: '&' takes a mask on its left: touch_mask"},
      {"touch_mask & 1.5", "column 14: found '1.5'; expected the bits of a mask"},
      {"touch_mask & antipodal", "column 14: found 'antipodal'; expected the bits"},
      {"peak_force < 8", "column 1: peak_force has a value for each fill; write max(peak_force) or min(peak_force)"},
      {"joints > 0", "column 1: joints is a vector"},
      {"max(3) > 0", "column 5: found '3'; expected the name of a variable in max()"},
      {"fingers_used > 1x", "column 16: this number cannot be read"},
      {"fingers_used > 1e999", "column 16: this number cannot be read"},
      {"and antipodal", "column 1: found 'and'; expected a name or a number"},
      {"antipodal \x01", "column 11: '\\x01' means nothing here"},
  };
  for (const auto& [text, gist] : cases)
    EXPECT_NE(where_refusal(text).find(gist), std::string::npos) << text << ": " << where_refusal(text);
  for (const char* open : {"(", "not "}) {
    std::string deep;
    for (int k = 0; k < 1000; ++k) deep += open;
    EXPECT_NE(where_refusal(deep).find("more than 64"), std::string::npos) << where_refusal(deep);
  }
  EXPECT_NE(where_refusal(std::string(5000, ' ')).find("at most 4096 characters"), std::string::npos);
}

}  // namespace
}  // namespace wholehand::sweeps
