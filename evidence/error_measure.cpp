// SPDX-License-Identifier: MIT
#include "evidence/error_measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/core_backend.h"
#include "core/prepare.h"
#include "core/touch.h"
#include "host/grip_backend.h"
#include "sweeps/plan.h"
#include "sweeps/variables.h"

namespace wholehand {
namespace {

constexpr double NO_FIGURE = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t LARGEST_TIMED_RUN = 1 << 20;  // timed grips of a vessel
constexpr std::size_t CHUNKS_IN_FLIGHT = 3;         // of a device, at most, and what all of them may take
const std::size_t CHUNKS_BYTES = CHUNKS_IN_FLIGHT * host::StreamOptions().slot_bytes;

// Random grips within the scene's axes: its own as Sobol points, by the seed. Alike ones follow each other, by height the last, as in a
// sweep: a device evaluates neighbours together.
std::vector<std::vector<GripInput>> random_error_grips(const Scene& scene, std::size_t count, std::uint64_t seed) {
  Scene sampled = scene;
  sampled.grips.sampling = Sampling::sobol;
  sampled.grips.count = count;
  sampled.grips.seed = seed;
  const Plan plan(sampled, true);
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

// What is compared.
FieldSet compared_fields(const Scene& scene) {
  std::vector<int> fields{FIELD_GAP, FIELD_CLOSURE, FIELD_POSED, FIELD_PROXIES, FIELD_STATUS, FIELD_TOUCH_MASK, FIELD_SEPARATION};
  if (!scene.tilts.empty())
    fields.insert(fields.end(), {scene.force.torque == Torque::exact ? FIELD_EXACT_TORQUE : FIELD_TORQUE, FIELD_FEEDBACK_FORCE,
                                 FIELD_HOLD_FORCE});
  return make_field_set(fields, scene);
}

bool is_feasible_status(std::uint32_t status) { return (status & STATUS_REASON_MASK) == REASON_NONE; }

// The errors of one quantity, with their places.
struct QuantityErrors {
  std::vector<double> values;
  std::vector<std::string> where;
  void add(double value, std::size_t vessel, std::size_t index) {
    values.push_back(value);
    where.push_back(fmt::format("{}:{}", vessel, index));
  }
};

// Largest difference between the planes of a field at one grip. With `finite`, infinite values on either side are passed over (a hold force is
// infinite where the pinch is not antipodal, which is an outcome and not a number): NaN where none is left.
double plane_difference(const GatheredPlanes& a, const GatheredPlanes& b, int field, int planes, std::size_t i, bool finite) {
  double worst = finite ? NO_FIGURE : 0;
  for (int p = 0; p < planes; ++p) {
    const double x = a.real(a.fields.plane[field] + p, i), y = b.real(b.fields.plane[field] + p, i);
    if (finite && (std::isinf(x) || std::isinf(y))) continue;
    worst = std::fmax(worst, figure_difference(x, y));
  }
  return worst;
}

// Whether an infinity stands on one side alone, in some plane of a field at one grip.
bool differs_in_infinity(const GatheredPlanes& a, const GatheredPlanes& b, int field, int planes, std::size_t i) {
  for (int p = 0; p < planes; ++p)
    if (std::isinf(a.real(a.fields.plane[field] + p, i)) != std::isinf(b.real(b.fields.plane[field] + p, i))) return true;
  return false;
}

// Largest distance between the points of a field at one grip.
double point_difference(const GatheredPlanes& a, const GatheredPlanes& b, int field, std::size_t i) {
  double worst = 0;
  for (int j = 0; j < JOINT_COUNT; ++j) {
    double square = 0;
    for (int k = 0; k < 3; ++k) {
      const double d =
          figure_difference(a.real(a.fields.plane[field] + 3 * j + k, i), b.real(b.fields.plane[field] + 3 * j + k, i));
      square += d * d;
    }
    worst = std::max(worst, std::sqrt(square));
  }
  return worst;
}

bool same_evaluator_options(const EvaluatorOptions& a, const EvaluatorOptions& b) {
  return a.grid_samples == b.grid_samples && a.grid_bits == b.grid_bits && a.quadrature_points == b.quadrature_points &&
         a.stop_tolerance == b.stop_tolerance && a.trace_steps == b.trace_steps && a.advance_steps == b.advance_steps &&
         a.gap_table == b.gap_table;
}

double middle(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
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

  // Of the same kind of machine, so that one's drift is the other's.
  bool is_beside(const Timed& other) const {
    return variant.on_core == other.variant.on_core && variant.precision == other.variant.precision &&
           variant.threads == other.variant.threads;
  }
  std::size_t held_bytes() const {
    const std::size_t chunks = CHUNKS_IN_FLIGHT * opened.grip_bytes * count;
    return opened.table_bytes + (variant.on_core ? 0 : std::min(chunks, CHUNKS_BYTES));
  }
};

ErrorFigures figures_of(const std::vector<double>& errors, const std::vector<std::string>& where) {
  if (errors.empty()) return {NO_FIGURE, NO_FIGURE, NO_FIGURE, "", 0};
  std::vector<std::size_t> order(errors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto value = [&](std::size_t i) { return std::isnan(errors[i]) ? std::numeric_limits<double>::infinity() : errors[i]; };
  // of equally bad ones the first
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return value(a) < value(b); });
  const auto rank = [&](double share) {
    const auto place = static_cast<std::size_t>(std::ceil(share * static_cast<double>(order.size())));
    return value(order[std::max<std::size_t>(place, 1) - 1]);
  };
  const double max = value(order.back());
  const std::size_t worst = *std::find_if(order.begin(), order.end(), [&](std::size_t i) { return value(i) == max; });
  return {rank(0.5), rank(0.999), max, where[worst], errors.size()};
}

TimeFigures time_figures(std::vector<double> runs, const std::vector<double>& base_beside, const std::vector<double>& base_all) {
  if (runs.empty()) return {};
  std::sort(runs.begin(), runs.end());
  double scale = 1;
  if (!base_beside.empty() && !base_all.empty() && middle(base_beside) > 0) scale = middle(base_all) / middle(base_beside);
  return {scale * middle(runs), scale * (runs[runs.size() * 3 / 4] - runs[runs.size() / 4])};
}

double ErrorRow::length_error() const {
  if (!variant.answers_the_question() || errors[ERROR_GAP].compared == 0) return NO_FIGURE;
  double worst = 0;
  for (const int q : {ERROR_SEPARATION, ERROR_POSED, ERROR_PROXY, ERROR_GAP, ERROR_COM})
    if (errors[q].compared > 0) worst = std::max(worst, errors[q].p999);
  return worst;
}

double ErrorRow::force_error() const {
  if (!variant.answers_the_question() || errors[ERROR_FEEDBACK].compared == 0) return NO_FIGURE;
  if (above_one_in_1000(hold_flips, errors[ERROR_FEEDBACK].compared)) return std::numeric_limits<double>::infinity();
  const double hold = errors[ERROR_HOLD].compared > 0 ? errors[ERROR_HOLD].p999 : 0;
  return std::max(errors[ERROR_FEEDBACK].p999, hold);
}

ErrorMeasure::ErrorMeasure(const Scene& scene, const MeasureOptions& options)
    : scene_(scene),
      options_(options),
      grips_(random_error_grips(scene, options.grips, options.seed)),
      reference_(make_core_evaluator(scene, reference_options())) {
  CoreBackend backend(reference_, scene, compared_fields(scene), Precision::full, options.threads);
  nearby_.resize(grips_.size());
  for (std::size_t v = 0; v < grips_.size(); ++v) {
    truth_.push_back(gather(backend, v, grips_[v]));
    true_liquid_.push_back(backend.liquid(v));
    for (std::size_t i = 0; i < grips_[v].size(); ++i) {
      const std::uint32_t status = truth_[v].uint(FIELD_STATUS, i);
      feasible_ += is_feasible_status(status) ? 1 : 0;
      grazing_ += is_feasible_status(status) && (status & STATUS_GRAZING) != 0 ? 1 : 0;
      if (!is_feasible_status(status)) continue;
      for (int j = 0; j < JOINT_COUNT; ++j) {
        const FieldSet& fields = truth_[v].fields;
        if (!(std::abs(truth_[v].real(fields.plane[FIELD_SEPARATION] + j, i)) <= GRID_BAND)) continue;
        Triple& point = nearby_[v].emplace_back();
        for (int k = 0; k < 3; ++k) point[k] = truth_[v].real(fields.plane[FIELD_POSED] + 3 * j + k, i);
      }
    }
  }
}

// The one used last again where it is the same: those with a grid are large and slow to make.
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
  row.errors.fill(figures_of({}, {}));
  const Scene& scene = variant.scene ? *variant.scene : scene_;
  const Opened opened = open(variant, compared_fields(scene));
  row.device = opened.backend->info().device;
  row.driver = opened.backend->info().driver;
  std::vector<GatheredPlanes> planes;
  std::vector<std::vector<LiquidResult>> liquid;
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t v = 0; v < grips_.size(); ++v) liquid.push_back(opened.backend->liquid(v));
  const double liquid_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (variant.on_core && !liquid.front().empty())
    row.liquid_seconds = liquid_seconds / static_cast<double>(liquid.size() * liquid.front().size());
  for (std::size_t v = 0; v < grips_.size(); ++v) planes.push_back(gather(*opened.backend, v, grips_[v]));
  compare(planes, *opened.core, row);
  if (variant.on_core && variant.options.grid_samples > 0) row.distance = compare_distance(*opened.core);
  if (variant.comparable.states && !scene_.tilts.empty() && scene_.liquid) compare_liquid(liquid, *opened.core, row);
  return row;
}

