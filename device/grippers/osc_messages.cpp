// SPDX-License-Identifier: MIT
#include "device/grippers/osc_messages.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "base/system/osc_reader.h"
#include "base/system/udp.h"
#include "core/quaternion.h"
#include "core/vectors.h"

namespace wholehand::device::osc {
namespace {

constexpr const char* WRONG_ARGUMENTS = "arguments of another number or type";

bool is_within(double value, double least, double most) { return value >= least && value <= most; }
// NaN is for the guard.
bool may_be(double value, double least, double most) { return std::isnan(value) || is_within(value, least, most); }

bool read_numbers(OscArguments& arguments, std::span<double> into) noexcept {
  for (double& number : into)
    if (!arguments.number(number)) return false;
  return true;
}

// Unit quaternions only, x, y, z, w.
Rotation rotation_of(const std::array<double, 4>& q) noexcept {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  Rotation rotation;
  rotation.fill(std::numeric_limits<double>::quiet_NaN());
  if (!(std::abs(length - 1) <= QUATERNION_TOLERANCE)) return rotation;
  return to_rotation(glm::mat3_cast(glm::dquat(q[3] / length, q[0] / length, q[1] / length, q[2] / length)));
}

const char* read_state(OscArguments arguments, GripperState& state) noexcept {
  std::int64_t sequence = 0, buttons = 0;
  std::array<double, 8> numbers{};
  if (!arguments.whole(LEAST_NUMBER, MOST_NUMBER, sequence) || !read_numbers(arguments, numbers) ||
      !arguments.whole(LEAST_NUMBER, MOST_NUMBER, buttons) || !arguments.is_over())
    return WRONG_ARGUMENTS;
  state = {};
  for (int k = 0; k < 3; ++k) {
    if (!may_be(numbers[k], -MOST_PLACE, MOST_PLACE)) return "a place out of range";
    state.position[k] = numbers[k];
  }
  state.rotation = rotation_of({numbers[3], numbers[4], numbers[5], numbers[6]});
  if (!may_be(numbers[7], LEAST_GAP, MOST_GAP)) return "a gap out of range";
  state.gap = numbers[7];
  state.buttons = static_cast<std::uint32_t>(buttons);
  state.sequence = static_cast<std::uint32_t>(sequence);
  return nullptr;
}

const char* read_hello(OscArguments arguments, Hello& hello) noexcept {
  std::array<double, 4> numbers{};
  std::int64_t port = 0;
  if (!read_numbers(arguments, numbers) || (arguments.left() > 0 && !arguments.whole(0, LARGEST_PORT, port)) ||
      !arguments.is_over())
    return WRONG_ARGUMENTS;
  hello = {{numbers[0], numbers[1]}, numbers[2], numbers[3], static_cast<int>(port)};
  if (!is_within(hello.gap[0], LEAST_GAP, MOST_GAP) || !is_within(hello.gap[1], LEAST_GAP, MOST_GAP) ||
      hello.gap[0] >= hello.gap[1])
    return "a gap that does not open, or out of range";
  if (!is_within(hello.force, 0, MOST_FORCE) || !is_within(hello.grip, 0, MOST_FORCE)) return "a largest force out of range";
  return nullptr;
}

class WordTaker final : public OscTaker {
 public:
  explicit WordTaker(Words& words) : words_(words) {}

  void take(const OscReceived& message) noexcept override {
    const char* wrong = nullptr;
    if (message.address == STATE) wrong = take_state(message);
    if (message.address == HELLO) {
      wrong = read_hello(OscArguments(message), words_.hello);
      words_.has_hello = true;
    }
    if (message.address == BYE) words_.has_bye = true;  // whatever arguments some senders cannot leave out
    if (wrong && !wrong_) wrong_ = wrong;
  }
  const char* wrong() const noexcept { return wrong_; }

 private:
  const char* take_state(const OscReceived& message) noexcept {
    GripperState state;
    if (const char* wrong = read_state(OscArguments(message), state)) return wrong;
    const bool is_replaced = is_finite(words_.state) && is_later(state.sequence, words_.state.sequence);
    if (!words_.has_state || is_replaced) words_.state = state;
    words_.has_state = true;
    return nullptr;
  }

  Words& words_;
  const char* wrong_ = nullptr;
};

}  // namespace

const char* read_words(std::span<const char> datagram, Words& words) noexcept {
  words = {};
  WordTaker reader(words);
  const char* wrong = read_osc(datagram, reader);
  if (!wrong) wrong = reader.wrong();
  if (wrong) words = {};
  const std::string_view bytes(datagram.data(), datagram.size());
  words.names_hello = bytes.find(HELLO) != std::string_view::npos;
  words.names_state = bytes.find(STATE) != std::string_view::npos;
  return wrong;
}

}  // namespace wholehand::device::osc
