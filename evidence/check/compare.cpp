// SPDX-License-Identifier: MIT
#include "evidence/check/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/numbers/nearest.h"
#include "core/grip_effort.h"
#include "core/planes.h"
#include "core/tolerances.h"
#include "evidence/check/binomial.h"
#include "evidence/check/load_floors.h"
#include "shaders/layout.h"
#include "shaders/status.h"

namespace wholehand {
namespace {

constexpr const char* PEAK_TILT = "force short of peak";  // at the tilt that the other side reports
constexpr const char* WORST_STATE =
    "effort short of worst";  // 1 / (1 + effort) of the state that is reported as the worst, above the least
constexpr const char* SAFE_TILT = "force beyond safe";  // where one side reports a larger safe tilt

const std::vector<int> DISCRETE{FIELD_STATUS,      FIELD_TOUCH_MASK, FIELD_TIP_MASK,
                                FIELD_FINGER_MASK, FIELD_INNER_MASK, FIELD_USED_MASK};

// Status bits of the iterations that used up their steps.
constexpr std::uint32_t ALL_STEPS = STATUS_PROXY_UNSETTLED | 0x1Fu << STATUS_UNSETTLED_SHIFT;

// Whether grip `i` of `a` has another outcome than grip `k` of `b`, ignoring the bits `besides` of the status.
bool differs(const GatheredPlanes& a, std::size_t i, const GatheredPlanes& b, std::size_t k, bool same_stop,
             std::uint32_t besides = 0) {
  return std::any_of(DISCRETE.begin(), DISCRETE.end(), [&](int field) {
    const std::uint32_t left_out = field != FIELD_STATUS ? 0
                                   : same_stop           ? STATUS_CONTACT_UNDECIDED | besides
                                                         : ALL_STEPS | STATUS_CONTACT_UNDECIDED | besides;
    return ((a.uint(field, i) ^ b.uint(field, k)) & ~left_out) != 0;
  });
}

bool differs(const GatheredPlanes& a, const GatheredPlanes& b, std::size_t i, bool same_stop, std::uint32_t besides = 0) {
  return differs(a, i, b, i, same_stop, besides);
}

bool grazes(const GatheredPlanes& planes, std::size_t i) { return (planes.uint(FIELD_STATUS, i) & STATUS_GRAZING) != 0; }

// The grip moved by `shift` m in every relevant way: along and about its axes, and in size.
std::vector<GripInput> moved(const std::vector<GripInput>& grips, int way, double shift, double length) {
  std::vector<GripInput> result = grips;
  const double sign = way % 2 == 0 ? 1 : -1;
  for (GripInput& grip : result) {
    switch (way / 2) {
      case 0:
        grip.height += sign * shift;
        break;
      case 1:
        grip.offset += sign * shift;
        break;
      case 2:
        grip.roll += sign * shift / length;
        break;
      case 3:
        grip.obliquity += sign * shift / length;
        break;
      default:
        grip.hand_scale *= 1 + sign * shift / length;
        break;
    }
  }
  return result;
}
constexpr int WAYS = 10;

// The scene with tips thickened by these amounts, which is equivalent to meeting the surface within a tolerance.
Scene with_tips(Scene scene, double thumb, double index) {
  scene.hand.fingers[0].radii[3] += thumb / scene.hand.scale;
  scene.hand.fingers[1].radii[4] += index / scene.hand.scale;
  return scene;
}

// The scene with hands stronger by this factor, which is equivalent to an effort within a tolerance.
Scene with_strengths(Scene scene, double factor) {
  for (double& digit : scene.strength->digits) digit *= factor;
  return scene;
}

// Whether the planes exist, and not only for some grips.
bool is_held(const GatheredPlanes& planes, int field) {
  return planes.fields.has(field) && static_cast<std::size_t>(planes.fields.plane[field]) * planes.count < planes.reals.size();
}

// Whether both sides have what the comparison of reported tilts needs.
bool has_tilts(const Scene& scene, const FieldSet& fields) {
  const auto needed = {FIELD_PEAK_TILT, FIELD_SAFE_TILT, FIELD_FEEDBACK_FORCE, FIELD_NORMAL_FORCE};
  return std::all_of(needed.begin(), needed.end(), [&](int field) { return fields.has(field); }) &&
         (has_effort(scene) || fields.has(FIELD_HOLD_FORCE));
}

// Whether both sides have what the comparison of reported worst states needs.
bool has_worst_state(const FieldSet& fields) {
  return fields.has(FIELD_WORST_EFFORT) && fields.has(FIELD_WORST_EFFORT_FILL) && fields.has(FIELD_WORST_EFFORT_TILT);
}

bool is_effort(int field) { return field == FIELD_WORST_EFFORT || field == FIELD_TIPS_WORST_EFFORT; }

void to_compared_form(GatheredPlanes& planes) {
  for (const int field : {FIELD_WORST_EFFORT, FIELD_TIPS_WORST_EFFORT, FIELD_FRICTION_NEEDED}) {
    if (!is_held(planes, field)) continue;
    const auto first = planes.reals.begin() + static_cast<std::ptrdiff_t>(planes.fields.plane[field] * planes.count);
    std::transform(first, first + static_cast<std::ptrdiff_t>(planes.count), first,
                   [field](double value) { return compared_form(field, value); });
  }
}

// The core's effort of a state, of these grips alone; by grip and state.
class StateEfforts {
 public:
  StateEfforts(const Scene& scene, const Evaluator& core, std::size_t vessel, const std::vector<GripInput>& grips,
               const std::vector<std::size_t>& asked)
      : place_(grips.size(), 0) {
    std::vector<GripInput> chosen;
    for (const std::size_t i : asked) {
      place_[i] = chosen.size();
      chosen.push_back(grips[i]);
    }
    if (!chosen.empty()) planes_ = gather(core, make_field_set({FIELD_EFFORT, FIELD_STATUS}, scene), vessel, chosen);
  }
  // 1 / (1 + effort) of the worst state.
  double least_form(std::size_t grip, std::size_t states) const {
    double least = 1;
    for (std::size_t state = 0; state < states; ++state)
      least = std::min(least, compared_form(FIELD_WORST_EFFORT, of(grip, state)));
    return least;
  }
  double of(std::size_t grip, std::size_t state) const {
    return planes_.real(planes_.fields.plane[FIELD_EFFORT] + static_cast<int>(state), place_[grip]);
  }

