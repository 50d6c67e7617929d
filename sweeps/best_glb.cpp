#include "sweeps/best_glb.h"

#include <fmt/format.h>

#include <algorithm>

#include "sweeps/grip_glb.h"
#include "sweeps/heat_map_plot.h"

namespace wholehand {

BestGlb write_best_glb(const Scene& scene, std::shared_ptr<const Evaluator> evaluator,
                       const std::vector<std::vector<BestGrip>>& best, int count, const OutputNames& names) {
  const GripMethods methods = core_grip_methods(scene, std::move(evaluator), "core");
  const std::vector<std::string> parts = file_name_parts(scene);
  BestGlb written;
  for (std::size_t v = 0; v < best.size(); ++v) {
    std::vector<std::string> files;
    for (std::size_t k = 0; k < std::min(best[v].size(), static_cast<std::size_t>(count)); ++k) {
      const std::string file = names.grip_glb(parts[v], k + 1);
      const GripReport report = make_grip_report(scene, v, best[v][k].grip, scene_axes(scene), methods);
      if (report.answer.result.reason != Reason::none) {
        written.notes.push_back(fmt::format("no {}: the core finds the grip not feasible ({})", file,
                                            REASON_NAMES[static_cast<std::size_t>(report.answer.result.reason)]));
        continue;
      }
      write_whole_file(file, grip_glb(scene, v, report), false);
      files.push_back(file);
    }
    if (!files.empty()) written.files.push_back(files.size() == 1 ? files[0] : files.front() + " .. " + files.back());
  }
  return written;
}

}  // namespace wholehand
