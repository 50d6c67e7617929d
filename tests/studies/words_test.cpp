// SPDX-License-Identifier: MIT
// The paper's words of correlations, at the limits of docs/study.md.
#include "studies/words.h"

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

}  // namespace
}  // namespace wholehand
