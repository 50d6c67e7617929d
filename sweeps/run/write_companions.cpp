// SPDX-License-Identifier: MIT
#include "sweeps/run/write_companions.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include "base/files/files.h"
#include "base/system/version.h"
#include "core/planes.h"
#include "sweeps/result/best_glb.h"
#include "sweeps/result/companions.h"
#include "sweeps/result/grip_lists.h"
#include "sweeps/result/heat_map_plot.h"
#include "sweeps/result/output_names.h"

namespace wholehand {
namespace {

// Answers their files.
std::vector<std::string> draw_companion_maps(const CompanionRequest& request, const std::vector<HeatMap>* maps) {
  if (!maps) {
    request.note("no heat maps: the score is not kept ([output] keep)");
    return {};
  }
  const std::vector<HeatMapPicture> pictures = sweep_pictures(request.scene, request.plan, *maps, request.names);
  std::vector<std::string> files;
  const std::string failure = write_pictures(heat_map_files(pictures), &files);
  if (!failure.empty()) request.note(failure);
  return files;
}

}  // namespace

void describe_best(const CompanionRequest& request, std::vector<std::vector<BestGrip>>& lists) {
  if (std::all_of(lists.begin(), lists.end(), [](const auto& list) { return list.empty(); })) return;
  const std::unique_ptr<Backend> core =
      request.parts.open_core(request.scene, make_field_set(best_fields(request.scene), request.scene));
  for (std::size_t list = 0; list < lists.size(); ++list) {
    std::vector<Candidate> candidates;
    for (const BestGrip& grip : lists[list]) candidates.push_back(grip.candidate);
    std::vector<BestGrip> described =
        evaluate_best(*core, request.scene, request.plan, list / request.plan.hand_scales(), candidates);
    for (std::size_t i = 0; i < described.size(); ++i) {
      const BestGrip& known = lists[list][i];
      described[i].score = known.candidate.score;
      described[i].refined = known.refined;
      described[i].refined_score = known.refined_score;
      described[i].robust = known.robust;
    }
    lists[list] = std::move(described);
  }
}

std::vector<std::string> write_companions(const CompanionRequest& request, const std::vector<std::vector<BestGrip>>& best,
                                          const std::vector<HeatMap>* maps, const BackendInfo& info) {
  const OutputNames& names = request.names;
  std::vector<std::string> files = draw_companion_maps(request, maps);
  if (request.best > 0) {
    const ListOrigin origin = list_origin(names.result, origin_of(request.scene, version(), info));
    write_whole_file(names.best, best_csv(request.scene, request.plan, best, origin), false);
    files.insert(files.begin(), names.best);
  } else if (is_best_list(names.best)) {
    std::remove(names.best.c_str());  // of the result that is replaced
  }
  if (request.glb > 0) {
    const BestGlb written = write_best_glb(request.scene, request.plan, request.parts.open_evaluator(), best, request.glb, names);
    files.insert(files.end(), written.files.begin(), written.files.end());
    for (const std::string& line : written.notes) request.note(line);
  }
  return files;
}

}  // namespace wholehand
