// SPDX-License-Identifier: MIT
// What a sweep computes and with what: the same for one process (run.cpp) and for each rank of a cluster. SweepState has what is done.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/system/interrupt.h"
#include "base/text/error.h"
#include "core/scene.h"
#include "sweeps/lists/list_chooser.h"
#include "sweeps/plan/plan.h"
#include "sweeps/plan/variables.h"
#include "sweeps/result/output_names.h"
#include "sweeps/result/result_contents.h"
#include "sweeps/result/result_file.h"
#include "sweeps/run/sweep_options.h"

namespace wholehand::sweeps {

class Sweep {
 public:
  // Scene, options and parts must outlive the object. `rank_prefix` begins the notes about this process's own work, if others work on the same sweep.
  Sweep(const Scene& scene, const SweepOptions& options, const BackendChoice& choice, const SweepParts& parts,
        std::string rank_prefix = "");
  Sweep(const Sweep&) = delete;
  Sweep& operator=(const Sweep&) = delete;

  // ---- the steps before the first grip ----

  // Whether there is nothing to resume because the result is complete, and the message for that.
  bool is_already_complete() const;
  ExitCode report_already_complete() const;
  // Refuses what it can before any work, with meshes unread.
  void check() const;
  // Reads the meshes and opens the devices. What is declared below under "what has been opened" exists only afterwards. Checks the disk space again if
  // the core takes a device's place in another precision.
  void open();
  // For a sweep on several devices: the result names all, and a mark only their kinds.
  void name_devices(const std::string& devices, const std::string& kinds, const std::string& drivers);
  void print_header() const;

  // ---- messages ----

  // A note goes to the hook if that is set, and print_text then prints nothing; otherwise to standard error.
  void note(const std::string& line) const;
  void print_text(const std::string& text) const;
  bool is_quiet() const { return static_cast<bool>(options_.hooks.note); }
  const std::string& rank_prefix() const { return rank_prefix_; }

  // ---- what is asked for ----

  const Scene& scene() const { return scene_; }
  const SweepOptions& options() const { return options_; }
  const BackendChoice& choice() const { return choice_; }
  const SweepParts& parts() const { return parts_; }
  const OutputNames& names() const { return names_; }
  const std::vector<const Variable*>& variables() const { return variables_; }
  std::size_t best_wanted() const { return best_wanted_; }  // grips of a list
  RankBy by() const { return by_; }                         // the criterion of the shown and written lists
  bool has_usual_order() const;                             // or the lists are finally ranked by another key
  bool needs_distinct_grips() const;                        // whether the best grips must differ
  bool refines() const;                                     // whether it searches for better grips near the best ones
  std::size_t candidates() const;                           // grips of a list from which the best are finally chosen
  bool is_asked_to_end(InterruptGuard& interrupt) const;    // by a signal, or by the time limit
  bool is_time_up() const;                                  // the sweep's time limit has passed

  // ---- what has been opened ----

  const Plan& plan() const { return *plan_; }
  std::uint64_t total() const;  // grips of all vessels
  Backend& backend() const { return *backend_; }
  const FieldSet& fields() const { return backend_->fields(); }
  bool has_field(int field) const;  // whether it is read back
  bool has_heat_map() const;        // whether scores and status are read back, and the score is wanted
  bool ranks_here() const;          // whether the best are found from scores read back, not by the backend
  const Evaluator* evaluator() const { return evaluator_.get(); }  // poses and refines the best grips; null if neither is requested
  const BackendInfo& info() const { return info_; }                // the backend's
  double gate(std::size_t vessel) const;                           // gate_tolerance (core/tolerances.h)
  std::size_t kept_best() const;                                   // grips of a list that are kept until all grips have come
  ListRequest list_request() const;                                // of the best grips
  ResultContents contents() const;                                 // refers to the sweep
  std::map<std::string, std::string> identity() const;             // what must be the same for another sweep to continue this one

  // ---- passes over grips ----

  // Everything but what is done with the grips [first, last) of a vessel.
  RunRequest grips_of(std::size_t vessel, std::uint64_t first, std::uint64_t last, InterruptGuard& interrupt) const;
  // Throws Error (failure) unless the backend handed over all grips that it has done: all of them, or none if none is kept. It may do nothing only if
  // `may_end`.
  void check_delivered(const RunResult& result, std::uint64_t delivered, bool may_end) const;
  // Recomputes a stretch if the file no longer holds it as it was written. False: interrupted. Throws Error (failure) if the result differs.
  bool repair_stretch(std::size_t vessel, const Stretch& stretch, ResultFile& file, InterruptGuard& interrupt) const;
  // Computes a stretch that the file does not hold. The same results.
  bool restore_stretch(std::size_t vessel, const Stretch& stretch, ResultFile& file, InterruptGuard& interrupt) const;

 private:
  void check_room() const;  // on the disk
  std::size_t pool() const;
  std::vector<int> swept_fields() const;
  bool has_score() const;
  std::string readable_stretch(const Stretch& stretch, std::size_t vessel) const;

  const Scene& scene_;
  const SweepOptions& options_;
  BackendChoice choice_;
  const SweepParts& parts_;
  std::string rank_prefix_;
  OutputNames names_;
  std::size_t best_wanted_;
  RankBy by_;
  std::vector<const Variable*> variables_;
  std::optional<Plan> plan_;
  std::unique_ptr<Backend> backend_;
  BackendInfo info_, identified_;  // what the result names, and what a mark names
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<VesselFacts> facts_;
};

}  // namespace wholehand::sweeps
