// SPDX-License-Identifier: MIT
// What a variant costs in error and takes in time, on the same grips and states as all others.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evidence/compare.h"
#include "evidence/error_variants.h"

namespace wholehand {

enum ErrorQuantity : int {
  ERROR_SEPARATION,  // um, of points that the reference has inside or within GRID_BAND of the surface
  ERROR_POSED,       // um, distance between posed joints
  ERROR_PROXY,       // um, distance between proxies
  ERROR_CLOSURE,
  ERROR_GAP,       // um
  ERROR_VOLUME,    // mL, of the liquid left
  ERROR_COM,       // um, of glass and liquid together
  ERROR_TORQUE,    // N m, the one that the scene renders
  ERROR_FEEDBACK,  // N
  ERROR_HOLD,      // N, where it is finite on both sides
  ERROR_QUANTITIES
};

// Over grips, each with the largest difference among its points or states; over states for the liquid's two. NaN where nothing compares.
struct ErrorFigures {
  double median, p999, max;
  std::string worst;  // vessel:index of the sampled grip, or of the state, fill-major
  std::uint64_t compared = 0;
};

// By nearest rank, NaN-safe: a value that only one side lacks is infinite. `where` names each error's place.
ErrorFigures figures_of(const std::vector<double>& errors, const std::vector<std::string>& where);

// A time by several runs of it.
struct TimeFigures {
  double median = 0, spread = 0;  // s; the spread is between the quartiles
};

// Of a variant: in units of the base's median beside it (runs interleaved with the variant's), times the base's median over all its runs, so
// that a machine that is slower for minutes makes nobody slow who is timed then. Without a base, or one that took no time: as they are.
TimeFigures time_figures(std::vector<double> runs, const std::vector<double>& base_beside = {},
                         const std::vector<double>& base_all = {});

// More than a 99.9th percentile leaves out.
constexpr bool above_one_in_1000(std::uint64_t some, std::uint64_t all) { return 1000 * some > all; }

struct ErrorRow {
  ErrorVariant variant;
  std::array<ErrorFigures, ERROR_QUANTITIES> errors;
  std::uint64_t grips = 0;  // of all vessels, whether compared or not
  std::optional<std::uint64_t> touch_flips, touch_flips_outside, feasible_flips;
  std::uint64_t hold_flips = 0;  // compared grips whose hold force is finite on one side alone, in some state
  double seconds_per_grip = 0;   // in the kernels of a sweep, median of the runs
  double spread = 0;             // s, between the quartiles of the runs
  ErrorFigures distance{};       // um, of a grid on the core at points about the glass
  double touch_margin = 0;       // m: a touch flip nearer to the contact tolerance is inside it
  double liquid_seconds = 0;     // of one state's liquid on the core; 0: none
  std::size_t memory_bytes = 0;  // tables and grids, and inputs and planes of a sweep of one vessel's grips
  std::string device, driver;

  // Largest of the lengths' 99.9th percentiles, um (separation, posed joints, proxies, gap, centre of mass), and of the forces', N; a hold
  // force on one side alone is wrong by infinity. NaN: the variant answers another question, or nothing of it compares.
  double length_error() const;
  double force_error() const;
  // On more than one grip in 1,000 it is of another mind whether they are feasible at all: what its errors leave out is no detail.
  bool flips_too_often() const { return feasible_flips && above_one_in_1000(*feasible_flips, grips); }
};

struct MeasureOptions {
  std::string on;  // the device; as open_backend, but for "core"
  int threads = 1;
  std::uint64_t seed = 1;
  std::size_t grips = 2048;   // of each vessel
  int runs = 7;               // timed
  double run_seconds = 0.05;  // of one timed run, at least: the grips are gone through as often as that takes
  // Variants that are held ready and timed in turns, the first run of each, then the second of each, ..
  std::size_t group = 32;
  std::size_t group_bytes = std::size_t(1) << 30;  // .. fewer where their tables and chunks together take more
  const std::atomic<bool>* stop = nullptr;
};

// What is being done, for a user who waits: variants compared so far, and the name of the one under way.
using MeasureProgress = std::function<void(std::size_t compared, const std::string& what)>;

// Keeps the grips, the reference's answers and the evaluator used last.
class ErrorMeasure {
 public:
  // Throws Error as the evaluators do.
  ErrorMeasure(const Scene& scene, const MeasureOptions& options);

  // A row a variant, in their order; fewer, and without times, where MeasureOptions::stop was set. Throws Error: the device fails.
  std::vector<ErrorRow> measure(const std::vector<ErrorVariant>& variants, const MeasureProgress& progress = {});
  ErrorRow measure(const ErrorVariant& variant) { return measure(std::vector<ErrorVariant>{variant}).front(); }

  const std::vector<std::vector<GripInput>>& grips() const { return grips_; }  // by vessel
  std::uint64_t feasible() const { return feasible_; }                         // by the reference
  std::uint64_t grazing() const { return grazing_; }
  std::vector<std::string> notes() const { return notes_; }  // of backends, each once

 private:
  struct Opened;
  struct Timed;
  Opened open(const ErrorVariant& variant, const FieldSet& fields);
  std::shared_ptr<const Evaluator> evaluator(const ErrorVariant& variant, Precision precision);
  ErrorRow compared_row(const ErrorVariant& variant);
  void compare(const std::vector<GatheredPlanes>& planes, const Evaluator& core, ErrorRow& row) const;
  void compare_liquid(const std::vector<std::vector<LiquidResult>>& liquid, const Evaluator& core, ErrorRow& row) const;
  ErrorFigures compare_distance(const Evaluator& core) const;
  double nearby_distance_error(const Evaluator& core) const;
  bool stopped() const { return options_.stop && options_.stop->load(); }
  Timed warmed(const ErrorVariant& variant, ErrorRow& row);
  double timed_run(Timed& timed);
  void time(std::vector<Timed>& group, std::vector<Timed>& bases);

  const Scene& scene_;
  MeasureOptions options_;
  std::vector<std::vector<GripInput>> grips_;
  std::shared_ptr<const Evaluator> reference_;
  std::vector<GatheredPlanes> truth_;
  std::vector<std::vector<LiquidResult>> true_liquid_;
  // by vessel: where the reference has joints whose skin is within GRID_BAND of the surface
  std::vector<std::vector<Triple>> nearby_;
  std::shared_ptr<const Evaluator> last_;  // and what it was made for
  const Scene* last_scene_ = nullptr;
  EvaluatorOptions last_options_;
  std::uint64_t feasible_ = 0, grazing_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace wholehand