 private:
  std::vector<std::size_t> place_;
  GatheredPlanes planes_;
};

// Enters a difference into its row. Returns it if it exceeds the tolerance, else 0.
double note_difference(Comparison& entry, double scale, std::size_t vessel, std::size_t grip, double difference, double tolerance) {
  if (entry.worst == 0 && difference == 0) entry.tolerance = std::max(entry.tolerance, tolerance * scale);
  if (difference > entry.worst / scale) {
    entry.worst = difference * scale;
    entry.tolerance = tolerance * scale;
    entry.vessel = vessel;
    entry.grip = grip;
  }
  entry.worst_ratio = std::max(entry.worst_ratio, difference == 0 ? 0 : difference / tolerance);
  return difference > tolerance ? difference : 0;
}

// A length over which the hand reaches, m: it turns shifts into angles.
double reach(const Scene& scene) { return 0.1 * scene.hand.scale; }

double tip_radius(const HandData& hand) { return hand.scale * std::max(hand.fingers[0].radii[3], hand.fingers[1].radii[4]); }

}  // namespace

bool is_compared_by_number(const Scene& scene, const Field& field) {
  const bool is_hold = field.number == FIELD_HOLD_FORCE || field.number == FIELD_LARGEST_HOLD;
  return field.label && !(is_hold && has_effort(scene));
}

FieldSet compared_fields(const Scene& scene) {
  std::vector<int> compared{FIELD_PEAK_TILT, FIELD_SAFE_TILT, FIELD_WORST_EFFORT_FILL, FIELD_WORST_EFFORT_TILT};
  compared.insert(compared.end(), DISCRETE.begin(), DISCRETE.end());
  const FieldSet all = all_fields(scene);
  for (const Field& field : real_fields())
    if (is_compared_by_number(scene, field)) compared.push_back(field.number);
  std::erase_if(compared, [&](int field) { return !all.has(field); });
  return make_field_set(compared, scene);
}

double compared_form(int field, double value) {
  return is_effort(field) || field == FIELD_EFFORT || field == FIELD_FRICTION_NEEDED ? 1 / (1 + value) : value;
}

double figure_difference(double a, double b) {
  if (std::isnan(a) && std::isnan(b)) return 0;
  if (a == b) return 0;  // infinities too
  const double difference = std::abs(a - b);
  return std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference;
}

std::array<double, 2> loaded_center(const VesselConstants& glass, const LiquidResult& liquid) {
  const double mass = glass.mass + liquid.mass, share = mass > 0 ? liquid.mass / mass : 0;
  return {(1 - share) * glass.center_of_mass[1] + share * liquid.height, share * liquid.lean};
}

Comparer::Comparer(const Scene& scene, const Evaluator& core, Allowance allowed, Spreads spreads)
    : scene_(scene), core_(core), allowed_(allowed), spreads_(spreads) {
  const double stop = allowed.stop_tolerance;
  for (const auto& [thumb, index] : {std::pair{stop, stop}, {stop, -stop}, {-stop, stop}, {-stop, -stop}})
    others_.push_back(make_core_evaluator(with_tips(scene, thumb, index)));
  // fingers that come to rest as early as those of the coarser precision
  for (const double earlier : {stop / 2, stop, 2 * stop}) {
    EvaluatorOptions options;
    options.stop_tolerance = earlier;
    others_.push_back(make_core_evaluator(scene, options));
  }
  if (has_effort(scene))
    for (const double factor : {1 - EFFORT_SHARE / 2, 1 + EFFORT_SHARE / 2})
      others_.push_back(make_core_evaluator(with_strengths(scene, factor)));
  const FieldSet fields = compared_fields(scene);
  for (const Field& field : real_fields())
    if (is_compared_by_number(scene, field) && fields.has(field.number)) row(field.kernel, field.label, fine_unit(field).name);
  if (has_tilts(scene, fields)) {
    row("force", PEAK_TILT, "mN");
    row("force", SAFE_TILT, "mN");
  }
  if (has_worst_state(fields)) row("effort", WORST_STATE, fine_unit(field_row(FIELD_WORST_EFFORT)).name);
  row("whole", "discrete outcomes", "grips");
}

Comparison& Comparer::row(const std::string& kernel, const std::string& quantity, const std::string& unit) {
  for (Comparison& existing : rows_)
    if (existing.kernel == kernel && existing.quantity == quantity) return existing;
  rows_.push_back({kernel, quantity, unit, 0, 0, 0, 0, 0, 0, 0});
  return rows_.back();
}

// Marks a nonzero difference as outside its tolerance.
void Comparer::count_outside(Comparison& entry, std::size_t vessel, std::size_t grip, double difference) {
  if (!(difference > 0)) return;
  ++entry.outside;
  outliers_.push_back({static_cast<std::size_t>(&entry - rows_.data()), vessel, grip, difference});
}

// How far the core's own numbers move when grips, tips and strengths move by what either side may be off, and whether a grip's outcome then changes,
// or it grazes.
struct Comparer::Spread {
  std::vector<double> reals;
  std::vector<char> undecided, may_graze;
};

void Comparer::add(std::size_t vessel, const std::vector<GripInput>& grips, const GatheredPlanes& a, const GatheredPlanes& b) {
  add(vessel, grips, a, b, gather(core_, a.fields, vessel, grips));
}

void Comparer::add(std::size_t vessel, const std::vector<GripInput>& grips, const GatheredPlanes& side_a,
                   const GatheredPlanes& side_b, const GatheredPlanes& own) {
  GatheredPlanes a = side_a, b = side_b, truth = own;
  to_compared_form(a);
  to_compared_form(b);
  const FieldSet& fields = a.fields;
  const std::size_t n = grips.size();
  to_compared_form(truth);
  std::vector<double> floors(FIELDS, 0.0);
  for (int field = 0; field < REAL_FIELDS; ++field)
    if (field_row(field).label && is_held(a, field) && is_held(b, field))
      floors[field] = ROUNDINGS * allowed_.epsilon * largest_of(truth, field);
  const LoadFloors load(scene_, core_, vessel, volume_tolerance(vessel), ROUNDINGS * allowed_.epsilon, truth);
  const auto floor = [&](int field, std::size_t k, std::size_t i) {
    return floors[field] + 2 * allowed_.stop_tolerance * rests(field, k) + load.of(field, k, i) +
           search_floor(field, k, vessel, truth, i);
  };
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < n; ++i)
    if (spreads_ == Spreads::everywhere || needs_spread(vessel, a, b, truth, floor, i)) chosen.push_back(i);
  const Spread spread = spread_of(vessel, grips, truth, chosen);
  const auto tolerance = [&](int field, std::size_t k, std::size_t i) {
    return floor(field, k, i) + 2 * spread.reals[(fields.plane[field] + k) * n + i];
  };
  const std::vector<char> left_out = add_outcomes(vessel, a, b, truth, spread, tolerance);
  add_numbers(vessel, a, b, left_out, tolerance);
  if (has_tilts(scene_, fields)) add_tilts(vessel, grips, a, b, left_out, tolerance);
  if (has_worst_state(fields)) add_worst_states(vessel, grips, a, b, truth, left_out, tolerance);
}