void ErrorMeasure::compare(const std::vector<GatheredPlanes>& planes, const Evaluator& core, ErrorRow& row) const {
  const Comparable& comparable = row.variant.comparable;
  const bool forces = comparable.states && !scene_.tilts.empty();
  const int states = static_cast<int>(scene_fills(scene_) * scene_.tilts.size());
  const int torque = scene_.force.torque == Torque::exact ? FIELD_EXACT_TORQUE : FIELD_TORQUE;
  std::array<QuantityErrors, ERROR_QUANTITIES> errors;
  std::uint64_t touch_flips = 0, feasible_flips = 0;
  std::vector<double> margins;  // of touch flips, m
  for (std::size_t v = 0; v < planes.size(); ++v) {
    const GatheredPlanes &a = planes[v], &b = truth_[v];
    row.grips += a.count;
    for (std::size_t i = 0; i < a.count; ++i) {
      const std::uint32_t status_a = a.uint(FIELD_STATUS, i), status_b = b.uint(FIELD_STATUS, i);
      feasible_flips += is_feasible_status(status_a) != is_feasible_status(status_b) ? 1 : 0;
      if (!is_feasible_status(status_a) || !is_feasible_status(status_b) || ((status_a | status_b) & STATUS_GRAZING) != 0) continue;
      errors[ERROR_CLOSURE].add(plane_difference(a, b, FIELD_CLOSURE, 1, i, false), v, i);
      errors[ERROR_GAP].add(1e6 * plane_difference(a, b, FIELD_GAP, 1, i, false), v, i);
      if (forces) {
        errors[ERROR_TORQUE].add(plane_difference(a, b, torque, states, i, false), v, i);
        errors[ERROR_FEEDBACK].add(plane_difference(a, b, FIELD_FEEDBACK_FORCE, states, i, false), v, i);
        const double hold = plane_difference(a, b, FIELD_HOLD_FORCE, states, i, true);
        if (!std::isnan(hold)) errors[ERROR_HOLD].add(hold, v, i);
        row.hold_flips += differs_in_infinity(a, b, FIELD_HOLD_FORCE, states, i) ? 1 : 0;
      }
      if (!comparable.pose) continue;
      errors[ERROR_POSED].add(1e6 * point_difference(a, b, FIELD_POSED, i), v, i);
      errors[ERROR_PROXY].add(1e6 * point_difference(a, b, FIELD_PROXIES, i), v, i);
      const std::uint32_t flipped = a.uint(FIELD_TOUCH_MASK, i) ^ b.uint(FIELD_TOUCH_MASK, i);
      touch_flips += static_cast<std::uint64_t>(std::popcount(flipped));
      double separation = 0;
      for (int j = 0; j < JOINT_COUNT; ++j) {
        const double own = a.real(a.fields.plane[FIELD_SEPARATION] + j, i), exact = b.real(b.fields.plane[FIELD_SEPARATION] + j, i);
        if (exact <= GRID_BAND) separation = std::max(separation, figure_difference(own, exact));
        if ((flipped >> j & 1) != 0) margins.push_back(std::abs(exact - judged_contact_tolerance(scene_.hand)));
      }
      errors[ERROR_SEPARATION].add(1e6 * separation, v, i);
    }
  }
  for (int q = 0; q < ERROR_QUANTITIES; ++q) row.errors[q] = figures_of(errors[q].values, errors[q].where);
  if (comparable.outcomes) row.feasible_flips = feasible_flips;
  if (!comparable.pose) return;
  row.touch_flips = touch_flips;
  // what a point at rest where the reference has it may be told wrongly. A tolerance looser than the precision's named one is no excuse, and
  // fingers that came to rest elsewhere are none
  const Allowance allowed = allowance(row.variant.precision);
  double reach = 0;
  for (const VesselData& vessel : scene_.vessels) reach = std::max(reach, 0.1 * scene_.hand.scale + vessel.height);
  row.touch_margin = 2 * std::min(row.variant.stop_tolerance(), allowed.stop_tolerance) + 64 * allowed.epsilon * reach;
  if (row.variant.options.grid_samples > 0) row.touch_margin += nearby_distance_error(core);
  row.touch_flips_outside = static_cast<std::uint64_t>(
      std::count_if(margins.begin(), margins.end(), [&](double margin) { return margin > row.touch_margin; }));
}

