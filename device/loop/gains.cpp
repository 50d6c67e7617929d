// SPDX-License-Identifier: MIT
#include "device/loop/gains.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/prepare.h"
#include "device/loop/grip_loop.h"
#include "device/loop/wall_sweep.h"
#include "device/session/workspace.h"

namespace wholehand::device {
namespace {

// The lightest finger, on users of every usual reaction.
std::vector<GripLoop> light_grips(double rate) {
  std::vector<GripLoop> grips;
  for (int reaction = 60; reaction <= 90; reaction += 5) {
    GripLoop light;
    light.rate = rate;
    light.finger_mass = 0.004;
    light.finger_damping = 1;
    light.finger_stiffness = 200;
    light.reaction = reaction * 1e-3;
    grips.push_back(light);
  }
  return grips;
}

double wall_limit(double rate, double wall_damping) {
  double limit = std::numeric_limits<double>::infinity();
  WallDevice device;
  device.rate = rate;
  device.wall_damping = wall_damping;
  for (const NamedDevice& named : wall_devices()) {
    if (named.damping < 1) continue;  // an axis without friction worth the name is no haptic device's
    device.mass = named.mass;
    device.damping = named.damping;
    limit = std::min(limit, wall_theory(device).linear);
  }
  return limit;
}

}  // namespace

GainLimits gain_limits(double rate, double wall_damping) {
  GainLimits limits;
  limits.stiffness = wall_limit(rate, wall_damping);
  limits.k_open = std::numeric_limits<double>::infinity();
  for (const GripLoop& loop : light_grips(rate)) limits.k_open = std::min(limits.k_open, largest_k_open(loop));
  return limits;
}

double device_slope(const Scene& scene, std::array<double, 2> device_gap) {
  const PreparedHand hand = prepare_hand(scene.hand);
  const std::array<double, 2> gap = scene.device.has_gap ? scene.device.gap : device_gap;
  return coupling_slope(scene.device.workspace_scale, scene.hand.scale * (hand.gap_open - hand.gap_closed) / (gap[1] - gap[0]));
}

void refuse_unstable_gains(const Scene& scene, std::array<double, 2> device_gap, bool unsafe) {
  if (unsafe) return;
  const LiveData& live = scene.live;
  const double slope = device_slope(scene, device_gap);
  const auto refuse = [&](const std::string& what, double limit) {
    throw usage_error(
        fmt::format("{}: unstable on a light device at {} Hz; allowed: at most {:.0f}, a higher [live] rate_Hz, or "
                    "--unsafe-gains if the device is known to stay stable (wholehand stability wall)",
                    what, plain_text(live.rate), limit));
  };
  const double stiffness = wall_limit(live.rate, slope * live.damping) / slope;
  if (live.stiffness > stiffness) {
    refuse(fmt::format("[live] K_N_m = {:g} with B_Ns_m = {:g}, and the device feels {:.3g} times these values (by two tips at its "
                       "arm, workspace_scale, gap_mm)",
                       live.stiffness, live.damping, slope),
           std::max(0.0, stiffness));
  }
  for (GripLoop loop : light_grips(live.rate)) {
    loop.k_open = scene.force.k_open;
    if (!decays(loop))
      refuse(fmt::format("[force] k_open_N_m = {:g}", scene.force.k_open), gain_limits(live.rate, live.damping).k_open);
  }
}

}  // namespace wholehand::device
