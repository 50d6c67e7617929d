// SPDX-License-Identifier: MIT
// Merges the shards that the nodes of a sweep wrote (sweeps/result/shard.h) into one result file.
#pragma once

#include <string>
#include <vector>

#include "base/text/error.h"

namespace wholehand::sweeps {

struct MergeRequest {
  std::string result;                // NAME.nc
  std::vector<std::string> folders;  // folder to search for shards, besides the result's
};

// Copies the grips of all shards into NAME.nc.partial, comparing each stretch with the checksum that the sweep's mark has of it, and those of the
// partial file itself too; then renames it. Memory does not grow with the files. The shards stay as they are. Prints what it did.
//
// Returns `interrupted` after a signal; the same call begins again. Throws Error: (usage) NAME.nc is no sweep with shards, one is missing, or another
// process writes it; (failure) the sweep did not end, a shard is damaged, or the disk is full. NAME.nc.partial and the mark then stay.
ExitCode merge_shards(const MergeRequest& request);

}  // namespace wholehand::sweeps
