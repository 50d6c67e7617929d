// SPDX-License-Identifier: MIT
// The best grips of a sweep as glTF.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/evaluator.h"
#include "sweeps/lists/best.h"
#include "sweeps/result/output_names.h"

namespace wholehand::sweeps {

struct BestGlb {
  std::vector<std::string> files;  // as the closing lines name them: for each list the first, or the first and the last
  std::vector<std::string> notes;  // for the user: what is missing
};

// Writes the first `count` of every list of best grips (one per vessel and hand scale, as in GripLists) to NAME.<vessel>.<rank>.glb, or
// NAME.<vessel>.hand<scale>.<rank>.glb if there are several hand scales, each file complete or absent, with the scene's own fills and tilts and the
// evaluator's numbers. Leaves out, with a note, a grip that is feasible only in the sweep's own precision. Throws Error (failure) if a file cannot be
// written.
BestGlb write_best_glb(const Scene& scene, const Plan& plan, std::shared_ptr<const Evaluator> evaluator,
                       const std::vector<std::vector<BestGrip>>& best, int count, const OutputNames& names);

}  // namespace wholehand::sweeps
