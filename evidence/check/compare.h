// SPDX-License-Identifier: MIT
// Two evaluations of the same grips side by side, quantity by quantity, with tolerances that come from how each grip's own answer moves.
//
// Arithmetic in float or double solves a nearby problem: every surface is met to within the stop tolerance, every position is rounded.
// So an answer may differ by as much as the core's own double answer moves when the grip is moved by that much, and no more. The bound
// is taken per grip and number: it grows where a finger grazes the glass, and nowhere else. docs/method.md has the derivation.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/backend.h"
#include "core/evaluator.h"
#include "core/fields.h"
#include "core/gather.h"

namespace wholehand {

// Allowed differences between two correct evaluations: of numbers by rounding, and of outcomes as a number of grips. Rounding and stop tolerance are
// those of the coarser precision of the two.
struct Allowance {
  double epsilon = 0;          // of the reals
  double stop_tolerance = 0;   // m
  double level_tolerance = 0;  // of the capacity
  // Both sides stop at that tolerance. If one continues to a finer one, it may use up its steps on a corner of a lattice that the other had finished
  // with; which side used up its steps is then not an outcome.
  bool same_stop = true;
};
Allowance allowance(Precision precision);
// Float on one side, double on the other.
Allowance float_against_double();

// Within the margin, discrete outcomes may differ in FLIP_SHARE of the grips in the long run. A sample contradicts that if at least as many
// differences would occur in less than FLIP_SIGNIFICANCE of all samples with exactly that share. The limit is strict, because neighboring grips
// differ together, and because a check makes up to three comparisons and must not fail by chance.
constexpr double FLIP_SHARE = 1e-3;
constexpr double FLIP_SIGNIFICANCE = 1e-6;
// How many of `grips` compared grips may differ: 1 of 1, 3 of 72, 6 of 400, 10 of 1,536, 18 of 4,608.
std::uint64_t allowed_flips(std::uint64_t grips);

// Whether a field is compared number by number. In a scene with strengths a hold force is an effort of a state, which the core computes for every
// backend.
bool is_compared_by_number(const Scene& scene, const Field& field);

// Every field that the scene has and that a comparison needs: all except efforts and hold forces of single states, which only the core computes.
FieldSet compared_fields(const Scene& scene);

// A number in its compared form: an effort and the least friction as 1 / (1 + number), which is finite even if they are not.
double compared_form(int field, double value);

// |a - b|: 0 for two NaN or two infinities of one sign, infinite if only one side is NaN.
double figure_difference(double a, double b);

// Height and lean of the center of mass of glass and liquid, m; the glass's own share to the side is left out, because no state changes it.
std::array<double, 2> loaded_center(const VesselConstants& glass, const LiquidResult& liquid);

// One quantity's comparison over all grips and vessels compared so far.
struct Comparison {
  std::string kernel, quantity, unit;
  double worst = 0;                         // largest difference, in the unit
  double tolerance = 0;                     // of that grip, in the unit; the largest if nothing differs
  std::size_t vessel = 0, grip = 0;         // where
  double worst_ratio = 0;                   // largest ratio of a difference to its own tolerance
  std::uint64_t compared = 0, outside = 0;  // grips; outside: over the tolerance
};

// A grip whose discrete outcomes differ; inside: the core's own outcome also changes within the allowance.
struct Flip {
  std::size_t vessel = 0, grip = 0;
  bool inside = false;
};

// A grip that exceeds its tolerance, or whose outcome differs beyond the margin: in which row, and by how much.
struct Outlier {
  std::size_t row = 0, vessel = 0, grip = 0;
  double difference = 0;  // in the row's unit; 1 for an outcome
};

// For which grips the core's own answers are moved, at twenty evaluations per grip. `needed`: if the sides differ by more than the floor of the
// tolerance. The grips outside, excluded and grazing are the same for both; for the other grips the tolerance is then only the floor.
enum class Spreads { where_needed, everywhere };

// Accumulates comparisons vessel by vessel.
class Comparer {
 public:
  Comparer(const Scene& scene, const Evaluator& core, Allowance allowed, Spreads spreads = Spreads::where_needed);

  // `a` and `b` evaluate `grips` of the vessel, both with the same fields. Grips that graze by the core, or within its allowance, are left out and
  // counted. So are those whose discrete outcomes differ while the core's own change within the allowance (excluded). Other differing ones count as
  // outside.
  void add(std::size_t vessel, const std::vector<GripInput>& grips, const GatheredPlanes& a, const GatheredPlanes& b);
  // `truth`: the core's own answers, with the same fields, from a caller that has them.
  void add(std::size_t vessel, const std::vector<GripInput>& grips, const GatheredPlanes& a, const GatheredPlanes& b,
           const GatheredPlanes& truth);
  void add_liquid(std::size_t vessel, const std::vector<LiquidResult>& a, const std::vector<LiquidResult>& b);

