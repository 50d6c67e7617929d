#include "sweeps/gains.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "sweeps/grip_loop.h"
#include "sweeps/wall_sweep.h"

namespace wholehand {

GainLimits gain_limits(double rate, double wall_damping) {
  GainLimits limits;
  limits.stiffness = std::numeric_limits<double>::infinity();
  WallDevice device;
  device.rate = rate;
  device.wall_damping = wall_damping;
  for (const NamedDevice& named : wall_devices()) {
    if (named.damping < 1) continue;  // an axis without friction worth the name is no haptic device's
    device.mass = named.mass;
    device.damping = named.damping;
    limits.stiffness = std::min(limits.stiffness, wall_theory(device).linear);
  }
  GripLoop light;
  light.rate = rate;
  light.finger_mass = 0.004;
  light.finger_damping = 1;
  light.finger_stiffness = 200;
  limits.k_open = sampled_k_open(light);
  return limits;
}

void refuse_unstable_gains(const Scene& scene, bool unsafe) {
  if (unsafe) return;
  const LiveData& live = scene.live;
  const GainLimits limits = gain_limits(live.rate, live.damping);
  const auto refuse = [&](const char* key, double gain, double limit) {
    if (gain <= limit) return;
    throw usage_error(
        fmt::format("{} = {:g}: not stable on a light device at {:g} Hz; allowed: at most {:.0f}, a higher [live] rate_Hz, or "
                    "--unsafe-gains where the device is known to bear it (wholehand stability wall)",
                    key, gain, live.rate, limit));
  };
  refuse("[live] K_N_m", live.stiffness, limits.stiffness);
  refuse("[force] k_open_N_m", scene.force.k_open, limits.k_open);
}

}  // namespace wholehand
