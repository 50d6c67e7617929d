// SPDX-License-Identifier: MIT
#include "core/candidates.h"

#include <algorithm>

namespace wholehand {

bool is_better(const Candidate& a, const Candidate& b) { return a.score != b.score ? a.score > b.score : a.index < b.index; }

void BestCandidates::offer(const Candidate& candidate) {
  if (heap_.size() < size_) {
    heap_.push_back(candidate);
    std::push_heap(heap_.begin(), heap_.end(), is_better);
  } else if (size_ > 0 && is_better(candidate, heap_.front())) {
    std::pop_heap(heap_.begin(), heap_.end(), is_better);
    heap_.back() = candidate;
    std::push_heap(heap_.begin(), heap_.end(), is_better);
  }
}

bool BestCandidates::takes(const Candidate& candidate) const {
  return heap_.size() < size_ || (size_ > 0 && is_better(candidate, heap_.front()));
}

double BestCandidates::least() const { return heap_.empty() || heap_.size() < size_ ? NO_LEAST_SCORE : heap_.front().score; }

void BestCandidates::offer(const std::vector<Candidate>& candidates) {
  for (const Candidate& candidate : candidates) offer(candidate);
}

std::vector<Candidate> BestCandidates::sorted() const {
  std::vector<Candidate> best = heap_;
  std::sort(best.begin(), best.end(), is_better);
  return best;
}

}  // namespace wholehand
