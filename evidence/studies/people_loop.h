// SPDX-License-Identifier: MIT
// A loop over the people of an experiment that takes long for each of them.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "evidence/studies/journal.h"

namespace wholehand {

// The results of each of `people`, in the order of their numbers: `work(person)` on `threads` threads (0: all), or the journal's. New results are
// added to the journal. Shows progress. Returns what is done; less than all if `stop` was set.
std::vector<std::vector<double>> of_people(const std::string& experiment, std::uint64_t people, int threads, StudyJournal& journal,
                                           const std::atomic<bool>& stop,
                                           const std::function<std::vector<double>(std::uint64_t)>& work);

}  // namespace wholehand
