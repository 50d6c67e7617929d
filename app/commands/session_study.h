// SPDX-License-Identifier: MIT
// wholehand session --study: compares recordings of several people with the paper.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/text/error.h"

namespace wholehand {

struct RecordedPeople {
  std::vector<std::string> recordings;  // files, one per person; at least one
  std::string folder;                   // for the files; empty: none are written
  std::uint64_t seed = 1;               // of the samples for the intervals
};

// Prints the table. Notes about incomplete recordings go to standard error. Throws Error: (usage) a file is not a recording or has other vessels than
// the first, or the folder cannot be written over; (failure) a file cannot be written.
ExitCode study_recordings(const RecordedPeople& people);

}  // namespace wholehand
