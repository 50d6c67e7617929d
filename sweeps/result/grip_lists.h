// SPDX-License-Identifier: MIT
// Lists of a sweep's grips, the best first: the sweep's own, and those that `wholehand rank` made of its result.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/backend.h"
#include "sweeps/lists/best.h"
#include "sweeps/result/sweep_result.h"

namespace wholehand {

struct RankedCandidate {
  std::size_t rank = 1;
  Candidate candidate;
};

// One list for each vessel and, where the plan has several, each hand scale: that of vessel v and hand scale s is number v * plan.hand_scales() + s.
using GripLists = std::vector<std::vector<RankedCandidate>>;

// Identifies a sweep: the same for the same scene, meshes, program, device, driver and precision. "sweep-" and 16 hexadecimal digits.
std::string sweep_id(const SweepOrigin& origin);

// The origin of a sweep that is under way, as far as its id goes, and that of the lists of its result file.
SweepOrigin origin_of(const Scene& scene, const std::string& version, const BackendInfo& info);
ListOrigin list_origin(const std::string& result, const SweepOrigin& origin);

// Whose grips a list has: "beaker1", "beaker1, hand scale 0.9"; and the same as part of a file's name, no two alike: "beaker1.hand0.9".
std::string list_name(const Scene& scene, const Plan& plan, std::size_t list);
std::vector<std::string> list_file_parts(const Scene& scene, const Plan& plan);

// The lists that the sweep wrote into its result; empty ones where it was asked for none. The result is in use with scene and plan.
GripLists lists_of_sweep(const SweepResult& result, const Scene& scene, const Plan& plan);

// The lists of a file by best_csv, in the order of their ranks; rows may have been left out and columns added since. Throws Error (usage), one line
// with the file and the line in it: it cannot be read, is no such list, is of another sweep, or names a grip, a vessel or a rank that is not
// there or is there twice.
GripLists read_grip_lists(const std::string& path, const SweepResult& result, const Scene& scene, const Plan& plan);

}  // namespace wholehand
