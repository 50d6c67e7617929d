// SPDX-License-Identifier: MIT
// Computes advice from a moment of a session, and from the advice what a simulated user can follow.
#pragma once

#include <atomic>
#include <cstddef>

#include "device/advice/adviser.h"
#include "device/session/session.h"
#include "device/simulated/shown_grip.h"

namespace wholehand::device {

// Advice for the moment of a tick, with the vessels at `poses`. Evaluates nothing if no vessel is near. Efforts of a held grip at tilts ahead use the
// posture that the session keeps. `keeps_line` as in an AdviceQuestion. Throws as Adviser::advise.
Advice advice_of(const LiveScene& live, const Tick& tick, const VesselPoses& poses, Adviser& adviser, std::size_t grips,
                 bool keeps_line = false, const std::atomic<bool>* stop = nullptr);

// The best grip, if it is better than the present one and the vessel is not held; else no grip (vessel -1).
ShownGrip shown_grip(const Scene& scene, const Advice& advice, const Adviser& adviser);

}  // namespace wholehand::device
