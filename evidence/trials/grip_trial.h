// SPDX-License-Identifier: MIT
// One grip of one vessel through the protocols.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/evaluator.h"
#include "evidence/trials/held_body.h"
#include "evidence/trials/trial.h"

namespace wholehand {

constexpr double CLOSE_TIME = 0.25,
                 STILL_TIME = 0.15;        // s: to press harder and harder, and to come to rest, before the vessel is released
constexpr double SETTLE_TIME = 0.5;        // s after that; a loss in this time is a loss at the release
constexpr double STATE_STEP = radians(5);  // between the tilts at which load and forces are computed; others are interpolated

// What touches the hand of a vessel, for a right hand: the same for every grip. Throws Error as vessel_form.
BodyForm trial_form(const Scene& scene, std::size_t vessel);

// Not thread-safe; use one per thread. All arguments except the form must outlive it.
class GripTrial {
 public:
  // If the engine does not accept the model, every outcome is `diverged`, with its words.
  GripTrial(const MujocoLibrary& library, const Scene& scene, const Evaluator& evaluator, const TrialSettings& settings,
            std::size_t vessel, const BodyForm& form, const GripInput& grip, int most_contacts = MOST_CONTACTS);

  // Takes a fill through tilts in ascending order, with an outcome for each. `track`, if requested, gets all frames until the vessel is lost or the
  // last hold ends, and `ends` how many of them belong to each tilt.
  std::vector<TrialOutcome> tilt(double fill, const std::vector<double>& tilts, TrialTrack* track, std::vector<std::size_t>* ends);
  // A fill pushed along a direction of the vessel frame (see TrialCase).
  TrialOutcome push(double fill, int direction, const TrialMaterial& material, TrialTrack* track);

 private:
  // The load on the vessel, and the hand's response.
  struct State {
    RigidLoad load;
    core_f64::Vec3 force{};
    std::vector<double> drives;
  };
  State state_at(double fill, double tilt) const;
  std::vector<double> drives_for(const RigidLoad& load, const core_f64::Vec3& force, double friction, double torsion) const;
  void act(const State& state);
  void act_between(const State& a, const State& b, double share, double tilt, bool with_load);
  core_f64::Vec3 up_at(double tilt) const;
  HeldBody& body();  // throws EngineError if there is none
  // Closes the hand on the pinned vessel and releases it. Returns what is wrong with the start, if anything.
  TrialReason close(const State& state);
  // Continues for a time; false once the vessel is lost, which `outcome` then records.
  bool watch(double duration, double tilt, TrialOutcome& outcome, TrialTrack* track);
  bool turn(double fill, State& state, double from, double to, TrialOutcome& outcome, TrialTrack* track);
  bool look(double tilt, TrialOutcome& outcome);
  void keep_frame(double tilt, TrialTrack* track);

  const Scene& scene_;
  const TrialSettings& settings_;
  double friction_ = 0, torsion_ = 0;  // of the scene, or as the settings say
  GripResult result_;
  PosedHand posed_{};  // of the right hand
  Triple pour_{};      // of the right hand's scene
  GraspContacts contacts_;
  GraspModel grasp_;
  VesselLoad vessel_load_;
  std::optional<HeldBody> body_;
  std::string last_error_;  // why there is none
  bool is_articulated_ = true;
  core_f64::Vec3 watched_{};  // a point of the vessel: its center of mass at the release
  long steps_ = 0;
};

}  // namespace wholehand
