// SPDX-License-Identifier: MIT
// The hold force of the whole hand within a tick: kernels 9 and 10 without allocation.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/contacts.h"
#include "core/effort.h"
#include "core/joints.h"
#include "device/session/live_scene.h"

namespace wholehand::device {

// Contacts of a hand that holds a vessel, in the vessel's frame.
class HandGrasp {
 public:
  // `posed` are the joints that rest on the vessel, m; `touching` has a bit for each that touches.
  void take(const LiveScene& live, const core_f64::Vessel& vessel, const std::array<core_f64::Vec3, JOINT_COUNT>& posed,
            std::uint32_t touching) noexcept;

  // What the weaker of thumb and index finger presses with at the least effort that holds `weight` (N) at `center` (m): the effort times that finger's
  // strength, N. Infinite if no force holds it.
  double hold_force(core_f64::Vec3 center, core_f64::Vec3 weight) const noexcept;

  std::span<const core_f64::ContactPoint> contacts() const noexcept { return {contacts_.data(), count_}; }
  core_f64::Vec3 center() const noexcept { return center_; }  // of the contacts
  const core_f64::HandStrength& strength() const noexcept { return strength_; }

 private:
  std::array<core_f64::ContactPoint, JOINT_COUNT> contacts_{};
  std::size_t count_ = 0;
  core_f64::HandStrength strength_;
  core_f64::Vec3 center_{};
};

}  // namespace wholehand::device
