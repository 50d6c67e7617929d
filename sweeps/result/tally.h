// SPDX-License-Identifier: MIT
// Counts gathered on the host while a vessel's chunks arrive.
#pragma once

#include "core/planes.h"
#include "sweeps/result/mark.h"

namespace wholehand::sweeps {

// Adds the grips of a chunk to the counts. Without a kept FIELD_STATUS, only their number. `gate`: gate_tolerance of the vessel.
void count_grips(const PlaneChunk& chunk, const FieldSet& fields, double gate, GripCounts& counts);

// "5,321 of 9,216 grips feasible (3,000 too wide, 895 misses); of these 310 implausible (200 through the table, 30 with fingers in each other, 90
// only too deep), 2,180 not held, 4,100 antipodal, 12 with a blocked finger". Parts appear if they are known. `reasons_known`: whether the status was
// kept; `azimuths`: number of azimuths for which each grip stands.
std::string counts_line(const GripCounts& counts, bool reasons_known, std::uint64_t azimuths);

// The same in short: "2,133 of 9,216 grips hold; 168 not held, 5,413 through the table, 1,454 too deep, 48 on mouth". `judges_holding`: the scene has
// efforts; otherwise the remaining ones are plausible.
std::string short_counts_line(const GripCounts& counts, bool reasons_known, std::uint64_t azimuths, bool judges_holding);

}  // namespace wholehand::sweeps
