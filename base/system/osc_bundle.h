// SPDX-License-Identifier: MIT
// Open Sound Control 1.0 (opensoundcontrol.stanford.edu/spec-1_0.html): bundles of messages, as they go into a datagram.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

namespace wholehand {

// The arguments that every receiver knows: int32, float32, string.
using OscValue = std::variant<std::int32_t, float, std::string_view>;

// A bundle to be carried out at once, of at most `capacity` bytes, none of which is allocated later.
class OscBundle {
 public:
  explicit OscBundle(std::size_t capacity);
  // Without messages again.
  void clear();
  // Adds a message. False: there is no room for it, and the bundle is as before. `address` begins with a slash; no text has a zero in it.
  bool add(std::string_view address, std::span<const OscValue> values);
  bool add(std::string_view address, std::initializer_list<OscValue> values) {
    return add(address, std::span<const OscValue>(values.begin(), values.size()));
  }
  bool is_empty() const { return bytes_.size() == HEAD; }
  std::span<const char> bytes() const { return bytes_; }
  // The first message alone, as a datagram without a bundle. The bundle has one.
  std::span<const char> first_message() const;

 private:
  static constexpr std::size_t HEAD = 16;  // "#bundle", time tag
  void put(std::uint32_t word);
  void put(std::string_view text);
  std::size_t capacity_;
  std::vector<char> bytes_;
};

}  // namespace wholehand
