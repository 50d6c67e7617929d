// SPDX-License-Identifier: MIT
#include "evidence/check/error_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "base/numbers/sobol.h"
#include "core/core_backend.h"
#include "core/fields.h"
#include "core/prepare.h"
#include "core/touch.h"
#include "evidence/check/compare.h"
#include "shaders/status.h"

namespace wholehand {
namespace {

// A quantity that is one number of a grip, by the name of its field. A name that core/fields does not have is passed over.
struct HandQuantity {
  ErrorQuantity quantity;
  std::string_view field;
  double scale = 1;
  bool of_states = false;  // and relative: it spans powers of ten, and may be infinite
};

constexpr HandQuantity HAND_QUANTITIES[] = {
    {ERROR_TABLE_DEPTH, "table_depth", 1e6}, {ERROR_SELF_DEPTH, "self_depth", 1e6},
    {ERROR_EFFORT, "worst_effort", 1, true}, {ERROR_TIPS_EFFORT, "tips_worst_effort", 1, true},
    {ERROR_PUSH, "push", 1, true},           {ERROR_FRICTION_NEEDED, "friction_needed", 1, true},
};

// The errors of one quantity, with their places.
struct QuantityErrors {
  std::vector<double> values;
  std::vector<std::string> where;
  void add(double value, std::size_t vessel, std::size_t index) {
    values.push_back(value);
    where.push_back(fmt::format("{}:{}", vessel, index));
  }
};

// Largest difference between the planes of a field at one grip. With `finite`, skips values that neither side has and values that are infinite on
// either side (a hold force is infinite if the pinch is not antipodal, which is an outcome and not a number): NaN if none is left.
double plane_difference(const GatheredPlanes& a, const GatheredPlanes& b, int field, int planes, std::size_t i, bool finite) {
  double worst = finite ? std::numeric_limits<double>::quiet_NaN() : 0;
  for (int p = 0; p < planes; ++p) {
    const double x = a.real(a.fields.plane[field] + p, i), y = b.real(b.fields.plane[field] + p, i);
    if (finite && (std::isinf(x) || std::isinf(y) || (std::isnan(x) && std::isnan(y)))) continue;
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

// Largest width of the brackets of a grip's efforts, in units of their upper ends. NaN where no state is held.
double widest_bracket(const GatheredPlanes& planes, int states, std::size_t i) {
  double widest = std::numeric_limits<double>::quiet_NaN();
  for (int state = 0; state < states; ++state) {
    const double effort = planes.real(planes.fields.plane[FIELD_EFFORT] + state, i);
    const double low = planes.real(planes.fields.plane[FIELD_EFFORT_LOW] + state, i);
    if (std::isfinite(effort) && effort > 0) widest = std::fmax(widest, (effort - low) / effort);
  }
  return widest;
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

using AllErrors = std::array<QuantityErrors, ERROR_QUANTITIES>;

// The errors of the whole hand's numbers at grip `i` of vessel `v`; of those of states only with `has_states`.
void add_hand_quantities(const GatheredPlanes& a, const GatheredPlanes& b, std::size_t v, std::size_t i, bool has_states,
                         AllErrors& errors) {
  for (const HandQuantity& asked : HAND_QUANTITIES) {
    const int field = field_of_variable(asked.field);
    if (field < 0 || !a.fields.has(field) || !b.fields.has(field) || (asked.of_states && !has_states)) continue;
    double error = plane_difference(a, b, field, 1, i, asked.of_states);
    if (std::isnan(error)) continue;
    const double exact = std::abs(b.real(b.fields.plane[field], i));
    if (asked.of_states) error = exact > 0 ? error / exact : error;
    errors[asked.quantity].add(asked.scale * error, v, i);
  }
}

}  // namespace

FieldSet reference_fields(const Scene& scene, bool brackets) {
  std::vector<int> fields{FIELD_GAP, FIELD_CLOSURE, FIELD_POSED, FIELD_PROXIES, FIELD_STATUS, FIELD_TOUCH_MASK, FIELD_SEPARATION};
  if (!scene.tilts.empty())
    fields.insert(fields.end(), {scene.force.torque == Torque::exact ? FIELD_EXACT_TORQUE : FIELD_TORQUE, FIELD_FEEDBACK_FORCE,
                                 FIELD_HOLD_FORCE});
  for (const HandQuantity& asked : HAND_QUANTITIES)
    if (const int field = field_of_variable(asked.field); field >= 0 && field_planes(field, scene) > 0) fields.push_back(field);
  if (brackets) fields.insert(fields.end(), {FIELD_EFFORT, FIELD_EFFORT_LOW});
  return make_field_set(fields, scene);
}

ErrorReference::ErrorReference(const Scene& scene, const std::vector<std::vector<GripInput>>& grips,
                               const ReferenceOptions& options)
    : scene_(scene), seed_(options.seed), reference_(make_core_evaluator(scene, reference_options())) {
  CoreBackend backend(reference_, scene, reference_fields(scene), Precision::full, options.threads);
  nearby_.resize(grips.size());
  for (std::size_t v = 0; v < grips.size(); ++v) {
    truth_.push_back(gather(backend, v, grips[v]));
    true_liquid_.push_back(backend.liquid(v));
    for (std::size_t i = 0; i < grips[v].size(); ++i) {
      const std::uint32_t status = truth_[v].uint(FIELD_STATUS, i);
      feasible_ += is_feasible(status) ? 1 : 0;
      grazing_ += is_feasible(status) && (status & STATUS_GRAZING) != 0 ? 1 : 0;
      if (!is_feasible(status)) continue;
      for (int j = 0; j < JOINT_COUNT; ++j) {
        const FieldSet& fields = truth_[v].fields;
        if (!(std::abs(truth_[v].real(fields.plane[FIELD_SEPARATION] + j, i)) <= LATTICE_BAND)) continue;
        Triple& point = nearby_[v].emplace_back();
        for (int k = 0; k < 3; ++k) point[k] = truth_[v].real(fields.plane[FIELD_POSED] + 3 * j + k, i);
      }
    }
  }
}

void ErrorReference::compare(const std::vector<GatheredPlanes>& planes, const Evaluator& core, ErrorRow& row) const {
  const Comparable& comparable = row.variant.comparable;
  const bool forces = comparable.states && !scene_.tilts.empty();
  const int states = static_cast<int>(scene_fills(scene_) * scene_.tilts.size());
  const int torque = scene_.force.torque == Torque::exact ? FIELD_EXACT_TORQUE : FIELD_TORQUE;
  AllErrors errors;
  std::uint64_t touch_flips = 0, feasible_flips = 0;
  std::vector<double> margins;  // of touch flips, m
  for (std::size_t v = 0; v < planes.size(); ++v) {
    const GatheredPlanes &a = planes[v], &b = truth_[v];
    row.grips += a.count;
    for (std::size_t i = 0; i < a.count; ++i) {
      const std::uint32_t status_a = a.uint(FIELD_STATUS, i), status_b = b.uint(FIELD_STATUS, i);
      feasible_flips += is_feasible(status_a) != is_feasible(status_b) ? 1 : 0;
      if (!is_feasible(status_a) || !is_feasible(status_b) || ((status_a | status_b) & STATUS_GRAZING) != 0) continue;
      errors[ERROR_CLOSURE].add(plane_difference(a, b, FIELD_CLOSURE, 1, i, false), v, i);
      errors[ERROR_GAP].add(1e6 * plane_difference(a, b, FIELD_GAP, 1, i, false), v, i);
      if (forces) {
        errors[ERROR_TORQUE].add(plane_difference(a, b, torque, states, i, false), v, i);
        errors[ERROR_FEEDBACK].add(plane_difference(a, b, FIELD_FEEDBACK_FORCE, states, i, false), v, i);
        const double hold = plane_difference(a, b, FIELD_HOLD_FORCE, states, i, true);
        if (!std::isnan(hold)) errors[ERROR_HOLD].add(hold, v, i);
        row.hold_flips += differs_in_infinity(a, b, FIELD_HOLD_FORCE, states, i) ? 1 : 0;
      }
      if (a.fields.has(FIELD_EFFORT_LOW))
        if (const double width = widest_bracket(a, states, i); !std::isnan(width)) errors[ERROR_EFFORT_BRACKET].add(width, v, i);
      if (!comparable.pose) continue;
      errors[ERROR_POSED].add(1e6 * point_difference(a, b, FIELD_POSED, i), v, i);
      errors[ERROR_PROXY].add(1e6 * point_difference(a, b, FIELD_PROXIES, i), v, i);
      const std::uint32_t flipped = a.uint(FIELD_TOUCH_MASK, i) ^ b.uint(FIELD_TOUCH_MASK, i);
      touch_flips += static_cast<std::uint64_t>(std::popcount(flipped));
      double separation = 0;
      for (int j = 0; j < JOINT_COUNT; ++j) {
        const double own = a.real(a.fields.plane[FIELD_SEPARATION] + j, i), exact = b.real(b.fields.plane[FIELD_SEPARATION] + j, i);
        if (exact <= LATTICE_BAND) separation = std::max(separation, figure_difference(own, exact));
        if ((flipped >> j & 1) != 0) margins.push_back(std::abs(exact - judged_contact_tolerance(scene_.hand)));
      }
      errors[ERROR_SEPARATION].add(1e6 * separation, v, i);
      // a flip means that other points press, which is an outcome
      add_hand_quantities(a, b, v, i, forces && flipped == 0, errors);
    }
  }
  for (int q = 0; q < ERROR_QUANTITIES; ++q) row.errors[q] = error_figures(errors[q].values, errors[q].where);
  if (comparable.outcomes) row.feasible_flips = feasible_flips;
  if (!comparable.pose) return;
  row.touch_flips = touch_flips;
  // the error of a point that rests at the reference's place. Neither a tolerance looser than the precision's named one nor fingers that came to rest
  // elsewhere are an excuse
  const Allowance allowed = allowance(row.variant.precision);
  double reach = 0;
  for (const VesselData& vessel : scene_.vessels) reach = std::max(reach, 0.1 * scene_.hand.scale + vessel.height);
  row.touch_margin = 2 * std::min(row.variant.stop_tolerance(), allowed.stop_tolerance) + 64 * allowed.epsilon * reach;
  if (row.variant.options.lattice_samples > 0) row.touch_margin += nearby_distance_error(core);
  row.touch_flips_outside = static_cast<std::uint64_t>(
      std::count_if(margins.begin(), margins.end(), [&](double margin) { return margin > row.touch_margin; }));
}

// Largest error of the signed distance itself where the reference's hand is at the surface, m.
double ErrorReference::nearby_distance_error(const Evaluator& core) const {
  double worst = 0;
  for (std::size_t v = 0; v < nearby_.size(); ++v)
    for (const Triple& point : nearby_[v])
      worst = std::max(worst, figure_difference(core.distance(v, point), reference_->distance(v, point)));
  return worst;
}

void ErrorReference::compare_liquid(const std::vector<std::vector<LiquidResult>>& liquid, const Evaluator& core,
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
  row.errors[ERROR_VOLUME] = error_figures(volume.values, volume.where);
  row.errors[ERROR_COM] = error_figures(center.values, center.where);
}

// The signed distance itself, inside and as far out as a touching point's center.
ErrorFigures ErrorReference::compare_distance(const Evaluator& core) const {
  constexpr std::size_t POINTS = 4096;
  const double margin = lattice_margin(scene_);
  std::vector<SobolPoint> points(POINTS);
  Sobol(seed_).points(0, POINTS, points.data());
  QuantityErrors errors;
  for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
    const PreparedVessel vessel = prepare_vessel(scene_.vessels[v], scene_.vessels[v].wall > 0);
    for (std::size_t i = 0; i < POINTS; ++i) {
      const double r = points[i][0] * (vessel.largest_radius + margin), azimuth = 2 * PI * points[i][1];
      const Triple p{r * std::cos(azimuth), points[i][2] * (scene_.vessels[v].height + 2 * margin) - margin, r * std::sin(azimuth)};
      errors.add(1e6 * figure_difference(core.distance(v, p), reference_->distance(v, p)), v, i);
    }
  }
  return error_figures(errors.values, errors.where);
}

}  // namespace wholehand