// Whether the grip's verdict may depend on how far the core's own answers move: outcomes differ or graze, the sides report different
// states, or a number differs by more than its floor, to which a spread can only add.
bool Comparer::needs_spread(std::size_t vessel, const GatheredPlanes& a, const GatheredPlanes& b, const GatheredPlanes& truth,
                            const Tolerance& floor, std::size_t i) const {
  const FieldSet& fields = a.fields;
  if (differs(a, b, i, allowed_.same_stop) || grazes(a, i) || grazes(b, i)) return true;
  if (has_tilts(scene_, fields) && (places_differ(FIELD_PEAK_TILT, a, b, i) || places_differ(FIELD_SAFE_TILT, a, b, i)))
    return true;
  if (has_worst_state(fields) && asks_worst_state(vessel, a, b, truth, i)) return true;
  const auto& known = real_fields();
  return std::any_of(known.begin(), known.end(), [&](const Field& field) {
    if (!is_compared_by_number(scene_, field) || !is_held(a, field.number) || !is_held(b, field.number)) return false;
    const int planes = field_planes(field.number, scene_fills(scene_), scene_.tilts.size());
    for (int p = 0; p < planes; ++p) {
      const int plane = fields.plane[field.number] + p;
      if (figure_difference(a.real(plane, i), b.real(plane, i)) > floor(field.number, p, i)) return true;
    }
    return false;
  });
}