// Largest error of the signed distance itself where the reference's hand is at the surface, m.
double ErrorMeasure::nearby_distance_error(const Evaluator& core) const {
  double worst = 0;
  for (std::size_t v = 0; v < nearby_.size(); ++v)
    for (const Triple& point : nearby_[v])
      worst = std::max(worst, figure_difference(core.distance(v, point), reference_->distance(v, point)));
  return worst;
}

void ErrorMeasure::compare_liquid(const std::vector<std::vector<LiquidResult>>& liquid, const Evaluator& core,
                                  ErrorRow& row) const {
  QuantityErrors volume, center;
  for (std::size_t v = 0; v < liquid.size(); ++v) {
    const VesselConstants own = core.constants(v), exact = reference_->constants(v);
    for (std::size_t s = 0; s < liquid[v].size(); ++s) {
      volume.add(1e6 * figure_difference(liquid[v][s].volume, true_liquid_[v][s].volume), v, s);
      const auto a = loaded_center(own, liquid[v][s]), b = loaded_center(exact, true_liquid_[v][s]);
      center.add(1e6 * std::hypot(figure_difference(a[0], b[0]), figure_difference(a[1], b[1])), v, s);
    }
  }
  row.errors[ERROR_VOLUME] = figures_of(volume.values, volume.where);
  row.errors[ERROR_COM] = figures_of(center.values, center.where);
}

