// SPDX-License-Identifier: MIT
// The grips of a sweep: a scene's axes as numbered grips, accessible in any order from any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/numbers/sobol.h"
#include "core/result.h"
#include "core/scene.h"

namespace wholehand::sweeps {

constexpr double LARGEST_SWEEP = 1e11;        // largest number of grips of all vessels in one sweep
constexpr std::size_t MOST_HAND_SCALES = 64;  // with a list of best grips each; more count as a range with one list

// Positions of the axes, slowest first, in the order in which grips are numbered and the result file stores them. Height is the fastest: a device
// evaluates neighbors together, and height changes a finger's motion least.
enum PlanPlace : int { PLACE_AZIMUTH, PLACE_OBLIQUITY, PLACE_ROLL, PLACE_OFFSET, PLACE_HAND_SCALE, PLACE_HEIGHT };

// What the grips have along an axis: one value; a list's; the equal steps of a range; or, if Sobol points fill a range, any value between its ends.
enum class AxisKind { number, list, steps, range };

// One axis of the grips.
struct PlanAxis {
  PlanAxis() = default;
  PlanAxis(std::string axis_name, std::string axis_units, std::string meaning, int dimension, const Axis& asked, bool is_sobol);

  std::string name;   // dimension of the result file; the height's is "height" or "height_fraction"
  std::string units;  // of its values: "m", "rad" or "1"
  std::string long_name;
  int axis = 0;                // AXIS_* of shaders/layout.h, and the Sobol dimension that feeds it
  std::vector<double> values;  // SI; for a range at least its ends
  AxisKind kind = AxisKind::number;
  double low = 0, high = 0;  // the least and the largest value
};

// The size of a scene's request. Reals, because the products may exceed any integer.
struct SweepSize {
  double grips = 0;   // of all vessels, stored
  double states = 0;  // grips x fills x tilts (just grips without tilts)
  double bytes = 0;   // of the results
};

// `bytes_per_grip`: bytes that the result file stores for one grip.
SweepSize sweep_size(const Scene& scene, double bytes_per_grip);

// Throws Error with the sizes: (usage) the sweep exceeds LARGEST_SWEEP grips; (failure) its results exceed `free_bytes`.
void check_sweep_size(const Scene& scene, const SweepSize& size, double free_bytes);

// A grid numbers its grips with the axes azimuth, obliquity, roll, offset, hand scale, height as digits, azimuth the slowest. Sobol
// points are numbered as the sequence goes. Every axis, even a constant one, keeps its own dimension of the sequence (AXIS_*), so
// that opening a further axis leaves the values of the others as they were. A range is filled continuously, equal parts of (0, 1)
// pick the values of a list, and a number stays. Every vessel gets the same points.
//
// A grid leaves out azimuth where it changes nothing: every vessel is a body of revolution whose center of mass lies on its axis,
// and no vector of the vessel frame is kept. Then the grips at the first azimuth stand for those at all `copies()` azimuths, and
// the result file repeats them.
class Plan {
 public:
  // Throws Error (usage) if the grips exceed LARGEST_SWEEP, or the Sobol points SOBOL_LARGEST_COUNT.
  Plan(const Scene& scene, bool keeps_vectors);

  bool is_sobol() const { return sobol_; }
  bool height_is_fraction() const { return height_is_fraction_; }
  const std::array<PlanAxis, 6>& axes() const { return axes_; }
  // Whether the evaluated grips differ along an axis (PLACE_*).
  bool varies(int place) const { return axes_[place].kind != AxisKind::number && !(place == PLACE_AZIMUTH && copies_ > 1); }
  std::uint64_t grips() const { return grips_; }    // evaluated per vessel
  std::uint64_t copies() const { return copies_; }  // stored grips per evaluated one
  std::uint64_t stored_grips() const { return grips_ * copies_; }
  bool is_symmetric() const { return symmetric_; }  // every vessel is a body of revolution, in mass too: azimuth changes nothing

  // The hands whose grips must not compete: the values of hand_scale, up to MOST_HAND_SCALES. Only one if the scene has one value, a continuous
  // range, or more. Best grips are listed for each vessel and each of these.
  std::size_t hand_scales() const { return scale_order_.empty() ? 1 : scale_order_.size(); }
  double hand_scale(std::size_t place) const { return axes_[PLACE_HAND_SCALE].values[place]; }  // where there are several
  // Indices of the hand scales of grips first .. first + count - 1; 0 if there is only one. Thread-safe.
  void hand_scales_of(std::uint64_t first, std::size_t count, std::size_t* out) const;
  std::size_t hand_scale_of(std::uint64_t grip) const;

  // Grips first .. first + count - 1 of a vessel into `out`. Thread-safe.
  void fill(std::size_t vessel, std::uint64_t first, std::size_t count, GripInput* out) const;
  GripInput grip(std::size_t vessel, std::uint64_t index) const;

  // A vessel's height of a grip in m from the value of the height's axis.
  double height(std::size_t vessel, double value) const;

  // Values of one axis (index into axes()) at grips first .. first + count - 1, before a height fraction is applied to a vessel.
  void coordinates(int axis, std::uint64_t first, std::size_t count, double* out) const;

 private:
  double axis_value(const PlanAxis& axis, const SobolPoint& point) const;
  // Lowest point of the vessel and height above it if heights are fractions, else 0 and 1.
  std::array<double, 2> height_span(std::size_t vessel) const;

  std::array<PlanAxis, 6> axes_;
  std::array<std::uint64_t, 6> counts_{};  // evaluated values of each axis of a grid
  bool sobol_ = false;
  bool symmetric_ = false;
  bool height_is_fraction_ = false;
  Sobol sequence_;
  std::uint64_t grips_ = 0;
  std::uint64_t copies_ = 1;
  std::vector<std::pair<double, std::size_t>> scale_order_;  // hand scales, ascending, and their places; empty: only one
  std::vector<std::array<double, 2>> vessel_spans_;          // y of the lowest point and height above it, m
};

}  // namespace wholehand::sweeps