// Whether the sides report different tilts of the field, at any fill.
bool Comparer::places_differ(int field, const GatheredPlanes& a, const GatheredPlanes& b, std::size_t i) const {
  for (int fill = 0; fill < static_cast<int>(scene_fills(scene_)); ++fill) {
    const auto reported = [&](const GatheredPlanes& side) {
      return listed_place(side.real(side.fields.plane[field] + fill, i), scene_.tilts, PI);
    };
    if (reported(a) != reported(b)) return true;
  }
  return false;
}

// The state that a side names as the worst, by fills and tilts; nothing if it names none of the scene's.
std::optional<std::size_t> Comparer::worst_state(std::size_t vessel, const GatheredPlanes& side, std::size_t i) const {
  const std::vector<double> fills = scene_.liquid ? vessel_fills(scene_, scene_.vessels[vessel]) : std::vector<double>{0};
  const auto reported = [&](int field) { return side.real(side.fields.plane[field], i); };
  const std::size_t fill = listed_place(reported(FIELD_WORST_EFFORT_FILL), fills, 1).value_or(0);
  const std::size_t tilt = listed_place(reported(FIELD_WORST_EFFORT_TILT), scene_.tilts, PI).value_or(0);
  if (fill == 0 || tilt == 0) return std::nullopt;
  return (fill - 1) * scene_.tilts.size() + tilt - 1;
}

// Whether the sides' worst states must be compared: they name two, instead of one that is rounded twice and is the core's own.
bool Comparer::asks_worst_state(std::size_t vessel, const GatheredPlanes& a, const GatheredPlanes& b, const GatheredPlanes& truth,
                                std::size_t i) const {
  const auto differ = [&](int field) {
    const int plane = a.fields.plane[field];
    return figure_difference(a.real(plane, i), b.real(plane, i)) != 0;
  };
  if (!differ(FIELD_WORST_EFFORT_FILL) && !differ(FIELD_WORST_EFFORT_TILT)) return false;
  const auto of_a = worst_state(vessel, a, i);
  return !of_a || of_a != worst_state(vessel, b, i) || of_a != worst_state(vessel, truth, i);
}

// Beside an edge, the distances to edge and face differ by x^2 / 2r at x from where they are equal, so up to here rounding may make another face the
// nearest, and change the normal with it.
double Comparer::corner(std::size_t vessel) const {
  return std::sqrt(2 * tip_radius(scene_.hand) * allowed_.epsilon * (reach(scene_) + scene_.vessels[vessel].height));
}

Comparer::Spread Comparer::spread_of(std::size_t vessel, const std::vector<GripInput>& all, const GatheredPlanes& truth,
                                     const std::vector<std::size_t>& chosen) const {
  const FieldSet& fields = truth.fields;
  const std::size_t n = all.size(), m = chosen.size();
  const double length = reach(scene_), shift = this->shift(vessel);
  Spread spread{std::vector<double>(truth.reals.size(), 0.0), std::vector<char>(n, 0), std::vector<char>(n, 0)};
  if (chosen.empty()) return spread;
  std::vector<GripInput> grips;
  for (const std::size_t i : chosen) grips.push_back(all[i]);
  // spread of the planes from `first` on, which are those from `first_of_other` on of the other
  const auto spread_to = [&](GatheredPlanes other, int first, int first_of_other, int planes) {
    to_compared_form(other);
    std::vector<char> differing(m, 0), by_gate(m, 0);
    for (std::size_t k = 0; k < m; ++k) {
      differing[k] = differs(other, k, truth, chosen[k], allowed_.same_stop) ? 1 : 0;
      by_gate[k] = differing[k] != 0 && !differs(other, k, truth, chosen[k], allowed_.same_stop, STATUS_NOT_HELD) ? 1 : 0;
      spread.undecided[chosen[k]] |= differing[k];
      spread.may_graze[chosen[k]] |= grazes(other, k) ? 1 : 0;
    }
    for (int plane = 0; plane < planes; ++plane)
      for (std::size_t k = 0; k < m; ++k) {
        if (by_gate[k] != 0 && first + plane == fields.plane[FIELD_SCORE]) continue;  // 0 on the other side of the gate
        double& most = spread.reals[(first + plane) * n + chosen[k]];
        const double difference = figure_difference(other.real(first_of_other + plane, k), truth.real(first + plane, chosen[k]));
        // with another outcome a number may be absent or infinite; with the same one, it is where a lever is at its threshold
        if (std::isfinite(difference) || differing[k] == 0) most = std::max(most, difference);
      }
  };
  for (int way = 0; way < WAYS; ++way)
    spread_to(gather(core_, fields, vessel, moved(grips, way, shift, length)), 0, 0, fields.real_planes);
  for (const auto& core : others_) spread_to(gather(*core, fields, vessel, grips), 0, 0, fields.real_planes);
  const double corner = this->corner(vessel);
  const int angles = fields.plane[FIELD_CONTACT_ANGLES];
  std::vector<int> asked = DISCRETE;
  if (angles >= 0) asked.push_back(FIELD_CONTACT_ANGLES);
  const FieldSet at_corner = make_field_set(asked, scene_);
  for (int way = 0; corner > shift && way < WAYS; ++way)
    spread_to(gather(core_, at_corner, vessel, moved(grips, way, corner, length)), std::max(0, angles),
              std::max(0, at_corner.plane[FIELD_CONTACT_ANGLES]), angles >= 0 ? 2 : 0);
  return spread;
}

