// SPDX-License-Identifier: MIT
// The folder and size limit of what the program can make again: lattices of meshes in `grids`, and compiled pipelines beside it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace wholehand {

// $XDG_CACHE_HOME/wholehand, else ~/.cache/wholehand; empty if neither variable holds an absolute path. The folder need not exist.
std::string cache_folder();

constexpr std::uintmax_t MEBIBYTE = std::uintmax_t{1} << 20;
constexpr std::uintmax_t DEFAULT_CACHE_BYTES = 1024 * MEBIBYTE;

// The size limit of all files together in bytes: WHOLEHAND_CACHE_MIB, else DEFAULT_CACHE_BYTES. With 0 nothing is read or kept. Throws Error (usage)
// if the variable is not a whole number of MiB.
std::uintmax_t cache_limit();

struct CacheUse {
  std::size_t files = 0;
  std::uintmax_t bytes = 0;
};

// Measures the program's own files in `folder`, finished or not. Files with other names do not count.
CacheUse cache_use(const std::string& folder);

// A line that says where the cache is, how large it is, and how large it may become. Throws Error (usage) as cache_limit does.
std::string cache_text();

// Removes unfinished files older than an hour, then the files with the oldest modification time, until `bytes` more fit below `limit`. Every use
// updates that time (touch_cached). Files with other names stay. Several processes may do this at once, and a process that is reading a removed file
// can go on reading. Never throws.
void make_cache_room(const std::string& folder, std::uintmax_t bytes, std::uintmax_t limit) noexcept;

// Sets the file's modification time to now, to mark its last use. A read-only file keeps its time.
void touch_cached(const std::string& file) noexcept;

}  // namespace wholehand
