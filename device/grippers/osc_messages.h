// SPDX-License-Identifier: MIT
// Messages to and from a hand over the network, as Open Sound Control; docs/devices.md describes them. Pure functions; nothing here allocates or
// throws.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "device/loop/gripper.h"
#include "device/session/tick.h"

namespace wholehand::device::osc {

constexpr const char* HELLO = "/wholehand/gripper/hello";
constexpr const char* STATE = "/wholehand/gripper/state";
constexpr const char* BYE = "/wholehand/gripper/bye";
constexpr const char* FORCE = "/wholehand/gripper/force";

// The largest allowed numbers; with a larger one, a message is malformed.
constexpr double MOST_PLACE = 100;                                                  // m from the origin, along each axis
constexpr double LEAST_GAP = -0.01, MOST_GAP = 1;                                   // m
constexpr double MOST_FORCE = 1000;                                                 // N
constexpr double QUATERNION_TOLERANCE = 1e-3;                                       // of the length
constexpr std::int64_t LEAST_NUMBER = -(1ll << 31), MOST_NUMBER = (1ll << 32) - 1;  // of 32 bits, signed or unsigned

// The hand's description: /wholehand/gripper/hello.
struct Hello {
  std::array<double, 2> gap{};  // closed, open, m
  double force = 0, grip = 0;   // the largest forces that it can bear at the arm and at the fingers, N
  int port = 0;                 // on the sender's host, for forces; 0: back to the source port
};

// The contents of a datagram for the gripper.
struct Words {
  bool has_hello = false, has_state = false, has_bye = false;
  Hello hello;
  // The latest by its sequence, or the first with a NaN, which the guard catches. A quaternion whose length is not 1 makes the rotation NaN.
  GripperState state;
  bool is_any() const { return has_hello || has_state || has_bye; }
  // Whether the datagram contains these addresses, even if it cannot be read.
  bool names_hello = false, names_state = false;
};

// Reads a datagram. Returns what is wrong with it, and then ignores all of it; null if nothing is wrong. Ignores messages with other addresses.
const char* read_words(std::span<const char> datagram, Words& words) noexcept;

// Whether sequence `a` comes after `b`; both wrap from 2^32 - 1 to 0.
constexpr bool is_later(std::uint32_t a, std::uint32_t b) { return static_cast<std::int32_t>(a - b) > 0; }

}  // namespace wholehand::device::osc
