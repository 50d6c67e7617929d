// SPDX-License-Identifier: MIT
#include "base/system/progress.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace wholehand {
namespace {

double now = 0;  // s

TEST(Progress, LineSaysShareRateAndTimeLeft) {
  EXPECT_EQ(Progress::line("beaker1", "grips", 1000, 0, 250, 0.5), "beaker1  25 %  500 grips/s  0:02 left");
  EXPECT_EQ(Progress::line("trials", "grips", 500, 0, 25, 10), "trials  5 %  2.5 grips/s  3:10 left");
  EXPECT_EQ(Progress::line("b", "grips", 30000000, 0, 10000000, 5), "b  33 %  2.00 million grips/s  0:10 left");
  EXPECT_EQ(Progress::line("contacts", "people", 10000, 0, 4500, 5), "contacts  45 %  900 people/s  0:07 left");
  EXPECT_EQ(Progress::line("b", "grips", 100000000, 0, 12345, 1), "b  0 %  12.3 thousand grips/s  2:15:00 left");
}

TEST(Progress, NoNameSteersTheTerminal) {
  EXPECT_EQ(Progress::line("a\x1b[2J\r\xc2\x9b", "grips", 10, 0, 0, 1), "a\\x1b[2J\\x0d\\u009b  0 %");
}

TEST(Progress, WhatWasThereBeforeSaysNothingAboutTheRate) {
  EXPECT_EQ(Progress::line("b", "grips", 1000, 500, 600, 1), "b  60 %  100 grips/s  0:04 left");
  EXPECT_EQ(Progress::line("b", "grips", 1000, 500, 500, 1), "b  50 %") << "no rate yet";
}

// What a sink writes while work of 100 goes on: pairs of seconds and of what is done.
std::string written(ProgressSink sink, const std::vector<std::pair<double, std::uint64_t>>& moments) {
  now = 1000;
  testing::internal::CaptureStderr();
  {
    Progress progress(100, 0, "people", sink, [] { return now; });
    for (const auto& [seconds, done] : moments) {
      now = 1000 + seconds;
      progress.update("b", done);
    }
  }
  return testing::internal::GetCapturedStderr();
}

TEST(Progress, TerminalGetsOneLineThatGoesAway) {
  EXPECT_EQ(written(ProgressSink::terminal, {{0.4, 10}, {0.6, 50}, {0.65, 51}}), "\rb  50 %  83 people/s  0:01 left\033[K\r\033[K")
      << "the first is too early, the last too soon after";
}

TEST(Progress, ALogGetsALineEveryTenSeconds) {
  EXPECT_EQ(written(ProgressSink::log, {{0.9, 1}, {1.1, 1}, {5, 5}, {11, 10}, {11.2, 11}, {12, 12}, {22, 20}}),
            "b  1 %  0.9 people/s  1:49 left\nb  11 %  1.0 people/s  1:31 left\nb  20 %  0.9 people/s  1:28 left\n")
      << "the first as soon as the rate is known, for work that takes ten seconds more";
}

TEST(Progress, ALogGetsNothingOfWorkThatEndsSoon) {
  EXPECT_EQ(written(ProgressSink::log, {{1.5, 20}, {4, 50}, {9, 99}}), "");
  EXPECT_EQ(written(ProgressSink::log, {{4, 0}, {10.1, 0}}), "b  0 %\n") << "no rate yet, and a long silence";
}

TEST(Progress, NobodyGetsNothing) { EXPECT_EQ(written(ProgressSink::none, {{0.6, 1}, {30, 50}}), ""); }

TEST(Progress, LongWorkIsAnnounced) {
  testing::internal::CaptureStderr();
  announce_time("comparing", 4.9);
  announce_time("comparing", 51);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "wholehand: comparing takes about 51 s\n");
}

}  // namespace
}  // namespace wholehand
