// SPDX-License-Identifier: MIT
// What advice changes, for the same people with and without it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "evidence/studies/advised_session.h"
#include "evidence/studies/page.h"
#include "evidence/studies/row.h"

namespace wholehand {

// Each number has three rows: subject "without", "with", and "difference" (with minus without, person by person). A number that needs grasps leaves
// out people who grasp in only one of the two sessions. Intervals are 95 % bootstrap intervals of the mean, resampling persons; absent with fewer
// than two people. The same for any `threads`.
std::vector<StudyRow> advice_rows(std::span<const AdvisedPerson> people, std::uint64_t seed, int resamples, int threads);

// A sentence for each number: "Effort: .21 lower (.25 to .18 lower). Advice helps." If the interval of the difference contains 0, the sentence says
// that no difference is seen.
std::vector<std::string> advice_sentences(std::span<const StudyRow> rows);

StudySection advice_section(std::vector<StudyRow> rows);
std::string advice_summary(std::span<const StudyRow> rows);

}  // namespace wholehand
