// SPDX-License-Identifier: MIT
// The messages of a sweep before, during and after its work.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/backend.h"
#include "sweeps/lists/best.h"
#include "sweeps/plan/plan.h"
#include "sweeps/plan/vessel_facts.h"

namespace wholehand::sweeps {

// How the time of a sweep was spent, s. The rest of the wall time is everything else.
struct SweepTimes {
  double wall = 0;
  double compiling = 0;  // of kernels, before the first grip
  double kernels = 0;    // that was waited for
  double writing = 0;    // of values, syncing included
  std::uint64_t written_bytes = 0;
};

// Grips and states, device, driver and precision, and omissions.
std::string opening_lines(const Scene& scene, const Plan& plan, const BackendInfo& info);

// The capacity and mass of each vessel, a line each.
std::string vessel_lines(const Scene& scene, const std::vector<VesselFacts>& facts);

// Whether the first grip of a list holds, by what margin and how surely: "grip 1 holds with 21 % of the hand's strength (margin 4.78) and in 97 % of
// its deviations". A list is empty only if no grip may be listed.
std::string verdict_text(const Scene& scene, const std::vector<BestGrip>& best);

// How many grips of a vessel are so near to the gate that another backend may decide otherwise: "3 grips are within 0.49 % of the gate, where another
// backend may decide otherwise"; empty if none is.
std::string gate_text(std::uint64_t at_gate, double gate_tolerance);

// The printed form of a list of a vessel's best grips: the table of the first, how many more are in `file` ("" if there is none), how many ranks are
// within view.score_tolerance of the next one, and whether the best lies at an end of an axis (not for a list of several results). Empty for an empty
// list.
std::string list_lines(const Scene& scene, const Plan& plan, std::size_t vessel, const std::vector<BestGrip>& best,
                       const std::string& file, const ListView& view);

// A vessel's verdict, its counts (a line or more) and its list; with several hand scales a verdict and a list of each. `lists`: of all vessels, as in
// GripLists; `failures`: for each list the replacement of its verdict, or nothing.
std::string best_lines(const Scene& scene, const Plan& plan, std::size_t vessel, const std::string& counts,
                       const std::vector<std::vector<BestGrip>>& lists, const std::vector<std::string>& failures,
                       const std::string& file, const ListView& view);

// The files with the size of the first, the times, and the resources used: CPU seconds and peak memory.
std::string closing_lines(const std::vector<std::string>& files, const SweepTimes& times);

// One sentence: the backend that `--on auto` chose, the sweep's time, and `alternative`, such as "; the core would take ..".
std::string backend_line(const BackendInfo& info, const SweepTimes& times, const std::string& alternative);

}  // namespace wholehand::sweeps
