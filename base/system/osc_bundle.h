// SPDX-License-Identifier: MIT
// Open Sound Control 1.0 (opensoundcontrol.stanford.edu/spec-1_0.html): bundles of messages, as sent in a datagram.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

namespace wholehand {

// The argument types that every receiver supports: int32, float32, string.
using OscValue = std::variant<std::int32_t, float, std::string_view>;

// A bundle for immediate execution, of at most `capacity` bytes, which are allocated at once.
class OscBundle {
 public:
  explicit OscBundle(std::size_t capacity);
  // Without messages again.
  void clear();
  // Adds a message. Returns false, and leaves the bundle unchanged, if there is no room. `address` begins with a slash; no text contains a zero byte.
  bool add(std::string_view address, std::span<const OscValue> values);
  bool add(std::string_view address, std::initializer_list<OscValue> values) {
    return add(address, std::span<const OscValue>(values.begin(), values.size()));
  }
  bool is_empty() const { return bytes_.size() == HEAD; }
  std::span<const char> bytes() const { return bytes_; }
  // The bundle's first and only message, as a datagram without a bundle.
  std::span<const char> first_message() const;

 private:
  static constexpr std::size_t HEAD = 16;  // "#bundle", time tag
  void put(std::uint32_t word);
  void put(std::string_view text);
  std::size_t capacity_;
  std::vector<char> bytes_;
};

}  // namespace wholehand
