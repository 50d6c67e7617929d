// SPDX-License-Identifier: MIT
// What ranks take from the counter: every grip once, in pieces that fit each rank.
#include "sweeps/cluster/work_range.h"

#include <gtest/gtest.h>
#include <algorithm>

#include <cstdint>
#include <vector>

namespace wholehand::sweeps {
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
  PieceSize slow(100, MUCH, 2), fast(100, MUCH, 2);
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
  std::vector<PieceSize> ranks(8, PieceSize(8, ALL, 2));
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

// Each rank asks for a piece before it computes the one before, and one has half the speed. The others wait for it no longer than it takes for two
// of the least pieces: the one that it computes, and the one that it has asked for.
TEST(PieceSize, ASlowRankEndsWithTheOthers) {
  constexpr std::uint64_t ALL = 100'000'000;
  constexpr double RATE = 42'000;
  struct Rank {
    PieceSize size;
    double rate, free = 0;  // grips a second; s
    std::uint64_t piece = 0;
  };
  for (const std::size_t count : {2u, 16u, 64u}) {
    std::vector<Rank> ranks(count, Rank{PieceSize(static_cast<int>(count), ALL, 2), RATE});
    ranks[1].rate = RATE / 2;
    std::uint64_t taken = 0;
    const auto ask = [&](const Rank& rank) {
      const std::uint64_t piece = std::min(ALL - taken, rank.size.next(ALL - taken, rank.free));
      taken += piece;
      return piece;
    };
    for (Rank& rank : ranks) rank.piece = ask(rank);
    double first_idle = 0, last = 0;
    while (first_idle == 0 || std::any_of(ranks.begin(), ranks.end(), [](const Rank& rank) { return rank.piece > 0; })) {
      Rank* next = nullptr;
      for (Rank& rank : ranks)
        if (rank.piece > 0 && (!next || rank.free < next->free)) next = &rank;
      const std::uint64_t piece = next->piece;
      next->piece = ask(*next);
      const double seconds = static_cast<double>(piece) / next->rate;
      next->free += seconds;
      next->size.done(piece, seconds);
      last = std::max(last, next->free);
      if (next->piece == 0) first_idle = first_idle == 0 ? next->free : std::min(first_idle, next->free);
    }
    EXPECT_LT(last - first_idle, 2 * 1024 / (RATE / 2)) << count << " ranks";
  }
}

}  // namespace
}  // namespace wholehand::sweeps
