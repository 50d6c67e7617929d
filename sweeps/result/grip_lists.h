// SPDX-License-Identifier: MIT
// Lists of a sweep's grips, the best first: the sweep's own, and those that `wholehand rank` made from its result.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/backend.h"
#include "sweeps/lists/best.h"
#include "sweeps/result/sweep_result.h"

namespace wholehand::sweeps {

struct RankedCandidate {
  std::size_t rank = 1;
  Candidate candidate;
};

// One list for each vessel and, if the plan has several, each hand scale. The list of vessel v and hand scale s has number v * plan.hand_scales() +
// s.
using GripLists = std::vector<std::vector<RankedCandidate>>;

// Identifies a sweep: the same for the same scene, meshes, program, device, driver and precision. "sweep-" and 16 hexadecimal digits.
std::string sweep_id(const SweepOrigin& origin);

// The origin of a running sweep, as far as its id is concerned, and that of the lists of its result file.
SweepOrigin origin_of(const Scene& scene, const std::string& version, const BackendInfo& info);
ListOrigin list_origin(const std::string& result, const SweepOrigin& origin);

// A list's name: "beaker1", "beaker1, hand scale 0.9"; and its unique form in a file name: "beaker1.hand0.9".
std::string list_name(const Scene& scene, const Plan& plan, std::size_t list);
std::vector<std::string> list_file_parts(const Scene& scene, const Plan& plan);

// The lists that the sweep wrote into its result; empty ones if it was asked for none. The result is in use with scene and plan.
GripLists lists_of_sweep(const SweepResult& result, const Scene& scene, const Plan& plan);

// The lists of a file by best_csv, in the order of their ranks; rows may have been removed and columns added since. Throws Error (usage), one line
// with the file and the line in it: it cannot be read, is not such a list, is of another sweep, or names a grip, a vessel or a rank that does not
// exist or occurs twice.
GripLists read_grip_lists(const std::string& path, const SweepResult& result, const Scene& scene, const Plan& plan);

}  // namespace wholehand::sweeps
