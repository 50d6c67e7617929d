// SPDX-License-Identifier: MIT
// Opens the gripper of `--device`.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/system/udp.h"
#include "core/scene.h"
#include "device/grippers/view_gripper.h"
#include "device/loop/gripper.h"

namespace wholehand {

constexpr double WATCHDOG = 20e-3;  // s of silence after which a device releases its force: two of the host's own patience

// Where --device osc:[HOST:]PORT listens; nothing for another device. Throws Error (usage): no such port or host.
std::optional<HostPort> osc_place(const std::string& device);

// Opens sim, view, hid[:PATH], usb[:VID:PID], omega[:N], haply[:[HOST:]PORT][/IDS] or osc:[HOST:]PORT, as named by --device; a recording has its
// own function (device/recordings/recording.h). `library`: of Force Dimension's SDK, empty: searched for; `watchdog` in s; `view`: input of the
// page's controls, which must outlive the gripper; null: there is no page; `say` gets lines for the user while a gripper is awaited. Throws Error:
// (usage) another name, listing the allowed ones, or no page; (failure) opening fails.
std::unique_ptr<device::Gripper> open_gripper(
    const std::string& device, const Scene& scene, std::uint64_t seed, const std::string& library, double watchdog = WATCHDOG,
    device::ViewInput* view = nullptr, const std::function<void(const std::string&)>& say = [](const std::string&) {});

}  // namespace wholehand
