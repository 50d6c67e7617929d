// SPDX-License-Identifier: MIT
// Finds where a rendered wall settles, over its stiffness and everything that limits it: many presses, on all threads.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "device/loop/wall.h"

namespace wholehand::device {

// One press of a device against a wall.
struct WallPoint {
  WallDevice device;
  double stiffness = 0;
  int integrator = LOOP_EXACT, substeps = 1;
  double energy = 0;  // of the late samples, over the allowed one: at most 1 if it settles
  bool settles() const { return energy <= 1; }
};

// Points that differ only in stiffness, ascending, and the theory's limits.
struct WallColumn {
  std::vector<WallPoint> points;
  WallLimits theory;  // `simulated`: the largest stiffness below every point that does not settle; 0 if the first does not
};

// A map: columns of one kind, for a picture and for the table.
struct WallSheet {
  std::string name;  // "rates", "damping", ..
  std::vector<WallColumn> columns;
};

// The devices of the maps: one axis of a haptic device each, named by mass and damping.
struct NamedDevice {
  std::string name;
  double mass, damping;
};
const std::vector<NamedDevice>& wall_devices();

// All sheets: stiffness x wall damping x rate for every device (a quick run: for one, coarser); delays; encoder and friction; fingers; integrators;
// and random devices, fingers, walls and rates, each 1 % below and above its linear limit. About 500,000 points; a quick run has 11,000.
std::vector<WallSheet> wall_sheets(bool quick, std::uint64_t seed);
// Fills in the energies and `simulated`. Calls `go_on` with the number of finished points every few thousand points, and stops with false if it
// returns false.
bool run_walls(
    std::vector<WallSheet>& sheets, const std::function<bool(std::size_t done)>& go_on = [](std::size_t) { return true; });
// The largest stiffness that settles with the integrator, by the core, found as by wall_limits.
double integrator_limit(const WallDevice& device, int integrator, int substeps);
std::size_t count_points(const std::vector<WallSheet>& sheets);

std::string wall_csv(const std::vector<WallSheet>& sheets);  // a row a point
// One row per column; each ends with the run's columns (`device,driver,version,seed`).
std::string wall_limits_csv(const std::vector<WallSheet>& sheets, const std::string& run);

}  // namespace wholehand::device
