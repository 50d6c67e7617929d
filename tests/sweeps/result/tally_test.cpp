// SPDX-License-Identifier: MIT
#include "sweeps/result/tally.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/support/fake_backend.h"

namespace wholehand::sweeps {
namespace {

TEST(Tally, CountsByReasonAndAmongTheFeasible) {
  const std::vector<std::uint32_t> status{
      STATUS_PLAUSIBLE | STATUS_ANTIPODAL, STATUS_PLAUSIBLE, STATUS_ANTIPODAL | (1u << STATUS_BLOCKED_SHIFT), REASON_MISSES,
      REASON_TOO_WIDE | STATUS_ANTIPODAL,  REASON_MISSES};
  FieldSet fields = make_field_set({FIELD_STATUS}, fake_scene());
  GripCounts counts;
  count_grips({0, 0, 6, 6, nullptr, nullptr, status.data()}, fields, 0, counts);
  EXPECT_EQ(counts.grips, 6u);
  EXPECT_EQ(counts.by_reason[REASON_NONE], 3u);
  EXPECT_EQ(counts.by_reason[REASON_MISSES], 2u);
  EXPECT_EQ(counts.by_reason[REASON_TOO_WIDE], 1u);
  EXPECT_EQ(counts.implausible, 1u);
  EXPECT_EQ(counts.antipodal, 2u);
  EXPECT_EQ(counts.blocked, 1u);
  EXPECT_EQ(counts_line(counts, true, 1),
            "3 of 6 grips feasible (2 misses, 1 too wide); of these 1 implausible (1 only too deep), 2 antipodal, 1 with a "
            "blocked finger");
  EXPECT_EQ(counts_line(counts, true, 12).substr(0, 38), "3 of 6 grips (each at 12 azimuths) fea");
  EXPECT_EQ(counts_line(counts, false, 1), "6 grips");
  EXPECT_EQ(short_counts_line(counts, true, 1, false), "2 of 6 grips are plausible; 1 too deep, 2 misses, 1 too wide");
  EXPECT_EQ(short_counts_line(counts, true, 12, true), "2 of 6 grips (each at 12 azimuths) hold; 1 too deep, 2 misses, 1 too wide");
  EXPECT_EQ(short_counts_line(counts, false, 1, true), "6 grips");
  const std::vector<std::uint32_t> unjudged{STATUS_PLAUSIBLE, STATUS_PLAUSIBLE | STATUS_UNJUDGED,
                                            STATUS_PLAUSIBLE | STATUS_NOT_HELD};
  GripCounts few;
  count_grips({0, 0, 3, 3, nullptr, nullptr, unjudged.data()}, fields, 0, few);
  EXPECT_EQ(few.unjudged, 1u);
  EXPECT_EQ(short_counts_line(few, true, 1, true),
            "1 of 3 grips are judged and hold; 1 not held, 1 not judged (out of reach of the list)");
  EXPECT_EQ(counts_line(few, true, 1),
            "3 of 3 grips feasible; of these 0 implausible, 1 not held, 1 not judged (out of reach of the list), 0 antipodal");
}

// Depth is counted where none of the three others makes a grip implausible; a grip of several counts for each.
TEST(Tally, TellsWhyGripsAreImplausible) {
  const std::uint32_t table = STATUS_THROUGH_TABLE, overlap = STATUS_SELF_OVERLAP, wrist = STATUS_BEYOND_WRIST;
  const std::vector<std::uint32_t> status{table, table | wrist,    table | overlap,      overlap, 0, 0, 0, 0,
                                          wrist, STATUS_PLAUSIBLE, table | REASON_MISSES};
  GripCounts counts;
  count_grips({0, 0, status.size(), status.size(), nullptr, nullptr, status.data()}, make_field_set({FIELD_STATUS}, fake_scene()),
              0, counts);
  EXPECT_EQ(counts.implausible, 9u);
  EXPECT_EQ(counts.through_table, 3u);
  EXPECT_EQ(counts.self_overlap, 2u);
  EXPECT_EQ(counts.beyond_wrist, 2u);
  EXPECT_EQ(counts.only_deep, 4u);
  EXPECT_EQ(
      counts_line(counts, true, 1),
      "10 of 11 grips feasible (1 misses); of these 9 implausible (3 through the table, 2 with fingers in each other, 2 beyond "
      "the wrist, 4 only too deep), 0 antipodal");
  EXPECT_EQ(
      short_counts_line(counts, true, 1, false),
      "1 of 11 grips are plausible; 3 through the table, 2 with fingers in each other, 2 beyond the wrist, 4 too deep, 1 misses");
  counts.through_table = counts.self_overlap = counts.beyond_wrist = counts.only_deep = 0;
  EXPECT_EQ(counts_line(counts, true, 1), "10 of 11 grips feasible (1 misses); of these 9 implausible, 0 antipodal");
}

TEST(Tally, CountsGripsThatDoNotHoldAndKeepsTheNearestToIt) {
  const std::uint32_t fails = STATUS_PLAUSIBLE | STATUS_NOT_HELD;
  const std::vector<std::uint32_t> status{fails, 0, fails, fails, fails};
  constexpr double NONE = std::numeric_limits<double>::infinity(), NOT_THERE = std::numeric_limits<double>::quiet_NaN();
  Scene scene = fake_scene();
  scene.strength.emplace();
  const FieldSet fields = make_field_set({FIELD_STATUS, FIELD_WORST_EFFORT, FIELD_FRICTION_NEEDED}, scene);
  const auto least_of = [&](const std::vector<double>& efforts, const std::vector<double>& frictions) {
    std::vector<double> reals(5 * static_cast<std::size_t>(fields.real_planes), 0);
    std::copy(efforts.begin(), efforts.end(), reals.begin() + 5 * fields.plane[FIELD_WORST_EFFORT]);
    std::copy(frictions.begin(), frictions.end(), reals.begin() + 5 * fields.plane[FIELD_FRICTION_NEEDED]);
    GripCounts counts, before;
    before.least_bad = {NONE, 3, 2};
    count_grips({0, 10, 5, 5, nullptr, reals.data(), status.data()}, fields, 0, counts);
    EXPECT_EQ(counts.not_held, 4u);
    EXPECT_TRUE(counts.none_holds());
    EXPECT_NE(counts_line(counts, true, 1).find("1 implausible (1 only too deep), 4 not held, 0 antipodal"), std::string::npos);
    EXPECT_EQ(short_counts_line(counts, true, 1, true), "0 of 5 grips hold; 4 not held, 1 too deep");
    counts += before;
    return counts.least_bad.grip;
  };
  EXPECT_EQ(least_of({3, NOT_THERE, 2, 1.5, NONE}, {1, NOT_THERE, 1, 1, 1}), 13u);
  EXPECT_EQ(least_of({NONE, NOT_THERE, NONE, NONE, NONE}, {4, NOT_THERE, 2, 2, NONE}), 12u) << "by the friction, then the first";
  EXPECT_EQ(least_of({NONE, NOT_THERE, NONE, NONE, NONE}, {4, NOT_THERE, 5, 6, NONE}), 2u) << "the one of before";
  EXPECT_FALSE(GripCounts().least_bad.is_known());
  EXPECT_FALSE(GripCounts().none_holds());
}

TEST(Tally, CountsPlausibleGripsNearTheGate) {
  constexpr double NOT_THERE = std::numeric_limits<double>::quiet_NaN(), NONE = std::numeric_limits<double>::infinity();
  constexpr std::uint32_t ok = STATUS_PLAUSIBLE, fails = STATUS_PLAUSIBLE | STATUS_NOT_HELD;
  const std::vector<double> efforts{1, 0.997, 0.995, 1.003, 1.005, 1, NOT_THERE, NONE};
  const std::vector<std::uint32_t> status{ok, ok, ok, fails, fails, 0, ok, fails};
  Scene scene = fake_scene();
  scene.strength.emplace();
  const FieldSet fields = make_field_set({FIELD_STATUS, FIELD_WORST_EFFORT}, scene);
  const auto at_gate = [&](double gate) {
    GripCounts counts;
    count_grips({0, 0, 8, 8, nullptr, efforts.data(), status.data()}, fields, gate, counts);
    GripCounts both = counts;
    both += counts;
    EXPECT_EQ(both.at_gate, 2 * counts.at_gate);
    return counts.at_gate;
  };
  EXPECT_EQ(at_gate(1e-3), 3u) << "an effort changes by four times as much there";
  EXPECT_EQ(at_gate(1.3e-3), 5u);
  EXPECT_EQ(at_gate(1e-9), 1u);
}

TEST(Tally, WithoutStatusOnlyTheNumberIsKnown) {
  GripCounts counts;
  count_grips({0, 0, 6, 6, nullptr, nullptr, nullptr}, make_field_set({}, fake_scene()), 0, counts);
  EXPECT_EQ(counts.grips, 6u);
  EXPECT_EQ(counts.by_reason[0], 0u);
}

TEST(Tally, NothingFeasibleSaysNoMore) {
  GripCounts counts;
  counts.grips = counts.by_reason[REASON_NOT_CONVERGED] = 2000;
  EXPECT_EQ(counts_line(counts, true, 1), "0 of 2,000 grips feasible (2,000 not converged)");
}

}  // namespace
}  // namespace wholehand::sweeps
