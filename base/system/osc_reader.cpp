// SPDX-License-Identifier: MIT
#include "base/system/osc_reader.h"

#include <bit>
#include <cmath>

namespace wholehand {
namespace {

constexpr std::size_t OSC_WORD = 4, OSC_TIME_TAG = 8;
constexpr std::string_view BUNDLE("#bundle\0", 8);
constexpr double MOST_WHOLE = 9007199254740992.0;  // 2^53: up to there a float64 has every whole number

// Big-endian.
std::uint64_t big_endian(std::span<const char> bytes) {
  std::uint64_t bits = 0;
  for (const char byte : bytes) bits = bits << 8 | static_cast<unsigned char>(byte);
  return bits;
}

// The text at the front, removed with its zeros up to a whole word. False: it has no end, or something other than zeros follows.
bool take_text(std::span<const char>& bytes, std::string_view& text) {
  const std::string_view all(bytes.data(), bytes.size());
  const std::size_t end = all.find('\0');
  if (end == std::string_view::npos) return false;
  const std::size_t size = (end / OSC_WORD + 1) * OSC_WORD;
  if (size > all.size() || all.substr(end, size - end).find_first_not_of('\0') != std::string_view::npos) return false;
  text = all.substr(0, end);
  bytes = bytes.subspan(size);
  return true;
}

const char* read_message(std::span<const char> bytes, OscTaker& taker) noexcept {
  OscReceived message;
  if (!take_text(bytes, message.address) || message.address.empty() || message.address.front() != '/')
    return "a message without an address";
  if (bytes.empty() || bytes.front() != ',' || !take_text(bytes, message.types)) return "a message without type tags";
  message.types.remove_prefix(1);
  message.arguments = bytes;
  taker.take(message);
  return nullptr;
}

const char* read_element(std::span<const char> bytes, OscTaker& taker, int depth) noexcept {
  if (bytes.empty()) return depth == 0 ? "an empty datagram" : "an empty part of a bundle";
  if (bytes.size() % OSC_WORD != 0) return "a length that is not a multiple of 4 bytes";
  if (std::string_view(bytes.data(), bytes.size()).substr(0, BUNDLE.size()) != BUNDLE) return read_message(bytes, taker);
  if (depth == OSC_DEPTH) return "too many bundles in each other";
  if (bytes.size() < BUNDLE.size() + OSC_TIME_TAG) return "a bundle without a time tag";
  bytes = bytes.subspan(BUNDLE.size() + OSC_TIME_TAG);
  while (!bytes.empty()) {
    const std::uint64_t size = big_endian(bytes.first(OSC_WORD));
    bytes = bytes.subspan(OSC_WORD);
    if (size > bytes.size()) return "a part of a bundle that is longer than the datagram";
    if (const char* wrong = read_element(bytes.first(size), taker, depth + 1)) return wrong;
    bytes = bytes.subspan(size);
  }
  return nullptr;
}

}  // namespace

const char* read_osc(std::span<const char> datagram, OscTaker& taker) noexcept { return read_element(datagram, taker, 0); }

bool OscArguments::take(std::size_t size, std::uint64_t& bits) noexcept {
  if (bytes_.size() < size) return false;
  bits = big_endian(bytes_.first(size));
  bytes_ = bytes_.subspan(size);
  types_.remove_prefix(1);
  return true;
}

bool OscArguments::number(double& value) noexcept {
  if (types_.empty()) return false;
  const char type = types_.front();
  std::uint64_t bits = 0;
  const bool is_long = type == 'h' || type == 'd';
  if (!is_long && type != 'i' && type != 'f') return false;
  if (!take(is_long ? 2 * OSC_WORD : OSC_WORD, bits)) return false;
  const auto low = static_cast<std::uint32_t>(bits);
  if (type == 'i') value = static_cast<std::int32_t>(low);
  if (type == 'f') value = std::bit_cast<float>(low);
  if (type == 'h') value = static_cast<double>(static_cast<std::int64_t>(bits));
  if (type == 'd') value = std::bit_cast<double>(bits);
  return true;
}

bool OscArguments::whole(std::int64_t least, std::int64_t most, std::int64_t& value) noexcept {
  double number = 0;
  if (!this->number(number) || !(std::abs(number) <= MOST_WHOLE) || number != std::floor(number)) return false;
  value = static_cast<std::int64_t>(number);
  return value >= least && value <= most;
}

}  // namespace wholehand
