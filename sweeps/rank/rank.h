// SPDX-License-Identifier: MIT
// Ranks a result's grips by other weights and under conditions, without another sweep: what `wholehand rank` does.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/evaluator.h"
#include "sweeps/lists/best.h"
#include "sweeps/rank/where.h"
#include "sweeps/result/grip_lists.h"

namespace wholehand::sweeps {

// Weights of the six terms, in the order of effective_weights, from "fingers=0.2,depth=0.5"; unnamed ones are the scene's. In a scene without tilts,
// whose weights are scaled to sum to 1, named weights are taken unchanged and the others scaled. Throws Error (usage) for a term that is unknown,
// absent or named twice, for a weight that is not a number from 0 to 1000, and if all weights are 0.
std::array<double, 6> read_weights(const std::string& text, const Scene& scene);

// The names that a condition may use: every variable of the catalogue, and the axes. Those that the file lacks are included with the reason.
std::vector<WhereName> where_names(const SweepResult& result, const Scene& scene, const Plan& plan);

// From "score", "robust", "worst_effort" or "push"; empty: "robust" in a scene with [robust], else "score". Throws Error (usage), also for a
// criterion that the scene lacks.
RankBy read_rank_by(const std::string& text, const Scene& scene);
// The same before a scene is known: throws for any other text.
void check_rank_by(const std::string& text);

// Throws Error (usage) if a result with only these variables lacks what rank_grips needs to rank by the sweep's own weights.
void check_rankable(const Scene& scene, const std::vector<const Variable*>& variables, RankBy by);

// How many grips `rank` lists by default: as many as the sweep listed, or as its scene asks for, or 20 if that is none.
std::size_t usual_length(const SweepResult& result, const Scene& scene, const Plan& plan);

struct RankRequest {
  std::string weights;             // as from read_weights; empty: the sweep's own scores
  std::vector<std::string> where;  // conditions, all of which a grip meets
  std::size_t best = 0;            // largest number of grips in a list
  double apart = 0;        // m, by which some joint of the hand differs between any two listed grips (sweeps/lists/list_chooser.h)
  std::size_t pool = 0;    // grips of a list that one pass keeps; 0: usual_pool
  bool least_bad = false;  // if no grip of a list holds: the plausible ones, by their worst effort
  RankBy by = RankBy::score;
};

struct Ranking {
  std::vector<std::vector<BestGrip>> lists;  // as of GripLists, the best first
  std::vector<std::uint64_t> matching;       // grips of each list that are eligible and meet the condition,
  std::vector<std::uint64_t> plausible;      // out of these feasible and plausible ones,
  std::vector<std::uint64_t> not_held;       // less these
  std::vector<std::uint64_t> at_gate;        // of the plausible, as in GripCounts; 0 if the file lacks worst_effort
  std::string note;                          // for the user: what does not come from the file; empty: everything does
};

// Goes through the file in blocks, as often as ListChooser needs, so that memory does not depend on the number of grips. Lists only eligible grips
// (shaders/status.h), by the requested criterion, then by number, as a sweep does. Robust scores come from the core. With the sweep's own weights the
// scores are the file's; grips that do not hold have 0 with any weights. All other numbers are the file's or, if it lacks some, the core's. Throws
// Error (usage): read_weights, Where, or values that the file lacks, with what to keep.
Ranking rank_grips(const SweepResult& result, const Scene& scene, const Plan& plan, const RankRequest& request,
                   const std::function<std::shared_ptr<const Evaluator>()>& open_core);

// Whether a list has plausible grips, none of which holds.
bool none_holds(const Ranking& ranking, std::size_t list);

// For each list without a holding grip, the line about its nearest grip (sweeps/rank/unheld.h); empty for the others. `least_bad` is a ranking for
// such grips.
std::vector<std::string> unheld_lines(const Evaluator& core, const Scene& scene, const Plan& plan, const Ranking& least_bad);

// A grip of one of several rankings, and its list there.
struct MergedGrip {
  std::size_t ranking = 0, list = 0;
  BestGrip grip;
};

// Ranks grips of several rankings `by` anew, at most `best` of them; ties keep their order.
std::vector<MergedGrip> merged(std::vector<MergedGrip> grips, RankBy by, std::size_t best);

}  // namespace wholehand::sweeps
