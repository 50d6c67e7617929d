// SPDX-License-Identifier: MIT
// The statistics of the paper's preliminary experiment, from the trials of many people. docs/study.md has each of them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "evidence/studies/force_trial.h"
#include "evidence/studies/row.h"

namespace wholehand {

using ForcesOfPerson = std::array<ForceOutcome, FORCE_CHOICES>;  // by PAPER_CHOICES

constexpr std::array<double, 3> OPENINGS{0.5e-3, 1e-3, 2e-3};  // m: openings whose shares are reported beside those of lost grips

// Rows of the experiment "forces". Intervals are for ten people; NaN with fewer than ten. The same bits for any number of threads.
std::vector<StudyRow> force_rows(std::span<const ForcesOfPerson> people, const std::string& vessel, std::uint64_t seed,
                                 int resamples, int threads);

}  // namespace wholehand
