// SPDX-License-Identifier: MIT
#include "base/system/osc_bundle.h"

#include <algorithm>
#include <bit>

namespace wholehand {
namespace {

constexpr std::size_t WORD = 4;
constexpr std::uint32_t AT_ONCE[2] = {0, 1};  // the time tag that means it

// Bytes of a text with its end, filled up to whole words.
std::size_t text_size(std::size_t length) { return (length / WORD + 1) * WORD; }

std::size_t size_of(const OscValue& value) {
  const auto* text = std::get_if<std::string_view>(&value);
  return text ? text_size(text->size()) : WORD;
}

constexpr char TAGS[] = {'i', 'f', 's'};  // by the variant's index

}  // namespace

OscBundle::OscBundle(std::size_t capacity) : capacity_(std::max(capacity, HEAD)) {
  bytes_.reserve(capacity_);
  clear();
}

void OscBundle::clear() {
  bytes_.clear();
  put(std::string_view("#bundle"));
  for (const std::uint32_t word : AT_ONCE) put(word);
}

bool OscBundle::add(std::string_view address, std::span<const OscValue> values) {
  std::size_t size = text_size(address.size()) + text_size(values.size() + 1);
  for (const OscValue& value : values) size += size_of(value);
  if (bytes_.size() + WORD + size > capacity_) return false;
  put(static_cast<std::uint32_t>(size));
  put(address);
  const std::size_t tags = text_size(values.size() + 1);
  bytes_.push_back(',');
  for (const OscValue& value : values) bytes_.push_back(TAGS[value.index()]);
  bytes_.resize(bytes_.size() + tags - values.size() - 1, 0);
  for (const OscValue& value : values) {
    if (const auto* number = std::get_if<std::int32_t>(&value)) put(static_cast<std::uint32_t>(*number));
    if (const auto* number = std::get_if<float>(&value)) put(std::bit_cast<std::uint32_t>(*number));
    if (const auto* text = std::get_if<std::string_view>(&value)) put(*text);
  }
  return true;
}

std::span<const char> OscBundle::first_message() const {
  std::size_t size = 0;
  for (std::size_t k = 0; k < WORD; ++k) size = size << 8 | static_cast<unsigned char>(bytes_[HEAD + k]);
  return std::span<const char>(bytes_).subspan(HEAD + WORD, size);
}

// Big-endian.
void OscBundle::put(std::uint32_t word) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes_.push_back(static_cast<char>(word >> shift & 0xffu));
}

void OscBundle::put(std::string_view text) {
  bytes_.insert(bytes_.end(), text.begin(), text.end());
  bytes_.resize(bytes_.size() + text_size(text.size()) - text.size(), 0);
}

}  // namespace wholehand
