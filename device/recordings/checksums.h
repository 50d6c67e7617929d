// SPDX-License-Identifier: MIT
// Checksums that reveal any change to a recording: one for each tick, and one for everything known about the session.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/recordings/classic_netcdf.h"

namespace wholehand::device {

constexpr const char* CHECKSUM = "checksum";  // a variable over the ticks, and an attribute

// Sets the attribute: the checksum of the contents of header and fixed variables, wherever they lie in the file. It leaves out the number of records,
// which grows.
void set_checksum(classic::Header& header, const std::string& fixed);
bool has_right_checksum(const classic::Header& header, const std::string& fixed);

// The checksums of records, in order: over the values of a record and of those before it, wherever they lie in the record.
class RecordChecksums {
 public:
  // Throws Error (usage), without the file's name, if the header has no variable for them.
  explicit RecordChecksums(const classic::Header& header);

  // Writes the checksum of the next record into it.
  void store(char* record);
  // Whether the next record has the right one.
  bool is_next(const char* record);

 private:
  struct Run {
    std::uint64_t place = 0, size = 0;
  };
  std::uint32_t next(const char* record);

  std::vector<Run> runs_;  // of values, without the padding between them
  std::uint64_t place_ = 0, before_ = 0;
  std::string values_;
};

}  // namespace wholehand::device
