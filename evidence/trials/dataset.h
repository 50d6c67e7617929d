// SPDX-License-Identifier: MIT
// The numbers of trials as NetCDF-4: trials.nc.
#pragma once

#include <cstdint>
#include <string>

#include "evidence/trials/options.h"
#include "evidence/trials/tried.h"

namespace wholehand {

// The file's data on the trials as a whole.
struct TrialOrigin {
  std::string engine, identity;
};

// An upper bound of the file's bytes, close to the real size.
std::uint64_t trials_dataset_room(const Scene& scene, const TriedGrips& tried);

// Makes the file, which must not exist, after checking the disk space. Dimensions `vessel`, `grip` and `trial`; a trial stores the index of its grip.
// Throws Error (failure), and then no file is left.
void write_trials_dataset(const std::string& path, const Scene& scene, const TrialOptions& options, const TriedGrips& tried,
                          const TrialOrigin& origin);

}  // namespace wholehand