  const std::vector<Comparison>& rows() const { return rows_; }
  std::uint64_t grips() const { return grips_; }
  std::uint64_t grazing() const { return grazing_; }
  std::uint64_t feasible() const { return feasible_; }  // by the core
  std::uint64_t excluded() const { return excluded_; }  // discrete outcomes differ within the margin
  const std::vector<Flip>& flips() const { return flips_; }
  const std::vector<Outlier>& outliers() const { return outliers_; }
  std::uint64_t allowed() const { return allowed_flips(grips_ - grazing_); }  // so many excluded are no evidence
  // No number exceeds its tolerance, no more are excluded than allowed, and not all are left out.
  bool holds() const;

 private:
  struct Spread;
  using Tolerance = std::function<double(int field, std::size_t state, std::size_t grip)>;
  bool needs_spread(std::size_t vessel, const GatheredPlanes& a, const GatheredPlanes& b, const GatheredPlanes& truth,
                    const Tolerance& floor, std::size_t i) const;
  bool places_differ(int field, const GatheredPlanes& a, const GatheredPlanes& b, std::size_t i) const;
  std::optional<std::size_t> worst_state(std::size_t vessel, const GatheredPlanes& side, std::size_t i) const;
  bool asks_worst_state(std::size_t vessel, const GatheredPlanes& a, const GatheredPlanes& b, const GatheredPlanes& truth,
                        std::size_t i) const;
  Spread spread_of(std::size_t vessel, const std::vector<GripInput>& all, const GatheredPlanes& truth,
                   const std::vector<std::size_t>& chosen) const;
  std::vector<char> add_outcomes(std::size_t vessel, const GatheredPlanes& a, const GatheredPlanes& b, const GatheredPlanes& truth,
                                 const Spread& spread, const Tolerance& tolerance);
  bool differs_by_gate(const GatheredPlanes& a, const GatheredPlanes& b, std::size_t grip, const Tolerance& tolerance) const;
  double largest_of(const GatheredPlanes& truth, int field) const;
  void add_numbers(std::size_t vessel, const GatheredPlanes& a, const GatheredPlanes& b, const std::vector<char>& left_out,
                   const Tolerance& tolerance);
  void add_tilts(std::size_t vessel, const std::vector<GripInput>& grips, const GatheredPlanes& a, const GatheredPlanes& b,
                 const std::vector<char>& left_out, const Tolerance& tolerance);
  double note_unsafe(Comparison& safe, std::size_t vessel, const GripInput& grip, const GatheredPlanes& stricter, std::size_t i,
                     std::size_t state, double effort, const Tolerance& tolerance);
  double rests(int field, std::size_t k) const;
  double effort_floor(int field, std::size_t vessel, double truth) const;
  double search_floor(int field, std::size_t plane, std::size_t vessel, const GatheredPlanes& truth, std::size_t grip) const;
  double volume_tolerance(std::size_t vessel) const;
  void add_worst_states(std::size_t vessel, const std::vector<GripInput>& grips, const GatheredPlanes& a, const GatheredPlanes& b,
                        const GatheredPlanes& truth, const std::vector<char>& left_out, const Tolerance& tolerance);
  double moves_state(std::size_t vessel, const GripInput& grip, std::size_t state) const;
  double shift(std::size_t vessel) const;
  double corner(std::size_t vessel) const;
  std::optional<std::size_t> listed_place(double reported, const std::vector<double>& listed, double largest) const;
  Comparison& row(const std::string& kernel, const std::string& quantity, const std::string& unit);
  void count_outside(Comparison& entry, std::size_t vessel, std::size_t grip, double difference);

  const Scene& scene_;
  const Evaluator& core_;
  Allowance allowed_;
  Spreads spreads_;
  std::vector<std::shared_ptr<const Evaluator>> others_;  // with tips and strengths as far off as either side may be
  std::vector<Comparison> rows_;
  std::vector<Flip> flips_;
  std::vector<Outlier> outliers_;
  std::uint64_t grips_ = 0, grazing_ = 0, excluded_ = 0, feasible_ = 0;
};

// Whether single precision, and not the device, is why a device in float and the core in float differ (`translation`): wherever they do, the core in
// float itself exceeds the tolerance of the core in double (`cost`), and the device in float (`device`: against the core in double) is no further
// off. All three compare the same grips of one scene.
bool is_of_precision(const Comparer& translation, const Comparer& cost, const Comparer& device);

}  // namespace wholehand
