// SPDX-License-Identifier: MIT
// The final terminal output of trials.
#pragma once

#include <string>

#include "evidence/trials/analysis.h"

namespace wholehand {

// How many grips of each vessel held, what predicted it, and the bars.
std::string trials_summary(const Scene& scene, const TrialOptions& options, const TrialAnalysis& analysis);

}  // namespace wholehand
