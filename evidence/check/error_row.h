// SPDX-License-Identifier: MIT
// A row of figures: a variant's error and time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evidence/check/error_variants.h"

namespace wholehand {

enum ErrorQuantity : int {
  ERROR_SEPARATION,  // um, of points that the reference has inside or within LATTICE_BAND of the surface
  ERROR_POSED,       // um, distance between posed joints
  ERROR_PROXY,       // um, distance between proxies
  ERROR_CLOSURE,
  ERROR_GAP,       // um
  ERROR_VOLUME,    // mL, of the liquid left
  ERROR_COM,       // um, of glass and liquid together
  ERROR_TORQUE,    // N m, the one that the scene renders
  ERROR_FEEDBACK,  // N
  ERROR_HOLD,      // N, if finite on both sides
  // These are about the whole hand; nothing compares if the scene or its fields lack one.
  ERROR_TABLE_DEPTH,      // um
  ERROR_SELF_DEPTH,       // um, overlap of two fingers
  ERROR_EFFORT,           // these four relative, if finite on both sides: the effort of the worst state,
  ERROR_TIPS_EFFORT,      // .. of the two tips alone,
  ERROR_PUSH,             // .. what may push,
  ERROR_FRICTION_NEEDED,  // .. and the least friction
  ERROR_EFFORT_BRACKET,   // relative width of a state's bracket by the variant itself, if it varies the efforts' tolerance
  ERROR_QUANTITIES
};

// Over grips, each with the largest difference among its points or states; over states for the liquid's two. NaN if nothing compares.
struct ErrorFigures {
  double median, p999, max;
  std::string worst;  // vessel:index of the sampled grip, or of the state, fill-major
  std::uint64_t compared = 0;
};

// By nearest rank, NaN-safe: a value that only one side lacks is infinite. `where` names each error's place.
ErrorFigures error_figures(const std::vector<double>& errors, const std::vector<std::string>& where);

// A time from several runs.
struct TimeFigures {
  double median = 0, spread = 0;  // s; the spread is between the quartiles
};

// A variant's times relative to the base's median in interleaved runs, times the base's median over all its runs, so that minutes of a slower machine
// do not count against the variant timed then. Unscaled without a base, or if it took no time.
TimeFigures time_figures(std::vector<double> runs, const std::vector<double>& base_beside = {},
                         const std::vector<double>& base_all = {});

// More than a 99.9th percentile omits.
constexpr bool above_one_in_1000(std::uint64_t some, std::uint64_t all) { return 1000 * some > all; }

struct ErrorRow {
  ErrorVariant variant;
  std::array<ErrorFigures, ERROR_QUANTITIES> errors;
  std::uint64_t grips = 0;  // of all vessels, whether compared or not
  std::optional<std::uint64_t> touch_flips, touch_flips_outside, feasible_flips;
  std::uint64_t hold_flips = 0;  // compared grips whose hold force is finite on only one side, in some state
  double seconds_per_grip = 0;   // in the kernels of a sweep, median of the runs
  double spread = 0;             // s, between the quartiles of the runs
  ErrorFigures distance{};       // um, of a lattice on the core at points about the glass
  double touch_margin = 0;       // m: a touch flip nearer than this to the contact tolerance is inside it
  double liquid_seconds = 0;     // of one state's liquid on the core; 0: none
  std::size_t memory_bytes = 0;  // tables and lattices, and inputs and planes of a sweep of one vessel's grips
  std::string device, driver;

  // Largest of the lengths' 99.9th percentiles, um (separation, posed joints, proxies, gap, center of mass), and of the forces', N; a hold force on
  // only one side is an infinite error. NaN: the variant answers another question, nothing of it compares, or, for lengths, it varies only what no
  // length depends on.
  double length_error() const;
  double force_error() const;
  // Whether it disagrees on the feasibility of more than one grip in 1,000: then its errors omit too much.
  bool flips_too_often() const { return feasible_flips && above_one_in_1000(*feasible_flips, grips); }
};

}  // namespace wholehand
