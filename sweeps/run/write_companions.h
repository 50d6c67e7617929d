// SPDX-License-Identifier: MIT
// Writes the files beside a result: pictures, the list of the best grips, and those as glTF.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/backend.h"
#include "sweeps/lists/best.h"
#include "sweeps/plan/plan.h"
#include "sweeps/result/heat_map.h"
#include "sweeps/result/mark.h"
#include "sweeps/result/output_names.h"
#include "sweeps/run/sweep_parts.h"

namespace wholehand {

struct CompanionRequest {
  const Scene& scene;
  const Plan& plan;
  const OutputNames& names;
  const SweepParts& parts;
  std::size_t best = 0;                          // grips of each list
  int glb = 0;                                   // of them as glTF
  std::function<void(const std::string&)> note;  // takes further notes, a line each
};

// Completes the figures of the grips of each list by the core, except places, scores, refinements and robust scores. A device would have to compile
// kernels with more outputs, for a few grips.
void describe_best(const CompanionRequest& request, std::vector<std::vector<BestGrip>>& lists);

// Returns the names of the files, as the closing lines show them. `maps` null: the score is not kept, and there are none. `info`: the sweep's.
std::vector<std::string> write_companions(const CompanionRequest& request, const std::vector<std::vector<BestGrip>>& best,
                                          const std::vector<HeatMap>* maps, const BackendInfo& info);

}  // namespace wholehand
