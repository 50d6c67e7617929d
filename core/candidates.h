// SPDX-License-Identifier: MIT
// The best grips of a sweep so far.
#pragma once

#include <cstddef>
#include <vector>

#include "core/backend.h"

namespace wholehand {

// Order of the best: by score descending, then index ascending. Total, so that merging in any order gives the same list.
bool is_better(const Candidate& a, const Candidate& b);

// The `size` best of all candidates offered; bounded memory, log(size) a candidate that gets in.
class BestCandidates {
 public:
  explicit BestCandidates(std::size_t size) : size_(size) {}
  void offer(const Candidate& candidate);
  void offer(const std::vector<Candidate>& candidates);
  bool takes(const Candidate& candidate) const;  // whether it would get in
  double least() const;                          // the score below which none gets in; NO_LEAST_SCORE while there is room
  std::vector<Candidate> sorted() const;         // the best first

 private:
  std::size_t size_;
  std::vector<Candidate> heap_;  // the worst on top
};

}  // namespace wholehand
