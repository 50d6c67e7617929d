// SPDX-License-Identifier: MIT
// Which traits of a person decide the results of the experiments of forces and sessions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "evidence/studies/force_statistics.h"
#include "evidence/studies/row.h"
#include "evidence/studies/session_statistics.h"

namespace wholehand {

// Rows of sensitivity (evidence/studies/sensitivity.h) for people 0, 1, .. of this seed. The outputs are means over a person's own grasps of the
// paper's vessels, or over the person's trials.
std::vector<StudyRow> session_sensitivity(std::span<const SessionSubject> people, const SessionVessels& vessels,
                                          std::uint64_t seed);
std::vector<StudyRow> force_sensitivity(std::span<const ForcesOfPerson> people, std::uint64_t seed);

}  // namespace wholehand
