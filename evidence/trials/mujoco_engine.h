// SPDX-License-Identifier: MIT
// Trials of grips in MuJoCo.
#pragma once

#include <memory>

#include "core/evaluator.h"
#include "evidence/trials/trial.h"

namespace wholehand {

// `scene` and `evaluator`, which was made for it, must outlive the engine. Throws Error (failure) where MuJoCo cannot be loaded.
// Whether a vessel has a model is asked with `check`, as a run may be of one vessel alone.
std::unique_ptr<TrialEngine> make_mujoco_engine(const Scene& scene, const Evaluator& evaluator, const TrialSettings& settings);

}  // namespace wholehand
