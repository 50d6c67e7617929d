// SPDX-License-Identifier: MIT
// The amounts of each liquid, by place, at a tick of a live session.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scene.h"
#include "device/session/tick.h"

namespace wholehand::device {

// The paper's mixing board: the volume in the target of each liquid that a task wants, m3.
struct MixedAmount {
  std::string liquid;
  double arrived = 0, wanted = 0, spilled = 0;
};
std::vector<MixedAmount> mixing_board(const Scene& scene, const Tick& tick);
// m3: of a liquid in the target, and spilled from all vessels. They allocate nothing.
double total_arrived(const Scene& scene, const Tick& tick, std::string_view liquid);
double total_spilled(const Scene& scene, const Tick& tick);

}  // namespace wholehand::device
