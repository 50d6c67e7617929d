// SPDX-License-Identifier: MIT
// From an advice to what a simulated user can follow of it.
#pragma once

#include "advice/adviser.h"
#include "device/shown_grip.h"

namespace wholehand {

// The best grip, where it is better than the present one and the vessel is not held; else no grip (vessel -1).
ShownGrip shown_grip(const Scene& scene, const Advice& advice, const Adviser& adviser);

}  // namespace wholehand
