// SPDX-License-Identifier: MIT
// The paper's preliminary experiment by virtual people: each of them tries each choice of forces.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "core/scene.h"
#include "evidence/studies/force_statistics.h"

namespace wholehand {

// One person's trials of a vessel. Ends early if `stop` is set.
ForcesOfPerson forces_of_person(const Scene& scene, std::size_t vessel, std::uint64_t seed, std::uint64_t person,
                                const std::atomic<bool>& stop);

// As numbers, to the bit, for a journal.
std::vector<double> to_numbers(const ForcesOfPerson& forces);
ForcesOfPerson forces_from_numbers(const std::vector<double>& numbers);

}  // namespace wholehand
