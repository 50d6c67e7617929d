// SPDX-License-Identifier: MIT
#include "device/loop/wall.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/files/json.h"
#include "base/text/readable.h"
#include "core/loop.h"
#include "core/wall_run.h"

namespace wholehand::device {
namespace {

constexpr double NO_LIMIT = std::numeric_limits<double>::infinity();
constexpr double STIFFEST = 1e12;       // N/m: what is stable there is not limited
constexpr double SOFTEST = 1e-3;        // N/m: below this nothing is a wall
constexpr double BEYOND_LINEAR = 1.01;  // what the simulation's finite time may add

core_f64::Plant plant_of(const WallDevice& device) {
  return {device.mass + device.finger_mass, device.damping + device.finger_damping, device.finger_stiffness};
}

core_f64::Wall wall_of(const WallDevice& device, double stiffness) {
  core_f64::Wall wall;
  wall.stiffness = stiffness;
  wall.damping = device.wall_damping;
  wall.period = 1 / device.rate;
  wall.encoder_step = device.encoder_step;
  wall.delay = device.delay;
  return wall;
}

constexpr int STATES = 3 + LOOP_DELAYS;  // place, speed, reading, and the forces that wait
using Matrix = std::array<std::array<double, STATES>, STATES>;

// One sample of the linear loop, column by column through the kernel. Speeds and forces are scaled to a place of the same energy, so that the matrix
// is about as large as its eigenvalues.
Matrix loop_matrix(const WallDevice& device, double stiffness) {
  const core_f64::Plant plant = plant_of(device);
  core_f64::Wall wall = wall_of(device, stiffness);
  wall.encoder_step = 0;
  wall.is_bilateral = true;
  const core_f64::Propagator by = core_f64::propagator(plant, wall.period);
  const double spring = std::max(stiffness + plant.stiffness, std::numeric_limits<double>::min());
  const double speed = std::sqrt(spring / plant.mass);
  Matrix matrix{};
  for (int column = 0; column < 3 + device.delay; ++column) {
    core_f64::LoopState state;
    if (column == 0) state.motion.place = 1;
    if (column == 1) state.motion.speed = speed;
    if (column == 2) state.reading = 1;
    if (column > 2) state.waiting[column - 3] = spring;
    const core_f64::LoopState next = core_f64::step_loop(plant, by, wall, state, 0, 0);
    matrix[0][column] = next.motion.place;
    matrix[1][column] = next.motion.speed / speed;
    matrix[2][column] = next.reading;
    for (int k = 0; k < device.delay; ++k) matrix[3 + k][column] = next.waiting[k] / spring;
  }
  return matrix;
}

Matrix squared(const Matrix& a) {
  Matrix result{};
  for (int i = 0; i < STATES; ++i)
    for (int k = 0; k < STATES; ++k)
      for (int j = 0; j < STATES; ++j) result[i][j] += a[i][k] * a[k][j];
  return result;
}

double largest_entry(const Matrix& a) {
  double largest = 0;
  for (const auto& row : a)
    for (const double value : row) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace

double largest_stable(const std::function<bool(double stiffness)>& is_stable) {
  double high = 1;
  while (is_stable(high)) {
    high *= 2;
    if (high > STIFFEST) return NO_LIMIT;
  }
  if (high == 1 && !is_stable(SOFTEST)) return 0;
  double low = high == 1 ? SOFTEST : high / 2;
  for (int step = 0; step < 100 && high - low > 1e-6 * high; ++step) {
    const double middle = 0.5 * (low + high);
    (is_stable(middle) ? low : high) = middle;
  }
  return low;
}

WallTrial wall_trial(const WallDevice& device, double stiffness) {
  const core_f64::Plant plant = plant_of(device);
  const core_f64::Wall wall = wall_of(device, stiffness);
  // off its rest by less than it is pressed in, so that a loop that settles stays in contact; with encoder or friction, by far more than they blur,
  // and settling means coming within twice of that
  const double blur = device.encoder_step + device.coulomb / stiffness;
  const double away = blur > 0 ? 20 * blur : 1e-3;
  WallTrial trial;
  WallCase& press = trial.press;
  press.mass = plant.mass;
  press.damping = plant.damping;
  press.spring = plant.stiffness;
  press.wall_stiffness = stiffness;
  press.wall_damping = device.wall_damping;
  press.period = wall.period;
  press.encoder_step = device.encoder_step;
  press.delay = device.delay;
  press.friction = device.coulomb;
  press.press = 2 * (stiffness + plant.stiffness) * away;
  press.place = 3 * away;
  trial.allowed = blur > 0 ? 2 * (stiffness + plant.stiffness) * blur * blur
                           : core_f64::loop_energy(plant, wall, {press.place, 0}, press.press);
  return trial;
}

bool settles(const WallDevice& device, double stiffness) {
  const WallTrial trial = wall_trial(device, stiffness);
  return core_f64::late_energy(trial.press, WALL_SAMPLES, LATE_SAMPLES) <= trial.allowed;
}

// |M^n|^(1/n) for n = 2^50, by squaring; kept from overflow by the logarithm of what is divided out. What rounding adds to the logarithm
// at a squaring is halved by each one after it.
double spectral_radius(const WallDevice& device, double stiffness) {
  Matrix matrix = loop_matrix(device, stiffness);
  double logarithm = 0, power = 1;
  for (int k = 0; k < 50; ++k) {
    const double size = largest_entry(matrix);
    if (size == 0) return 0;
    for (auto& row : matrix)
      for (double& value : row) value /= size;
    logarithm += std::log(size) / power;
    matrix = squared(matrix);
    power *= 2;
  }
  const double size = largest_entry(matrix);
  return size > 0 ? std::exp(logarithm + std::log(size) / power) : 0;
}

WallLimits wall_theory(const WallDevice& device) {
  const double period = 1 / device.rate;
  WallLimits limits;
  limits.passive = std::max(0.0, 2 * (device.damping - std::abs(device.wall_damping)) / period);
  limits.coulomb = 2 * device.damping / period;
  if (device.encoder_step > 0) limits.coulomb = std::min(limits.coulomb, 2 * device.coulomb / device.encoder_step);
  limits.linear = largest_stable([&](double stiffness) { return spectral_radius(device, stiffness) <= 1; });
  return limits;
}

WallLimits wall_limits(const WallDevice& device) {
  WallLimits limits = wall_theory(device);
  limits.simulated = largest_stable([&](double stiffness) { return settles(device, stiffness); });
  // with an ideal reading and no friction to hold it, what stays bounded beyond the linear limit is a cycle
  if (device.encoder_step == 0 && device.coulomb == 0) limits.simulated = std::min(limits.simulated, BEYOND_LINEAR * limits.linear);
  return limits;
}

std::string wall_json(const WallLimits& limits) {
  const auto number = [](double value) { return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(); };
  nlohmann::ordered_json json;
  json["largest_stable_K_Npm"] = number(limits.simulated);
  json["passive_K_Npm"] = number(limits.passive);
  json["linear_K_Npm"] = number(limits.linear);
  json["coulomb_K_Npm"] = number(limits.coulomb);
  return json_text(json) + "\n";
}

std::string wall_table(const WallDevice& device, const WallLimits& limits) {
  const auto number = [](double value) { return std::isfinite(value) ? fixed_text(value, 1) : std::string("no limit"); };
  return fmt::format(
      "Stiffest wall of a device of {:g} kg and {:g} N s/m at {} Hz, N/m:\n"
      "  settles in simulation      {:>12}\n"
      "  passive, whoever holds it  {:>12}\n"
      "  linear loop's eigenvalues  {:>12}\n"
      "  encoder and friction       {:>12}\n",
      device.mass, device.damping, plain_text(device.rate), number(limits.simulated), number(limits.passive), number(limits.linear),
      number(limits.coulomb));
}

}  // namespace wholehand::device
