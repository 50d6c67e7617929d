// SPDX-License-Identifier: MIT
// Maps of a vessel in a report over height and roll: the best score, with the fingers and the force of its grip; and the least worst effort, of any
// grip.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/charts/field.h"
#include "evidence/report/source.h"
#include "sweeps/result/heat_map.h"
#include "sweeps/result/mark.h"

namespace wholehand {

struct MapCell {
  CellKind kind = CellKind::absent;  // no feasible grip, only implausible ones, or a best one:
  double score = 0;
  std::uint64_t grip = 0;                                        // in the plan
  double fingers = std::numeric_limits<double>::quiet_NaN();     // used
  double peak_force = std::numeric_limits<double>::quiet_NaN();  // N, largest over all fills
  double effort = std::numeric_limits<double>::quiet_NaN();      // least worst effort of a plausible grip; infinite: nothing holds
  std::uint64_t effort_grip = 0;                                 // the first grip that has it
};

struct GripMap {
  sweeps::MapAxis heights, rolls;
  std::vector<MapCell> cells;  // height-major
  bool knows_reasons = false;  // otherwise a grip without a score counts as implausible
  bool has_fingers = false, has_forces = false, has_efforts = false;
  bool is_by_core = false;      // some fingers and forces come from the core
  const MapCell* best() const;  // null if no grip is feasible and plausible
};

// The counts of a vessel's grips. False: the file lacks what they need.
bool read_counts(const ReportSource& source, std::size_t vessel, sweeps::GripCounts& counts);

// Whether there is a score to map.
bool has_map(const ReportSource& source);
// The variable with the worst effort of each grip; null if the file lacks it.
const sweeps::Variable* effort_variable(const ReportSource& source);
// The best of equal scores is the first. Fingers and forces that the file lacks come from the core, if there is one. `effort`: one real per grip,
// infinite if nothing holds the vessel and NaN if the grip is not plausible; null: there are no efforts.
GripMap read_map(const ReportSource& source, std::size_t vessel, const sweeps::Variable* effort);
inline GripMap read_map(const ReportSource& source, std::size_t vessel) {
  return read_map(source, vessel, effort_variable(source));
}

// One color scale for all vessels, so that their maps can be compared.
struct MapScales {
  ColorScale score, fingers, peak_force, effort;
};
constexpr double MOST_MAPPED_EFFORT = 2;  // greater ones have its color
MapScales map_scales(const std::vector<GripMap>& maps);

// A figure of the available maps, with the listed grips marked. `id`: of the vessel, in the page.
void write_maps(MarkupWriter& html, const ReportSource& source, std::size_t vessel, const GripMap& map, const MapScales& scales,
                const std::vector<Candidate>& best, const std::string& id);

}  // namespace wholehand
