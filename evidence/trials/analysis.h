// SPDX-License-Identifier: MIT
// Summarizes all trials: how many grips hold, what predicted it, and where prediction and engine disagree.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "evidence/trials/logistic.h"
#include "evidence/trials/options.h"
#include "evidence/trials/statistics.h"
#include "evidence/trials/tried.h"

namespace wholehand {

// Trials that are reported together: a sample under a protocol and, for six_forces, with a material.
struct TrialGroup {
  TrialSample sample = TrialSample::stratified;
  TrialProtocol protocol = TrialProtocol::fill_tilt;
  int material = 0;
  bool operator==(const TrialGroup&) const = default;
};
bool is_of(const TrialGroup& group, const TrialGrip& grip, const TrialCase& one);

// Trials of one kind. `share` is of those that were not discarded.
struct TrialCount {
  Share held;
  std::size_t discarded = 0, diverged = 0;  // the second are among the first
  std::size_t slipped = 0;                  // of those held
};

// One vessel, at one fill and tilt if given.
struct SuccessRow {
  TrialGroup group;
  std::size_t vessel = 0;
  double fill = 0, tilt = 0;  // of fill_tilt
  TrialCount trials;          // a vessel lost at a smaller tilt is not held
};

// Whole grips of a vessel: success is to hold in every trial of the group. Grips with a discarded trial are left out.
struct WholeGrips {
  TrialGroup group;
  std::size_t vessel = 0;
  Share held;
  std::size_t discarded = 0;
  Share slipped;  // of all trials of the group that were held
};

// Whole grips of a vessel and sample under six_forces, by material: the same grips at the mass and friction of each.
struct PushedGrips {
  TrialSample sample = TrialSample::stratified;
  std::size_t vessel = 0;
  std::vector<WholeGrips> by_material;  // in the order of TrialSettings::materials
};

// ---- what predicts success ----

enum TrialPredictorName : std::size_t {
  BY_WORST_EFFORT,        // of the ways to the tried states
  BY_SCENE_WORST_EFFORT,  // of all states of the scene
  BY_TIPS_EFFORT,         // the same of the two tips
  BY_PUSH,
  BY_FRICTION_NEEDED,
  BY_EPSILON,
  BY_SCORE,
  BY_LEG_EFFORT,  // of the way to a state; the last two are judged trial by trial
  BY_LEG_TIPS,
  TRIAL_PREDICTORS
};
extern const std::array<const char*, TRIAL_PREDICTORS> TRIAL_PREDICTOR_NAMES;
constexpr bool is_by_trial(std::size_t predictor) { return predictor >= BY_LEG_EFFORT; }

// A predictor's values for the grips of a group, or for its trials: larger is better. By grip, success is to hold in every trial, and grips with a
// discarded trial are left out. By trial, only those that test their own state (is_conclusive) are included.
std::vector<Prediction> predictions_of(const TriedGrips& tried, const TrialGroup& group, std::size_t predictor);

struct PredictorRow {
  TrialGroup group;
  std::size_t predictor = 0;
  Auc auc;
};

// Where trials and effort contradict: held though effort > 1, or lost though effort <= 1. As everywhere here, the effort is that of the whole way to
// the state, because a vessel may be lost before it gets there.
struct Disagreement {
  std::size_t grip = 0, place = 0;  // index among the tried grips, and of the case
  double effort = 0;
};

struct GroupEfforts {
  TrialGroup group;
  std::vector<CalibrationBin> bins;
  Confusion confusion;
  std::size_t earlier = 0, discarded = 0;  // trials that are not among them
};

// ---- grips placed as a person takes them ----

constexpr std::size_t FIRST_GRIPS = 5;  // of a list: those that a person acts on

// The results of the placements of a vessel's grips of a sample, or of the first FIRST_GRIPS of its lists.
struct ScatterRow {
  TrialSample sample = TrialSample::best;
  std::size_t vessel = 0;
  bool is_first = false;
  PlacementCount count;
  Share held;  // of all placements: impossible or discarded ones count as not held
};

enum ScatterPredictorName : std::size_t { BY_OWN_SCORE, BY_ROBUST_RANK, BY_ROBUST_SHARE, SCATTER_PREDICTORS };
extern const std::array<const char*, SCATTER_PREDICTORS> SCATTER_PREDICTOR_NAMES;

// How well a number predicts the placements of a sample's grips: larger is better, and success is to be held.
std::vector<Prediction> scatter_predictions(const TriedGrips& tried, TrialSample sample, std::size_t predictor);

struct ScatterPredictors {
  TrialSample sample = TrialSample::stratified;
  std::array<Auc, SCATTER_PREDICTORS> aucs;
  AucDifference robust_gain;  // AUC of the robust rank minus that of the score
};

struct ScatterAnalysis {
  std::vector<ScatterRow> rows;
  std::vector<ScatterPredictors> predictors;
  std::optional<WeightTrial> weights;  // by the placements of the stratified sample
};

// A bar with fewer is not judged, because its interval is too wide: if 10 of 10 hold, the true share may be 72 %.
constexpr std::size_t LEAST_JUDGED = 10;  // successes, and as many failures, of an AUC; grips of a share

// A criterion that the results should meet.
struct TrialBar {
  std::string what;
  double wanted = 0, found = 0;  // NaN: not measured
  Interval interval;
  std::string how;              // of what
  bool is_judged = false;       // of at least LEAST_JUDGED
  const char* verdict() const;  // "met", "missed", "too few to judge", or "not measured" for lack of grips
};

struct TrialAnalysis {
  std::vector<TrialGroup> groups;  // that have grips, in the order of the tables
  std::vector<SuccessRow> successes;
  std::vector<WholeGrips> grips;
  std::vector<PushedGrips> pushed;  // of those, the ones under six_forces
  std::vector<PredictorRow> predictors;
  std::vector<GroupEfforts> efforts;
  std::optional<WeightTrial> weights;  // by the stratified sample at fill_tilt
  std::optional<ScatterAnalysis> scatter;
  std::vector<TrialBar> bars;
  std::vector<Disagreement> disagreements;  // the worst first, at most MOST_DISAGREEMENTS
};

TrialAnalysis analyze_trials(const Scene& scene, const TriedGrips& tried, const TrialOptions& options);

// ---- words ----

std::string group_text(const TrialGroup& group, const TrialSettings& settings);  // "best grips, fill-tilt"
std::string sample_text(TrialSample sample);                                     // "best grips"
std::string scatter_row_text(const ScatterRow& row);                             // "first 5 grips", or the sample
// "mass and friction of the scene".
std::string material_text(const TrialMaterial& material);
// Whether the fitted weights are better than the scene's, a sentence.
std::string weights_text(const WeightTrial& weights);
// "12 overlap, 3 impossible"; nothing if all were held.
std::string failures_text(const PlacementCount& count);
// What the engine did in one trial, a sentence.
std::string outcome_text(const TrialCase& one, const TrialOutcome& outcome);
// "0.91 (0.88 to 0.94)".
std::string interval_text(double value, const Interval& interval, int digits);

}  // namespace wholehand