// Whether nothing differs but which side calls the grip held: two efforts that agree to their tolerance may lie on both sides of 1.
bool Comparer::differs_by_gate(const GatheredPlanes& a, const GatheredPlanes& b, std::size_t i, const Tolerance& tolerance) const {
  if (!is_held(a, FIELD_WORST_EFFORT) || !is_held(b, FIELD_WORST_EFFORT)) return false;
  const int plane = a.fields.plane[FIELD_WORST_EFFORT];
  const double of_a = a.real(plane, i), of_b = b.real(plane, i), gate = compared_form(FIELD_WORST_EFFORT, 1);
  return !differs(a, b, i, allowed_.same_stop, STATUS_NOT_HELD) && (of_a < gate) != (of_b < gate) &&
         figure_difference(of_a, of_b) <= tolerance(FIELD_WORST_EFFORT, 0, i);
}

// Returns for each grip whether its numbers are left out.
std::vector<char> Comparer::add_outcomes(std::size_t vessel, const GatheredPlanes& a, const GatheredPlanes& b,
                                         const GatheredPlanes& truth, const Spread& spread, const Tolerance& tolerance) {
  std::vector<char> left_out(truth.count, 0);
  Comparison& outcomes = row("whole", "discrete outcomes", "grips");
  for (std::size_t i = 0; i < left_out.size(); ++i) {
    ++grips_;
    feasible_ += is_feasible(truth.uint(FIELD_STATUS, i)) ? 1 : 0;
    // by the core, or by a side if the core's own answer is that near to grazing: a side alone may not exclude a grip
    if (grazes(truth, i) || (spread.may_graze[i] != 0 && (grazes(a, i) || grazes(b, i)))) {
      ++grazing_;
      left_out[i] = 1;
      continue;
    }
    ++outcomes.compared;
    if (!differs(a, b, i, allowed_.same_stop)) continue;
    left_out[i] = 1;
    const bool is_inside = spread.undecided[i] != 0 || differs_by_gate(a, b, i, tolerance);
    flips_.push_back({vessel, i, is_inside});
    if (is_inside) {
      ++excluded_;
    } else {
      count_outside(outcomes, vessel, i, 1);
      outcomes.worst += 1;
      outcomes.vessel = vessel;
      outcomes.grip = i;
    }
  }
  return left_out;
}

double Comparer::largest_of(const GatheredPlanes& truth, int field) const {
  double largest = 0;
  for (int p = 0; p < field_planes(field, scene_fills(scene_), scene_.tilts.size()); ++p)
    for (std::size_t i = 0; i < truth.count; ++i) {
      const double value = std::abs(truth.real(truth.fields.plane[field] + p, i));
      if (std::isfinite(value)) largest = std::max(largest, value);
    }
  return largest;
}

void Comparer::add_numbers(std::size_t vessel, const GatheredPlanes& a, const GatheredPlanes& b, const std::vector<char>& left_out,
                           const Tolerance& tolerance) {
  for (const Field& field : real_fields()) {
    if (!is_compared_by_number(scene_, field) || !is_held(a, field.number) || !is_held(b, field.number)) continue;
    const FineUnit unit = fine_unit(field);
    Comparison& entry = row(field.kernel, field.label, unit.name);
    const int planes = field_planes(field.number, scene_fills(scene_), scene_.tilts.size());
    for (std::size_t i = 0; i < left_out.size(); ++i) {
      if (left_out[i] != 0) continue;
      ++entry.compared;
      double over = 0;
      for (int p = 0; p < planes; ++p) {
        const int plane = a.fields.plane[field.number] + p;
        const double difference = figure_difference(a.real(plane, i), b.real(plane, i));
        over = std::max(over, note_difference(entry, unit.scale, vessel, i, difference, tolerance(field.number, p, i)));
      }
      count_outside(entry, vessel, i, over);
    }
  }
}

// How much plane `k` of the field depends on a length at which a finger rests. Each side ends anywhere within one stop tolerance of the surface, so
// such lengths, and what is computed from them, may differ by two, however little the finger itself moves.
double Comparer::rests(int field, std::size_t k) const {
  switch (field) {
    case FIELD_TERMS:
      return k == 2 ? 1 / DEPTH_SCALE : 0;
    case FIELD_SCORE:
      return effective_weights(scene_)[2] / DEPTH_SCALE;
    default:
      return field_row(field).rests;
  }
}

