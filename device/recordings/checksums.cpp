// SPDX-License-Identifier: MIT
#include "device/recordings/checksums.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/files/checksum.h"
#include "base/text/error.h"

namespace wholehand::device {

using classic::Attribute;
using classic::Header;

namespace {

// Without places and sizes, which follow from the rest or are changed by other programs, and without the checksum itself.
std::string checksum_of(Header header, const std::string& fixed) {
  header.records = 0;
  for (classic::Variable& variable : header.variables) variable.begin = variable.size = 0;
  std::erase_if(header.attributes, [](const Attribute& attribute) { return attribute.name == CHECKSUM; });
  const std::string bytes = classic::encode_header(header) + fixed;
  return checksum_text(bytes.data(), bytes.size());
}

}  // namespace

void set_checksum(Header& header, const std::string& fixed) {
  const Attribute checksum = classic::text_attribute(CHECKSUM, checksum_of(header, fixed));
  const auto there = std::find_if(header.attributes.begin(), header.attributes.end(),
                                  [](const Attribute& attribute) { return attribute.name == CHECKSUM; });
  if (there != header.attributes.end()) {
    *there = checksum;
  } else {
    header.attributes.push_back(checksum);
  }
}

bool has_right_checksum(const Header& header, const std::string& fixed) {
  const Attribute* checksum = header.attribute(CHECKSUM);
  return checksum && checksum->bytes == checksum_of(header, fixed);
}

RecordChecksums::RecordChecksums(const Header& header) {
  const classic::Variable* own = header.variable(CHECKSUM);
  if (!own || !own->is_record || own->type != classic::Type::int32 || own->values != 1)
    throw usage_error("is not a recording of a session: it lacks the checksums of its ticks");
  place_ = own->begin - header.record_begin;
  for (const classic::Variable& variable : header.variables)
    if (variable.is_record && &variable != own)
      runs_.push_back({variable.begin - header.record_begin, variable.values * classic::type_size(variable.type)});
}

void RecordChecksums::store(char* record) {
  std::string bytes;
  classic::append_32(bytes, next(record));
  std::copy(bytes.begin(), bytes.end(), record + place_);
}

bool RecordChecksums::is_next(const char* record) { return next(record) == classic::load_32(record + place_); }

std::uint32_t RecordChecksums::next(const char* record) {
  values_.clear();
  for (const Run& run : runs_) values_.append(record + run.place, run.size);
  before_ = checksum_after(before_, values_.data(), values_.size());
  return static_cast<std::uint32_t>(before_);
}

}  // namespace wholehand::device
