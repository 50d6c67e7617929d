// SPDX-License-Identifier: MIT
// An open gripper over either transport: start-up, watchdog, measurements and forces as docs/gripper-protocol.md has them.
#pragma once

#include <memory>
#include <string>

#include "device/grippers/protocol.h"
#include "device/grippers/transport.h"
#include "device/loop/gripper.h"

namespace wholehand {

// The identity, checked; else what is wrong with it, in one line. Empty: nothing.
std::string read_identity(Transport& transport, protocol::Identity& identity);

// Completes `found`, a device at its address: its name and limits by its identity, or that it cannot be opened. `transport` null:
// found.missing says why it was not opened.
GripperFound described(GripperFound found, Transport* transport);

// Takes the gripper into use: no force, its watchdog at that period, its first measurement seen. Throws Error: (usage) a period that the
// protocol does not allow, (failure) everything else.
std::unique_ptr<Gripper> open_over(std::unique_ptr<Transport> transport, const std::string& address, double watchdog_s);

// The message for users who may not open a device node.
std::string no_permission(const std::string& node);
constexpr const char* IN_USE = "in use by another session";

}  // namespace wholehand
