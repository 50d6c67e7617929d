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

// The scene's text with one vessel alone: `wholehand view` takes no vessels that overlap. Lines that go are left empty,
// so that messages keep their places. Empty where what is left is no scene.
std::string text_of_one_vessel(const Scene& scene, std::size_t vessel);

// The frames of several tracks of one run, ascending in time, each moment once.
std::vector<TrialFrame> joined_frames(const std::vector<TrialTrack>& tracks);

// A moment each: gravity points down, and so the hand turns with the vessel that it holds. The middle of the tips is above the
// table, by as much as the vessel is high. Tips are the engine's; a viewer poses the other fingers anew.
std::vector<Tick> ticks_of_trial(const Scene& scene, const Evaluator& core, const TrialGrip& grip, const TrialCase& one,
                                 const TrialOutcome& outcome, const std::vector<TrialFrame>& frames, double rate);

// Writes the recording; nothing is at `path` yet. Throws Error: (usage) text_of_one_vessel has none; (failure) it cannot be
// written, and nothing of it is left.
void write_trial_recording(const std::string& path, const Scene& scene, const Evaluator& core, const std::string& engine,
                           const TrialGrip& grip, const TrialCase& one, const TrialOutcome& outcome,
                           const std::vector<TrialTrack>& tracks);

}  // namespace wholehand
