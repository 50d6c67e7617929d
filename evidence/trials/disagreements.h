// SPDX-License-Identifier: MIT
// Repeats the worst disagreements between effort and engine, with a drawing and a recording of each.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "base/files/file_set.h"
#include "evidence/trials/analysis.h"
#include "evidence/trials/output.h"
#include "evidence/trials/predictions.h"

namespace wholehand {

struct ShownDisagreement {
  Disagreement which;
  std::string drawing;    // SVG; empty: it cannot be drawn, and `trouble` says why
  std::string forces;     // meaning of its arrows; may be empty
  std::string recording;  // name of the file in the folder; empty: there is none, and `trouble` says why
  std::string error;
};

// The cases of the engine run that leads to one of a grip's cases: the smaller tilts of its fill, and itself.
std::vector<TrialCase> cases_up_to(const std::vector<TrialCase>& cases, std::size_t place);

// Writes the recordings into the set, and removes those of earlier trials. `scene` is the original one, whose text the recordings get. `stop` ends it
// before the next one. Throws Error (failure): a recording could not be written. If a drawing or an engine fails, that is the trouble of its
// disagreement.
std::vector<ShownDisagreement> show_disagreements(const TrialFiles& files, FileSet& set, const Scene& scene,
                                                  const TrialPredictor& predictor, const TrialEngine& engine,
                                                  const TriedGrips& tried, const TrialAnalysis& analysis,
                                                  const std::atomic<bool>& stop);

}  // namespace wholehand
