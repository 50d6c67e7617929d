// SPDX-License-Identifier: MIT
#include "base/files/checksum.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <new>

namespace wholehand {
namespace {

constexpr std::uint64_t PIECE = 1 << 20;  // bytes

std::string hash_text(XXH128_hash_t hash) { return fmt::format("{:016x}{:016x}", hash.high64, hash.low64); }

}  // namespace

struct RunsChecksum::Hash {
  Hash() : state(XXH3_createState()) {
    if (!state) throw std::bad_alloc();
    XXH3_128bits_reset(state);
  }
  ~Hash() { XXH3_freeState(state); }
  Hash(const Hash&) = delete;
  Hash& operator=(const Hash&) = delete;
  XXH3_state_t* state;
};

RunsChecksum::RunsChecksum() = default;
RunsChecksum::~RunsChecksum() = default;
RunsChecksum::RunsChecksum(RunsChecksum&&) noexcept = default;
RunsChecksum& RunsChecksum::operator=(RunsChecksum&&) noexcept = default;

void RunsChecksum::add(std::size_t run, const void* data, std::size_t size) {
  while (runs_.size() <= run) runs_.push_back(std::make_unique<Hash>());
  XXH3_128bits_update(runs_[run]->state, data, size);
}

std::string RunsChecksum::text() const {
  std::string all;
  for (const auto& run : runs_) all += hash_text(XXH3_128bits_digest(run->state));
  return checksum_text(all.data(), all.size());
}

std::string checksum_text(const void* data, std::size_t size) { return hash_text(XXH3_128bits(data, size)); }

std::uint64_t checksum_after(std::uint64_t before, const void* data, std::size_t size) {
  return XXH3_64bits_withSeed(data, size, before);
}

bool add_range(RunsChecksum& checksum, std::size_t run, int file, FileRange range) {
  std::vector<char> buffer(std::min(range.size, PIECE));
  while (range.size > 0) {
    const ssize_t size =
        pread(file, buffer.data(), std::min<std::uint64_t>(range.size, buffer.size()), static_cast<off_t>(range.offset));
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return false;
    if (size == 0) return true;
    checksum.add(run, buffer.data(), static_cast<std::size_t>(size));
    range.offset += static_cast<std::uint64_t>(size);
    range.size -= static_cast<std::uint64_t>(size);
  }
  return true;
}

std::optional<std::string> checksum_without(int file, const std::vector<FileRange>& ranges) {
  struct stat status {};
  if (fstat(file, &status) != 0) return std::nullopt;
  const auto length = static_cast<std::uint64_t>(status.st_size);
  RunsChecksum checksum;
  checksum.add(0, &length, sizeof length);
  std::uint64_t place = 0;
  const auto add_until = [&](std::uint64_t end) { return end <= place || add_range(checksum, 0, file, {place, end - place}); };
  for (const FileRange& range : ranges) {
    if (!add_until(range.offset)) return std::nullopt;
    place = std::max(place, range.offset + range.size);
  }
  return add_until(length) ? std::optional(checksum.text()) : std::nullopt;
}

}  // namespace wholehand
