// SPDX-License-Identifier: MIT
#include "device/session/tilts_ahead.h"

#include <algorithm>
#include <cmath>

#include "core/grip_effort.h"
#include "device/session/held_hand.h"

namespace wholehand::device {

using core_f64::EffortSolver;
using core_f64::Vec3;

namespace {

// Level and unit, in the vessel's frame: where its mouth goes down.
Vec3 side_of(const LiveScene& live, const HeldHand& held) {
  const Vec3 up = held.up();
  const double sine = std::hypot(up.x, up.z);
  if (std::atan2(sine, up.y) >= LEANS_FROM) return {-up.x / sine, 0, -up.z / sine};
  const double sense = live.scene.liquid && live.scene.liquid->pour == Pour::towards ? -1 : 1;
  const Vec3 pinch = held.pinch();
  return std::hypot(pinch.x, pinch.z) > DEGENERATE_SINE_F64 ? core_f64::pour_direction(pinch, sense) : Vec3(1, 0, 0);
}

// Up in the frame of a vessel that is tilted towards `side`.
Vec3 up_at(double tilt, Vec3 side) { return std::cos(tilt) * Vec3(0, 1, 0) - std::sin(tilt) * side; }

}  // namespace

const TiltAhead* TiltsAhead::hardest() const {
  const auto end = tilts.begin() + static_cast<std::ptrdiff_t>(count);
  const auto found =
      std::max_element(tilts.begin(), end, [](const TiltAhead& a, const TiltAhead& b) { return a.effort < b.effort; });
  return found == end ? nullptr : &*found;
}

double TiltsAhead::other_worst() const {
  double worst = 0;
  for (std::size_t k = 0; k < count; ++k) worst = std::max(worst, tilts[k].other);
  return worst;
}

std::optional<TiltsAhead> tilts_ahead(const LiveScene& live, const Tick& tick, const std::array<Triple, JOINT_COUNT>& posed) {
  if (!live.scene.strength || tick.vessel < 0 || !is_held(tick.state)) return std::nullopt;
  const auto v = static_cast<std::size_t>(tick.vessel);
  const HeldHand held(live, tick, posed);
  const double volume = tick.volume[v];
  const Vec3 side = side_of(live, held);
  EffortSolver solver(held.contacts(), held.strength(), held.center());
  double left = volume, left_other = volume;
  TiltsAhead ahead;
  for (int k = static_cast<int>(std::ceil(tick.tilt / AHEAD_STEP)); k * AHEAD_STEP <= MOST_AHEAD + 1e-9; ++k) {
    const double tilt = k * AHEAD_STEP;
    left = held_back(live, v, left, up_at(tilt, side));
    left_other = held_back(live, v, left_other, up_at(tilt, -side));
    ahead.tilts[ahead.count++] = {tilt, solver.solve(weight_of(live, v, left, up_at(tilt, side))).effort,
                                  solver.solve(weight_of(live, v, left_other, up_at(tilt, -side))).effort};
    if (volume > 0 && left <= LEFT_AS_EMPTY * volume) break;
  }
  return ahead;
}

}  // namespace wholehand::device