// The floor of a compared form, and of the push (core/tolerances.h). A push is held beside the weight, by an effort of both together, and ends
// where the last columns are sqrt(eps) apart. The least friction ends up to a step above a certified bound, at an effort as near to 1: it
// goes with the effort at least as its inverse, and what rounding takes moves it as much as 1 / effort.
double Comparer::effort_floor(int field, std::size_t vessel, double truth) const {
  const bool is_friction = field == FIELD_FRICTION_NEEDED;
  if (std::isnan(truth) || !(is_effort(field) || is_friction || field == FIELD_PUSH)) return 0;
  const VesselConstants& glass = core_.constants(vessel);
  const StrengthData& strengths = *scene_.strength;
  const double weight = scene_.gravity * glass.mass;
  if (is_effort(field)) return effort_tolerance(strengths, weight, allowed_.epsilon, truth);
  if (is_friction) {
    return (core_f64::FRICTION_STEP + rounded_reserve(strengths, weight, allowed_.epsilon)) * truth * truth +
           effort_share(strengths) * truth * (1 - truth);
  }
  const double strongest = *std::max_element(strengths.digits.begin(), strengths.digits.end());
  return EFFORT_SHARE * (truth + scene_.gravity * glass.largest_mass) + 3 * std::sqrt(allowed_.epsilon) * strongest;
}

// The floor of a number that is or contains an effort, which is the search's answer: the hold term is the compared form of the worst effort.
double Comparer::search_floor(int field, std::size_t plane, std::size_t vessel, const GatheredPlanes& truth,
                              std::size_t grip) const {
  if (!has_effort(scene_)) return 0;
  const bool is_term = field == FIELD_TERMS && plane == 5;
  if (!is_term && field != FIELD_SCORE)
    return effort_floor(field, vessel, truth.real(truth.fields.plane[field] + static_cast<int>(plane), grip));
  const double weight = is_term ? 1 : scene_.score.hold;
  const auto floor = [&](double term) { return weight * effort_floor(FIELD_WORST_EFFORT, vessel, term); };
  return truth.fields.has(FIELD_WORST_EFFORT) ? floor(truth.real(truth.fields.plane[FIELD_WORST_EFFORT], grip))
                                              : floor(0) + floor(0.5);  // more than of any term
}

// Enters by how much the forces of the side that calls a state unsafe exceed the limits of a safe one: infinitely, if they exceed none. With efforts
// the hold is how far 1 / (1 + effort) is below that of an effort of 1; `effort` is the core's. Returns what exceeds its tolerance.
double Comparer::note_unsafe(Comparison& safe, std::size_t vessel, const GripInput& grip, const GatheredPlanes& stricter,
                             std::size_t i, std::size_t state, double effort, const Tolerance& tolerance) {
  const bool by_effort = has_effort(scene_);
  const auto force = [&](int field) { return stricter.real(stricter.fields.plane[field] + static_cast<int>(state), i); };
  const double normal = force(FIELD_NORMAL_FORCE) - scene_.force.max;
  const double hold = by_effort ? compared_form(FIELD_EFFORT, 1) - compared_form(FIELD_EFFORT, effort)
                                : force(FIELD_HOLD_FORCE) - scene_.force.grip_strength;
  double of_hold = by_effort ? tolerance(FIELD_WORST_EFFORT, 0, i) + EFFORT_SHARE / 4 : tolerance(FIELD_HOLD_FORCE, state, i);
  // the effort of this state may move more than that of the worst one does: from less than 1 to infinite, at the limit of friction
  if (by_effort && std::abs(hold) > of_hold) of_hold += 2 * moves_state(vessel, grip, state);
  const double least_hold = by_effort ? -of_hold : 0;
  const double by_normal = normal < 0 && !(hold > least_hold) ? std::numeric_limits<double>::infinity() : std::max(0.0, normal);
  const double over = note_difference(safe, 1e3, vessel, i, by_normal, tolerance(FIELD_NORMAL_FORCE, state, i));
  return std::max(over, note_difference(safe, 1e3, vessel, i, std::max(0.0, hold), of_hold));
}

