// SPDX-License-Identifier: MIT
#include "device/recordings/classic_netcdf.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/error.h"

namespace wholehand::device::classic {
namespace {

constexpr std::string_view MAGIC{"CDF\2", 4};
constexpr std::uint32_t DIMENSIONS_TAG = 10, VARIABLES_TAG = 11, ATTRIBUTES_TAG = 12;
constexpr std::uint64_t MOST_DIMENSIONS_OF_ONE = 8;
constexpr std::uint64_t LARGEST_RECORD = 1ull << 32;    // bytes
constexpr std::uint64_t FURTHEST_PLACE = 1ull << 62;    // in a file
constexpr std::uint64_t LARGEST_VARIABLE = 1ull << 40;  // values, of a record or of all of it: no arithmetic below overflows

std::uint64_t padded(std::uint64_t bytes) { return (bytes + 3) / 4 * 4; }

void append_padding(std::string& bytes) { bytes.resize(padded(bytes.size()), '\0'); }

// All that is written has a length that is a multiple of four, so that padding the whole is padding the part.
void append_name(std::string& bytes, const std::string& name) {
  append_32(bytes, static_cast<std::uint32_t>(name.size()));
  bytes += name;
  append_padding(bytes);
}

void append_list(std::string& bytes, std::uint32_t tag, std::size_t count) {
  append_32(bytes, count == 0 ? 0 : tag);
  append_32(bytes, static_cast<std::uint32_t>(count));
}

void append_attributes(std::string& bytes, const std::vector<Attribute>& attributes) {
  append_list(bytes, ATTRIBUTES_TAG, attributes.size());
  for (const Attribute& attribute : attributes) {
    append_name(bytes, attribute.name);
    append_32(bytes, static_cast<std::uint32_t>(attribute.type));
    append_32(bytes, static_cast<std::uint32_t>(attribute.bytes.size() / type_size(attribute.type)));
    bytes += attribute.bytes;
    append_padding(bytes);
  }
}

// A header's bytes from the front; throws where they end or say what cannot be.
class HeaderBytes {
 public:
  explicit HeaderBytes(std::string_view bytes) : bytes_(bytes) {}

  std::string_view take(std::uint64_t count) {
    if (count > bytes_.size() - at_) throw usage_error("its header is cut off or damaged");
    const std::string_view part = bytes_.substr(at_, count);
    at_ += count;
    return part;
  }
  std::string_view take_padded(std::uint64_t count) { return take(padded(count)).substr(0, count); }
  std::uint32_t word() { return load_32(take(4).data()); }
  std::uint64_t long_word() { return load_64(take(8).data()); }
  std::string name() { return std::string(take_padded(word())); }

  // The length of a list whose every entry takes `least` bytes or more.
  std::uint32_t list(std::uint32_t tag, std::uint64_t least) {
    const std::uint32_t found = word(), count = word();
    if (found != tag && (found != 0 || count != 0)) throw usage_error("its header is damaged");
    if (count > (bytes_.size() - at_) / least) throw usage_error("its header is cut off or damaged");
    return count;
  }
  Type type() {
    const std::uint32_t value = word();
    if (value < 1 || value > 6) throw usage_error(fmt::format("its header is damaged: type {}", value));
    return static_cast<Type>(value);
  }
  std::uint64_t at() const { return at_; }

