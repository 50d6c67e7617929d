// SPDX-License-Identifier: MIT
#include "system/progress.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace wholehand {
namespace {

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

TEST(Progress, NothingWherePiped) {
  testing::internal::CaptureStderr();
  {
    Progress progress(100, 0, "grips", false);
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    progress.update("b", 50);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Progress, TerminalGetsOneLineThatGoesAway) {
  testing::internal::CaptureStderr();
  {
    Progress progress(100, 0, "people", true);
    progress.update("b", 10);  // too early
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    progress.update("b", 50);
    progress.update("b", 51);  // too soon after
  }
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_EQ(text.find("10 %"), std::string::npos);
  EXPECT_NE(text.find("b  50 %"), std::string::npos);
  EXPECT_NE(text.find(" people/s  0:0"), std::string::npos) << text;
  EXPECT_EQ(text.find("51 %"), std::string::npos);
  EXPECT_TRUE(text.ends_with("\r\033[K")) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace wholehand
