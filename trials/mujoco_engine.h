// SPDX-License-Identifier: MIT
// Trials of grips in MuJoCo.
#pragma once

#include <memory>

#include "core/evaluator.h"
#include "trials/trial.h"

namespace wholehand {

// `scene` and `evaluator`, which was made for it, must outlive the engine. Throws Error (failure) where MuJoCo cannot be loaded.
std::unique_ptr<TrialEngine> make_mujoco_engine(const Scene& scene, const Evaluator& evaluator, const TrialSettings& settings);

}  // namespace wholehand
