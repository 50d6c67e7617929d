// SPDX-License-Identifier: MIT
// What a sweep has done so far: its progress mark, kept in memory and saved from time to time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "base/system/progress.h"
#include "base/text/error.h"
#include "sweeps/lists/list_chooser.h"
#include "sweeps/result/heat_map.h"
#include "sweeps/result/mark.h"
#include "sweeps/result/result_file.h"
#include "sweeps/run/sweep.h"

namespace wholehand::sweeps {

class SweepState {
 public:
  // The sweep must outlive the object.
  explicit SweepState(const Sweep& sweep) : sweep_(sweep) {}

  // Call it once the sweep is open. Resumes from the mark of an earlier sweep if the user asks for it and there is one. Returns whether it does.
  bool begin();
  SweepMark& mark() { return mark_; }
  const SweepMark& mark() const { return mark_; }
  std::vector<HeatMap>& maps() { return maps_; }  // one per vessel
  std::uint64_t done() const;                     // grips of all vessels
  bool has_shards() const;                        // whether other files hold some of them

  // Ends a pass over the grips of a vessel (ListChooser::end_pass): the mark has what is decided.
  void end_pass(std::size_t vessel, ListChooser& chooser, const ListChooser::PoseHands& pose = {});

  // Syncs everything up to here to the disk, then saves the mark that says so.
  void save(ResultFile& file);
  bool is_saved() const { return is_saved_; }  // a mark of this sweep exists
  // Does what follows the last grip. If that fails, the mark covers all grips, as far as it can be written.
  void run_and_save_on_failure(ResultFile& file, const std::function<void()>& ending);
  ExitCode interrupted() const;

  // Runs the request on the backend. Counts the seconds in kernels, and those in the backend outside of the sink.
  RunResult run(RunRequest request);
  double wall_seconds() const;     // of all sessions
  double awaited_kernels() const;  // s in kernels; those that ran while the file was being written cost no time of their own
  // Notes of the backend, each once. `progress` may be null.
  void note_once(const std::vector<std::string>& notes, Progress* progress);

 private:
  MarkBounds bounds() const;
  void announce_check() const;

  const Sweep& sweep_;
  SweepMark mark_;
  std::vector<HeatMap> maps_;
  bool is_saved_ = false;
  double wall_before_ = 0;  // s, of earlier sessions
  double kernel_seconds_ = 0, wait_seconds_ = 0;
  std::set<std::string> noted_;
};

}  // namespace wholehand::sweeps
