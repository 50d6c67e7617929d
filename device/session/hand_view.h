// SPDX-License-Identifier: MIT
// The whole hand as a live session shows it: computes 24 points, none of them inside the glass, from a tick's two fingertips.
#pragma once

#include <array>
#include <optional>

#include "device/session/hand_hold.h"
#include "device/session/session.h"
#include "device/session/vessel_tracker.h"

namespace wholehand::device {

// free, touching a vessel, touching it because its finger was brought there (kernel 5), or a tip that the gripper tracks.
enum class PointContact : std::uint8_t { free, touching, projected, tracked, tracked_touching };

// World frame of the scene, m; points in the order of the joints.
struct HandView {
  std::array<Triple, JOINT_COUNT> rigged{};   // the hand on its trajectory at the gripper's pose, ignoring glass
  std::array<Triple, JOINT_COUNT> posed{};    // its tips at their proxies, its other fingers on the glass
  std::array<Triple, JOINT_COUNT> proxies{};  // these, moved outside of all vessels: what is drawn
  std::array<PointContact, JOINT_COUNT> contact{};
  Triple wrist{}, rigged_wrist{};  // origins of the posed and the rigged hand's frames
  Rotation rotation{NO_ROTATION};  // of that frame; of a left hand the one that sweeps/grips/hand_nodes.h means
  int vessel = -1;                 // the vessel in whose frame it is posed: touched, held or nearest; -1: none is near
  std::optional<HandHold> hold;    // of a held vessel, in a scene with strengths
};

// If held, kernels 4 and 5 use what the session kept of the grasp, so that this is that grip's hand, with the tick's own touch mask. Otherwise the
// hand is rigged and moved out of the glass, point by point. Its other fingers close on the vessel gradually (by a share of their largest angle) as
// both tips approach it from either side, and reach it when both touch. The tracked tips are at the tick's proxies and, if a vessel returns through
// the hand, outside of it. A holding hand passes through other vessels, as the session allows. Pure; `poses` are those of the same moment.
HandView hand_view(const LiveScene& live, const Tick& tick, const VesselPoses& poses);
// The same without `hold`. `yielding`: a copy of live.hand whose angles the call changes, so that nothing is allocated.
HandView hand_posture(const LiveScene& live, const Tick& tick, const VesselPoses& poses, core_f64::Hand& yielding);

constexpr double CLOSING_IN = 20e-3;  // m: when both tips are nearer than this, fingers start closing on the vessel (ours)

// The liquid's surface in a vessel: the plane up . p = level, vessel frame, m. Nothing without liquid. Liquid that the lip does not hold back at that
// tilt runs over, so the surface is at most at the lip.
struct LiquidSurface {
  Triple up{};
  double level = 0;
};
std::optional<LiquidSurface> liquid_surface(const core_f64::Vessel& vessel, const core_f64::Quadrature& quadrature, double volume,
                                            const Rotation& rotation);

// The stream over the held vessel's lip: from its lowest point straight down to the surface in the target, if it arrives, or to `table` (its y, m).
// Nothing if nothing flows.
struct PouringStream {
  Triple from{}, to{};
  double flow = 0;  // m3/s
};
std::optional<PouringStream> pouring_stream(const LiveScene& live, const Tick& tick, double table);

// Height of the liquid in the target, a cylinder on the table (m above it, at most to its mouth), and the volume in it at a tick, m3.
double target_level(const TaskData& task, double volume, double table);
double target_volume(const Scene& scene, const Tick& tick);
constexpr double TARGET_WALL = 1.8e-3;  // m, outside of its diameter (ours: a scene has only its mouth)

// y of the surface on which the vessels stand at the start: the lowest of their lowest points.
double table_height(const Scene& scene);

}  // namespace wholehand::device
