// SPDX-License-Identifier: MIT
// Checksums of what a sweep wrote: of data in many places of a file, hashed while it is written or when it is read back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace wholehand {

// A checksum over runs: each run is fed in order, the runs in any order, and how they were cut does not count. 128 bits, XXH3.
class RunsChecksum {
 public:
  RunsChecksum();
  ~RunsChecksum();
  RunsChecksum(RunsChecksum&&) noexcept;
  RunsChecksum& operator=(RunsChecksum&&) noexcept;

  void add(std::size_t run, const void* data, std::size_t size);
  // The checksum of all runs so far, as hexadecimal digits; more may follow.
  std::string text() const;

 private:
  struct Hash;
  std::vector<std::unique_ptr<Hash>> runs_;
};

// The checksum of one piece of data.
std::string checksum_text(const void* data, std::size_t size);

// 64 bits of it, which depend on `before` as well.
std::uint64_t checksum_after(std::uint64_t before, const void* data, std::size_t size);

// `size` bytes of a file from `offset` on.
struct FileRange {
  std::uint64_t offset = 0, size = 0;
  bool operator==(const FileRange&) const = default;
};

// Adds a range of an open file to a run; what the file does not have of it is left out. False: it cannot be read.
bool add_range(RunsChecksum& checksum, std::size_t run, int file, FileRange range);

// The checksum of an open file but for some ranges, which are in the file's order; and its length. Nothing where it cannot be read.
std::optional<std::string> checksum_without(int file, const std::vector<FileRange>& ranges);

}  // namespace wholehand
