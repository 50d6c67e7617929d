// SPDX-License-Identifier: MIT
// What a sweep gets besides its scene: options, and the parts with which it computes.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/system/clock.h"
#include "core/backend.h"
#include "core/evaluator.h"
#include "core/scene.h"
#include "sweeps/lists/best.h"
#include "sweeps/result/output_bytes.h"

namespace wholehand::sweeps {

// How the caller takes part.
struct SweepHooks {
  // Called once meshes are read: tells the user about the scene in that precision. May be empty.
  std::function<void(const Scene&, Precision)> warn = {};
  // Takes the notes of the work, a line each. If it is set, the sweep is part of another program: it prints nothing and shows no progress. Empty:
  // notes go to standard error.
  std::function<void(const std::string&)> note = {};
};

// Numbers that change the sweep's work, but none of its values.
struct SweepTuning {
  std::size_t pool = 0;  // grips of a list that a pass keeps (sweeps/lists/list_chooser.h); 0: usual_pool
  // Scores of one vessel's grips that are kept for further passes, 8 B each; with more grips each pass evaluates all of them again.
  std::size_t cached_scores = std::size_t{1} << 22;
  double mark_seconds = 5;   // least time between two progress marks: the most that a crash may cost
  double piece_seconds = 2;  // least duration of the piece of work that a rank of a cluster takes
};

// What the user asks for.
struct SweepOptions {
  std::string output = {};                  // NAME.nc; empty: the scene file's name with .nc, in the working directory
  std::string on = "vulkan";                // see open_backend; or ON_AUTO (sweeps/run/auto_backend.h)
  std::optional<Precision> precision = {};  // absent: double on the core, float elsewhere
  std::optional<int> best = {};             // absent: the scene's
  int glb = 0;                              // this many of the best of each vessel are written as glTF
  bool resume = false;
  bool explain = false;
  ListView list = {};  // how each list is printed; `by` is not read
  std::string rank_by =
      {};                 // the criterion of the lists, as from read_rank_by; the result's best grips always have the usual order
  bool refine = true;     // the best grips, see sweeps/lists/refine.h
  int threads = 0;        // of the core, 0: all
  double time_limit = 0;  // s after `started` at which the sweep ends as if interrupted; 0: none
  double started = monotonic_now();  // s of the clock: when the work was requested, for the closing lines too
  // For machines without a shared file system: those with the same name write into one file; empty: those of a node. Absent: all into one.
  std::optional<std::string> shards = {};
  SweepHooks hooks = {};
  SweepTuning tuning = {};
};

// Where a sweep computes. It is chosen once, before the sweep begins (sweeps/run/auto_backend.h).
struct BackendChoice {
  std::string on = "core";  // see open_backend
  Precision precision = Precision::full;
  std::string alternative = {};  // the time of the other backend, or what it lacks; completes the sentence of backend_line
  std::optional<Precision> fallback_precision = {};  // of the core, in place of a device that fails; absent: the choice stands
};

// What a sweep gets from elsewhere. Tests supply their own.
struct SweepParts {
  std::function<std::unique_ptr<Backend>(const BackendChoice&, const FieldSet&)> open_backend;
  std::function<std::unique_ptr<Evaluator>()> open_evaluator;  // for vessel facts that no grip changes
  // Slow work after all checks that can be made at once (meshes); may be empty. Returns where the sweep goes on, as with_core_fallback does.
  std::function<BackendChoice(const BackendChoice&)> prepare = {};
  // Opens the core for the sweep's scene, or for one that differs from it only in its friction. It evaluates listed grips and their deviations, so
  // that lists are the same on every device.
  std::function<std::unique_ptr<Backend>(const Scene&, const FieldSet&)> open_core = {};
  OpenOutput open_output = {};  // writes the values; empty: the system's own calls
};

}  // namespace wholehand::sweeps
