// SPDX-License-Identifier: MIT
// A hand over the network, as liblo writes what it says.
#pragma once

#include <lo/lo.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "core/quaternion.h"
#include "device/session/tick.h"

namespace wholehand {

// liblo's encoding of a message; `types` as OSC names them, of i h f d s T. Numbers of another type are converted.
inline std::string osc_message(const std::string& address, const std::string& types, const std::vector<double>& numbers) {
  const lo_message message = lo_message_new();
  for (std::size_t k = 0; k < types.size(); ++k) {
    if (types[k] == 'i') lo_message_add_int32(message, static_cast<std::int32_t>(numbers.at(k)));
    if (types[k] == 'h') lo_message_add_int64(message, static_cast<std::int64_t>(numbers.at(k)));
    if (types[k] == 'f') lo_message_add_float(message, static_cast<float>(numbers.at(k)));
    if (types[k] == 'd') lo_message_add_double(message, numbers.at(k));
    if (types[k] == 's') lo_message_add_string(message, "text");
    if (types[k] == 'T') lo_message_add_true(message);
  }
  std::size_t size = 0;
  std::unique_ptr<void, void (*)(void*)> bytes(lo_message_serialise(message, address.c_str(), nullptr, &size), std::free);
  const std::string all(static_cast<const char*>(bytes.get()), size);
  lo_message_free(message);
  return all;
}

inline std::string big_endian_word(std::uint32_t word) {
  return {static_cast<char>(word >> 24), static_cast<char>(word >> 16), static_cast<char>(word >> 8), static_cast<char>(word)};
}

// By hand: a bundle of datagrams, with some time tag.
inline std::string osc_bundle(const std::vector<std::string>& parts) {
  std::string all("#bundle\0\x12\x34\x56\x78\0\0\0\0", 16);
  for (const std::string& part : parts) all += big_endian_word(static_cast<std::uint32_t>(part.size())) + part;
  return all;
}

constexpr const char* STATE_TYPES = "iffffffffi";

inline std::string osc_state(std::int64_t sequence, const device::GripperState& state, const std::string& types = STATE_TYPES) {
  const Quaternion turn = quaternion_of(state.rotation);
  return osc_message("/wholehand/gripper/state", types,
                     {static_cast<double>(sequence), state.position[0], state.position[1], state.position[2], turn[0], turn[1],
                      turn[2], turn[3], state.gap, static_cast<double>(state.buttons)});
}

inline std::string osc_hello(const std::vector<double>& numbers) {
  return osc_message("/wholehand/gripper/hello",
                     std::string(std::min<std::size_t>(numbers.size(), 4), 'f') + (numbers.size() > 4 ? "i" : ""), numbers);
}

}  // namespace wholehand
