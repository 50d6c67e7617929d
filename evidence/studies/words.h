// SPDX-License-Identifier: MIT
// Correlations in the paper's words.
#pragma once

#include <string>

namespace wholehand {

// The |r| from which a correlation counts, is strong, and is very strong (Evans 1996). docs/study.md says more.
constexpr double WEAK_R = 0.2, STRONG_R = 0.6, VERY_STRONG_R = 0.8;

// "VSN", "SN", "N", "-", "P", "SP" or "VSP", for r in two digits, as shown; "" for NaN.
std::string word_of_correlation(double r);

// Why a point of the hand that touches in this share of the grasps (NaN: none holds) has no correlation: "never touches", "always touches", "no grasp
// holds", and otherwise "too few grasps": fewer than three, or all at one place.
std::string why_no_correlation(double touch_share);

}  // namespace wholehand
