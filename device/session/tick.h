// SPDX-License-Identifier: MIT
// One tick of a live session as plain data: the gripper's state, the session's results, and the fingers' force. It travels through the ring to
// recorder and displays, and a recording is a list of ticks.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "core/scene.h"

namespace wholehand::device {

constexpr int LIVE_VESSELS = 16;  // at most in a live scene

// The result of a read: a value, nothing yet, or an error.
enum class ReadOutcome : std::uint8_t { value, timeout, error };

// A gripper's measurement at one moment. Device frame: right-handed, +x to the right and +y up for the person who holds it, +z towards
// them. The gripper's own +x runs along its closing line: to the index finger of a right hand, to the thumb of a left hand; at
// NO_ROTATION the palm faces away from the person (-z).
struct GripperState {
  Triple position{};               // of the middle between the two tracked points, m
  Rotation rotation{NO_ROTATION};  // of the gripper in the device frame
  double gap = 0;                  // between the two tracked points, or the device's equivalent, m
  std::uint32_t buttons = 0;       // bit k: button k is pressed
  std::uint32_t sequence = 0;      // changes with each measurement
  double time = 0;                 // of the measurement by the device's own clock, s; 0 if it has none
};

// What is written to a gripper, device frame. With d its closing line (its own +x), the tip at +x is pushed by arm / 2 + grip d + across, the other
// one by arm / 2 - grip d - across.
struct GripperForce {
  Triple arm{};     // sum of both tips' forces, N
  double grip = 0;  // on each finger, N; positive opens
  Triple across{};  // across d, N; zero where the device cannot push each tip by itself
};

// free: nothing is touched. touching: a tracked tip is on a vessel. Held states are lift (upright since the grasp or again, within 5 degrees), tilt
// (turning by 5 degrees or more within half a second) and maintain (tilted and still). slipped, let_go: the vessel was lost, or put down; it returns
// to where it stood, or the fingers have not left it since. released: no force any more.
enum class SessionState : std::uint8_t { free, touching, lift, tilt, maintain, slipped, released, let_go };
constexpr int SESSION_STATES = 8;
extern const std::array<const char*, SESSION_STATES> SESSION_STATE_NAMES;
constexpr bool is_held(SessionState state) {
  return state == SessionState::lift || state == SessionState::tilt || state == SessionState::maintain;
}

constexpr bool is_returning(SessionState state) { return state == SessionState::slipped || state == SessionState::let_go; }

// The grip force of the fingers, N: that at the grasp and what they have closed since, up to the largest feedback. What tilt and liquid add to the normal
// force does not come from them, so that this equals Tick::user_force wherever the feedback is not clamped.
constexpr double still_grip(double normal_at_grasp, double opening_force, double largest) {
  return std::clamp(normal_at_grasp + opening_force, 0.0, largest);
}

// Why a session released its force.
enum class Fault : std::uint8_t {
  none,
  read_error,   // the device reports an error, or is gone
  timeout,      // it does not answer
  stale,        // the same measurement twice
  not_finite,   // a number that is not finite, or an invalid rotation
  jump,         // faster than anything physical
  write_error,  // it takes no force
  late,         // steps over their budget
  ring_full,    // the recording does not keep up
  interrupted,  // SIGINT, SIGTERM, SIGHUP
};
constexpr int FAULTS = 10;
extern const std::array<const char*, FAULTS> FAULT_NAMES;

// Frames: world, in which the scene's places lie, +y up; vessel, as in docs/method.md. NaN: no value (nothing held, say).
struct Tick {
  static constexpr double NONE = std::numeric_limits<double>::quiet_NaN();

  std::int64_t number = 0;  // periods since the start; time = number / rate
  ReadOutcome read = ReadOutcome::value;
  Fault fault = Fault::none;
  GripperState device;  // as read

  SessionState state = SessionState::free;
  int vessel = -1;    // touched, held or returning; -1: none
  int guidance = -1;  // number of the shown guidance point on each vessel that has any (modulo their count); -1 without a task

  // ---- the hand, world frame ----
  Triple middle{};                      // of the two mapped tips, m
  Rotation hand_rotation{NO_ROTATION};  // of the gripper's axes
  double gap = 0;                       // of the hand, m
  double closure = 0;
  std::array<Triple, 2> tips{}, proxies{};  // thumb, index, m
  // the pose kept while held: which joints touch (bit j) and which fingers are used (bit f)
  std::uint32_t touch_mask = 0, used_mask = 0;

  // ---- the vessel that is touched, held or returning, world frame ----
  Triple vessel_place{};                  // of its origin, m
  Rotation vessel_rotation{NO_ROTATION};  // vessel to world
  double tilt = 0;                        // between its axis and up, rad
  double grasp_height = NONE;             // of the middle of the tips at the grasp, vessel frame, m
  double guidance_distance = NONE;        // of this grasp, m

  // ---- liquid, by vessel, m3: in it, arrived in the target, spilled; the rest of the sum is in the air ----
  std::array<double, LIVE_VESSELS> volume{}, arrived{}, spilled{};
  double flow = 0;  // over the held vessel's lip, m3/s

  // ---- forces, N ----
  std::array<Triple, 2> coupling{};                          // of the surface on thumb and index tip before the grasp, world frame
  double weight = 0;                                         // of vessel and liquid, as far as it is lifted
  double torque = 0, exact_torque = 0;                       // N m
  double normal_force = 0, opening_force = 0, feedback = 0;  // kernel 7
  double hold_force = NONE;                                  // physically required; infinite if the pinch is not antipodal
  double user_force = 0;  // the user's grip force: feedback less the torque's rise since the grasp
  // Sliding in the fingers, with [live] slide. Margin: the grip force that counts there (still_grip) less what holding takes now, N. Since the grasp: the
  // way of the contacts along the surface, m, in which a turn counts at the soft finger's radius; and the vessel's turn about the line of the tips, rad
  // (right-handed from thumb to index finger, for a left hand left-handed). The contacts' speed, m/s.
  double safety_margin = NONE, slip_distance = 0, slip_angle = 0, slip_speed = 0;
  GripperForce wanted;   // of the method, device frame
  GripperForce written;  // after limits, ramp and slew, device frame

  // ---- counts since the start ----
  int grasps = 0, lost = 0, destinations = 0;
  bool task_done = false;

  // ---- timing, s ----
  double latency = 0;    // from the tick's time to when the loop woke
  double step_time = 0;  // from having the measurement until the force was written
};

}  // namespace wholehand::device
