// SPDX-License-Identifier: MIT
// A live session as a pure state machine: from the gripper's state to the fingers' force, tick by tick. The same states at the same ticks give the
// same forces to the bit.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/grip.h"
#include "core/held.h"
#include "device/session/hand_grasp.h"
#include "device/session/live_hand.h"
#include "device/session/live_scene.h"
#include "device/session/pouring.h"
#include "device/session/proxy.h"
#include "device/session/slide.h"
#include "device/session/vessel_tracker.h"
#include "device/session/workspace.h"

namespace wholehand::device {

class Session {
 public:
  // `device_gap`: closed and open gap of the device, m. Throws Error (usage) if it is not a range and the scene gives none.
  Session(const Scene& scene, std::array<double, 2> device_gap);

  // Computes the tick of that number, which is greater than the previous one. Fills everything but read, fault, device, written and timing. Neither
  // allocates nor throws. The state must be finite.
  void step(const GripperState& state, std::int64_t number, Tick& tick) noexcept;

  // Where every vessel is since the last step, world frame.
  const VesselPoses& poses() const noexcept { return vessels_.poses(); }
  const LiveScene& live() const noexcept { return *live_; }
  const Workspace& workspace() const noexcept { return workspace_; }

 private:
  // What is kept from the moment of the grasp. Vessel frame: `midpoint` and `direction` of the tips, their contacts' proxies.
  struct Grasp {
    double device_gap = 0;  // g_grasp, m
    double normal = 0;      // F_n then, N
    bool is_antipodal = false;
    core_f64::Vec3 midpoint{}, direction{};
    std::array<core_f64::Vec3, 2> proxies{};
    core_f64::Mat3 turn{1};   // of the vessel in the gripper's axes
    core_f64::Vec3 offset{};  // of the vessel's origin from the middle of the tips, in the gripper's axes
    std::uint32_t touch_mask = 0, used_mask = 0;
    double guidance_distance = Tick::NONE;
    double height = 0;  // of the midpoint at the grasp, vessel frame, m
    bool is_delivered = false;
  };
  // How the held vessel has slid since the grasp. `u` and `v` are across the line of the tips, in the gripper's axes.
  struct Sliding {
    core_f64::Vec3 u{}, v{};
    SlideMotion motion;
    HandGrasp hand;                              // with slide_by = "hand"
    double distance = 0, angle = 0;              // m, rad
    double posed_distance = 0, posed_angle = 0;  // where the other fingers last came to rest
  };
  // Both tips on one vessel, and its outward normals there.
  struct Touch {
    int vessel = -1;
    std::array<core_f64::Vec3, 2> normals{};
  };
  // How the held vessel is tilted: towards `lean`, horizontal in its own frame.
  struct Leaning {
    core_f64::Vec3 lean{};
    double sine = 0, cosine = 1;
  };

  void approach(const HandPose& pose, Tick& tick) noexcept;
  bool grasp(const HandPose& pose, double device_gap, Tick& tick) noexcept;
  std::optional<Touch> touch_of_both_tips() const noexcept;
  std::optional<core_f64::Closing> close_on(const Touch& touch, const HandPose& pose) const noexcept;
  void keep_grasp(const Touch& touch, const HandPose& pose, const core_f64::GripAnswer& answer) noexcept;
  void hold(const HandPose& pose, double device_gap, double seconds, Tick& tick) noexcept;
  Leaning leaning_of(const Stance& vessel) const noexcept;
  void begin_slide(const core_f64::GripAnswer& answer) noexcept;
  // False: contact is lost. `lifted` is the share of the weight that no table carries.
  bool slide(const HandPose& pose, double lifted, const core_f64::Load& load, const core_f64::HeldForces& held, double seconds,
             Tick& tick) noexcept;
  bool follow_line(core_f64::Vec3 line, core_f64::Vec3 middle) noexcept;
  void pose_again() noexcept;
  bool slides_by_hand() const noexcept;
  void take_posed(const core_f64::GripAnswer& answer) noexcept;
  core_f64::Load run_liquid(const Stance& vessel, const Leaning& leaning, double seconds, Tick& tick) noexcept;
  bool is_at_destination(core_f64::Vec3 place) const noexcept;
  void note_delivery(core_f64::Vec3 place) noexcept;
  void fill_held(const Stance& vessel, double mass, const core_f64::HeldForces& held, Tick& tick) const noexcept;
  core_f64::Vec3 carried_across(const HandPose& pose, core_f64::Vec3 center, core_f64::Vec3 carried) const noexcept;
  double lifted_share(const Stance& vessel) const noexcept;
  bool is_open(double device_gap) const noexcept;
  SessionState turning(double tilt) noexcept;
  void leave(const Stance& pose) noexcept;
  void come_back(Tick& tick) noexcept;
  void settle_vessels() noexcept;
  bool is_left(const Obstacles::Standing& standing) const noexcept;
  int tasks_done() const noexcept;
  void fill_hand(const HandPose& pose, double closure, Tick& tick) const noexcept;
  void fill_vessel(const Stance& pose, Tick& tick) const noexcept;

  std::unique_ptr<const LiveScene> live_;  // vessel poses; obstacles point into it
  Workspace workspace_;
  Pouring pouring_;
  Obstacles obstacles_;
  VesselTracker vessels_;
  double period_;                // s
  std::array<double, 2> radii_;  // of thumb and index tip, m
  std::int64_t number_ = -1;     // of the previous tick; -1: none
  std::array<core_f64::Vec3, 2> tips_{}, tips_before_{};
  std::array<Proxy, 2> proxies_{};
  double seconds_ = 0;  // since the tick before
  SessionState state_ = SessionState::free;
  int vessel_ = -1;  // touched, held or returning
  Grasp grasp_;
  Sliding sliding_;
  bool is_turning_ = false;
  SessionState rest_ = SessionState::lift;  // when it does not turn
  double rested_at_ = 0;                    // rad: tilt at which it last came to rest
  double turn_from_ = 0, turn_time_ = 0;    // rad, s: since when it has not changed while it turns, and for how long
  Stance left_at_;
  double left_for_ = 0;  // s
  bool is_tutored_ = false;
  int grasps_ = 0, lost_ = 0, destinations_ = 0;
};

// Constants of ours; docs/method.md, "Live".
constexpr double TURN_STEP = 5 * PI / 180;    // rad: a tilt that changes by less is maintained (the paper's)
constexpr double TURN_REST = 1 * PI / 180;    // rad: less than this
constexpr double TURN_WINDOW = 0.5;           // rest means this many s
constexpr double OPEN_MARGIN = 0.02;          // of the device's range of gaps: this near to its end the fingers are open
constexpr double RETURN_TIME = 0.5;           // s of a vessel's return
constexpr double PUT_DOWN = 15e-3;            // m: released this near to where it stood, it counts as put down and not lost
constexpr double DESTINATION_RADIUS = 30e-3;  // m
constexpr double FULL_WEIGHT = 5e-3;          // m of lifting over which the weight comes on
constexpr double POSE_SLIP = 1e-3;            // m of sliding after which the other fingers come to rest anew
constexpr double POSE_TURN = 1 * PI / 180;    // rad: likewise
constexpr double LEAST_GYRATION = 1e-3;       // m: a vessel's radius of gyration is no smaller

}  // namespace wholehand::device
