// SPDX-License-Identifier: MIT
#include "sweeps/run/ending.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include "base/files/files.h"
#include "base/system/clock.h"
#include "base/system/version.h"
#include "base/text/printable.h"
#include "core/planes.h"
#include "core/tolerances.h"
#include "sweeps/lists/hand_lists.h"
#include "sweeps/lists/refine.h"
#include "sweeps/lists/robust.h"
#include "sweeps/rank/rank.h"
#include "sweeps/rank/unheld.h"
#include "sweeps/result/best_glb.h"
#include "sweeps/result/companions.h"
#include "sweeps/result/grip_lists.h"
#include "sweeps/result/heat_map_plot.h"
#include "sweeps/result/tally.h"
#include "sweeps/run/closing.h"

namespace wholehand::sweeps {
namespace {

class Ending {
 public:
  Ending(const Sweep& sweep, SweepState& state, ResultFile& file)
      : sweep_(sweep), state_(state), file_(file), scene_(sweep.scene()), plan_(sweep.plan()), names_(sweep.names()) {}

  void publish(BestLists best, ChecksumParts checksums) {
    if (sweep_.has_usual_order()) describe(best);
    file_.check_own();
    // Renames the result last: once it exists, everything does. Lists in another order are made from the finished result.
    std::vector<std::string> files;
    if (sweep_.has_usual_order()) files = write_companions(best);
    const bool is_parted = state_.has_shards();
    write_result(best, is_parted, std::move(checksums));
    if (!sweep_.has_usual_order()) {
      Ranking ranking = rank_finished({"", {}, 0, scene_.output.apart, 0, false, sweep_.by()});
      if (!ranking.note.empty()) sweep_.note(ranking.note);
      best = std::move(ranking.lists);
      files = write_companions(best);
    }
    files.insert(files.begin(), is_parted ? names_.partial : names_.result);
    print_lists(best);
    const SweepTimes times{monotonic_now() - sweep_.options().started, sweep_.info().compile_seconds, state_.awaited_kernels(),
                           file_.seconds(), file_.bytes()};
    sweep_.print_text("\n" + closing_lines(files, times));
    const std::string& alternative = sweep_.choice().alternative;
    if (!alternative.empty()) sweep_.print_text(backend_line(sweep_.info(), times, alternative));
  }

 private:
  // Completes the figures of the grips of each list by the core, except scores. A device would have to compile kernels with more outputs, for a few
  // grips.
  void describe(BestLists& lists) const {
    if (std::all_of(lists.begin(), lists.end(), [](const auto& list) { return list.empty(); })) return;
    const std::unique_ptr<Backend> core = sweep_.parts().open_core(scene_, make_field_set(best_fields(scene_), scene_));
    for (std::size_t list = 0; list < lists.size(); ++list) {
      evaluate_best(*core, scene_, list / plan_.hand_scales(), lists[list]);
      for (BestGrip& grip : lists[list]) grip.score = grip.candidate.score;
    }
  }

  // Pictures, the list of the best grips, and those as glTF. Returns the names of the files, as the closing lines show them.
  std::vector<std::string> write_companions(const BestLists& best) {
    std::vector<std::string> files = draw_maps();
    if (sweep_.best_wanted() > 0) {
      const ListOrigin origin = list_origin(names_.result, origin_of(scene_, version(), sweep_.info()));
      write_whole_file(names_.best, best_csv(scene_, plan_, best, origin), false);
      files.insert(files.begin(), names_.best);
    } else if (is_best_list(names_.best)) {
      std::remove(names_.best.c_str());  // of the result that is replaced
    }
    if (const int glb = sweep_.options().glb; glb > 0) {
      const BestGlb written = write_best_glb(scene_, plan_, sweep_.parts().open_evaluator(), best, glb, names_);
      files.insert(files.end(), written.files.begin(), written.files.end());
      for (const std::string& line : written.notes) sweep_.note(line);
    }
    return files;
  }

  // Returns their files.
  std::vector<std::string> draw_maps() {
    if (!sweep_.has_heat_map()) {
      sweep_.note("no heat maps: the score is not kept ([output] keep)");
      return {};
    }
    std::vector<std::string> files;
    const std::string failure = write_pictures(heat_map_files(sweep_pictures(scene_, plan_, state_.maps(), names_)), &files);
    if (!failure.empty()) sweep_.note(failure);
    return files;
  }

  void write_result(const BestLists& best, bool is_parted, ChecksumParts checksums) {
    // Syncs the values first, so that little time passes between the ending, which no earlier mark fits, and the mark that vouches for it.
    if (state_.is_saved()) state_.save(file_);
    file_.write_ending(best, state_.wall_seconds(), state_.mark().kernel_seconds);
    if (is_parted) state_.mark().shards->is_ended = true;
    if (state_.is_saved() || is_parted) state_.save(file_);  // which now vouches for the ending, too
    if (!is_parted) file_.finish(std::move(checksums));
  }

