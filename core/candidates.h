// SPDX-License-Identifier: MIT
// The best grips of a sweep so far.
#pragma once

#include <cstddef>
#include <vector>

#include "core/backend.h"

namespace wholehand {

// Order of the best: by score descending, then index ascending. The order is total, so merging in any order gives the same list.
bool is_better(const Candidate& a, const Candidate& b);

// The `size` best of all offered candidates. Memory is bounded; an accepted candidate costs log(size).
class BestCandidates {
 public:
  explicit BestCandidates(std::size_t size) : size_(size) {}
  void offer(const Candidate& candidate);
  void offer(const std::vector<Candidate>& candidates);
  bool takes(const Candidate& candidate) const;  // whether it would be accepted
  double least() const;                          // lower scores are rejected; NO_LEAST_SCORE while there is room
  std::vector<Candidate> sorted() const;         // the best first

 private:
  std::size_t size_;
  std::vector<Candidate> heap_;  // the worst on top
};

}  // namespace wholehand
