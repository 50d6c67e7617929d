// SPDX-License-Identifier: MIT
// The core's predictions for a grip and each of its tried cases, made before any engine runs.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "core/evaluator.h"
#include "core/grip_effort.h"
#include "core/scene.h"
#include "evidence/trials/logistic.h"
#include "evidence/trials/trial.h"

namespace wholehand {

// Efforts are infinite if no force of the hand holds the load. Those of the way are the largest over the states that a run passes on its way to the
// case, from the previous case of its fill: from that tilt to this one, and for a fill's first case from upright, where the vessel is released. A
// push has no way.
struct CasePrediction {
  double effort = 0;      // of the whole hand
  double tips = 0;        // of thumb and index tip alone
  double leg_effort = 0;  // the same two, over the way
  double leg_tips = 0;
};

struct GripPrediction {
  std::vector<CasePrediction> cases;             // in the order of the cases
  double worst_effort = 0;                       // of the ways to the fill_tilt cases; NaN without any
  double tips_worst_effort = 0;                  // likewise
  double scene_worst_effort = 0;                 // over all states of the scene, as a sweep has it
  double push = 0;                               // N
  double friction_needed = 0;                    // over all states of the scene
  double epsilon = 0;                            // the middle of its bracket
  double score = 0;                              // 0 if the worst effort of the scene is above 1
  std::array<double, SCORE_TERM_COUNT> terms{};  // fingers, contacts, depth, posture, force, hold
};

// The tilts at which a way from one tilt to another is evaluated: both, and every whole LEG_STEP between them.
inline constexpr double LEG_STEP = radians(5);
std::vector<double> leg_tilts(double from, double to);

constexpr std::size_t TRIAL_FACETS = 2'000;  // of the hull for epsilon: 15 ms per grip, and a bracket about 12 % wide

// By the core in double precision, with the mass and the friction of the trials in place of the scene's. Thread-safe.
class TrialPredictor {
 public:
  // For a scene with strengths and tilts.
  TrialPredictor(const Scene& scene, const TrialSettings& settings);

  // `grip` is feasible.
  GripPrediction predict(std::size_t vessel, const GripInput& grip, const std::vector<TrialCase>& cases) const;

  // The scene with the friction of the trials, and its core.
  const Scene& scene() const { return scene_; }
  std::shared_ptr<const Evaluator> core() const { return core_; }

 private:
  struct Held;
  CasePrediction predict_case(const Held& held, const TrialCase& one) const;
  void predict_leg(const Held& held, const TrialCase& one, double from, CasePrediction& prediction) const;
  void predict_states(const Held& held, GripPrediction& prediction) const;
  void predict_scores(const Held& held, GripPrediction& prediction) const;
  double mass_of(double state) const;

  // A vessel over the scene's states, with the mass of the trials.
  struct States {
    std::vector<core_f64::Load> loads;  // fill-major over the tilts
    std::vector<core_f64::StateTilt> tilts;
    std::vector<std::size_t> counted;  // tilts at each fill
    core_f64::Load fullest;            // upright
  };
  States states_of(std::size_t vessel) const;

  Scene scene_;
  TrialSettings settings_;
  std::shared_ptr<const Evaluator> core_;
  std::vector<States> states_;  // of each vessel
};

}  // namespace wholehand
