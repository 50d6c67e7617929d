// SPDX-License-Identifier: MIT
// Measures a variant's error and time on the same grips and states as all others.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "evidence/check/error_reference.h"
#include "evidence/check/error_row.h"
#include "evidence/check/error_variants.h"

namespace wholehand {

struct MeasureOptions {
  std::string on;  // the device, as for open_backend, but not "core"
  int threads = 1;
  std::uint64_t seed = 1;
  std::size_t grips = 2048;   // of each vessel
  int runs = 7;               // timed
  double run_seconds = 0.05;  // shortest timed run: repeats the grips as often as needed
  // Number of variants held ready and timed in turns: the first run of each, then the second of each, ..
  std::size_t group = 32;
  std::size_t group_bytes = std::size_t(1) << 30;  // .. fewer if their tables and chunks together take more
  const std::atomic<bool>* stop = nullptr;
};

// Progress for a waiting user: variants compared so far, and the name of the current one.
using MeasureProgress = std::function<void(std::size_t compared, const std::string& what)>;

// Keeps the grips, the reference's answers and the evaluator used last.
class ErrorMeasure {
 public:
  // Throws Error as the evaluators do.
  ErrorMeasure(const Scene& scene, const MeasureOptions& options);

  // One row per variant, in order; fewer, and without times, if MeasureOptions::stop was set. Throws Error: the device fails.
  std::vector<ErrorRow> measure(const std::vector<ErrorVariant>& variants, const MeasureProgress& progress = {});
  ErrorRow measure(const ErrorVariant& variant) { return measure(std::vector<ErrorVariant>{variant}).front(); }

  const std::vector<std::vector<GripInput>>& grips() const { return grips_; }  // by vessel
  std::uint64_t feasible() const { return reference_.feasible(); }             // by the reference
  std::uint64_t grazing() const { return reference_.grazing(); }
  std::vector<std::string> notes() const { return notes_; }  // of backends, each once

 private:
  struct Opened;
  struct Timed;
  Opened open(const ErrorVariant& variant, const FieldSet& fields);
  std::shared_ptr<const Evaluator> evaluator(const ErrorVariant& variant, Precision precision);
  ErrorRow compared_row(const ErrorVariant& variant);
  bool stopped() const { return options_.stop && options_.stop->load(); }
  Timed warmed(const ErrorVariant& variant, ErrorRow& row);
  double timed_run(Timed& timed);
  void time(std::vector<Timed>& group, std::vector<Timed>& bases);

  const Scene& scene_;
  MeasureOptions options_;
  std::vector<std::vector<GripInput>> grips_;
  ErrorReference reference_;
  std::shared_ptr<const Evaluator> last_;  // and what it was made for
  const Scene* last_scene_ = nullptr;
  EvaluatorOptions last_options_;
  std::vector<std::string> notes_;
};

}  // namespace wholehand
