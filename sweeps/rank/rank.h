// SPDX-License-Identifier: MIT
// The best grips of a result by other weights and under conditions, without another sweep: what `wholehand rank` does.
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

namespace wholehand {

// Weights of the six terms, in the order of effective_weights, from "fingers=0.2,depth=0.5": the scene's own where one is not named; in a scene
// without tilts, where they are scaled to sum to 1, those named are taken as they are and the others as scaled. Throws Error (usage) for a term that
// is not
// known or not there, is named twice, or whose weight is no number from 0 to 1000; and where no weight is left.
std::array<double, 6> read_weights(const std::string& text, const Scene& scene);

// What a condition may name: every variable of the catalogue, and the axes. Whatever the file lacks is there with the reason.
std::vector<WhereName> where_names(const SweepResult& result, const Scene& scene, const Plan& plan);

// From "score", "robust", "worst_effort" or "push"; empty: "robust" in a scene with [robust], else "score". Throws Error (usage), also
// for what the scene does not have.
RankBy read_rank_by(const std::string& text, const Scene& scene);
// The same before a scene is known: throws for a text that is none of these.
void check_rank_by(const std::string& text);

// Throws Error (usage) where a result with these variables alone lacks what rank_grips needs to rank by the sweep's own weights.
void check_rankable(const Scene& scene, const std::vector<const Variable*>& variables, RankBy by);

// How many grips `rank` lists unless it is given a number: as many as the sweep listed, or what its scene asks for, or 20 where that is none.
std::size_t usual_length(const SweepResult& result, const Scene& scene, const Plan& plan);

struct RankRequest {
  std::string weights;             // as of read_weights; empty: the sweep's own scores
  std::vector<std::string> where;  // conditions, all of which a grip meets
  std::size_t best = 0;            // grips a list at most
  double apart = 0;        // m, that some joint of the hand moves from one listed grip to any other (sweeps/lists/list_chooser.h)
  std::size_t pool = 0;    // grips of a list that one pass keeps; 0: usual_pool
  bool least_bad = false;  // where no grip of a list holds: the plausible ones, by their worst effort
  RankBy by = RankBy::score;
};

struct Ranking {
  std::vector<std::vector<BestGrip>> lists;  // as of GripLists, the best first
  std::vector<std::uint64_t> matching;       // grips of each list that are eligible and meet the condition,
  std::vector<std::uint64_t> plausible;      // out of these feasible and plausible ones,
  std::vector<std::uint64_t> not_held;       // less these
  std::vector<std::uint64_t> at_gate;        // of the plausible, as in GripCounts; 0 where the file lacks worst_effort
  std::string note;                          // for the user: what is not from the file; empty: everything is
};

// Goes through the file in blocks, as often as ListChooser needs, so that memory does not depend on the number of grips. Only
// eligible grips (shaders/status.h) are listed, by what is asked for, then by their number, as a sweep lists them; robust scores are the core's.
// With the sweep's own weights the scores are the file's, and grips that do not hold have 0 with any. All other numbers are the
// file's or, where that lacks some of them, the core's. Throws Error (usage):
// read_weights, Where, or values that the file lacks, with what to keep.
Ranking rank_grips(const SweepResult& result, const Scene& scene, const Plan& plan, const RankRequest& request,
                   const std::function<std::shared_ptr<const Evaluator>()>& open_core);

// Whether a list has plausible grips, none of which holds.
bool none_holds(const Ranking& ranking, std::size_t list);

// For each list of which no grip holds, the line about its nearest grip (sweeps/rank/unheld.h); empty for the others. `least_bad` is a ranking
// that was asked for such grips.
std::vector<std::string> unheld_lines(const Evaluator& core, const Scene& scene, const Plan& plan, const Ranking& least_bad);

// A grip of one of several rankings, and of which list there.
struct MergedGrip {
  std::size_t ranking = 0, list = 0;
  BestGrip grip;
};

// Ranks grips of several rankings `by` anew, at most `best` of them; of equal ones the first stay first.
std::vector<MergedGrip> merged(std::vector<MergedGrip> grips, RankBy by, std::size_t best);

}  // namespace wholehand
