// SPDX-License-Identifier: MIT
// A user's way through a live session, tick by tick: comes near, touches, grasps, lifts, tilts until it pours, holds still, tilts
// back, lets go. What the tests of the session, the loop and the tick path are run on.
#pragma once

#include <array>

#include "core/scene.h"
#include "device/session/tick.h"

namespace wholehand {

// The default scene's first beaker, half full, with a target into which it pours; a device whose gap is the hand's own.
Scene live_scene();
// Closed and open gap of a hand, m: a device with this range has the slope 1.
std::array<double, 2> own_gap(const HandData& hand);

struct LiveScript {
  double rate = 1000;     // Hz
  double hurry = 1;       // how many times faster than an ordinary user
  double azimuth = 0;     // of the line through the tips, rad
  double height = 55e-3;  // of the grasp, m
  double tilt = radians(115);
  Triple vessel{};  // where it stands, m

  double seconds() const;
  double pause() const;  // s that it is held still when tilted: as long as it takes to be called so
  device::GripperState at(std::int64_t tick) const;
};

// From 0 to 1 between two times, at rest at either end.
double ease(double time, double from, double to);

// ---- rotations, row-major, of plain doubles ----
wholehand::Rotation turned(char axis, double angle);
wholehand::Rotation product(const wholehand::Rotation& a, const wholehand::Rotation& b);

}  // namespace wholehand
