// SPDX-License-Identifier: MIT
// The recorded fields of a tick, and their encoding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "device/recordings/classic_netcdf.h"
#include "device/session/tick.h"

namespace wholehand::device {

// How a number of a tick is stored in the file.
enum class RecordedAs : std::uint8_t {
  real,     // double as float64
  number,   // int64 as float64: a whole number that a double holds
  word,     // uint32 as the int32 of the same bits, because classic files lack the unsigned type
  integer,  // int as int32
  flag,     // an enumeration of one byte, or a bool, as byte
};

// One variable of a recording: one member of a tick.
struct RecordedField {
  const char* name;
  const char* units;  // empty: it has none
  const char* long_name;
  const char* comment;     // empty: none
  const char* dimensions;  // besides the ticks, e.g. "contact xyz"; empty: none
  RecordedAs as;
  std::size_t offset;                     // of the member in a Tick
  double least = 0, most = 0;             // of integers and flags, both included
  bool is_finite = false;                 // of reals: a file with any other value is no recording
  const char* const* meanings = nullptr;  // of a flag's values, most + 1 of them
};

std::span<const RecordedField> recorded_fields();

// How many numbers it has in a tick with so many vessels, and in a Tick itself.
std::size_t recorded_values(const RecordedField& field, std::size_t vessels);
std::size_t bytes_in_tick(const RecordedField& field);

// Appends a field of a tick in the file's encoding, padded to four bytes.
void append_field(std::string& bytes, const RecordedField& field, const Tick& tick, std::size_t vessels);

// The inverse; false if a value is not allowed for the field. `bytes` holds what append_field writes.
bool load_field(const char* bytes, const RecordedField& field, Tick& tick, std::size_t vessels);

}  // namespace wholehand::device
