// SPDX-License-Identifier: MIT
// What a node writes in a sweep by machines that share no file system: the values of its grips, at their places in the result. The places
// between them store nothing.
#pragma once

#include <string>
#include <string_view>

#include "sweeps/result/output_names.h"
#include "sweeps/result/run_layout.h"

namespace wholehand {

// How a shard begins; the identifier of its sweep and a line's end follow.
inline constexpr std::string_view SHARD_START = "wholehand shard of sweep ";

// NAME.nc.NODE.shard beside NAME.nc.partial.
std::string shard_path(const OutputNames& names, const std::string& node);

// Another one each time.
std::string new_shard_id();

// Whether a shard of this sweep is there.
bool is_shard(const std::string& path, const std::string& id);

// Why what is at this path is no shard of the wanted sweep; empty: nothing is there.
std::string why_no_shard(const std::string& path);

// Makes an empty shard, in place of any other. Throws Error: (usage) what is there is no shard, and stays; (failure) it cannot be made, or the layout
// leaves no room for how it begins.
void make_shard(const std::string& path, const std::string& id, const RunLayout& layout);

}  // namespace wholehand
