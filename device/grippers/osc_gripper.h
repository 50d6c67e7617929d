// SPDX-License-Identifier: MIT
// A hand over the network in place of a device: an engine or a tracker sends its pose as Open Sound Control over UDP and receives the forces.
// docs/devices.md describes the messages.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/system/udp.h"
#include "core/scene.h"
#include "device/loop/gripper.h"

namespace wholehand::device {

constexpr double OSC_START = 10;       // s that a session waits for its first state
constexpr double OSC_SILENCE = 50e-3;  // s without a new state after which the hand counts as gone

// Listens at an address of this machine (port 0: any free port) for states of a hand, and takes the first sender. Between messages the hand moves as
// PacketMotion says. `say` gets lines for the user: where it waits, and what is unsafe. Without a hello, its gap is the scene's hand's and its
// largest forces are the paper's. Throws Error (failure): no such address, its port in use, no hand for `patience`.
std::unique_ptr<Gripper> open_osc(const HostPort& at, const Scene& scene, const std::function<void(const std::string&)>& say,
                                  double patience = OSC_START);

}  // namespace wholehand::device
