// SPDX-License-Identifier: MIT
// Compares extreme scenes on every backend with the core in double.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/absent.h"
#include "evidence/check/compare.h"
#include "host/device.h"

namespace wholehand {

// A scene, what it stresses and what is expected of it, one line each.
struct ExtremeCase {
  std::string name, stresses, expected;
  Scene scene;
};

// From a scene whose file begins with `# Hard: ..` and `# Comes out: ..`; its name is the file's, without .toml. Throws Error (usage) if one of the
// lines is missing.
ExtremeCase extreme_case(const Scene& scene);

struct ExtremeOptions {
  std::string on = "vulkan";  // see open_backend; "core": no device
  host::DeviceOptions device;
  std::size_t grips = 200;  // of each vessel, at most; spread over the scene's
};

// One case on one backend. Differences are the largest from the core in double over all vessels, for feasible grips with equal discrete outcomes that
// do not graze; 0 for the core in double itself.
struct ExtremeRow {
  std::string name, backend, device, driver;
  Precision precision = Precision::full;
  std::uint64_t grips = 0, feasible = 0, implausible = 0, grazing = 0;
  std::array<std::uint64_t, 7> reasons{};                                   // by Reason; none: feasible
  std::uint64_t blocked = 0, unsettled_fingers = 0, unsettled_proxies = 0;  // grips
  int trace_steps = -1, advance_steps = -1;  // largest of a trace and of a finger's stage; -1: a device, which reports none
  double gap = 0, separation = 0, posed = 0, proxy = 0, center_of_mass = 0;  // m; that of vessel and liquid
  double volume = 0, torque = 0, feedback = 0, hold = 0;                     // m3, N m, N, N
  double table_depth = 0, self_depth = 0;                                    // m
  double effort = 0, push = 0, friction_needed = 0;                          // of the worst state; N
  std::uint64_t touch_flips = 0, touch_flips_outside = 0;  // grips that do not graze; outside: beyond the comparer's margin
  std::uint64_t feasible_flips = 0, feasible_flips_outside = 0;
  std::uint64_t misplaced = 0;  // values that should be finite and are not: must be 0
  std::string first_misplaced;
  bool holds = true;  // to the comparer's tolerances of this precision
  std::vector<Comparison> comparisons;
};

// Core in double and in float; device in float, and in double if supported. Throws Error as open_backend does.
std::vector<ExtremeRow> evaluate_extreme(const ExtremeCase& extreme, const ExtremeOptions& options = {});

// CSV: a head, and one line per row; the column names have the units.
std::string extreme_csv(const std::vector<ExtremeRow>& rows);

}  // namespace wholehand
