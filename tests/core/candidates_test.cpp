// SPDX-License-Identifier: MIT
#include "core/candidates.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace wholehand {
namespace {

// 200 candidates with few distinct scores.
std::vector<Candidate> many() {
  std::vector<Candidate> all;
  for (std::uint64_t i = 0; i < 200; ++i) all.push_back({static_cast<double>(i * 7919 % 13) / 13, i});
  return all;
}

bool same(const std::vector<Candidate>& a, const std::vector<Candidate>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Candidate& x, const Candidate& y) { return x.score == y.score && x.index == y.index; });
}

TEST(Candidates, BestAreByScoreThenIndex) {
  std::vector<Candidate> expected = many();
  std::sort(expected.begin(), expected.end(), is_better);
  for (const std::size_t size : {1, 5, 37, 200}) {
    BestCandidates best(size);
    best.offer(many());
    EXPECT_TRUE(same(best.sorted(), {expected.begin(), expected.begin() + static_cast<std::ptrdiff_t>(size)})) << size;
  }
}

TEST(Candidates, OrderAndGroupingOfOffersDoNotMatter) {
  BestCandidates forward(20), backward(20), merged(20);
  forward.offer(many());
  std::vector<Candidate> reversed = many();
  std::reverse(reversed.begin(), reversed.end());
  backward.offer(reversed);
  for (std::size_t part = 0; part < 7; ++part) {
    BestCandidates best(20);
    for (std::size_t i = part; i < reversed.size(); i += 7) best.offer(reversed[i]);
    merged.offer(best.sorted());
  }
  EXPECT_TRUE(same(forward.sorted(), backward.sorted()));
  EXPECT_TRUE(same(forward.sorted(), merged.sorted()));
}

TEST(Candidates, FewerThanWantedAreAllKept) {
  BestCandidates best(10);
  best.offer({0.5, 3});
  EXPECT_EQ(best.sorted().size(), 1u);
  BestCandidates none(0);
  none.offer({0.5, 3});
  EXPECT_TRUE(none.sorted().empty());
}

TEST(Candidates, WhatIsTakenIsKnownBefore) {
  BestCandidates best(20);
  for (const Candidate& candidate : many()) {
    const bool takes = best.takes(candidate);
    best.offer(candidate);
    const std::vector<Candidate> kept = best.sorted();
    EXPECT_EQ(takes, std::any_of(kept.begin(), kept.end(), [&](const Candidate& other) { return other.index == candidate.index; }));
  }
  EXPECT_FALSE(BestCandidates(0).takes({1, 0}));
}

}  // namespace
}  // namespace wholehand
