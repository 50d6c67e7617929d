// SPDX-License-Identifier: MIT
// The data that the page of trials shows.
#pragma once

#include <string>
#include <vector>

#include "evidence/trials/analysis.h"
#include "evidence/trials/disagreements.h"
#include "evidence/trials/options.h"

namespace wholehand {

// Everything that the page shows.
struct TrialPageSource {
  const Scene& scene;
  const TrialOptions& options;
  const TriedGrips& tried;
  const TrialAnalysis& analysis;
  const std::vector<ShownDisagreement>& disagreements;
  std::string engine, identity;
};

}  // namespace wholehand
