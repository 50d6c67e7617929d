// SPDX-License-Identifier: MIT
// A node's file in a sweep by machines without a shared file system: the values of its grips, at their places in the result, in a sparse file.
#pragma once

#include <string>
#include <string_view>

#include "sweeps/result/output_names.h"
#include "sweeps/result/run_layout.h"

namespace wholehand::sweeps {

// The first characters of a shard; its sweep's identifier and a line end follow.
inline constexpr std::string_view SHARD_START = "wholehand shard of sweep ";

// NAME.nc.NODE.shard beside NAME.nc.partial.
std::string shard_path(const OutputNames& names, const std::string& node);

// Another one each time.
std::string new_shard_id();

// Whether a shard of this sweep exists.
bool is_shard(const std::string& path, const std::string& id);

// Why the file at this path is not a shard of the wanted sweep; empty: there is no file.
std::string why_no_shard(const std::string& path);

// Makes an empty shard, replacing any other. Throws Error: (usage) the existing file is not a shard, and stays; (failure) it cannot be made, or the
// layout leaves no room for its beginning.
void make_shard(const std::string& path, const std::string& id, const RunLayout& layout);

}  // namespace wholehand::sweeps
