// SPDX-License-Identifier: MIT
// The interface of a two-finger haptic gripper.
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
#include "device/session/reach.h"

namespace wholehand::device {

// Whether every number in it is finite.
inline bool is_finite(const GripperForce& force) {
  // by component: std::hypot of three loses a NaN beside zeros in libstdc++ 12
  const auto is_number = [](double x) { return std::isfinite(x); };
  return std::all_of(force.arm.begin(), force.arm.end(), is_number) && std::isfinite(force.grip) &&
         std::all_of(force.across.begin(), force.across.end(), is_number);
}
inline bool is_none(const GripperForce& force) { return force.arm == Triple{} && force.grip == 0 && force.across == Triple{}; }

// What an open gripper is and can do. Forces are the largest that may ever be written to it.
struct GripperLimits {
  std::string name;             // for people, e.g. "omega.7"
  std::string address;          // what would reopen it (app/commands/open_gripper.h), e.g. "hid:/dev/hidraw0"
  double force = 0;             // magnitude at the arm, N
  double grip = 0;              // at the fingers, N
  std::array<double, 2> gap{};  // closed, open, m
  double rate = 0;              // measurements a second at most, Hz
  bool has_rotation = true;     // false: GripperState::rotation stays NO_ROTATION
  bool is_left_handed = false;
  bool pushes_each_tip = false;  // it renders GripperForce::across
  double watchdog = 0;  // the device drops its force by itself if it hears nothing for so long, s; 0: never; or UNKNOWN_WATCHDOG
};

// An open gripper. Open functions (open_sim, open_hid, ..) throw Error. The haptic thread calls the methods below; they do not throw, and do not
// themselves allocate, lock or log. It has no force before the first write, and none after destruction.
class Gripper {
 public:
  Gripper() = default;
  virtual ~Gripper() = default;
  Gripper(const Gripper&) = delete;
  Gripper& operator=(const Gripper&) = delete;

  virtual const GripperLimits& limits() const noexcept = 0;

  // The first read is next: it has no force yet, and it may wait for some dozen milliseconds. Called at most once.
  virtual void begin() noexcept {}
  // The newest measurement for the tick of that number, waiting at most READ_PATIENCE; `state` stays unchanged if there is none.
  virtual ReadOutcome read(GripperState& state, std::int64_t tick) noexcept = 0;
  // False: the device did not accept it.
  virtual bool write(const GripperForce& force) noexcept = 0;
  // Writes zero force as the last write: returns when the device has accepted or refused it. May wait for some milliseconds. This, panic() and
  // release_from_watchdog() return no_force if the gripper discards forces; a device returns something else.
  virtual ReleaseResult release() noexcept {
    write({});
    return ReleaseResult::no_force;
  }
  // The last of all calls, after release(), while the haptic thread is still watched, because a device's library may not return from closing either.
  // The destructor, which nobody watches, does the rest.
  virtual void close() noexcept {}
  // Why the last read, write or release failed: a text that stays valid until the next of these ("unplugged"). Never null.
  virtual const char* last_error() const noexcept { return ""; }
  // Zero force as far as a signal handler can write it, from any thread, at any time. not_attempted: nothing of this kind is safe there.
  virtual ReleaseResult panic() noexcept { return ReleaseResult::no_force; }
  // Zero force from a second thread while a call of the haptic thread does not return. It may wait as long as that call does. The session may
  // continue afterwards; its next force begins at zero.
  virtual ReleaseResult release_from_watchdog() noexcept { return ReleaseResult::no_force; }
  // A line that the user must see now, once; polled by a thread other than the haptic one, which it does not make wait.
  virtual std::optional<std::string> take_warning() { return std::nullopt; }
  // Oddities, for the report after a session.
  virtual std::vector<std::string> notes_for_report() const { return {}; }
  // The state shown after this tick, for simulated users and for hands that receive the session's state.
  virtual void show(const Tick&) noexcept {}
  // The number of the next tick: a recording's, in which some may be missing. -1: the loop's own clock counts.
  virtual std::int64_t replayed_tick() const noexcept { return -1; }
  // Whether its user is done: a simulated user, or a recording at its end.
  virtual bool is_done() const noexcept { return false; }
  // Whether the recording has zero force in the last read tick although the method wanted one: the force started there, or restarted after a stall.
  virtual bool replays_zero() const noexcept { return false; }

  // The force of the last write that was begun, for messages from another thread or a signal handler: a write that fails halfway may have reached the
  // device.
  void set_last_written_force(const GripperForce& force) noexcept {
    written_arm_.store(norm(force.arm), std::memory_order_relaxed);
    written_grip_.store(std::hypot(force.grip, norm(force.across)), std::memory_order_relaxed);
  }
  ForceSize last_written_force() const noexcept {
    return {written_arm_.load(std::memory_order_relaxed), written_grip_.load(std::memory_order_relaxed)};
  }

 private:
  static_assert(std::atomic<double>::is_always_lock_free, "read in a signal handler");
  std::atomic<double> written_arm_{0}, written_grip_{0};  // N
};

constexpr double PAPER_FORCE = 12, PAPER_GRIP = 8;  // N: limits of the gripper in the paper, and of its substitutes
constexpr double READ_PATIENCE = 10e-3;  // s: several periods of any allowed rate, but shorter than a person's shortest reaction

// A gripper that is attached, or one that cannot be opened because something is missing.
struct GripperFound {
  std::string address;  // what opens it (app/commands/open_gripper.h); empty if it cannot be opened
  std::string name;
  std::string summary;           // limits and rate in one line; empty if they could not be read
  std::string missing;           // what is missing to open it, and the remedy; empty: nothing
  Remedy remedy = Remedy::none;  // of what is missing
};

}  // namespace wholehand::device
