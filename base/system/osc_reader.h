// SPDX-License-Identifier: MIT
// Parses received Open Sound Control 1.0 datagrams with any content. Nothing here allocates or throws.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace wholehand {

// A message in place, within its datagram.
struct OscReceived {
  std::string_view address;         // begins with a slash
  std::string_view types;           // without their comma
  std::span<const char> arguments;  // in whole words, to the end of the message
};

// Reads a message's arguments in order. A method returns false and takes nothing if the type differs, no argument is left, or the message is cut.
class OscArguments {
 public:
  explicit OscArguments(const OscReceived& message) : types_(message.types), bytes_(message.arguments) {}

  // int32, int64, float32 or float64.
  bool number(double& value) noexcept;
  // The same, if it is a whole number from `least` to `most`.
  bool whole(std::int64_t least, std::int64_t most, std::int64_t& value) noexcept;
  // Whether all arguments were taken and the message ends with them.
  bool is_over() const noexcept { return types_.empty() && bytes_.empty(); }
  std::size_t left() const noexcept { return types_.size(); }

 private:
  bool take(std::size_t size, std::uint64_t& bits) noexcept;
  std::string_view types_;
  std::span<const char> bytes_;
};

// Receives the messages of a datagram in order.
class OscTaker {
 public:
  virtual void take(const OscReceived& message) noexcept = 0;

 protected:
  ~OscTaker() = default;
};

// Parses a datagram: a message, or a bundle of messages and bundles, whose time tags are ignored. Returns what is wrong with it, or null. Messages
// before the fault may already have been delivered.
const char* read_osc(std::span<const char> datagram, OscTaker& taker) noexcept;

constexpr int OSC_DEPTH = 8;  // of bundles in bundles

}  // namespace wholehand
