// SPDX-License-Identifier: MIT
#include "sweeps/result/best_glb.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/files/files.h"
#include "sweeps/grips/glb.h"
#include "sweeps/result/grip_lists.h"
#include "sweeps/result/output_names.h"

namespace wholehand::sweeps {

BestGlb write_best_glb(const Scene& scene, const Plan& plan, std::shared_ptr<const Evaluator> evaluator,
                       const std::vector<std::vector<BestGrip>>& best, int count, const OutputNames& names) {
  const GripMethods methods = core_grip_methods(scene, std::move(evaluator), "core");
  const std::vector<std::string> parts = list_file_parts(scene, plan);
  BestGlb written;
  for (std::size_t list = 0; list < best.size(); ++list) {
    const std::size_t vessel = list / plan.hand_scales();
    std::vector<std::string> files;
    for (std::size_t k = 0; k < std::min(best[list].size(), static_cast<std::size_t>(count)); ++k) {
      const std::string file = names.grip_glb(parts[list], best[list][k].rank);
      const GripReport report = make_grip_report(scene, vessel, best[list][k].grip, scene_axes(scene, vessel), methods);
      if (report.answer.result.reason != Reason::none) {
        written.notes.push_back(fmt::format("{} is not written: the core finds that the grip is not feasible ({})", file,
                                            REASON_NAMES[static_cast<std::size_t>(report.answer.result.reason)]));
        continue;
      }
      write_whole_file(file, grip_glb(scene, vessel, report), false);
      files.push_back(file);
    }
    if (!files.empty()) written.files.push_back(files.size() == 1 ? files[0] : files.front() + " .. " + files.back());
  }
  return written;
}

}  // namespace wholehand::sweeps
