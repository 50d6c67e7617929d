// SPDX-License-Identifier: MIT
#include "sweeps/lists/hand_lists.h"

#include <algorithm>

#include "shaders/status.h"

namespace wholehand::sweeps {

void add_eligible(const PlaneChunk& chunk, const FieldSet& fields, std::vector<Candidate>& eligible) {
  for (std::size_t i = 0; i < chunk.count; ++i)
    if (is_eligible(chunk.uint(fields.plane[FIELD_STATUS], i)))
      eligible.push_back({chunk.real(fields.plane[FIELD_SCORE], i), chunk.first + i});
}

HandLists::HandLists(const Plan& plan, std::size_t size, const std::vector<Candidate>& candidates)
    : plan_(plan), lists_(plan.hand_scales(), BestCandidates(size)) {
  offer(candidates);
}

void HandLists::offer(const PlaneChunk& chunk, const FieldSet& fields) {
  hands_.resize(chunk.count);
  plan_.hand_scales_of(chunk.first, chunk.count, hands_.data());
  for (std::size_t i = 0; i < chunk.count; ++i) {
    if (is_eligible(chunk.uint(fields.plane[FIELD_STATUS], i)))
      lists_[hands_[i]].offer({chunk.real(fields.plane[FIELD_SCORE], i), chunk.first + i});
  }
}

void HandLists::offer(const std::vector<Candidate>& candidates) {
  for (const Candidate& candidate : candidates) lists_[plan_.hand_scale_of(candidate.index)].offer(candidate);
}

bool HandLists::takes(const Candidate& candidate) const { return lists_[plan_.hand_scale_of(candidate.index)].takes(candidate); }

double HandLists::least() const { return std::ranges::min_element(lists_, {}, &BestCandidates::least)->least(); }

std::vector<Candidate> HandLists::all() const {
  std::vector<Candidate> all;
  for (const BestCandidates& list : lists_) {
    const std::vector<Candidate> sorted = list.sorted();
    all.insert(all.end(), sorted.begin(), sorted.end());
  }
  return all;
}

}  // namespace wholehand::sweeps
