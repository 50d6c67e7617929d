// SPDX-License-Identifier: MIT
#include "sweeps/tally.h"

#include <gtest/gtest.h>

#include "tests/support/fake_backend.h"

namespace wholehand {
namespace {

TEST(Tally, CountsByReasonAndAmongTheFeasible) {
  const std::vector<std::uint32_t> status{
      STATUS_PLAUSIBLE | STATUS_ANTIPODAL, STATUS_PLAUSIBLE, STATUS_ANTIPODAL | (1u << STATUS_BLOCKED_SHIFT), REASON_MISSES,
      REASON_TOO_WIDE | STATUS_ANTIPODAL,  REASON_MISSES};
  FieldSet fields = make_field_set({FIELD_STATUS}, fake_scene());
  GripCounts counts;
  count_grips({0, 0, 6, 6, nullptr, nullptr, status.data()}, fields, counts);
  EXPECT_EQ(counts.grips, 6u);
  EXPECT_EQ(counts.by_reason[REASON_NONE], 3u);
  EXPECT_EQ(counts.by_reason[REASON_MISSES], 2u);
  EXPECT_EQ(counts.by_reason[REASON_TOO_WIDE], 1u);
  EXPECT_EQ(counts.implausible, 1u);
  EXPECT_EQ(counts.antipodal, 2u);
  EXPECT_EQ(counts.blocked, 1u);
  EXPECT_EQ(counts_line(counts, true, 1),
            "3 of 6 grips feasible (2 misses, 1 too wide); of these 1 implausible, 2 antipodal, 1 with a blocked finger");
  EXPECT_EQ(counts_line(counts, true, 12).substr(0, 38), "3 of 6 grips (each at 12 azimuths) fea");
  EXPECT_EQ(counts_line(counts, false, 1), "6 grips");
}

TEST(Tally, WithoutStatusOnlyTheNumberIsKnown) {
  GripCounts counts;
  count_grips({0, 0, 6, 6, nullptr, nullptr, nullptr}, make_field_set({}, fake_scene()), counts);
  EXPECT_EQ(counts.grips, 6u);
  EXPECT_EQ(counts.by_reason[0], 0u);
}

TEST(Tally, NothingFeasibleSaysNoMore) {
  GripCounts counts;
  counts.grips = counts.by_reason[REASON_NOT_CONVERGED] = 2000;
  EXPECT_EQ(counts_line(counts, true, 1), "0 of 2,000 grips feasible (2,000 not converged)");
}

}  // namespace
}  // namespace wholehand
