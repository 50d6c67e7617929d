// SPDX-License-Identifier: MIT
// What C has beside what the core has.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstring>

namespace wholehand {

// Equal to the bit, NaN too.
template <std::size_t N>
void expect_same(const double* c, const std::array<double, N>& core, const char* what) {
  EXPECT_EQ(std::memcmp(c, core.data(), sizeof core), 0) << what << ": " << c[0] << " and " << core[0];
}
inline void expect_same(double c, double core, const char* what) { expect_same(&c, std::array<double, 1>{core}, what); }

}  // namespace wholehand
