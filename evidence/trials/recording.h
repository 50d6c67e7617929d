// SPDX-License-Identifier: MIT
// A trial as a recording that `wholehand view` plays.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/evaluator.h"
#include "core/scene.h"
#include "device/session/tick.h"
#include "evidence/trials/sample.h"
#include "evidence/trials/trial.h"

namespace wholehand {

// The scene's text with only one vessel, because `wholehand view` takes no vessels that overlap. Removed lines stay as empty lines, so that messages
// keep their places. Empty if the rest is not a scene.
std::string text_of_one_vessel(const Scene& scene, std::size_t vessel);

// The frames of several tracks of one run, ascending in time, each moment once.
std::vector<TrialFrame> joined_frames(const std::vector<TrialTrack>& tracks);

// One tick per moment. Gravity points down, so the hand turns with the vessel that it holds. The middle of the tips is above the table by the
// vessel's height. Tips are the engine's; a viewer poses the other fingers anew.
std::vector<device::Tick> ticks_of_trial(const Scene& scene, const Evaluator& core, const TrialGrip& grip, const TrialCase& one,
                                         const TrialOutcome& outcome, const std::vector<TrialFrame>& frames, double rate);

// Writes the recording to `path`, where nothing exists yet. Throws Error: (usage) text_of_one_vessel has none; (failure) it cannot be written, and
// nothing of it is left.
void write_trial_recording(const std::string& path, const Scene& scene, const Evaluator& core, const std::string& engine,
                           const TrialGrip& grip, const TrialCase& one, const TrialOutcome& outcome,
                           const std::vector<TrialTrack>& tracks);

}  // namespace wholehand
