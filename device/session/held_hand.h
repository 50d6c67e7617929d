// SPDX-License-Identifier: MIT
// A hand that holds a vessel of a session, as input of kernel 10: its contacts, and the vessel's weight.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/contacts.h"
#include "core/held.h"
#include "device/session/hand_grasp.h"
#include "device/session/live_scene.h"

namespace wholehand::device {

// Everything is in the vessel's own frame, in the world of the right hand; m, N.
class HeldHand {
 public:
  // `tick` has a held vessel, `posed` are the joints that rest on it, in the scene's world, and the scene has [strength].
  HeldHand(const LiveScene& live, const Tick& tick, const std::array<Triple, JOINT_COUNT>& posed);

  std::span<const core_f64::ContactPoint> contacts() const { return grasp_.contacts(); }
  const std::vector<core_f64::ContactPoint>& tips() const { return tips_; }  // of thumb and index finger
  core_f64::Vec3 center() const { return grasp_.center(); }                  // of the contacts
  const core_f64::HandStrength& strength() const { return grasp_.strength(); }

  // Between the vessel's frame and the scene's world.
  Triple place_out(core_f64::Vec3 place) const;
  Triple turned_out(core_f64::Vec3 v) const;

  // Up, in the vessel's present frame.
  core_f64::Vec3 up() const;
  // The line from the thumb's tip to the index finger's, unit; across the vessel if they coincide.
  core_f64::Vec3 pinch() const;

 private:
  const LiveScene& live_;
  Stance stance_;
  core_f64::Vec3 pinch_{1, 0, 0};
  HandGrasp grasp_;
  std::vector<core_f64::ContactPoint> tips_;
};

// The weight of a vessel with `volume` m3 of the scene's liquid (null: the empty vessel) with `up` in its frame. Liquid above the lip acts at the
// center of the rest, as in a Session.
core_f64::Wrench weight_of(const LiveScene& live, std::size_t vessel, double volume, core_f64::Vec3 up);

// The part of `volume` m3 that the vessel's lip holds back with `up` in its frame.
double held_back(const LiveScene& live, std::size_t vessel, double volume, core_f64::Vec3 up);

}  // namespace wholehand::device
