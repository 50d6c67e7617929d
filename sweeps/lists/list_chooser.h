// SPDX-License-Identifier: MIT
// Chooses the best grips of a vessel that differ from one another, in passes over all of its grips.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/candidates.h"
#include "core/evaluator.h"
#include "sweeps/lists/different_grips.h"
#include "sweeps/plan/plan.h"

namespace wholehand::sweeps {

// The state of a list between two passes.
struct ListProgress {
  std::vector<Candidate> chosen;     // the best first
  std::optional<Candidate> decided;  // every grip up to this one, in order, is chosen or near a chosen one; absent: none is decided
  bool is_complete = false;
};

struct ListRequest {
  std::size_t best = 0;  // grips of a list at most
  double apart = 0;      // m, see are_different
  std::size_t pool = 0;  // grips of a list that a pass keeps; at least 1, and at least `best` where apart is 0
  int threads = 0;       // 0: all
};

// How many grips a pass keeps for each list.
std::size_t usual_pool(const Plan& plan, std::size_t best, double apart);

// A list is defined thus: go through the feasible, plausible grips of its vessel and hand scale in the order of is_better, and take
// each that differs from all taken before, until there are `best`. That order is known only when every grip has come in, and not
// all can be kept.
//
// So a pass keeps the best `pool` grips of those that are not decided and differ from all chosen so far, and its end goes through
// these in order. That is the same: a grip that the pass did not keep is near a chosen one, or stands behind every grip of a full
// pool. When the pool is used up and was full, all up to its last grip is decided, and another pass goes on from there. The first
// of a full pool is always taken, so there are at most `best` passes. Memory is that of `pool` + `best` grips a list.
//
// Scores are those of the grips' evaluation. Hands are the core's in double precision, whatever computed the scores, so that
// every backend and `rank` have one rule.
class ListChooser {
 public:
  using Hands = std::vector<std::optional<PosedHand>>;

  // The lists of each hand scale of a vessel. `core` may be null if apart is 0. `progress`: of a chooser that continues; empty: nothing is known.
  // Plan and core must outlive the object.
  ListChooser(const Plan& plan, const Evaluator* core, std::size_t vessel, const ListRequest& request,
              std::vector<ListProgress> progress = {});

  // Takes feasible, plausible grips, in any order, each once per pass.
  void offer(const std::vector<Candidate>& grips);
  // The grips offered in this pass that may still be chosen, for another chooser with the same progress.
  std::vector<Candidate> open_grips() const;
  // Takes what another chooser with the same progress found open in this pass, without checking its hands.
  void add_open(const std::vector<Candidate>& grips);
  // Call after all grips of the vessel. `is_complete` says whether another pass is needed. `pose`: finds the hands of some grips, in their order, if
  // other processes help.
  using PoseHands = std::function<Hands(const std::vector<Candidate>& grips)>;
  void end_pass(const PoseHands& pose = {});

  // The hands of grips of the vessel, by the core; none for a grip without a hand.
  Hands hands_of(const std::vector<Candidate>& grips) const;

  bool is_complete() const;
  const std::vector<ListProgress>& progress() const { return progress_; }
  std::vector<Candidate> chosen() const;  // of one list after the other

 private:
  bool is_open(std::size_t list, const Candidate& grip) const;
  void offer_piece(const Candidate* grips, std::size_t count);
  void choose_from_pool(std::size_t list, const PoseHands& pose);

  const Plan& plan_;
  const Evaluator* core_;
  std::size_t vessel_;
  ListRequest request_;
  std::vector<ListProgress> progress_;
  std::vector<DifferentGrips> taken_;
  std::vector<BestCandidates> pools_;
};

}  // namespace wholehand::sweeps