 private:
  std::string_view bytes_;
  std::uint64_t at_ = 0;
};

std::vector<Attribute> take_attributes(HeaderBytes& bytes) {
  std::vector<Attribute> attributes(bytes.list(ATTRIBUTES_TAG, 12));
  for (Attribute& attribute : attributes) {
    attribute.name = bytes.name();
    attribute.type = bytes.type();
    const std::uint64_t count = bytes.word();
    attribute.bytes = bytes.take_padded(count * type_size(attribute.type));
  }
  return attributes;
}

// What a variable takes, from its type and dimensions.
void measure(Variable& variable, const std::vector<Dimension>& dimensions) {
  variable.is_record = !variable.dimensions.empty() && dimensions[variable.dimensions[0]].length == 0;
  variable.values = 1;
  for (std::size_t k = variable.is_record ? 1 : 0; k < variable.dimensions.size(); ++k) {
    const std::uint64_t length = dimensions[variable.dimensions[k]].length;
    if (length == 0) throw usage_error(fmt::format("its variable '{}' has the records in the wrong place", variable.name));
    if (variable.values > LARGEST_VARIABLE / length)
      throw usage_error(fmt::format("its variable '{}' is too large", variable.name));
    variable.values *= length;
  }
  variable.size = padded(variable.values * type_size(variable.type));
}

Variable take_variable(HeaderBytes& bytes, const std::vector<Dimension>& dimensions) {
  Variable variable;
  variable.name = bytes.name();
  const std::uint32_t count = bytes.word();
  if (count > MOST_DIMENSIONS_OF_ONE) throw usage_error(fmt::format("its variable '{}' has {} dimensions", variable.name, count));
  for (std::uint32_t k = 0; k < count; ++k) {
    variable.dimensions.push_back(bytes.word());
    if (variable.dimensions.back() >= dimensions.size())
      throw usage_error("its header is damaged: a dimension that it does not have");
  }
  variable.attributes = take_attributes(bytes);
  variable.type = bytes.type();
  bytes.word();  // its size, which is not needed: of large variables it is wrong by definition
  variable.begin = bytes.long_word();
  if (variable.begin > FURTHEST_PLACE) throw usage_error(fmt::format("its variable '{}' has no place in the file", variable.name));
  measure(variable, dimensions);
  return variable;
}

// Variables lie behind the header, fixed ones within the file, and none upon another.
void check_places(const Header& header, std::uint64_t file_size) {
  std::vector<const Variable*> by_place;
  for (const Variable& variable : header.variables) by_place.push_back(&variable);
  std::stable_sort(by_place.begin(), by_place.end(), [](const Variable* a, const Variable* b) { return a->begin < b->begin; });
  std::uint64_t free_from = header.bytes;
  bool in_records = false;
  for (const Variable* variable : by_place) {
    const bool is_beyond = !variable->is_record && (variable->begin > file_size || variable->size > file_size - variable->begin);
    if (variable->begin < free_from || is_beyond || (in_records && !variable->is_record))
      throw usage_error(fmt::format("its variable '{}' has no place in the file", variable->name));
    in_records = variable->is_record;
    free_from = variable->begin + variable->size;
    // records follow each other without a gap
    if (in_records && free_from > header.record_begin + header.record_size)
      throw usage_error(fmt::format("its variable '{}' has no place in the records", variable->name));
  }
}

// The records' place and size, from the variables that have any.
void find_records(Header& header) {
  header.record_begin = header.record_size = 0;
  for (const Variable& variable : header.variables) {
    if (!variable.is_record) continue;
    header.record_begin = header.record_size == 0 ? variable.begin : std::min(header.record_begin, variable.begin);
    header.record_size += variable.size;
    if (header.record_size > LARGEST_RECORD) throw usage_error("its records are too large");
  }
}

}  // namespace

std::uint64_t type_size(Type type) {
  constexpr std::uint64_t SIZES[] = {0, 1, 1, 2, 4, 4, 8};
  return SIZES[static_cast<std::uint32_t>(type)];
}

const Variable* Header::variable(std::string_view name) const {
  const auto found = std::find_if(variables.begin(), variables.end(), [name](const Variable& v) { return v.name == name; });
  return found == variables.end() ? nullptr : &*found;
}

const Attribute* Header::attribute(std::string_view name) const {
  const auto found = std::find_if(attributes.begin(), attributes.end(), [name](const Attribute& a) { return a.name == name; });
  return found == attributes.end() ? nullptr : &*found;
}

Attribute text_attribute(const std::string& name, const std::string& value) { return {name, Type::text, value}; }

Attribute number_attribute(const std::string& name, const std::vector<double>& values) {
  Attribute attribute{name, Type::float64, {}};
  for (const double value : values) append_real(attribute.bytes, value);
  return attribute;
}

Attribute integer_attribute(const std::string& name, const std::vector<std::int32_t>& values) {
  Attribute attribute{name, Type::int32, {}};
  for (const std::int32_t value : values) append_32(attribute.bytes, static_cast<std::uint32_t>(value));
  return attribute;
}

Attribute byte_attribute(const std::string& name, const std::vector<std::int8_t>& values) {
  Attribute attribute{name, Type::byte, {}};
  for (const std::int8_t value : values) attribute.bytes += static_cast<char>(value);
  return attribute;
}

std::string encode_header(const Header& header) {
  std::string bytes(MAGIC);
  append_32(bytes, header.records);
  append_list(bytes, DIMENSIONS_TAG, header.dimensions.size());
  for (const Dimension& dimension : header.dimensions) {
    append_name(bytes, dimension.name);
    append_32(bytes, dimension.length);
  }
  append_attributes(bytes, header.attributes);
  append_list(bytes, VARIABLES_TAG, header.variables.size());
  for (const Variable& variable : header.variables) {
    append_name(bytes, variable.name);
    append_32(bytes, static_cast<std::uint32_t>(variable.dimensions.size()));
    for (const std::uint32_t dimension : variable.dimensions) append_32(bytes, dimension);
    append_attributes(bytes, variable.attributes);
    append_32(bytes, static_cast<std::uint32_t>(variable.type));
    append_32(bytes, static_cast<std::uint32_t>(variable.size));
    append_64(bytes, variable.begin);
  }
  return bytes;
}

void lay_out(Header& header, std::uint64_t room) {
  for (Variable& variable : header.variables) measure(variable, header.dimensions);
  header.bytes = encode_header(header).size();
  std::uint64_t at = header.bytes + padded(room);
  for (const bool records : {false, true}) {
    for (Variable& variable : header.variables) {
      if (variable.is_record != records) continue;
      variable.begin = at;
      at += variable.size;
    }
  }
  find_records(header);
}

Header parse_header(std::string_view start, std::uint64_t file_size) {
  if (!start.starts_with(MAGIC))
    throw usage_error(
        "is not a recording (NetCDF classic with 64-bit offsets; nccopy -k 64-bit-offset converts a rewritten recording back)");
  HeaderBytes bytes(start);
  bytes.take(MAGIC.size());
  Header header;
  header.records = bytes.word();
  header.dimensions.resize(bytes.list(DIMENSIONS_TAG, 8));
  for (Dimension& dimension : header.dimensions) {
    dimension.name = bytes.name();
    dimension.length = bytes.word();
    // they are known by their names from here on
    if (std::any_of(header.dimensions.data(), &dimension, [&](const Dimension& other) { return other.name == dimension.name; }))
      throw usage_error("is damaged: two dimensions have the same name");
  }
  header.attributes = take_attributes(bytes);
  const std::uint32_t count = bytes.list(VARIABLES_TAG, 32);
  for (std::uint32_t k = 0; k < count; ++k) header.variables.push_back(take_variable(bytes, header.dimensions));
  header.bytes = bytes.at();
  find_records(header);
  check_places(header, file_size);
  return header;
}

}  // namespace wholehand::device::classic
