// SPDX-License-Identifier: MIT
// The reference core as a backend: chunks of grips on all threads.
#pragma once

#include <memory>

#include "core/backend.h"
#include "core/evaluator.h"

namespace wholehand {

// The core's description of itself on `threads` threads.
BackendInfo core_info(Precision precision, int threads);

// Chunks are handed out to threads in ascending order and delivered in that order on the thread that called run, so nothing depends
// on how many threads there are. At most two chunks per thread wait for delivery: memory is bounded whatever the number of grips.
class CoreBackend final : public Backend {
 public:
  // `threads`: 0 takes all. `precision` is that of the evaluator's arithmetic; its planes are doubles either way.
  CoreBackend(std::shared_ptr<const Evaluator> evaluator, const Scene& scene, const FieldSet& fields, Precision precision,
              int threads);

  const BackendInfo& info() const override { return info_; }
  const FieldSet& fields() const override { return fields_; }
  // Calls the sink for every chunk also when no plane is kept. An exception of the evaluator, the grips or the sink ends the run and
  // is thrown on. `kernel_seconds`: wall time in which at least one thread was evaluating.
  RunResult run(const RunRequest& request) override;
  std::vector<LiquidResult> liquid(std::size_t vessel) override;
  // Makes the evaluator anew, with its precision and the options of users. Not during a run.
  bool use_fills_of(const Scene& other) override;

 private:
  Scene scene_;
  std::shared_ptr<const Evaluator> evaluator_;
  FieldSet fields_;
  BackendInfo info_;
  int threads_;
};

}  // namespace wholehand
