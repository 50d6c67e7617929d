// SPDX-License-Identifier: MIT
// Checksums of everything in a result file, kept in a variable of the file: of the values of each variable and vessel, block by block, and of the
// rest.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/files/checksum.h"

namespace wholehand::sweeps {

inline constexpr const char* CHECKSUMS = "checksums";        // the variable of characters, and its dimension
inline constexpr std::uint64_t CHECKSUM_BLOCK = 1ull << 20;  // largest number of bytes with a checksum of their own
inline constexpr const char* SWEEP_AGAIN = "; sweep again, or use a copy that is not damaged";

inline constexpr std::size_t CHECKSUM_LENGTH = 32;  // characters

// A numeric variable, or its part for one vessel.
struct ChecksumPart {
  std::string variable;
  std::optional<std::uint64_t> vessel;  // from 0; nothing: all of them, or the variable has no vessels
  FileRange range;
  std::vector<std::string> blocks;  // checksums of the range's blocks, as far as known

  std::uint64_t block_count() const { return (range.size + CHECKSUM_BLOCK - 1) / CHECKSUM_BLOCK; }
};

// Where a file has its values, in the file's order, and room for their checksums.
struct ChecksumParts {
  FileRange room;
  std::vector<ChecksumPart> parts;
};

// Characters that a variable over so many vessels (0: none) takes at most in the room, and those that the room takes besides.
std::uint64_t checksum_room(const std::string& variable, std::uint64_t vessels, std::uint64_t bytes);
inline constexpr std::uint64_t CHECKSUM_START_ROOM = 256;

// By HDF5, from a file that no process writes to meanwhile. Throws Error (failure).
ChecksumParts checksum_parts(const std::string& path);

// The checksum of a block of a part of an open file. Throws Error (failure): the file lacks it, or cannot be read.
std::string block_checksum(int file, const ChecksumPart& part, std::uint64_t block);

// Computes the unknown checksums, writes all into the open file `path`, and syncs it: the last change of a result. Throws Error (failure).
void write_checksums(int file, const std::string& path, ChecksumParts parts);

// The checksums of a file that is being read. Values are compared with theirs once, before their first use.
class ResultChecksums {
 public:
  // `text`: the contents of the file's variable CHECKSUMS. Compares everything except values of parts. Throws Error (usage), one line with the path:
  // the file is damaged, or was never finished.
  ResultChecksums(const std::string& path, const std::string& text);
  ~ResultChecksums();
  ResultChecksums(const ResultChecksums&) = delete;
  ResultChecksums& operator=(const ResultChecksums&) = delete;

  // Compares the values [first, last) of the `count` values of a variable, or all that the file holds. Both throw Error (usage) that names the
  // variable, and the vessel if the variable has vessels.
  void check(const std::string& variable, std::uint64_t first, std::uint64_t last, std::uint64_t count);
  void check_all();

 private:
  void check_block(ChecksumPart& part, std::uint64_t block);

  std::string path_;
  int file_ = -1;
  std::map<std::string, std::vector<ChecksumPart>> parts_;  // by variable; a compared block has no checksum any more
};

}  // namespace wholehand::sweeps
