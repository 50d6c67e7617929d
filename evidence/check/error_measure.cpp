// SPDX-License-Identifier: MIT
#include "evidence/check/error_measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/system/clock.h"
#include "core/core_backend.h"
#include "host/grip_backend.h"
#include "sweeps/plan/plan.h"
#include "sweeps/plan/variables.h"

namespace wholehand {
namespace {

constexpr std::size_t LARGEST_TIMED_RUN = 1 << 20;  // timed grips of a vessel
constexpr std::size_t CHUNKS_IN_FLIGHT = 3;         // of a device, at most, and what all of them may take
const std::size_t CHUNKS_BYTES = CHUNKS_IN_FLIGHT * host::StreamOptions().slot_bytes;

// Random grips within the scene's axes: its own as Sobol points, by the seed. Alike ones follow each other, by height the last, as in a
// sweep: a device evaluates neighbors together.
std::vector<std::vector<GripInput>> random_error_grips(const Scene& scene, std::size_t count, std::uint64_t seed) {
  Scene sampled = scene;
  sampled.grips.sampling = Sampling::sobol;
  sampled.grips.count = count;
  sampled.grips.seed = seed;
  const sweeps::Plan plan(sampled, true);
  std::vector<std::vector<GripInput>> grips(scene.vessels.size(), std::vector<GripInput>(count));
  const auto part = [](const Axis& axis, double value, double parts) {
    const auto [low, high] = std::minmax_element(axis.values.begin(), axis.values.end());
    return *high > *low ? std::floor((value - *low) / (*high - *low) * parts) : 0;
  };
  const auto place = [&](const GripInput& g) {
    return std::array{part(scene.grips.azimuth, g.azimuth, 2), part(scene.grips.obliquity, g.obliquity, 4),
                      part(scene.grips.roll, g.roll, 12), part(scene.grips.offset, g.offset, 2), g.height};
  };
  for (std::size_t v = 0; v < grips.size(); ++v) {
    plan.fill(v, 0, count, grips[v].data());
    std::stable_sort(grips[v].begin(), grips[v].end(), [&](const GripInput& a, const GripInput& b) { return place(a) < place(b); });
  }
  return grips;
}

bool same_evaluator_options(const EvaluatorOptions& a, const EvaluatorOptions& b) {
  return a.lattice_samples == b.lattice_samples && a.lattice_bits == b.lattice_bits && a.quadrature_points == b.quadrature_points &&
         a.stop_tolerance == b.stop_tolerance && a.effort_tolerance == b.effort_tolerance && a.trace_steps == b.trace_steps &&
         a.advance_steps == b.advance_steps && a.gap_table == b.gap_table;
}

}  // namespace

// A variant ready to run.
struct ErrorMeasure::Opened {
  std::shared_ptr<const Evaluator> core;  // whose constants it has
  std::unique_ptr<Backend> backend;
  std::size_t table_bytes = 0, grip_bytes = 0;
};

// A variant being timed.
struct ErrorMeasure::Timed {
  Opened opened;
  ErrorVariant variant;
  std::size_t row = 0;           // its place among the rows
  std::size_t count = 0;         // grips of each vessel in a run
  std::vector<double> runs;      // s a grip
  std::vector<double> all_runs;  // of a base: those of the groups before, too

