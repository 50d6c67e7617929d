// SPDX-License-Identifier: MIT
// The JSON of Haply's Inverse Service, format 3.x: what it sends, and the forces that go to it. docs/devices.md names the sources.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene.h"

namespace wholehand::device::haply {

constexpr int SERVICE_PORT = 10001;  // of format 3.x
constexpr int OLD_PORT = 10000;      // of format 3.0, and of HTTP before service 3.5

// An Inverse3 of the inventory.
struct Arm {
  std::string id;
  std::string handedness;  // "left" or "right"; empty: the service does not say
};

// The first message of the service.
struct Inventory {
  std::vector<Arm> arms;
  std::vector<std::string> grips;  // ids of VerseGrips, wired and wireless
  bool is_old = false;             // format 3.0: the devices are an object
};

// The devices of a session.
struct Devices {
  std::array<std::string, 2> arms;  // left and right; the second is empty if there is one
  std::string grip;                 // empty: none

  std::size_t count() const { return arms[1].empty() ? 1 : 2; }
};

// One state of the devices in Haply's frame: +x to the right, +y forward, +z up.
struct Measurement {
  std::array<Triple, 2> cursors{};                // of Devices::arms, each in the frame of its own base, m
  std::array<double, 4> orientation{1, 0, 0, 0};  // of the grip: w, x, y, z
  std::uint32_t buttons = 0;                      // of the grip; bit k: the k-th by name is pressed
};

struct Version {
  int major = 0, minor = 0;
  bool operator<(const Version& other) const { return major != other.major ? major < other.major : minor < other.minor; }
};
constexpr Version OLDEST_VERSION{3, 1};
constexpr Version VECTOR_VERSION{3, 5};  // its documentation calls a force `vector`; before, clients call it `values`

// Each reads a message of the service. Returns what is wrong with it, in words that stay valid; null: nothing, and `into` is filled. After a wrong
// message `into` is unspecified. A JSON number that is not finite counts as wrong.
const char* read_inventory(std::string_view text, Inventory& into);
const char* read_measurement(std::string_view text, const Devices& devices, Measurement& into);
const char* read_version(std::string_view text, Version& into);

// The message that puts one force on each arm, N in Haply's frame. `forces` must be finite.
std::string write_forces(const Devices& devices, const std::array<Triple, 2>& forces, const Version& version);

// A complete WebSocket frame of a client (RFC 6455, 5.2) with this text, masked by a fixed key: for a signal handler, which cannot make one.
std::string masked_frame(std::string_view text);

// Between Haply's frame and the device frame (+x to the right, +y up, +z towards the person).
constexpr Triple from_haply(const Triple& v) { return {v[0], v[2], -v[1]}; }
constexpr Triple to_haply(const Triple& v) { return {v[0], -v[2], v[1]}; }

}  // namespace wholehand::device::haply
