// SPDX-License-Identifier: MIT
// NetCDF's classic format with 64-bit offsets (CDF-2; NetCDF User's Guide, appendix B), as far as recordings need it: a header that says
// where everything lies, then the fixed variables, then records that are only ever appended. Everything in it is big-endian.
//
// Not the NetCDF library, because a recording must stay readable when its process is killed or its disk fills up in the middle of a
// record, and because a foreign file must not be able to do harm: the library buffers, and it trusts headers.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace wholehand::device::classic {

enum class Type : std::uint32_t { byte = 1, text = 2, int16 = 3, int32 = 4, float32 = 5, float64 = 6 };
std::uint64_t type_size(Type type);

constexpr std::uint32_t MOST_RECORDS = 0xFFFFFFFE;    // one more means "count them from the file's length"
constexpr std::uint64_t RECORD_COUNT_PLACE = 4;       // in the file, four bytes
constexpr std::uint64_t LARGEST_HEADER = 8ull << 20;  // of those that are read

struct Dimension {
  std::string name;
  std::uint32_t length = 0;  // 0: the records
};

struct Attribute {
  std::string name;
  Type type = Type::text;
  std::string bytes;  // as they lie in the file, without padding
};

struct Variable {
  std::string name;
  Type type = Type::float64;
  std::vector<std::uint32_t> dimensions;  // numbers in its dimensions; the record dimension first if it has it
  std::vector<Attribute> attributes;
  // set by lay_out and parse_header
  bool is_record = false;
  std::uint64_t values = 0;  // of a record, or of all of it
  std::uint64_t size = 0;    // of these, padded to four bytes
  std::uint64_t begin = 0;   // position in the file, of the first record
};

struct Header {
  std::uint32_t records = 0;
  std::vector<Dimension> dimensions;
  std::vector<Attribute> attributes;
  std::vector<Variable> variables;
  // set by lay_out and parse_header
  std::uint64_t bytes = 0;         // its own length, without the reserved room behind it
  std::uint64_t record_begin = 0;  // of the first record
  std::uint64_t record_size = 0;   // from one record to the next; 0: no variable has records

  const Variable* variable(std::string_view name) const;
  const Attribute* attribute(std::string_view name) const;
};

Attribute text_attribute(const std::string& name, const std::string& value);
Attribute number_attribute(const std::string& name, const std::vector<double>& values);
Attribute integer_attribute(const std::string& name, const std::vector<std::int32_t>& values);
Attribute byte_attribute(const std::string& name, const std::vector<std::int8_t>& values);

// Assigns sizes and positions to all variables: the fixed ones `room` bytes behind the header, then the records.
void lay_out(Header& header, std::uint64_t room);

std::string encode_header(const Header& header);

// Parses the header at the start of a file of `file_size` bytes, `start` being at least its first min(file_size, LARGEST_HEADER) bytes. Throws Error
// (usage), without the file's name, if it is not a CDF-2 file, or contradicts itself: counts beyond its length, variables without a position, before
// the end of the header or overlapping. Fixed variables lie wholly within the file; records may be missing.
Header parse_header(std::string_view start, std::uint64_t file_size);

// ---- numbers, big-endian ----

inline void append_32(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
}
inline void append_64(std::string& bytes, std::uint64_t value) {
  append_32(bytes, static_cast<std::uint32_t>(value >> 32));
  append_32(bytes, static_cast<std::uint32_t>(value));
}
inline void append_real(std::string& bytes, double value) { append_64(bytes, std::bit_cast<std::uint64_t>(value)); }

inline std::uint32_t load_32(const char* bytes) {
  std::uint32_t value = 0;
  for (int k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(bytes[k]);
  return value;
}
inline std::uint64_t load_64(const char* bytes) { return static_cast<std::uint64_t>(load_32(bytes)) << 32 | load_32(bytes + 4); }
inline double load_real(const char* bytes) { return std::bit_cast<double>(load_64(bytes)); }

}  // namespace wholehand::device::classic