  // Whether both run on the same kind of machine, so that one's drift is the other's.
  bool is_beside(const Timed& other) const {
    return variant.on_core == other.variant.on_core && variant.precision == other.variant.precision &&
           variant.threads == other.variant.threads;
  }
  std::size_t held_bytes() const {
    const std::size_t chunks = CHUNKS_IN_FLIGHT * opened.grip_bytes * count;
    return opened.table_bytes + (variant.on_core ? 0 : std::min(chunks, CHUNKS_BYTES));
  }
};

ErrorMeasure::ErrorMeasure(const Scene& scene, const MeasureOptions& options)
    : scene_(scene),
      options_(options),
      grips_(random_error_grips(scene, options.grips, options.seed)),
      reference_(scene, grips_, {options.threads, options.seed}) {}

// The one used last again where it is the same: those with a lattice are large and slow to make.
std::shared_ptr<const Evaluator> ErrorMeasure::evaluator(const ErrorVariant& variant, Precision precision) {
  const Scene& scene = variant.scene ? *variant.scene : scene_;
  if (precision == Precision::single) return make_core_float_evaluator(scene, variant.options);
  if (!last_ || last_scene_ != &scene || !same_evaluator_options(last_options_, variant.options)) {
    last_.reset();
    last_ = make_core_evaluator(scene, variant.options);
    last_scene_ = &scene;
    last_options_ = variant.options;
  }
  return last_;
}

ErrorMeasure::Opened ErrorMeasure::open(const ErrorVariant& variant, const FieldSet& fields) {
  const Scene& scene = variant.scene ? *variant.scene : scene_;
  Opened opened;
  if (variant.on_core) {
    opened.core = evaluator(variant, variant.precision);
    opened.backend = std::make_unique<CoreBackend>(opened.core, scene, fields, variant.precision, variant.threads);
    const std::size_t planes = fields.real_planes * sizeof(double) + fields.uint_planes * sizeof(std::uint32_t);
    opened.table_bytes = opened.core->table_bytes();
    opened.grip_bytes = sizeof(GripInput) + planes;
    return opened;
  }
  opened.core = evaluator(variant, Precision::full);
  host::GripBackendOptions device;
  device.precision = variant.precision;
  device.outline = variant.outline;
  device.evaluator = variant.options;
  auto backend = std::make_unique<host::GripBackend>(scene, opened.core, fields, options_.on, device);
  opened.table_bytes = backend->table_bytes();
  opened.grip_bytes = backend->bytes_per_grip();
  opened.backend = std::move(backend);
  return opened;
}

// The first variant of each kind of machine stays ready to the end, to be timed beside the others of its kind.
std::vector<ErrorRow> ErrorMeasure::measure(const std::vector<ErrorVariant>& variants, const MeasureProgress& progress) {
  std::vector<ErrorRow> rows;
  std::vector<Timed> bases, group;
  struct Beside {
    std::size_t row, base;
    std::vector<double> runs, base_runs;
  };
  std::vector<Beside> timed_rows;
  std::size_t bytes = 0;
  for (std::size_t k = 0; k < variants.size() && !stopped(); ++k) {
    if (progress) progress(k, variants[k].name);
    rows.push_back(compared_row(variants[k]));
    Timed timed = warmed(variants[k], rows.back());
    timed.row = k;
    bytes += timed.held_bytes();
    const bool is_base = std::none_of(bases.begin(), bases.end(), [&](const Timed& base) { return base.is_beside(timed); });
    (is_base ? bases : group).push_back(std::move(timed));
    if (k + 1 < variants.size() && group.size() < options_.group && bytes < options_.group_bytes) continue;
    if (progress) progress(k, "timing");
    time(group, bases);
    if (stopped()) break;
    for (Timed& one : group) {
      const auto base = std::find_if(bases.begin(), bases.end(), [&](const Timed& other) { return other.is_beside(one); });
      timed_rows.push_back({one.row, static_cast<std::size_t>(base - bases.begin()), std::move(one.runs), base->runs});
    }
    group.clear();
    bytes = 0;
  }
  if (stopped()) return rows;
  const auto set_time = [&](std::size_t row, const TimeFigures& time) {
    rows[row].seconds_per_grip = time.median;
    rows[row].spread = time.spread;
  };
  for (const Timed& base : bases) set_time(base.row, time_figures(base.all_runs));
  for (const Beside& one : timed_rows) set_time(one.row, time_figures(one.runs, one.base_runs, bases[one.base].all_runs));
  return rows;
}

// All but its time.
ErrorRow ErrorMeasure::compared_row(const ErrorVariant& variant) {
  ErrorRow row;
  row.variant = variant;
  row.errors.fill(error_figures({}, {}));
  const Scene& scene = variant.scene ? *variant.scene : scene_;
  // a device has no states' efforts of its own
  const bool brackets = variant.axis == SweptAxis::effort && variant.on_core;
  const Opened opened = open(variant, reference_fields(scene, brackets));
  row.device = opened.backend->info().device;
  row.driver = opened.backend->info().driver;
  std::vector<GatheredPlanes> planes;
  std::vector<std::vector<LiquidResult>> liquid;
  const double start = monotonic_now();
  for (std::size_t v = 0; v < grips_.size(); ++v) liquid.push_back(opened.backend->liquid(v));
  const double liquid_seconds = monotonic_now() - start;
  if (variant.on_core && !liquid.front().empty())
    row.liquid_seconds = liquid_seconds / static_cast<double>(liquid.size() * liquid.front().size());
  for (std::size_t v = 0; v < grips_.size(); ++v) planes.push_back(gather(*opened.backend, v, grips_[v]));
  reference_.compare(planes, *opened.core, row);
  if (variant.on_core && variant.options.lattice_samples > 0) row.distance = reference_.compare_distance(*opened.core);
  if (variant.comparable.states && !scene_.tilts.empty() && scene_.liquid) reference_.compare_liquid(liquid, *opened.core, row);
  return row;
}

// Ready to be timed as a sweep runs it: with the planes that it keeps. The first run compiles; those after it find out how many grips make a
// run long enough, and let chunks grow.
ErrorMeasure::Timed ErrorMeasure::warmed(const ErrorVariant& variant, ErrorRow& row) {
  const Scene& scene = variant.scene ? *variant.scene : scene_;
  Timed timed;
  timed.opened = open(variant, make_field_set(sweeps::variable_fields(sweeps::choose_variables(scene)), scene));
  timed.variant = variant;
  row.memory_bytes = timed.opened.table_bytes + timed.opened.grip_bytes * options_.grips;
  timed.count = options_.grips;
  double seconds = timed_run(timed);
  if (!variant.on_core) seconds = timed_run(timed);
  for (int growth = 0; growth < 3 && seconds < options_.run_seconds && timed.count < LARGEST_TIMED_RUN && !stopped(); ++growth) {
    const double factor = std::min(1.2 * options_.run_seconds / std::max(seconds, 1e-6), 64.0);
    timed.count = std::min(LARGEST_TIMED_RUN, static_cast<std::size_t>(static_cast<double>(timed.count) * factor) + 1);
    seconds = timed_run(timed);
  }
  return timed;
}

// Seconds in kernels.
double ErrorMeasure::timed_run(Timed& timed) {
  double total = 0;
  for (std::size_t v = 0; v < grips_.size(); ++v) {
    RunRequest request;
    request.vessel = v;
    request.last = timed.count;
    request.best = static_cast<std::size_t>(std::max(0, scene_.output.best));
    request.stop = options_.stop;
    request.grips = [&](std::size_t vessel, std::uint64_t first, std::size_t wanted, GripInput* out) {
      for (std::size_t i = 0; i < wanted; ++i) out[i] = grips_[vessel][(first + i) % options_.grips];
    };
    const RunResult result = timed.opened.backend->run(request);
    total += result.kernel_seconds;
    for (const std::string& note : result.notes)
      if (std::find(notes_.begin(), notes_.end(), note) == notes_.end()) notes_.push_back(note);
  }
  return total;
}

// In turns, so that what else the machine does meanwhile comes to all of them alike.
void ErrorMeasure::time(std::vector<Timed>& group, std::vector<Timed>& bases) {
  std::vector<Timed*> taking_turns;
  for (Timed& base : bases) {
    base.runs.clear();
    // one that has been timed is timed again for those beside it
    const bool is_wanted =
        base.all_runs.empty() || std::any_of(group.begin(), group.end(), [&](const Timed& one) { return one.is_beside(base); });
    if (is_wanted) taking_turns.push_back(&base);
  }
  for (Timed& one : group) taking_turns.push_back(&one);
  for (int k = 0; k < options_.runs; ++k) {
    for (Timed* timed : taking_turns) {
      if (stopped()) return;
      timed->runs.push_back(timed_run(*timed) / static_cast<double>(timed->count * grips_.size()));
    }
  }
  for (Timed& base : bases) base.all_runs.insert(base.all_runs.end(), base.runs.begin(), base.runs.end());
}

}  // namespace wholehand