  Ranking rank_finished(RankRequest request) const {
    SweepResult result(names_.result);
    result.use(scene_, plan_);
    if (request.best == 0) request.best = usual_length(result, scene_, plan_);
    return rank_grips(result, scene_, plan_, request, sweep_.parts().open_evaluator);
  }

  void print_lists(const BestLists& best) const {
    ListView view = sweep_.options().list;
    view.by = sweep_.by();
    const std::vector<std::string> failures = unheld_lists(best);
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
      const std::string& name = scene_.vessels[v].name;
      const std::string failure = unheld(v), counts = counts_text(v);
      view.score_tolerance = score_tolerance(effective_weights(scene_), sweep_.gate(v));
      if (sweep_.is_quiet() && !failure.empty()) sweep_.note(name + ": " + failure);
      sweep_.print_text("\n" + (!failure.empty() ? fmt::format("{}: {}\n  {}\n", name, failure, counts)
                                : sweep_.best_wanted() == 0
                                    ? fmt::format("{}: {}\n", name, counts)
                                    : best_lines(scene_, plan_, v, counts, best, failures, names_.best, view)));
    }
  }

  // Whether the result has what `rank --least-bad` needs.
  bool keeps_least_bad() const {
    int kept = 0;
    for (const Variable* variable : sweep_.variables())
      for (const std::string_view name : {"plausible", "not_held", "worst_effort", "score"}) kept += variable->name == name ? 1 : 0;
    return kept == 4;
  }

  const GripCounts& counts_of(std::size_t v) const { return state_.mark().vessels[v].counts; }

  // The note for a vessel without a holding grip.
  std::string unheld(std::size_t v) const {
    const GripCounts& counts = counts_of(v);
    if (!counts.none_holds() || !counts.least_bad.is_known()) return "";
    const std::shared_ptr<const Evaluator> core = sweep_.parts().open_evaluator();
    return fmt::format(
        "{}{}", unheld_line(*core, scene_, plan_, v, with_least_friction(*core, scene_, plan_, v, counts.least_bad)),
        keeps_least_bad() ? fmt::format("; `wholehand rank {} --least-bad` lists such grips", one_line(names_.result)) : "");
  }

  // The same for each list, if others of its vessel have grips (with several hand scales). The marks only know the nearest grip of a vessel, so this
  // reads the finished result.
  std::vector<std::string> unheld_lists(const BestLists& best) const {
    bool is_any = false;
    for (std::size_t list = 0; list < best.size(); ++list) {
      const GripCounts& counts = counts_of(list / plan_.hand_scales());
      is_any = is_any || (best[list].empty() && counts.not_held > 0 && !counts.none_holds());
    }
    if (!is_any || sweep_.is_quiet() || sweep_.best_wanted() == 0 || !keeps_least_bad() || state_.has_shards())
      return std::vector<std::string>(best.size());
    return unheld_lines(*sweep_.parts().open_evaluator(), scene_, plan_, rank_finished({"", {}, 1, 0, 0, true}));
  }

  std::string counts_text(std::size_t v) const {
    const GripCounts& counts = counts_of(v);
    const bool is_known = sweep_.has_field(FIELD_STATUS);
    const std::string gate_line = gate_text(counts.at_gate, sweep_.gate(v));
    return (sweep_.options().list.is_wide ? counts_line(counts, is_known, plan_.copies())
                                          : short_counts_line(counts, is_known, plan_.copies(), has_effort(scene_))) +
           (gate_line.empty() ? "" : "\n  " + gate_line);
  }

  const Sweep& sweep_;
  SweepState& state_;
  ResultFile& file_;
  const Scene& scene_;
  const Plan& plan_;
  const OutputNames& names_;
};

}  // namespace

BestLists find_best(const Sweep& sweep, const SweepState& state) {
  BestLists lists;
  const Plan& plan = sweep.plan();
  for (std::size_t v = 0; v < sweep.scene().vessels.size(); ++v) {
    const HandLists kept(plan, sweep.candidates(), state.mark().vessels[v].best);
    for (std::size_t s = 0; s < plan.hand_scales(); ++s) {
      std::vector<BestGrip>& list = lists.emplace_back();
      for (const Candidate& candidate : kept.sorted(s)) list.push_back(bare_grip(plan, v, candidate));
    }
  }
  return lists;
}

bool choose_best(const Sweep& sweep, BestLists& best, InterruptGuard& interrupt) {
  const auto look = [&] {
    if (sweep.is_asked_to_end(interrupt)) interrupt.flag() = true;
    return interrupt.flag().load();
  };
  const std::size_t wanted = sweep.best_wanted();
  if (wanted > 0 && !rank_robustly(sweep.parts().open_core, sweep.scene(), sweep.plan(), wanted, &interrupt.flag(), best, look))
    return false;
  return !sweep.refines() || refine_lists(*sweep.evaluator(), sweep.scene(), sweep.plan(), sweep.options().threads, best, look);
}

void publish(const Sweep& sweep, SweepState& state, ResultFile& file, BestLists best, ChecksumParts checksums) {
  Ending(sweep, state, file).publish(std::move(best), std::move(checksums));
}

}  // namespace wholehand::sweeps
