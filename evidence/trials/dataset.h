// SPDX-License-Identifier: MIT
// The numbers of trials as NetCDF-4: trials.nc.
#pragma once

#include <cstdint>
#include <string>

#include "evidence/trials/options.h"
#include "evidence/trials/tried.h"

namespace wholehand {

// What the file says of the trials as a whole.
struct TrialOrigin {
  std::string engine, identity;
};

// No file of these trials is larger, and none is much smaller, bytes.
std::uint64_t trials_dataset_room(const Scene& scene, const TriedGrips& tried);

// Makes the file, which must not be there, after it has been seen that the disk has the room. Dimensions `vessel`, `grip` and
// `trial`; a trial has the place of its grip. Throws Error (failure), and then no file is left.
void write_trials_dataset(const std::string& path, const Scene& scene, const TrialOptions& options, const TriedGrips& tried,
                          const TrialOrigin& origin);

}  // namespace wholehand
