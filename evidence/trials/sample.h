// SPDX-License-Identifier: MIT
// Chooses the grips to try: the best of each vessel, and a sample over the whole range of scores.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/backend.h"
#include "evidence/trials/options.h"
#include "sweeps/plan/plan.h"
#include "sweeps/result/grip_lists.h"

namespace wholehand {

enum class TrialSample { best, stratified };
constexpr std::array<const char*, 2> TRIAL_SAMPLE_NAMES{"best", "stratified"};

// A grip to be tried.
struct TrialGrip {
  std::size_t vessel = 0;
  std::uint64_t number = 0;  // in its vessel's plan
  GripInput grip;
  TrialSample sample = TrialSample::stratified;
  double score = 0;      // the score that chose it
  std::size_t rank = 0;  // rank in its list, from 1; 0: in none
};

// The seed's draw for a grip.
std::uint64_t grip_key(std::uint64_t seed, std::size_t vessel, std::uint64_t number);

constexpr std::size_t SCORE_STRATA = 10;

// About `count` of the grips, as many as possible from each of SCORE_STRATA equal parts of the range of their scores. A part that has fewer than its
// share gives all, and the others give more. In each part the seed draws: a grip's key depends only on seed, vessel and number, so that the order of
// `eligible` does not matter. By number, ascending.
std::vector<Candidate> stratified_sample(const std::vector<Candidate>& eligible, std::size_t count, std::size_t vessel,
                                         std::uint64_t seed);

// Numbers of the grips of a vessel whose scores are considered: all, or if there are more than `most`, one of each of `most` equal stretches, drawn
// by the seed.
std::vector<std::uint64_t> looked_at(std::uint64_t grips, std::size_t most, std::size_t vessel, std::uint64_t seed);

// Feasible, plausible grips of a vessel with their scores, among those that are considered: by the core in double precision, so that they are the
// same on every machine, or from a result. Those that do not hold are also tried, with a score of 0; a result without `plausible` has only the
// others. Empty if `stop` is set.
std::vector<Candidate> plausible_by_core(const Scene& scene, const sweeps::Plan& plan, std::shared_ptr<const Evaluator> core,
                                         std::size_t vessel, const TrialOptions& options, const std::atomic<bool>& stop);
std::vector<Candidate> plausible_in_result(const sweeps::SweepResult& result, const sweeps::Plan& plan, std::size_t vessel,
                                           const TrialOptions& options);

// One of this many grips of a stratified sample begins too deep in the vessel to be tried.
constexpr std::size_t DEEP_ONE_OF = 5;

// Eligible grips of a vessel, divided by their starting depth in it, by the core.
struct PartedByDepth {
  std::vector<Candidate> usual, deep;  // deep: by more than the overlap at which a trial is discarded
};
PartedByDepth parted_by_depth(const Scene& scene, const sweeps::Plan& plan, std::shared_ptr<const Evaluator> core,
                              std::size_t vessel, const std::vector<Candidate>& eligible, const TrialOptions& options,
                              const std::atomic<bool>& stop);

// A stratified sample of each part. One of DEEP_ONE_OF grips is a deep one, and more only if there are too few usual ones, so that the share of
// discarded grips does not depend on the score's weight of depth.
std::vector<Candidate> sample_of_parts(const PartedByDepth& parts, std::size_t count, std::size_t vessel, std::uint64_t seed);

// The best different holding ones of plausible grips, as a sweep lists them, one hand scale after the other. Empty if `stop` is set.
std::vector<Candidate> best_different(const Scene& scene, const sweeps::Plan& plan, const Evaluator& core, std::size_t vessel,
                                      const std::vector<Candidate>& plausible, const TrialOptions& options,
                                      const std::atomic<bool>& stop);

// Removes grips that are not feasible and plausible by the core, since a result may have found them in single precision. Returns how many.
std::size_t remove_impossible(const Evaluator& core, std::vector<TrialGrip>& grips);

// The source of scores: the core, or a result with its own lists. The result is in use with scene and plan.
struct GripSourceOfTrials {
  const Scene& scene;
  const sweeps::Plan& plan;
  std::shared_ptr<const Evaluator> core;
  const sweeps::SweepResult* result = nullptr;
};

// All grips to try: of each vessel the best, then the others. A listed grip is not also in the stratified sample. Leaves out chosen grips of a result
// that the core does not find feasible and plausible, and notes how many. Throws Error (usage) if no grip is feasible and plausible. Empty if `stop`
// is set.
std::vector<TrialGrip> choose_trial_grips(const GripSourceOfTrials& source, const TrialOptions& options,
                                          const std::atomic<bool>& stop);

}  // namespace wholehand
