// SPDX-License-Identifier: MIT
// The best grips of a vessel during a sweep, one list for each hand scale.
#pragma once

#include <cstddef>
#include <vector>

#include "core/backend.h"
#include "core/candidates.h"
#include "sweeps/plan/plan.h"

namespace wholehand::sweeps {

// Adds the eligible grips (shaders/status.h) of a chunk whose score and status are kept.
void add_eligible(const PlaneChunk& chunk, const FieldSet& fields, std::vector<Candidate>& eligible);

class HandLists {
 public:
  // The `size` best for each of the plan's hand scales; starts with `candidates`, in any order. The plan must outlive the object.
  HandLists(const Plan& plan, std::size_t size, const std::vector<Candidate>& candidates);

  // Adds the eligible grips of a chunk whose score and status are kept; and single grips.
  void offer(const PlaneChunk& chunk, const FieldSet& fields);
  void offer(const std::vector<Candidate>& candidates);
  bool takes(const Candidate& candidate) const;  // whether it would be accepted

  double least() const;  // no list accepts lower scores

  std::vector<Candidate> sorted(std::size_t hand_scale) const { return lists_[hand_scale].sorted(); }  // the best first
  std::vector<Candidate> all() const;                                                                  // one list after the other

 private:
  const Plan& plan_;
  std::vector<BestCandidates> lists_;
  std::vector<std::size_t> hands_;
};

}  // namespace wholehand::sweeps