// A reported tilt is a choice among the listed ones: it must be as good a choice by the other side's forces, to their tolerances.
void Comparer::add_tilts(std::size_t vessel, const std::vector<GripInput>& grips, const GatheredPlanes& a, const GatheredPlanes& b,
                         const std::vector<char>& left_out, const Tolerance& tolerance) {
  const FieldSet& fields = a.fields;
  const bool by_effort = has_effort(scene_);
  std::vector<std::size_t> asked;  // where the sides report different safe tilts
  for (std::size_t i = 0; by_effort && i < a.count; ++i)
    if (left_out[i] == 0 && places_differ(FIELD_SAFE_TILT, a, b, i)) asked.push_back(i);
  const StateEfforts efforts(scene_, core_, vessel, grips, asked);
  Comparison& peak = row("force", PEAK_TILT, "mN");
  Comparison& safe = row("force", SAFE_TILT, "mN");
  const std::size_t tilts = scene_.tilts.size();
  for (std::size_t i = 0; i < a.count; ++i) {
    if (left_out[i] != 0 || !is_feasible(a.uint(FIELD_STATUS, i))) continue;
    ++peak.compared;
    ++safe.compared;
    double peak_over = 0, safe_over = 0;
    for (int fill = 0; fill < static_cast<int>(scene_fills(scene_)); ++fill) {
      const std::size_t first = fill * tilts;
      const auto reported = [&](const GatheredPlanes& side, int field) {
        return listed_place(side.real(fields.plane[field] + fill, i), scene_.tilts, PI);
      };
      const std::optional<std::size_t> reported_a = reported(a, FIELD_PEAK_TILT), reported_b = reported(b, FIELD_PEAK_TILT);
      constexpr double WRONG = std::numeric_limits<double>::infinity();
      if (reported_a.value_or(0) == 0 || reported_b.value_or(0) == 0) {
        peak_over = std::max(peak_over, note_difference(peak, 1e3, vessel, i, WRONG, 0));
        continue;
      }
      const std::size_t peak_a = first + *reported_a - 1, peak_b = first + *reported_b - 1;
      const auto feedback = [&](std::size_t state) {
        return b.real(fields.plane[FIELD_FEEDBACK_FORCE] + static_cast<int>(state), i);
      };
      const double of_peak = tolerance(FIELD_FEEDBACK_FORCE, peak_a, i) + tolerance(FIELD_FEEDBACK_FORCE, peak_b, i);
      peak_over =
          std::max(peak_over, note_difference(peak, 1e3, vessel, i, std::max(0.0, feedback(peak_b) - feedback(peak_a)), of_peak));
      const std::optional<std::size_t> safe_a = reported(a, FIELD_SAFE_TILT), safe_b = reported(b, FIELD_SAFE_TILT);
      if (!safe_a || !safe_b) {
        safe_over = std::max(safe_over, note_difference(safe, 1e3, vessel, i, WRONG, 0));
        continue;
      }
      if (safe_a == safe_b) continue;
      // the first state that one side calls unsafe and the other does not
      const GatheredPlanes& stricter = *safe_a < *safe_b ? a : b;
      const std::size_t state = first + std::min(*safe_a, *safe_b);
      const double effort = by_effort ? efforts.of(i, state) : 0;
      safe_over = std::max(safe_over, note_unsafe(safe, vessel, grips[i], stricter, i, state, effort, tolerance));
    }
    count_outside(peak, vessel, i, peak_over);
    count_outside(safe, vessel, i, safe_over);
  }
}

// The reported worst state is a choice among all. If the sides name two, each must be as bad as the worst by the core's efforts, to the tolerance of
// the worst effort plus this state's own spread.
void Comparer::add_worst_states(std::size_t vessel, const std::vector<GripInput>& grips, const GatheredPlanes& a,
                                const GatheredPlanes& b, const GatheredPlanes& truth, const std::vector<char>& left_out,
                                const Tolerance& tolerance) {
  std::vector<std::size_t> asked;
  for (std::size_t i = 0; i < a.count; ++i)
    if (left_out[i] == 0 && asks_worst_state(vessel, a, b, truth, i)) asked.push_back(i);
  const StateEfforts efforts(scene_, core_, vessel, grips, asked);
  const double scale = fine_unit(field_row(FIELD_WORST_EFFORT)).scale;
  const std::size_t states = scene_fills(scene_) * scene_.tilts.size();
  Comparison& entry = row("effort", WORST_STATE, fine_unit(field_row(FIELD_WORST_EFFORT)).name);
  entry.compared += static_cast<std::uint64_t>(std::count(left_out.begin(), left_out.end(), 0));
  for (const std::size_t i : asked) {
    double most = 0, of_most = tolerance(FIELD_WORST_EFFORT, 0, i);
    for (const GatheredPlanes* side : {&a, &b}) {
      const std::optional<std::size_t> named = worst_state(vessel, *side, i);
      const std::size_t state = named.value_or(0);
      const double least = efforts.least_form(i, states);
      const double above = compared_form(FIELD_EFFORT, efforts.of(i, state)) - least;
      const double wrong = named && !std::isnan(above) ? above : std::numeric_limits<double>::infinity();
      double allowed = tolerance(FIELD_WORST_EFFORT, 0, i);
      if (std::isfinite(wrong) && wrong > allowed) allowed += 2 * moves_state(vessel, grips[i], state);
      if (!(wrong / allowed > most / of_most)) continue;
      most = wrong;
      of_most = allowed;
    }
    count_outside(entry, vessel, i, note_difference(entry, scale, vessel, i, most, of_most));
  }
}

