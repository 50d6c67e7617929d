// SPDX-License-Identifier: MIT
// A two-finger haptic gripper, whatever is behind it.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/text/error.h"
#include "core/vectors.h"
#include "device/loop/release_result.h"
#include "device/session/tick.h"

namespace wholehand {

// Whether every number in it is one.
inline bool is_finite(const GripperState& state) {
  const auto is_number = [](double x) { return std::isfinite(x); };
  return std::all_of(state.position.begin(), state.position.end(), is_number) &&
         std::all_of(state.rotation.begin(), state.rotation.end(), is_number) && std::isfinite(state.gap) &&
         std::isfinite(state.time);
}
inline bool is_finite(const GripperForce& force) {
  return std::isfinite(force.arm[0]) && std::isfinite(force.arm[1]) && std::isfinite(force.arm[2]) && std::isfinite(force.grip);
}
inline bool is_none(const GripperForce& force) { return force.arm == Triple{} && force.grip == 0; }

// What an open gripper is and can do. Forces are the largest that may ever be written to it.
struct GripperLimits {
  std::string name;             // for people, e.g. "omega.7"
  std::string address;          // what would open it again (app/commands/open_gripper.h), e.g. "hid:/dev/hidraw0"
  double force = 0;             // magnitude at the arm, N
  double grip = 0;              // at the fingers, N
  std::array<double, 2> gap{};  // closed, open, m
  double rate = 0;              // measurements a second at most, Hz
  bool has_rotation = true;     // false: GripperState::rotation stays NO_ROTATION
  bool is_left_handed = false;
  double watchdog =
      0;  // the device drops its force by itself where it hears nothing for so long, s; 0: it does not; or UNKNOWN_WATCHDOG
};

// An open gripper. Open functions (open_sim, open_hid, ..) throw Error; the methods below are called from the haptic thread, do not throw,
// and allocate, lock and log nothing of their own. No force is on it until the first write, and none is left when it is destroyed.
class Gripper {
 public:
  Gripper() = default;
  virtual ~Gripper() = default;
  Gripper(const Gripper&) = delete;
  Gripper& operator=(const Gripper&) = delete;

  virtual const GripperLimits& limits() const noexcept = 0;

  // The first read is next: no force is on it yet, and it may wait for some dozen milliseconds. Called once at most.
  virtual void begin() noexcept {}
  // The newest measurement for the tick of that number, waiting for it at most READ_PATIENCE; `state` is left alone where there is none.
  virtual ReadOutcome read(GripperState& state, std::int64_t tick) noexcept = 0;
  // False: the device did not take it.
  virtual bool write(const GripperForce& force) noexcept = 0;
  // No force, as the last thing that is written: returns when the device has it, or does not take it. May wait for some milliseconds. What this,
  // panic() and release_from_watchdog() answer for a gripper whose forces go nowhere is no_force; a device says otherwise.
  virtual ReleaseResult release() noexcept {
    write({});
    return ReleaseResult::no_force;
  }
  // The last of all calls, after release(), made where the haptic thread is watched: the library of a device may not return from
  // leaving it either. What is left to do afterwards is the destructor's, which nobody watches.
  virtual void close() noexcept {}
  // Why the last read, write or release failed: a few words that stay where they are until the next of these ("unplugged"). Never null.
  virtual const char* last_error() const noexcept { return ""; }
  // Zero force as far as a signal handler may do that, from any thread, whatever the haptic thread was doing. not_attempted: nothing of this
  // kind is safe there.
  virtual ReleaseResult panic() noexcept { return ReleaseResult::no_force; }
  // Zero force from a second thread while the haptic thread is in a call that does not return. It may wait for as long as that call does; the
  // session may go on afterwards, its next force beginning at zero.
  virtual ReleaseResult release_from_watchdog() noexcept { return ReleaseResult::no_force; }
  // A line that the user must see now, once; asked from time to time by another thread than the haptic one, which it does not make wait.
  virtual std::optional<std::string> take_warning() { return std::nullopt; }
  // Oddities, for the report of a session that is over.
  virtual std::vector<std::string> notes_for_report() const { return {}; }
  // What is on the screen after this tick: for simulated users, and hands that receive the session's state.
  virtual void show(const Tick&) noexcept {}
  // The number that the next tick must have: a recording's, in which some may be missing. -1: the loop's own
  // clock counts.
  virtual std::int64_t replayed_tick() const noexcept { return -1; }
  // Whether its user is done: a simulated user, a recording at its end.
  virtual bool is_done() const noexcept { return false; }
  // Whether the recording has zero force in the tick that was read last though the method wanted one: the force began there, or anew after a stall.
  virtual bool replays_zero() const noexcept { return false; }

  // The force of the last write that was begun, for messages from another thread or a signal handler: a write that fails half-way may
  // have reached the device.
  void set_last_written_force(const GripperForce& force) noexcept {
    written_arm_.store(norm(force.arm), std::memory_order_relaxed);
    written_grip_.store(std::abs(force.grip), std::memory_order_relaxed);
  }
  ForceSize last_written_force() const noexcept {
    return {written_arm_.load(std::memory_order_relaxed), written_grip_.load(std::memory_order_relaxed)};
  }

 private:
  static_assert(std::atomic<double>::is_always_lock_free, "read in a signal handler");
  std::atomic<double> written_arm_{0}, written_grip_{0};  // N
};

constexpr double PAPER_FORCE = 12, PAPER_GRIP = 8;  // N: limits of the gripper in the paper, and of those that stand in for it
constexpr double READ_PATIENCE = 10e-3;  // s: several periods of any allowed rate, and shorter than a person's shortest reaction

// A gripper that is attached, or would be there if something were not missing.
struct GripperFound {
  std::string address;  // what opens it (app/commands/open_gripper.h); empty where it cannot be opened
  std::string name;
  std::string summary;           // limits and rate in one line; empty where they could not be read
  std::string missing;           // what is missing to open it, and the remedy; empty: nothing
  Remedy remedy = Remedy::none;  // of what is missing
};

}  // namespace wholehand
