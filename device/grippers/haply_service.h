// SPDX-License-Identifier: MIT
// Meets Haply's Inverse Service: its version, what is attached, and which devices a session takes.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "base/system/udp.h"
#include "device/grippers/haply_messages.h"
#include "device/grippers/haply_socket.h"
#include "device/loop/gripper.h"

namespace wholehand::device {

constexpr double INVERSE3_FORCE = 10;  // N: of one device, by CHAI3D's src/devices/CHaplyDevices.cpp in Haply's fork

// Where the service is, and which devices it has to use; no ids: it has two Inverse3 of different sides, or one and a VerseGrip.
struct HaplyAddress {
  HostPort at{"127.0.0.1", haply::SERVICE_PORT};
  std::array<std::string, 2> arms;  // ids: left and right; the second empty: one Inverse3 and the first VerseGrip
};

// "haply", followed by the port or host and port if they are not the default.
std::string haply_place(const HostPort& at);

// A connected service of a version that is understood.
struct HaplyService {
  std::unique_ptr<HaplySocket> socket;
  haply::Inventory inventory;
  haply::Version version;
};

// Throws Error (failure): nothing answers, or not as format 3.1 and later do.
HaplyService meet_haply_service(const HostPort& at);

// The devices of a session. Throws Error (failure), with the remedy: they are not there, or cannot be told apart.
haply::Devices choose_haply_devices(const haply::Inventory& inventory, const HaplyAddress& address);

// What the service at this address has; one entry that says what is missing if there is none. Does not throw.
std::vector<GripperFound> find_haply_grippers(const HostPort& at = HaplyAddress{}.at);

}  // namespace wholehand::device
