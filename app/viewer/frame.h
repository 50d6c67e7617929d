// SPDX-License-Identifier: MIT
// One moment as the viewer shows it, and as the JSON for the page; docs/view.md names the fields.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/quaternion.h"
#include "device/advice/advice.h"
#include "device/run/display_loop.h"
#include "device/session/hand_view.h"
#include "device/session/vessel_tracker.h"

namespace wholehand {

// The hand of an advised grip, where it would be now: position and rotation of each node, world frame of the scene.
struct GhostNode {
  Triple place{};
  Quaternion turn{0, 0, 0, 1};
};

struct GhostHand {
  GhostNode wrist;
  std::array<GhostNode, JOINT_COUNT> joints;
};

// The hand of the best grip, on its vessel at the vessel's present pose. Absent if no grip is better than the present one.
std::optional<GhostHand> ghost_of(const Scene& scene, const device::Advice& advice, const device::VesselPoses& poses);

// What is advised, world frame.
struct FrameAdvice {
  int vessel = -1;
  std::string words;
  double from = 0, to = 0;  // efforts of the present grip and of the best one; NaN: not possible; infinite: nothing holds it
  std::optional<GhostHand> ghost;
};
FrameAdvice frame_advice(const Scene& scene, const device::Advice& advice, const device::VesselPoses& poses);

// SI; world frame, except what a vessel has in its own.
struct ViewFrame {
  struct Vessel {
    bool is_shown = true;  // false: the page does not draw it
    device::VesselPose pose;
    double volume = 0;  // m3
    std::optional<device::LiquidSurface> surface;
  };

  double time = 0;  // s
  std::int64_t tick = 0;
  const char* state = "";
  int vessel = -1;
  device::HandView hand;
  std::optional<Rotation> rotation;  // of the gripper's axes; absent where there is no gripper
  double closure = 0, gap = 0, tilt = 0;
  std::vector<Vessel> vessels;
  std::optional<device::PouringStream> stream;
  // N; N m. `feedback` is what the method wants, `written` what the gripper got: absent without a gripper. `hold` is the whole hand's if `hand.hold`
  // has it, else two tips'. JSON has null for infinite or absent values, and marks an infinite hold force.
  double feedback = 0, written = device::Tick::NONE, base = 0, normal = 0, opening = 0, user = 0, hold = device::Tick::NONE,
         weight = 0, torque = 0;
  // Sliding: absent where it is off or nothing is held. N, m, rad.
  struct Slip {
    double margin = 0, distance = 0, angle = 0, speed = 0;
  };
  std::optional<Slip> slip;
  std::vector<double> arrived;  // of each amount that the task wants, m3
  double spilled = 0, target_volume = 0;
  std::optional<FrameAdvice> advice;  // absent: advice is off, or no vessel is near
  int guidance = -1;                  // modulo each vessel's count
  bool is_done = false;
  device::DisplayTiming timing;
};

// One JSON object in one line. Numbers have a float's digits: tenths of a micrometer in a hand.
std::string frame_json(const ViewFrame& frame);

// Makes frames of a session's ticks. Keeps the liquid's surface of a resting vessel between frames.
class FrameMaker {
 public:
  // `live` must outlive it.
  explicit FrameMaker(const device::LiveScene& live);
  ViewFrame make(const device::Tick& tick, const device::VesselPoses& poses, const device::HandView& hand,
                 const device::DisplayTiming& timing);

 private:
  struct Rest {
    double volume = 0;
    Rotation rotation{};  // not a rotation: not known yet
    std::optional<device::LiquidSurface> surface;
  };
  const device::LiveScene& live_;
  double table_;
  std::vector<Rest> rests_;
};

}  // namespace wholehand
