// SPDX-License-Identifier: MIT
// The leaf functions of loop and force with raw numbers: whatever is finite and within the ranges that their callers promise, the
// answers are finite (an infinite hold force where nothing can hold apart), forces are within their limits, and friction never adds
// energy.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/held.h"
#include "core/loop.h"
#include "tests/fuzz/must.h"

namespace wholehand {
namespace {

// Eight bytes a number, folded into its range; past the end 0.
class Numbers {
 public:
  Numbers(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  double raw() {
    double value = 0;
    if (size_ - at_ >= sizeof value) {
      std::memcpy(&value, data_ + at_, sizeof value);
      at_ += sizeof value;
    } else {
      at_ = size_;
    }
    return value;
  }
  // As it stands where it is within, else folded: every exponent is reached, denormals too.
  double in(double low, double high) {
    const double value = raw();
    if (std::isfinite(value) && value >= low && value <= high) return value;
    const double folded = std::isfinite(value) ? std::fmod(std::abs(value), high - low) : 0;
    return std::clamp(low + folded, low, high);
  }
  int choice(int count) { return static_cast<int>(in(0, count - 1e-9)); }

 private:
  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
};

void try_loop(Numbers& numbers) {
  using namespace core_f64;
  // as the command takes them, and fingers on them
  const Plant plant{numbers.in(1e-6, 2e3), numbers.in(0, 2e6), numbers.in(0, 1e6)};
  Wall wall;
  wall.stiffness = numbers.in(0, 1e12);
  wall.damping = numbers.in(-1e6, 1e6);
  wall.period = 1 / numbers.in(1, 1e5);
  wall.encoder_step = numbers.choice(2) == 1 ? numbers.in(1e-12, 0.1) : 0;
  wall.force_limit = numbers.in(0, 1e3);
  wall.delay = numbers.choice(LOOP_DELAYS + 1);
  wall.is_bilateral = numbers.choice(2) == 1;
  const Propagator by = propagator(plant, wall.period);
  for (const double part : {by.place_place, by.place_speed, by.place_force, by.speed_place, by.speed_speed, by.speed_force})
    must(std::isfinite(part), "a propagator that is not finite");
  const double place = numbers.in(-1, 1), speed = numbers.in(-10, 10), press = numbers.in(0, 1e3), friction = numbers.in(0, 1e3);
  LoopState state = let_go(wall, place);
  state.motion.speed = speed;
  for (int step = 0; step < 4; ++step) {
    state = step_loop(plant, by, wall, state, press, friction);
    // a wall of 10^12 N/m on a microgram throws it far, and not beyond what a double holds
    must(std::isfinite(state.motion.place) && std::isfinite(state.motion.speed), "a motion that is not finite");
    if (wall.force_limit > 0)
      for (const double force : state.waiting) must(std::abs(force) <= wall.force_limit, "a force beyond its limit");
  }
  // nothing drives it: friction and damping only take energy, where a sample is no longer than the plant's fastest mode: few
  // reversals, and found
  if (wall.period * (std::sqrt(plant.stiffness / plant.mass) + plant.damping / plant.mass) > 1) return;
  const Motion before{place, speed};
  const Motion after = advance_with_friction(plant, by, before, 0, friction, wall.period);
  Wall none;
  const double had = loop_energy(plant, none, before, 0), has = loop_energy(plant, none, after, 0);
  must(has <= had * (1 + 1e-9) + 1e-300, "friction added energy");
}

void try_force(Numbers& numbers) {
  using namespace core_f64;
  const double mass = numbers.in(0, 1e6), gravity = numbers.in(0, 100), friction = numbers.in(0, 10), torsion = numbers.in(0, 1);
  const Vec3 arm(numbers.in(-100, 100), numbers.in(-100, 100), numbers.in(-100, 100));
  const auto direction = [&numbers] {
    const Vec3 v(numbers.in(-1, 1), numbers.in(-1, 1), numbers.in(-1, 1));
    const double length = glm::length(v);
    return length > 1e-100 && std::isfinite(length) ? v / length : Vec3(1, 0, 0);
  };
  const Vec3 across = direction(), up = direction();
  const double hold = hold_force(mass, gravity, arm, across, up, friction, torsion);
  must(!std::isnan(hold) && hold >= 0, "a hold force that is no force");
  // the smallest friction and torsion that are not none may overflow
  must(std::isfinite(hold) || friction < 1e-100 || torsion < 1e-100, "a hold force that is infinite for no reason");
  const double most = numbers.in(0, 1e6);
  const double force = feedback_force(numbers.in(-1e9, 1e9), numbers.in(-1e9, 1e9), most);
  must(force >= 0 && force <= most, "a feedback beyond its limit");
}

}  // namespace
}  // namespace wholehand

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  wholehand::Numbers numbers(data, size);
  wholehand::try_loop(numbers);
  wholehand::try_force(numbers);
  return 0;
}