// The signed distance itself, inside and as far out as a touching point's centre.
ErrorFigures ErrorMeasure::compare_distance(const Evaluator& core) const {
  constexpr std::size_t POINTS = 4096;
  const double margin = grid_margin(scene_);
  std::vector<SobolPoint> points(POINTS);
  Sobol(options_.seed).points(0, POINTS, points.data());
  QuantityErrors errors;
  for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
    const PreparedVessel vessel = prepare_vessel(scene_.vessels[v], scene_.vessels[v].wall > 0);
    for (std::size_t i = 0; i < POINTS; ++i) {
      const double r = points[i][0] * (vessel.largest_radius + margin), azimuth = 2 * PI * points[i][1];
      const Triple p{r * std::cos(azimuth), points[i][2] * (scene_.vessels[v].height + 2 * margin) - margin, r * std::sin(azimuth)};
      errors.add(1e6 * figure_difference(core.distance(v, p), reference_->distance(v, p)), v, i);
    }
  }
  return figures_of(errors.values, errors.where);
}

// Ready to be timed as a sweep runs it: with the planes that it keeps. The first run compiles; those after it find out how many grips make a
// run long enough, and let chunks grow.
ErrorMeasure::Timed ErrorMeasure::warmed(const ErrorVariant& variant, ErrorRow& row) {
  const Scene& scene = variant.scene ? *variant.scene : scene_;
  Timed timed;
  timed.opened = open(variant, make_field_set(variable_fields(choose_variables(scene)), scene));
  timed.variant = variant;
  row.memory_bytes = timed.opened.table_bytes + timed.opened.grip_bytes * options_.grips;
  // the core hands out chunks of 512
  timed.count = variant.on_core ? std::max(options_.grips, 1024 * static_cast<std::size_t>(variant.threads)) : options_.grips;
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
