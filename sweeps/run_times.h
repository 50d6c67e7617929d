// SPDX-License-Identifier: MIT
// The times of earlier sweeps, kept in the cache folder between runs of the program.
#pragma once

#include <string>
#include <vector>

#include "sweeps/cost_model.h"

namespace wholehand {

// The file in a cache folder.
std::string run_times_file(const std::string& folder);

// What the file says. Empty where it is not there, and where it is not as it was written: then `why` says so in half a sentence.
std::vector<RunTime> read_run_times(const std::string& file, std::string& why);

// Replaces the file as a whole: a reader sees the old or the new one. Where two programs write at once, one run may be lost. Makes the
// folder where it is missing. False: it cannot be written, and nothing is changed.
bool write_run_times(const std::string& file, const std::vector<RunTime>& history) noexcept;

// This machine among those that share a home.
std::string machine_name();

}  // namespace wholehand
