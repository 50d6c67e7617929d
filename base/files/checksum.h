// SPDX-License-Identifier: MIT
// Checksums of what a sweep wrote: data in many places of a file, hashed while it is written or read back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace wholehand {

// A 128-bit XXH3 checksum over runs. Each run is fed in order, but runs may come in any order and be cut anywhere.
class RunsChecksum {
 public:
  RunsChecksum();
  ~RunsChecksum();
  RunsChecksum(RunsChecksum&&) noexcept;
  RunsChecksum& operator=(RunsChecksum&&) noexcept;

  void add(std::size_t run, const void* data, std::size_t size);
  // The checksum of all runs so far, in hexadecimal digits. More data may follow.
  std::string text() const;

 private:
  struct Hash;
  std::vector<std::unique_ptr<Hash>> runs_;
};

// The checksum of one piece of data.
std::string checksum_text(const void* data, std::size_t size);

// 64 bits of it, which also depend on `before`.
std::uint64_t checksum_after(std::uint64_t before, const void* data, std::size_t size);

// `size` bytes of a file from `offset` on.
struct FileRange {
  std::uint64_t offset = 0, size = 0;
  bool operator==(const FileRange&) const = default;
};

// Adds a range of an open file to a run, as far as the file has it. Returns false if it cannot be read.
bool add_range(RunsChecksum& checksum, std::size_t run, int file, FileRange range);

// The checksum and the length of an open file, without some ranges, which are in ascending order. Nothing if the file cannot be read.
std::optional<std::string> checksum_without(int file, const std::vector<FileRange>& ranges);

}  // namespace wholehand
