// SPDX-License-Identifier: MIT
// The page of trials: trials.html.
#pragma once

#include <string>
#include <vector>

#include "trials/analysis.h"
#include "trials/disagreements.h"
#include "trials/options.h"

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

// One self-contained file of HTML (well-formed XML too): no script, nothing that is fetched. It links to the recordings beside it.
std::string trials_page(const TrialPageSource& source);

}  // namespace wholehand
