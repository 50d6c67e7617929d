// SPDX-License-Identifier: MIT
// A sweep step by step: what one process does from start to end (run_sweep), and what the ranks of a cluster share.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/system/interrupt.h"
#include "base/system/progress.h"
#include "base/text/error.h"
#include "core/scene.h"
#include "sweeps/lists/list_chooser.h"
#include "sweeps/plan/plan.h"
#include "sweeps/plan/variables.h"
#include "sweeps/rank/rank.h"
#include "sweeps/result/heat_map.h"
#include "sweeps/result/mark.h"
#include "sweeps/result/output_names.h"
#include "sweeps/result/result_contents.h"
#include "sweeps/result/result_file.h"
#include "sweeps/run/sweep_options.h"
#include "sweeps/run/sweep_parts.h"
#include "sweeps/run/write_companions.h"

namespace wholehand {

class Sweep {
 public:
  // Scene, options and parts must outlive the object.
  Sweep(const Scene& scene, const SweepOptions& options, const BackendChoice& choice, const SweepParts& parts);
  virtual ~Sweep() = default;
  Sweep(const Sweep&) = delete;
  Sweep& operator=(const Sweep&) = delete;

  // Everything that run_sweep does.
  virtual ExitCode run();

 protected:
  // Refuses what it can before any work, with meshes unread.
  void check() const;
  // Whether there is nothing to resume because the result is complete, and the message for that.
  bool is_already_complete() const;
  ExitCode report_already_complete() const;
  // Handles meshes and devices: afterwards plan(), backend_, evaluator_ and facts_ exist. If the core takes a device's place, in another precision,
  // checks the disk space again.
  void open();
  void print_header() const;
  // A note goes to options.hooks.note if that is set, and print_text then prints nothing; otherwise to standard error.
  void note(const std::string& line) const;
  void print_text(const std::string& text) const;
  bool is_quiet() const { return static_cast<bool>(options_.hooks.note); }
  // Sets the progress: from the mark of an earlier sweep to resume, if there is one, else nothing done. True: resumed.
  bool begin();
  // Recomputes a stretch that the file no longer holds as it was written. False: interrupted. Throws Error (failure) if the result differs.
  bool repair_stretch(std::size_t vessel, const Stretch& stretch, ResultFile& file, InterruptGuard& interrupt);
  // Computes a stretch that the file does not hold. The same results.
  bool restore_stretch(std::size_t vessel, const Stretch& stretch, ResultFile& file, InterruptGuard& interrupt);
  // The beginning of a note about this process's own work, if others work on the same sweep.
  virtual std::string rank_prefix() const { return ""; }
  // Syncs everything up to here to the disk, then saves the mark that says so.
  void save(ResultFile& file);
  ExitCode interrupted() const;
  // Does what follows the last grip. If that fails, the mark covers all grips, as far as it can be written.
  void run_and_save_on_failure(ResultFile& file, const std::function<void()>& ending);
  // The places of the grips of each list; the final choice with refined grips and robust scores (false if interrupted); and the files, once
  // everything is known.
  BestLists find_best() const;
  bool choose_best(BestLists& best, InterruptGuard& interrupt) const;
  void publish(ResultFile& file, BestLists best);

  const Plan& plan() const { return *plan_; }
  ResultContents contents() const;
  double gate(std::size_t vessel) const;  // gate_tolerance (core/tolerances.h)
  std::map<std::string, std::string> identity() const;
  bool needs_distinct_grips() const;            // whether the best grips must differ
  bool refines() const;                         // whether it searches for better grips near the best ones
  std::size_t candidates() const;               // grips of a list from which the best are finally chosen
  std::size_t pool() const;                     // grips of a list that one pass keeps
  std::size_t kept_best() const;                // grips of a list that are kept until all grips have come
  bool skips_hopeless_efforts() const;          // whether only grips that may still be listed get efforts
  bool ranks_here() const;                      // whether the best are found from scores read back, not by the backend
  bool has_field(int field) const;              // whether it is read back
  bool has_heat_map() const;                    // whether scores and status are read back, and the score is wanted
  ListRequest list_request() const;             // of the best grips
  std::uint64_t total() const;                  // grips of all vessels
  std::uint64_t done() const;                   // of them in mark_
  bool has_shards() const;                      // whether other files hold some of them
  bool is_time_up() const;                      // the sweep's time limit has passed
  bool is_asked_to_end(InterruptGuard&) const;  // by a signal, or by the time limit
  bool is_mark_due() const;
  RunRequest grips_of(std::size_t vessel, InterruptGuard& interrupt) const;   // everything but what is done with them
  void note_once(const std::vector<std::string>& notes, Progress* progress);  // which may be null
  static void choose_from_pass(ListChooser& chooser, VesselProgress& vessel, const ListChooser::PoseHands& pose = {});

  const Scene& scene_;
  const SweepOptions& options_;
  BackendChoice choice_;
  const SweepParts& parts_;
  OutputNames names_;
  std::size_t best_wanted_;
  RankBy by_;  // the criterion of the shown and written lists
  std::vector<const Variable*> variables_;
  std::optional<Plan> plan_;
  std::unique_ptr<Backend> backend_;
  BackendInfo info_;                      // the backend's
  BackendInfo identified_;                // the same as in a mark: for ranks without their number
  std::unique_ptr<Evaluator> evaluator_;  // poses and refines the best grips; null if neither is requested
  std::vector<VesselFacts> facts_;
  std::vector<HeatMap> maps_;  // one per vessel
  SweepMark mark_;
  bool is_marked_ = false;   // a mark of this sweep exists
  ChecksumParts checksums_;  // of the result, as far as ranks have found some
  double wait_seconds_ = 0;  // in the backend, without its time in the sink
  double kernel_seconds_ = 0;

 private:
  void check_room() const;       // on the disk
  bool has_usual_order() const;  // or the lists are finally ranked by another key
  Ranking rank_finished(const RankRequest& request) const;
  CompanionRequest companions() const;
  std::vector<int> swept_fields() const;
  bool has_score() const;
  bool keeps_least_bad() const;
  std::string unheld(std::size_t vessel) const;
  std::vector<std::string> unheld_lists(const BestLists& best) const;
  std::string counts_text(std::size_t vessel) const;
  MarkBounds bounds() const;
  void announce_check() const;
  bool repair(ResultFile& file, InterruptGuard& interrupt);
  std::string readable_stretch(const Stretch& stretch, std::size_t vessel) const;
  bool compute_again(std::size_t v, const Stretch& stretch, ResultFile& file, InterruptGuard& interrupt);
  bool sweep(ResultFile& file, InterruptGuard& interrupt);
  void run_stretch(std::size_t v, ResultFile& file, InterruptGuard& interrupt, Progress& progress);
  bool choose(std::size_t v, ResultFile& file, InterruptGuard& interrupt);
  void reset_score_cache();
  void cache_scores(const std::vector<Candidate>& eligible, std::size_t of_grips);
  void pass_cached_scores(ListChooser& chooser) const;
  bool pass_again(std::size_t v, ListChooser& chooser, InterruptGuard& interrupt);

  double wall_before_ = 0;  // of earlier sessions, s
  double mark_interval_;
  double last_mark_ = 0;  // s of the clock
  std::set<std::string> noted_;
  std::vector<double> score_cache_;  // scores of the current vessel; NaN: not eligible. Empty: not kept
  std::uint64_t cached_count_ = 0;   // grips whose outcome is included
};

}  // namespace wholehand
