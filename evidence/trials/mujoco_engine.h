// SPDX-License-Identifier: MIT
// Trials of grips in MuJoCo.
#pragma once

#include <memory>

#include "core/evaluator.h"
#include "evidence/trials/trial.h"

namespace wholehand {

// `scene` and `evaluator`, which was made for it, must outlive the engine. Throws Error (failure) if MuJoCo cannot be loaded. Use `check` to ask
// whether a vessel has a model, because a run may be about one vessel alone.
std::unique_ptr<TrialEngine> make_mujoco_engine(const Scene& scene, const Evaluator& evaluator, const TrialSettings& settings);

}  // namespace wholehand