// The spread of the core's own 1 / (1 + effort) of one state, which may exceed that of the worst state.
double Comparer::moves_state(std::size_t vessel, const GripInput& grip, std::size_t state) const {
  const FieldSet fields = make_field_set({FIELD_EFFORT, FIELD_STATUS}, scene_);
  const auto form = [&](const Evaluator& core, const std::vector<GripInput>& grips) {
    return compared_form(FIELD_EFFORT,
                         gather(core, fields, vessel, grips).real(fields.plane[FIELD_EFFORT] + static_cast<int>(state), 0));
  };
  const double at = form(core_, {grip});
  double most = 0;
  const auto note = [&](double other) {
    const double difference = figure_difference(other, at);
    if (std::isfinite(difference)) most = std::max(most, difference);
  };
  for (int way = 0; way < WAYS; ++way) note(form(core_, moved({grip}, way, shift(vessel), reach(scene_))));
  for (const auto& core : others_) note(form(*core, {grip}));
  return most;
}

// How far a side may be off in a place, m: it ends anywhere within its stop tolerance, and rounds.
double Comparer::shift(std::size_t vessel) const {
  return allowed_.stop_tolerance + ROUNDINGS * allowed_.epsilon * (reach(scene_) + scene_.vessels[vessel].height);
}

// The place of a reported value among the listed ones, from 1; 0 for NaN, and nothing where it is none of them. Listed values are at most
// rounded to the coarser precision. No value is larger than `largest`.
std::optional<std::size_t> Comparer::listed_place(double reported, const std::vector<double>& listed, double largest) const {
  if (std::isnan(reported)) return 0;
  const std::size_t nearest = nearest_place(listed, reported);
  if (!(std::abs(listed[nearest] - reported) <= 4 * allowed_.epsilon * largest)) return std::nullopt;
  return nearest + 1;
}

double Comparer::volume_tolerance(std::size_t vessel) const {
  return (4 * allowed_.level_tolerance + ROUNDINGS * allowed_.epsilon) * core_.constants(vessel).capacity;
}

// The level is solved to its tolerance of the capacity and sums of slices are rounded; a center of mass is compared by its moment, because the last
// drop's place means nothing.
void Comparer::add_liquid(std::size_t vessel, const std::vector<LiquidResult>& a, const std::vector<LiquidResult>& b) {
  if (a.empty()) return;
  const double of_volume = volume_tolerance(vessel), of_moment = 2 * of_volume * scene_.vessels[vessel].height;
  const auto compare = [&](const char* name, const char* unit, double scale, double tolerance, auto value) {
    Comparison& entry = row("liquid", name, unit);
    for (std::size_t s = 0; s < a.size(); ++s) {
      const double difference = figure_difference(value(a[s]), value(b[s]));
      ++entry.compared;
      count_outside(entry, vessel, s, note_difference(entry, scale, vessel, s, difference, tolerance));
    }
  };
  compare("volume", "mL", 1e6, of_volume, [](const LiquidResult& r) { return r.volume; });
  compare("poured", "mL", 1e6, of_volume, [](const LiquidResult& r) { return r.poured; });
  compare("lean moment", "mL mm", 1e9, of_moment, [](const LiquidResult& r) { return r.volume * r.lean; });
  compare("height moment", "mL mm", 1e9, of_moment, [](const LiquidResult& r) { return r.volume * r.height; });
}

bool is_of_precision(const Comparer& translation, const Comparer& cost, const Comparer& device) {
  const auto off = [](const Comparer& comparer, const Outlier& at) {
    for (const Outlier& other : comparer.outliers())
      if (other.row == at.row && other.vessel == at.vessel && other.grip == at.grip) return other.difference;
    return 0.0;
  };
  const auto is_the_cores = [&](const Outlier& outlier) {
    const double of_core = off(cost, outlier);
    return of_core > 0 && off(device, outlier) <= of_core;
  };
  const std::vector<Outlier>& outliers = translation.outliers();
  return !outliers.empty() && translation.excluded() <= translation.allowed() &&
         std::all_of(outliers.begin(), outliers.end(), is_the_cores);
}

bool Comparer::holds() const {
  const bool inside = std::all_of(rows_.begin(), rows_.end(), [](const Comparison& r) { return r.outside == 0; });
  return inside && excluded_ <= allowed() && (grazing_ + excluded_ < grips_ || grips_ == 0);
}

Allowance allowance(Precision precision) {
  if (precision == Precision::single) return {std::numeric_limits<float>::epsilon(), STOP_TOLERANCE_F32, LEVEL_TOLERANCE_F32, true};
  return {std::numeric_limits<double>::epsilon(), STOP_TOLERANCE_F64, LEVEL_TOLERANCE_F64, true};
}

Allowance float_against_double() {
  Allowance allowed = allowance(Precision::single);
  allowed.same_stop = false;
  return allowed;
}

std::uint64_t allowed_flips(std::uint64_t grips) { return largest_plausible_count(grips, FLIP_SHARE, FLIP_SIGNIFICANCE); }

}  // namespace wholehand
