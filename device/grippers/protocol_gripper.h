// SPDX-License-Identifier: MIT
// An open gripper over either transport: start-up, watchdog, measurements and forces as in docs/gripper-protocol.md.
#pragma once

#include <memory>
#include <string>

#include "device/grippers/protocol.h"
#include "device/grippers/transport.h"
#include "device/loop/gripper.h"

namespace wholehand::device {

// Reads and checks the identity. Returns what is wrong with it, in one line; empty: nothing.
std::string read_identity(Transport& transport, protocol::Identity& identity);

// Completes `found`, a device at its address, with its name and limits from its identity, or notes that it cannot be opened. `transport` null:
// found.missing says why it was not opened.
GripperFound described(GripperFound found, Transport* transport);

// Starts using the gripper: sets no force and its watchdog's period, and waits for the first measurement. Throws Error: (usage) a period that the
// protocol does not allow; (failure) everything else.
std::unique_ptr<Gripper> open_over(std::unique_ptr<Transport> transport, const std::string& address, double watchdog_s);

// The message for users without permission to open a device node.
std::string no_permission(const std::string& node);
constexpr const char* IN_USE = "in use by another session";

}  // namespace wholehand::device
