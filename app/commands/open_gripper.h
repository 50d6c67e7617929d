// SPDX-License-Identifier: MIT
// From `--device` to an open gripper.
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

constexpr double WATCHDOG = 20e-3;  // s without a word from the host after which a device lets go: two of the host's own patience

// Where --device osc:[HOST:]PORT listens; nothing: it is another device. Throws Error (usage): no such port or host.
std::optional<HostPort> osc_place(const std::string& device);

// sim, view, hid[:PATH], usb[:VID:PID], omega[:N] or osc:[HOST:]PORT, as --device names them; a recording is opened by its own
// (device/recordings/recording.h). `library`: of Force Dimension's SDK, empty: wherever it is found; `watchdog` in s; `view`: where the page's
// controls go in, which must outlive the gripper; null: there is no page; `say` is given lines for the user, of a gripper that is waited for.
// Throws Error: (usage) another name, with those that are allowed, or no page; (failure) what opening it throws.
std::unique_ptr<Gripper> open_gripper(
    const std::string& device, const Scene& scene, std::uint64_t seed, const std::string& library, double watchdog = WATCHDOG,
    ViewInput* view = nullptr, const std::function<void(const std::string&)>& say = [](const std::string&) {});

}  // namespace wholehand
