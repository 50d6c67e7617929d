// SPDX-License-Identifier: MIT
// The core with an interface of plain doubles, so that both precisions can be linked: `core_f64` is the reference and drives the product; `core_f32`
// measures what single precision costs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/backend.h"
#include "core/planes.h"
#include "core/prepared.h"
#include "core/result.h"
#include "core/scene.h"

namespace wholehand {

struct PreparedLattice;  // core/prepare.h

// Evaluation options beyond the scene, for measuring shortcuts, not for users.
struct EvaluatorOptions {
  int lattice_samples = 0;  // > 0: replace each outline by a regular lattice of that many samples along its longest side
  int lattice_bits = 32;    // of a sample: 32, or 16 (half precision)
  int quadrature_points = QUADRATURE_POINTS;  // liquid: Gauss-Legendre points a piece, 2..64
  double stop_tolerance = 0;                  // m; 0: the precision's named one
  double effort_tolerance = 0;                // of an effort's bracket, relative; 0: EFFORT_TOLERANCE
  int trace_steps = 0, advance_steps = 0;     // at most; 0: the named numbers
  int gap_table = 0;  // > 0: the closure by interpolation in a table of so many entries, 2..GAP_TABLE_LARGEST; 0: solved
};

// Facts of a vessel, independent of grips; SI. `largest` is the load upright at the scene's largest fill: mass of glass and liquid, the liquid's
// share of it, and that share's part of the center of mass's height.
struct VesselConstants {
  double capacity = 0;          // m3, upright to the brim; 0 without a cavity
  double mass = 0;              // empty, kg
  Triple center_of_mass{};      // empty, vessel frame, m
  double torque_reference = 0;  // per object, N m
  double largest_mass = 0, largest_share = 0, largest_height = 0;
};

// A scene prepared for the kernels. Immutable after construction; any thread may call every method.
class Evaluator {
 public:
  virtual ~Evaluator() = default;

  // One grip with every intermediate value. Allocates nothing.
  virtual void grip(std::size_t vessel, const GripInput& grip, GripResult& result) const = 0;

  // Liquid of one vessel at a fill (fraction of the capacity) and tilt (rad, 0..pi), minus what poured on the way there.
  virtual LiquidResult liquid(std::size_t vessel, double fill, double tilt) const = 0;

  // Force of a feasible grip holding `liquid` at `tilt`. `opening` is g_grasp - g of the device, m.
  virtual StateResult state(std::size_t vessel, const GripInput& grip, const GripResult& result, const LiquidResult& liquid,
                            double tilt, double opening = 0) const = 0;

  // Scores over the scene's fills and the tilts that count there (core/counted_tilts.h).
  virtual GripScore score(std::size_t vessel, const GripInput& grip, const GripResult& result) const = 0;

  // Where the posed hand of a feasible grip presses (kernel 9). None if the evaluator does not compute contacts.
  virtual std::vector<GripContact> contacts(std::size_t vessel, const GripResult& result) const;

  // Only the joints of a grip's posed hand, vessel frame, m; nothing if the grip is infeasible.
  virtual std::optional<PosedHand> posed(std::size_t vessel, const GripInput& grip) const;

  // Evaluates `count` grips into planes of `stride` doubles (uints likewise). Infeasible grips have NaN reals (but t, gap and midpoint from too_wide
  // on); score and terms are 0. States that are left out are NaN. `least_score`: see RunRequest.
  virtual void planes(std::size_t vessel, const GripInput* grips, std::size_t count, const FieldSet& fields, std::size_t stride,
                      double* reals, std::uint32_t* uints, double least_score = NO_LEAST_SCORE) const = 0;

  // Signed distance and its gradient (unit) at a point of the vessel frame, m.
  virtual double distance(std::size_t vessel, const Triple& point) const = 0;
  virtual Triple gradient(std::size_t vessel, const Triple& point) const = 0;

  virtual VesselConstants constants(std::size_t vessel) const = 0;
  double capacity(std::size_t vessel) const { return constants(vessel).capacity; }
  double empty_mass(std::size_t vessel) const { return constants(vessel).mass; }
  Triple empty_center_of_mass(std::size_t vessel) const { return constants(vessel).center_of_mass; }
  virtual double pouring_tilt(std::size_t vessel, double fill) const = 0;  // rad; NaN where it never pours (nothing in it)
  virtual double gap_at(double closure) const = 0;                         // g(c) at hand scale 1 times the scene's, m

  // The samples that replace a vessel's outline; null if none do.
  virtual const PreparedLattice* lattice(std::size_t vessel) const;
  // Bytes of everything that the kernels read: outlines or lattices, cavities, tables of hand, lips, states and quadrature.
  virtual std::size_t table_bytes() const { return 0; }
};

// Prepares a scene. Throws Error (usage) if the scene is physically impossible: a hand whose gap does not strictly fall (names the closure at which
// it turns), a wall thicker than the vessel, a cavity that folds over itself.
std::unique_ptr<Evaluator> make_core_evaluator(const Scene& scene, const EvaluatorOptions& options = {});
std::unique_ptr<Evaluator> make_core_float_evaluator(const Scene& scene, const EvaluatorOptions& options = {});

}  // namespace wholehand
