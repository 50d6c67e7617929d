// SPDX-License-Identifier: MIT
// Fingers of the simulated user on a spring, as the gripper renders a held vessel.
#include "device/simulated/sim_fingers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/people/participant.h"

namespace wholehand::device {
namespace {

constexpr double PERIOD = 1e-3, BASE = 0.8, OPENING = 600;  // s, N, N/m
constexpr double RANGE = 0.1, MOST = 8;                     // m, N

Traits median() { return Participant(PeopleData{}).person().traits; }

// Closes on a vessel whose side is 10 mm from where the fingers are open, and presses it from `reaction` after the touch on.
struct Pinch {
  SimFingers fingers{OPENING, RANGE, MOST, PERIOD};
  Traits traits = median();
  double load = 0, opening = OPENING;
  double rendered = 0, touched = -1, time = 0;
  std::vector<double> forces, places;  // since the touch

  explicit Pinch(const Traits& own) : traits(own) { fingers.take(traits); }

  void run(double seconds, double force) {
    const double end = time + seconds;
    for (; time < end; time += PERIOD) {
      const bool presses = touched >= 0 && time - touched > traits[Trait::reaction];
      const auto late = static_cast<std::size_t>(traits[Trait::reaction] / PERIOD);
      if (presses) {
        fingers.press(force, forces[forces.size() - std::min(late, forces.size())], load);
      } else {
        fingers.go(0.06 * std::min(time, 0.2), time < 0.2 ? 0.06 : 0);
      }
      fingers.advance(rendered, 0, 0);
      if (touched < 0 && fingers.place() > 0.01) touched = time;
      rendered = touched < 0 ? 0 : std::max(0.0, BASE + load + opening * (fingers.place() - 0.01));
      if (touched < 0) continue;
      forces.push_back(rendered);
      places.push_back(fingers.place());
    }
  }
};

// More is wanted than the gripper renders, or nothing stops the fingers: they stay within what a closed gripper asks for, and let
// go as quickly as others.
TEST(SimFingers, DoNotWindUp) {
  // their held place goes 0.12 m in 0.15 s, and they swing with 90 rad/s: 0.8 m/s / 90 rad/s
  constexpr double INERTIA = 9e-3;  // m
  for (const double opening : {600.0, 0.0}) {
    SimFingers fingers(opening, RANGE, MOST, PERIOD);
    const Traits traits = median();
    fingers.take(traits);
    for (int k = 0; k < 20000; ++k) {
      fingers.press(12, opening > 0 ? MOST : BASE, 0);
      fingers.advance(opening > 0 ? MOST : BASE, 0, 0);
      ASSERT_LT(fingers.place(), RANGE + 12 / traits[Trait::finger_stiffness] + INERTIA) << opening << ' ' << k;
    }
  }
}

// What is pressed on has the stiffness that the person has learnt: the force is there when the response is over, and stays.
TEST(SimFingers, PressWhatThePersonWantsWithinTheResponse) {
  for (const double wanted : {1.0, 3.3, 6.0}) {
    Pinch pinch(median());
    pinch.run(1.5, wanted);
    ASSERT_GE(pinch.touched, 0);
    const auto at = [&pinch](double since) { return pinch.forces[static_cast<std::size_t>(since / PERIOD)]; };
    const double done = pinch.traits[Trait::reaction] + pinch.traits[Trait::response];
    // the fingers lag behind their held place by their damping over their stiffness, 10 ms: five of these later nothing of it is
    // left
    EXPECT_NEAR(at(done + 0.05), wanted, 0.1 * wanted) << "and an eighth of the fingers' speed at the touch is not foreseen";
    EXPECT_NEAR(at(1.2), wanted, 0.02 * wanted);
  }
}

// The fingers have learnt another stiffness than the actual one: the correction reaches the force, later.
TEST(SimFingers, CorrectWhatTheyDidNotForesee) {
  Pinch pinch(median());
  pinch.opening = 300;
  pinch.run(0.4, 4);
  EXPECT_LT(pinch.forces.back(), 3.5) << "softer than expected";
  pinch.run(4, 4);
  EXPECT_NEAR(pinch.forces.back(), 4, 0.05);
}

// A load comes on that the person wants to meet with as much again: at rest the force is the wanted one, and the place is further in by
// what the spring asks for.
TEST(SimFingers, FollowALoad) {
  Pinch pinch(median());
  pinch.run(2, 3);
  const double place = pinch.places.back();
  pinch.load = 1;
  pinch.run(3, 3 + 1.5);
  EXPECT_NEAR(pinch.forces.back(), 4.5, 0.05);
  EXPECT_NEAR(pinch.places.back() - place, 0.5 / OPENING, 0.05e-3);
}

// With nothing done about it, a load opens the fingers by its share of both stiffnesses.
TEST(SimFingers, GiveWayByTheirStiffness) {
  SimFingers fingers(OPENING, RANGE, MOST, PERIOD);
  const Traits traits = median();
  fingers.take(traits);
  for (int k = 0; k < 2000; ++k) {
    fingers.go(0.01, 0);
    fingers.advance(2, 0, 0);
  }
  EXPECT_NEAR(fingers.place(), 0.01 - 2 / traits[Trait::finger_stiffness], 1e-9);
}

// Trembling and wandering are shares of the force that is wanted, through the stiffness of fingers and nothing else.
TEST(SimFingers, TrembleByAShareOfTheForce) {
  Traits traits = median();
  traits[static_cast<std::size_t>(Trait::grip_tremor)] = 0.1;
  traits[static_cast<std::size_t>(Trait::grip_error)] = 0.2;
  SimFingers fingers(OPENING, RANGE, MOST, PERIOD);
  fingers.take(traits);
  const auto rest = [&](double trembling, double wandering) {
    for (int k = 0; k < 3000; ++k) {
      fingers.press(4, 4, 0);
      fingers.advance(4, trembling, wandering);
    }
    return fingers.place();
  };
  const double calm = rest(0, 0), k = traits[Trait::finger_stiffness];
  EXPECT_NEAR(rest(1, 0) - calm, 0.4 / k, 1e-9);
  EXPECT_NEAR(rest(0, 1) - calm, 0.8 / k, 1e-9);
}

}  // namespace
}  // namespace wholehand::device
