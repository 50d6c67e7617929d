// SPDX-License-Identifier: MIT
// Where the program keeps what it can make again, and how much of it: lattices of meshes in `grids`, compiled pipelines beside it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace wholehand {

// $XDG_CACHE_HOME/wholehand, else ~/.cache/wholehand; empty where neither variable holds an absolute path. It need not exist.
std::string cache_folder();

constexpr std::uintmax_t MEBIBYTE = std::uintmax_t{1} << 20;
constexpr std::uintmax_t DEFAULT_CACHE_BYTES = 1024 * MEBIBYTE;

// How many bytes all files together may take: WHOLEHAND_CACHE_MIB, else DEFAULT_CACHE_BYTES. 0: nothing is read and nothing is kept.
// Throws Error (usage) where the variable holds anything but a whole number of MiB.
std::uintmax_t cache_limit();

struct CacheUse {
  std::size_t files = 0;
  std::uintmax_t bytes = 0;
};

// Counts the files that the program keeps in `folder`, finished or begun. Files with other names do not count.
CacheUse cache_use(const std::string& folder);

// A line about what is kept between runs: where, how large, and how large it may become. Throws Error (usage) as cache_limit does.
std::string cache_text();

// Removes what was begun over an hour ago, then the files whose time of change is oldest, until so many bytes more fit below `limit`. Whoever
// uses a file sets that time (touch_cached). Files with other names stay. Several processes may do this at once, and a file that one of
// them is reading stays readable to it. Never throws.
void make_cache_room(const std::string& folder, std::uintmax_t bytes, std::uintmax_t limit) noexcept;

// Sets the file's time of change to now, as that of its last use; of a file that may only be read it stays.
void touch_cached(const std::string& file) noexcept;

}  // namespace wholehand
