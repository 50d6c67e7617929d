// SPDX-License-Identifier: MIT
// The core as a backend: chunks of grips on all threads.
#pragma once

#include <memory>

#include "core/backend.h"
#include "core/evaluator.h"

namespace wholehand {

// The core's description of itself on `threads` threads.
BackendInfo core_info(Precision precision, int threads);

// Threads take chunks in ascending order, and the thread that called run delivers them in that order, so results do not depend on the number of
// threads. At most two chunks per thread wait for delivery, so memory is bounded for any number of grips.
class CoreBackend final : public Backend {
 public:
  // `threads`: 0 takes all. `precision` is that of the evaluator's arithmetic; its planes are doubles either way.
  CoreBackend(std::shared_ptr<const Evaluator> evaluator, const Scene& scene, const FieldSet& fields, Precision precision,
              int threads);

  const BackendInfo& info() const override { return info_; }
  const FieldSet& fields() const override { return fields_; }
  // Calls the sink for every chunk, even if no plane is kept. An exception of the evaluator, the grips or the sink ends the run and is rethrown.
  // `kernel_seconds`: wall time in which at least one thread was evaluating.
  RunResult run(const RunRequest& request) override;
  std::vector<LiquidResult> liquid(std::size_t vessel) override;
  // Remakes the evaluator with its precision and the options of users. Not during a run.
  bool use_fills_of(const Scene& other) override;

 private:
  Scene scene_;
  std::shared_ptr<const Evaluator> evaluator_;
  FieldSet fields_;
  BackendInfo info_;
  int threads_;
};

}  // namespace wholehand
