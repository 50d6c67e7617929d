// SPDX-License-Identifier: MIT
// The paper's words of correlations, at the limits of docs/study.md.
#include "evidence/studies/words.h"

#include <gtest/gtest.h>

#include <cmath>

namespace wholehand {
namespace {

TEST(CorrelationWords, ChangeAtTheirLimits) {
  EXPECT_EQ(word_of_correlation(-1), "VSN");
  EXPECT_EQ(word_of_correlation(-0.8), "VSN");
  EXPECT_EQ(word_of_correlation(-0.79), "SN");
  EXPECT_EQ(word_of_correlation(-0.6), "SN");
  EXPECT_EQ(word_of_correlation(-0.59), "N");
  EXPECT_EQ(word_of_correlation(-0.2), "N");
  EXPECT_EQ(word_of_correlation(-0.19), "-");
  EXPECT_EQ(word_of_correlation(0), "-");
  EXPECT_EQ(word_of_correlation(0.19), "-");
  EXPECT_EQ(word_of_correlation(0.2), "P");
  EXPECT_EQ(word_of_correlation(0.6), "SP");
  EXPECT_EQ(word_of_correlation(0.8), "VSP");
  EXPECT_EQ(word_of_correlation(std::nan("")), "");
}

// Each number of two digits has a word beside it, and neither contradicts the other.
TEST(CorrelationWords, AreOfTheNumberAsItIsShown) {
  EXPECT_EQ(word_of_correlation(0.1949), "-");  // 0.19
  EXPECT_EQ(word_of_correlation(0.1951), "P");  // 0.20
  EXPECT_EQ(word_of_correlation(-0.196), "N");
  EXPECT_EQ(word_of_correlation(0.5949), "P");
  EXPECT_EQ(word_of_correlation(0.5951), "SP");
  EXPECT_EQ(word_of_correlation(-0.7951), "VSN");
  EXPECT_EQ(word_of_correlation(-0.001), "-");
}

TEST(CorrelationWords, SayWhyThereIsNone) {
  EXPECT_EQ(why_no_correlation(0), "never touches");
  EXPECT_EQ(why_no_correlation(1), "always touches");
  EXPECT_EQ(why_no_correlation(0.5), "too few grasps");
  EXPECT_EQ(why_no_correlation(std::nan("")), "no grasp holds");
}

}  // namespace
}  // namespace wholehand
