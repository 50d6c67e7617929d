// SPDX-License-Identifier: MIT
#include "base/files/cache_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <vector>

#include "base/text/error.h"
#include "base/text/readable.h"

namespace wholehand {
namespace {

namespace fs = std::filesystem;

constexpr auto STALE = std::chrono::hours(1);  // an unfinished file older than this is abandoned
constexpr std::uintmax_t MOST_MEBIBYTES = 1'000'000'000;
constexpr std::string_view PIPELINES = ".pipelines";

struct CachedFile {
  fs::file_time_type used;
  std::uintmax_t size;
  fs::path path;
  bool is_whole;
};

bool is_digits(std::string_view text) { return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos; }

// The names that core/meshes/cache.cpp and host/pipeline_cache.cpp give: 32 hexadecimal digits, then KEY.grid, KEY.XXXXXX.partial,
// DEVICE-DRIVER.pipelines, DEVICE-DRIVER.pipelines.PROCESS.
bool is_kept_name(std::string_view name, bool& is_whole) {
  if (name.find_first_not_of("0123456789abcdef") != 32) return false;
  name.remove_prefix(32);
  is_whole = name == ".grid";
  if (is_whole || (name.starts_with('.') && name.ends_with(".partial"))) return true;
  const std::size_t ending = name.find(PIPELINES);
  if (ending == name.npos || name[0] != '-' || !is_digits(name.substr(1, ending - 1))) return false;
  const std::string_view rest = name.substr(ending + PIPELINES.size());
  is_whole = rest.empty();
  return is_whole || (rest[0] == '.' && is_digits(rest.substr(1)));
}

// Others may add and remove files meanwhile; missing ones are skipped.
std::vector<CachedFile> cached_files(const fs::path& folder) {
  std::vector<CachedFile> files;
  for (const fs::path& part : {folder, folder / "grids"}) {
    std::error_code gone;
    for (fs::directory_iterator entry(part, gone), end; !gone && entry != end; entry.increment(gone)) {
      std::error_code failed;
      bool is_whole = false;
      if (!is_kept_name(entry->path().filename().string(), is_whole)) continue;
      if (!fs::is_regular_file(entry->symlink_status(failed))) continue;
      const fs::file_time_type used = entry->last_write_time(failed);
      const std::uintmax_t size = failed ? 0 : entry->file_size(failed);
      if (!failed) files.push_back({used, size, entry->path(), is_whole});
    }
  }
  return files;
}

}  // namespace

std::string cache_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache && *cache == '/') return std::string(cache) + "/wholehand";
  const char* home = std::getenv("HOME");
  return home && *home == '/' ? std::string(home) + "/.cache/wholehand" : "";
}

std::uintmax_t cache_limit() {
  const char* given = std::getenv("WHOLEHAND_CACHE_MIB");
  if (!given || !*given) return DEFAULT_CACHE_BYTES;
  std::uintmax_t mebibytes = 0;
  const char* end = given + std::strlen(given);
  const auto [next, error] = std::from_chars(given, end, mebibytes);
  if (error != std::errc() || next != end || mebibytes > MOST_MEBIBYTES) {
    throw usage_error(
        fmt::format("WHOLEHAND_CACHE_MIB '{}'; allowed: a whole number of MiB, 0 to {} (0: no cache)", given, MOST_MEBIBYTES));
  }
  return mebibytes * MEBIBYTE;
}

CacheUse cache_use(const std::string& folder) {
  CacheUse use;
  for (const CachedFile& file : cached_files(folder)) {
    ++use.files;
    use.bytes += file.size;
  }
  return use;
}

std::string cache_text() {
  const std::uintmax_t limit = cache_limit();
  const std::string folder = cache_folder();
  if (folder.empty()) return "cache  none: neither XDG_CACHE_HOME nor HOME is an absolute path\n";
  const CacheUse use = cache_use(folder);
  const std::string bound = limit > 0 ? fmt::format("at most {} MiB", readable_number(limit / MEBIBYTE)) : "not used";
  return fmt::format("cache  {}  {} MiB in {}, {} (WHOLEHAND_CACHE_MIB)\n", folder,
                     fixed_text(static_cast<double>(use.bytes) / MEBIBYTE, 1), counted(use.files, "file"), bound);
}

void make_cache_room(const std::string& folder, std::uintmax_t bytes, std::uintmax_t limit) noexcept try {
  std::vector<CachedFile> files = cached_files(folder);
  std::sort(files.begin(), files.end(), [](const CachedFile& a, const CachedFile& b) { return a.used < b.used; });
  std::uintmax_t total = bytes;
  for (const CachedFile& file : files) total += file.size;
  const auto now = fs::file_time_type::clock::now();
  for (const bool wants_whole : {false, true}) {
    for (const CachedFile& file : files) {
      if (file.is_whole != wants_whole) continue;
      if (file.is_whole ? total <= limit : now - file.used <= STALE) continue;
      std::error_code ignored;
      fs::remove(file.path, ignored);
      total -= file.size;
    }
  }
} catch (const std::exception&) {
  // without memory for the list: the next run makes room
}

void touch_cached(const std::string& file) noexcept try {
  std::error_code ignored;
  fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
} catch (const std::exception&) {
  // it then counts as used when it was made
}

}  // namespace wholehand
