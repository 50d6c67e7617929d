// SPDX-License-Identifier: MIT
// What ranks take from the counter: every grip once, in pieces that fit who takes them.
#include "cluster/work_range.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace wholehand {
namespace {

TEST(WorkRange, APieceMayReachOverVessels) {
  const WorkRange work({{0, 90, 100}, {2, 0, 50}, {3, 7, 8}});
  EXPECT_EQ(work.size(), 61u);
  EXPECT_EQ(work.piece(0, 10), (std::vector<GripRange>{{0, 90, 100}}));
  EXPECT_EQ(work.piece(8, 4), (std::vector<GripRange>{{0, 98, 100}, {2, 0, 2}}));
  EXPECT_EQ(work.piece(5, 1000), (std::vector<GripRange>{{0, 95, 100}, {2, 0, 50}, {3, 7, 8}}));
  EXPECT_EQ(work.piece(60, 1), (std::vector<GripRange>{{3, 7, 8}}));
  EXPECT_TRUE(work.piece(61, 5).empty());
  EXPECT_TRUE(WorkRange({}).piece(0, 5).empty());
}

TEST(WorkRange, PiecesHaveEveryGripOnce) {
  const WorkRange work({{0, 0, 1000}, {1, 500, 1700}});
  std::vector<std::vector<int>> times(2, std::vector<int>(1700, 0));
  std::uint64_t size = 1;
  for (std::uint64_t first = 0; first < work.size(); first += size, size = size * 3 % 401)
    for (const GripRange& range : work.piece(first, size))
      for (std::uint64_t i = range.first; i < range.last; ++i) ++times[range.vessel][i];
  for (std::uint64_t i = 0; i < 1700; ++i) {
    EXPECT_EQ(times[0][i], i < 1000 ? 1 : 0) << i;
    EXPECT_EQ(times[1][i], i >= 500 ? 1 : 0) << i;
  }
}

// Nothing is known at first; then a fast rank takes more; at the end all take little.
TEST(PieceSize, FitsTheRank) {
  constexpr std::uint64_t MUCH = 1'000'000'000'000;
  PieceSize slow(100, 2), fast(100, 2);
  EXPECT_EQ(slow.next(MUCH, 0), fast.next(MUCH, 0));
  slow.done(10'000, 1);
  fast.done(10'000'000, 1);
  EXPECT_EQ(fast.next(MUCH, 0), 1000 * slow.next(MUCH, 0));
  EXPECT_GT(slow.next(MUCH, 10'000), slow.next(MUCH, 0)) << "a long sweep has longer pieces";
  EXPECT_LE(fast.next(4'000'000, 0), 4'000'000u / 100 / 4);
  EXPECT_EQ(fast.next(0, 0), slow.next(0, 0));
  slow.done(0, 1);  // says nothing
  EXPECT_GT(slow.next(MUCH, 0), 0u);
}

// The slowest rank's last piece, taken when it took others' rate for its own, is no more than a part of what was left.
TEST(PieceSize, AllGripsAreTakenInFewPieces) {
  constexpr std::uint64_t ALL = 100'000'000;
  std::vector<PieceSize> ranks(8, PieceSize(8, 2));
  std::uint64_t left = ALL, pieces = 0;
  for (double time = 0; left > 0; time += 0.25) {
    PieceSize& rank = ranks[pieces++ % ranks.size()];
    const std::uint64_t taken = std::min(left, rank.next(left, time));
    EXPECT_LE(taken, std::max<std::uint64_t>(1024, left / 32));
    rank.done(taken, static_cast<double>(taken) / 1e6);
    left -= taken;
  }
  EXPECT_LT(pieces, 1000u);
}

}  // namespace
}  // namespace wholehand
