// SPDX-License-Identifier: MIT
// Open Sound Control 1.0 that comes from somewhere: what is in a datagram, whatever its bytes are. Nothing here allocates or throws.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace wholehand {

// A message where it lies in its datagram.
struct OscReceived {
  std::string_view address;         // begins with a slash
  std::string_view types;           // without their comma
  std::span<const char> arguments;  // in whole words, to the end of the message
};

// The arguments of a message, one after the other. A method that returns false has taken nothing that counts: the type is another one,
// there is no argument left, or the message is cut.
class OscArguments {
 public:
  explicit OscArguments(const OscReceived& message) : types_(message.types), bytes_(message.arguments) {}

  // int32, int64, float32 or float64.
  bool number(double& value) noexcept;
  // The same, as long as it is a whole number from `least` to `most`.
  bool whole(std::int64_t least, std::int64_t most, std::int64_t& value) noexcept;
  // Whether all that the types name was taken, and the message ends with it.
  bool is_over() const noexcept { return types_.empty() && bytes_.empty(); }
  std::size_t left() const noexcept { return types_.size(); }

 private:
  bool take(std::size_t size, std::uint64_t& bits) noexcept;
  std::string_view types_;
  std::span<const char> bytes_;
};

// Whoever takes the messages of a datagram, in their order.
class OscTaker {
 public:
  virtual void take(const OscReceived& message) noexcept = 0;

 protected:
  ~OscTaker() = default;
};

// Takes a datagram apart: a message, or a bundle of messages and bundles, whose time tags are ignored. What is wrong with it, or null
// where nothing is; a datagram of which a part is wrong may have had messages taken before.
const char* read_osc(std::span<const char> datagram, OscTaker& taker) noexcept;

constexpr int OSC_DEPTH = 8;  // of bundles in bundles

}  // namespace wholehand
