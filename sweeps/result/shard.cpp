// SPDX-License-Identifier: MIT
#include "sweeps/result/shard.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <random>

#include "base/files/files.h"
#include "base/text/error.h"
#include "sweeps/result/output_names.h"

namespace wholehand::sweeps {
namespace {

std::string first_line(const std::string& id) { return std::string(SHARD_START) + id + "\n"; }

}  // namespace

std::string shard_path(const OutputNames& names, const std::string& node) { return names.target + "." + node + ".shard"; }

std::string new_shard_id() {
  std::random_device chance;
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", chance(), chance(), chance(), chance());
}

bool is_shard(const std::string& path, const std::string& id) { return begins_with(path, first_line(id)); }

std::string why_no_shard(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return errno == ENOENT ? "" : fmt::format("cannot be examined: {}", std::strerror(errno));
  if (!S_ISREG(status.st_mode)) return "is no file";
  if (access(path.c_str(), R_OK) != 0) return fmt::format("cannot be read: {}", std::strerror(errno));
  return begins_with(path, SHARD_START) ? "is a shard of another sweep" : "is no shard";
}

void make_shard(const std::string& path, const std::string& id, const RunLayout& layout) {
  const std::string line = first_line(id);
  std::uint64_t lowest = layout.height.value_or(line.size());
  for (const LayoutBlock& block : layout.blocks) lowest = std::min(lowest, block.offset);
  for (const std::uint64_t offset : layout.axes) lowest = std::min(lowest, offset);
  if (lowest < line.size()) throw failure_error(path + ": the result's values leave no room for the first line of a shard");
  check_overwrites_kind(path, SHARD_START, "shard", "--shards");
  // a new file under the old name: never over one that may still be open elsewhere
  write_whole_file(path, line, true);
}

}  // namespace wholehand::sweeps
