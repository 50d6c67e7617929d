// SPDX-License-Identifier: MIT
// What the loop does to the energy of a device that is pressed against a wall.
// sanitizers: thread
#include "core/vectors.h"
#include "device/loop/haptic_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/loop.h"
#include "tests/support/loop_rig.h"
#include "tests/support/scenes.h"

namespace wholehand::device {
namespace {

using core_f64::Vec3;

// A gripper that is a mass with damping on one axis, integrated exactly between ticks: what the loop writes acts on it until the
// next tick.
class MassGripper : public Gripper {
 public:
  MassGripper(double rate, core_f64::Plant plant, Vec3 axis, Vec3 start, double speed, double press)
      : plant_(plant), by_(core_f64::propagator(plant, 1 / rate)), axis_(axis), start_(start), press_(press) {
    motion_.speed = speed;
    limits_.force = 1e3;
    limits_.grip = 1e3;
    limits_.gap = {0, 0.12};
  }
  const GripperLimits& limits() const noexcept override { return limits_; }
  ReadOutcome read(GripperState& state, std::int64_t tick) noexcept override {
    if (tick > 0) motion_ = core_f64::advance(by_, motion_, force_ + press_);
    motions.push_back(motion_);
    state.position = to_triple(start_ + motion_.place * axis_);
    state.gap = gap;
    state.sequence = static_cast<std::uint32_t>(tick + 1);
    return ReadOutcome::value;
  }
  bool write(const GripperForce& force) noexcept override {
    force_ = glm::dot(to_vec3(force.arm), axis_);
    forces.push_back(force_);
    return true;
  }
  std::vector<core_f64::Motion> motions;
  std::vector<double> forces;
  double gap = 0.12;

 private:
  core_f64::Plant plant_;
  core_f64::Propagator by_;
  Vec3 axis_, start_;
  double press_, force_ = 0;
  core_f64::Motion motion_;
  GripperLimits limits_;
};

struct Against {
  const char* name;
  Vec3 axis, start;  // of the middle of the tips
  double slope;      // how many tips push the arm
};

// The thumb alone meets the side; both tips meet the lid, one tip each side of its middle: twice K and B act on the arm.
std::vector<Against> walls() {
  return {{"side", Vec3(-1, 0, 0), Vec3(0.113, 0.05, 0), 1}, {"lid", Vec3(0, -1, 0), Vec3(0, 0.119, 0), 2}};
}

// Whatever the speed it is thrown at, it comes back slower, where b > slope (K T / 2 + |B|): the energy of motion never grows over
// what it was before the contact and what the press puts in.
TEST(Energy, NeverGrowsAgainstAPassiveWall) {
  for (const Against& against : walls()) {
    for (const double rate : {1000.0, 4000.0}) {
      for (const double stiffness : {300.0, 800.0}) {
        for (const double damping : {0.0, 0.3}) {
          const double b = 1.05 * against.slope * (stiffness / rate / 2 + damping);
          for (const double mass : {0.05, 0.2}) {
            for (const double speed : {0.05, 0.2, 0.5}) {
              for (const double press : {0.0, 1.0}) {
                SCOPED_TRACE(std::string(against.name) + " " + std::to_string(rate) + " " + std::to_string(stiffness) + " " +
                             std::to_string(damping) + " " + std::to_string(mass) + " " + std::to_string(speed) + " " +
                             std::to_string(press));
                LoopRig run;
                run.scene.live.rate = rate;
                run.scene.live.stiffness = stiffness;
                run.scene.live.damping = damping;
                run.scene.live.ramp = 0;
                run.scene.live.slew = 1e9;
                run.scene.live.jump = 1e3;
                run.options.seconds = 1;
                const core_f64::Plant plant{mass, b, 0};
                MassGripper gripper(rate, plant, against.axis, against.start, speed, press);
                if (against.slope == 2) gripper.gap = 0.03;
                Session session(run.scene, gripper.limits().gap);
                HapticLoop loop(run.scene.live, gripper, session, {}, run.options);
                loop.run(NEVER_STOPPED);
                // total energy with the press's potential: it may only fall but for what is stored in the wall, which is gone when
                // it is out of it, so each maximum of it in the air is lower than the one before
                double last = std::numeric_limits<double>::infinity(), strongest = 0;
                for (std::size_t k = 0; k < gripper.motions.size(); ++k) {
                  strongest = std::max(strongest, std::abs(gripper.forces[k]));
                  if (gripper.forces[k] != 0) continue;
                  const core_f64::Motion& m = gripper.motions[k];
                  const double energy = 0.5 * mass * m.speed * m.speed - press * m.place;
                  ASSERT_LE(energy, last + 1e-12) << k;
                  last = energy;
                }
                // it begins a millimeter or two away, and gets m v / b far
                if (press > 0 || mass * speed / b > 4e-3) {
                  EXPECT_GT(strongest, 0);
                }
                const double left =
                    b + against.slope * (damping - stiffness / rate / 2);  // of all damping, beside what sampling costs
                if (press > 0 && left / (2 * mass) > 8) {
                  // and where a second is enough for that it comes to rest on it, held by what presses
                  EXPECT_NEAR(gripper.forces[gripper.forces.size() - 2], -press, 0.02);
                  EXPECT_LT(std::abs(gripper.motions.back().speed), 2e-3);
                }
              }
            }
          }
        }
      }
    }
  }
}

// The same check fails at a wall that is not passive: it is too stiff for its rate, and the device gains energy.
TEST(Energy, GrowsAgainstAWallThatIsNotPassive) {
  LoopRig run;
  run.scene.live.stiffness = 2000;
  run.scene.live.damping = 0;
  run.scene.live.ramp = 0;
  run.scene.live.slew = 1e9;
  run.scene.live.jump = 1e3;
  run.options.seconds = 1;
  const core_f64::Plant plant{0.05, 0.1, 0};
  MassGripper gripper(1000, plant, Vec3(-1, 0, 0), Vec3(0.107, 0.05, 0), 0.05, 1);
  Session session(run.scene, gripper.limits().gap);
  HapticLoop loop(run.scene.live, gripper, session, {}, run.options);
  loop.run(NEVER_STOPPED);
  double largest = 0;
  for (std::size_t k = gripper.motions.size() / 2; k < gripper.motions.size(); ++k)
    largest = std::max(largest, std::abs(gripper.motions[k].speed));
  EXPECT_GT(largest, 0.1);
}

}  // namespace
}  // namespace wholehand::device
