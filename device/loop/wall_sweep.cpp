// SPDX-License-Identifier: MIT
#include "device/loop/wall_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/numbers/parallel.h"
#include "base/numbers/random_bits.h"
#include "base/text/text.h"
#include "core/wall_run.h"

namespace wholehand::device {
namespace {

constexpr std::size_t POINTS_AT_ONCE = 4096;  // between two questions whether to go on: a fraction of a second on two cores

std::vector<double> logarithmic(double from, double to, int count) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(from * std::pow(to / from, static_cast<double>(k) / (count - 1)));
  return values;
}

WallDevice device_at(const NamedDevice& named, double rate) {
  WallDevice device;
  device.mass = named.mass;
  device.damping = named.damping;
  device.rate = rate;
  return device;
}

// From far below what settles to `above` times as much and more.
WallColumn column_of(const WallDevice& device, int count, int integrator = LOOP_EXACT, int substeps = 1, double above = 10) {
  WallColumn column;
  column.theory = wall_theory(device);
  const double about = 2 * (device.damping + std::max(device.wall_damping, 0.0)) * device.rate;
  for (const double stiffness : logarithmic(0.01 * about, above * about, count)) {
    column.points.push_back({device, stiffness, integrator, substeps, 0});
  }
  return column;
}

// The same on every machine: the library's distributions are not.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : engine_(seed) {}
  double between(double low, double high) { return low + (high - low) * unit_interval(engine_()); }
  double evenly_in_logarithm(double low, double high) { return low * std::pow(high / low, between(0, 1)); }

 private:
  std::mt19937_64 engine_;
};

WallSheet by_chance(int count, std::uint64_t seed) {
  WallSheet sheet{"chance", {}};
  Chance chance(seed);
  for (int k = 0; k < count; ++k) {
    WallDevice device;
    device.mass = chance.evenly_in_logarithm(0.02, 0.5);
    device.damping = chance.evenly_in_logarithm(0.3, 3);
    device.rate = chance.evenly_in_logarithm(250, 8000);
    device.wall_damping = chance.between(0, 1) < 0.5 ? 0 : chance.between(-0.5, 2) * device.damping;
    device.delay = chance.between(0, 1) < 0.5 ? 0 : static_cast<int>(chance.between(0, LOOP_DELAYS + 1));
    if (chance.between(0, 1) < 0.5) {
      device.finger_mass = chance.between(0.004, 0.02);
      device.finger_damping = chance.between(1, 8);
      device.finger_stiffness = chance.between(200, 800);
    }
    WallColumn column;
    column.theory = wall_theory(device);
    // damping that is delayed leaves some without any stable wall
    if (!(column.theory.linear > 1)) continue;
    for (const double share : {0.99, 1.01}) column.points.push_back({device, share * column.theory.linear, LOOP_EXACT, 1, 0});
    sheet.columns.push_back(column);
  }
  return sheet;
}

const std::array<const char*, 3> INTEGRATOR_NAMES{"exact", "euler", "semi_implicit"};

std::string number_or_empty(double value) { return std::isfinite(value) ? fmt::format("{:.7g}", value) : ""; }

}  // namespace

const std::vector<NamedDevice>& wall_devices() {
  static const std::vector<NamedDevice> devices{
      {"100 g, 1 N s/m", 0.1, 1}, {"20 g, 1 N s/m", 0.02, 1}, {"100 g, 0.1 N s/m", 0.1, 0.1}, {"220 g, 2 N s/m", 0.22, 2}};
  return devices;
}

std::vector<WallSheet> wall_sheets(bool quick, std::uint64_t seed) {
  const int stiffnesses = quick ? 48 : 96;
  const std::vector<double> rates = logarithmic(250, 8000, quick ? 11 : 41);  // 1000 and every octave among them
  WallSheet map{"stiffness_damping_rate", {}}, delays{"delay", {}}, encoders{"encoder", {}}, fingers{"finger", {}},
      integrators{"integrator", {}};
  const std::vector<NamedDevice>& devices = wall_devices();
  for (std::size_t d = 0; d < (quick ? 1 : devices.size()); ++d) {
    for (const double rate : rates)
      for (int k = 0; k <= (quick ? 14 : 28); ++k) {
        WallDevice device = device_at(devices[d], rate);
        device.wall_damping = device.damping * (-0.5 + 3.5 * k / (quick ? 14 : 28));
        map.columns.push_back(column_of(device, stiffnesses));
      }
    for (const double rate : {250.0, 1000.0, 4000.0})
      for (int delay = 0; delay <= LOOP_DELAYS; ++delay) {
        WallDevice device = device_at(devices[d], rate);
        device.delay = delay;
        delays.columns.push_back(column_of(device, stiffnesses));
      }
    for (const double friction : {0.05, 0.2})
      for (const double step : logarithmic(1e-6, 1e-3, quick ? 7 : 19)) {
        WallDevice device = device_at(devices[d], 1000);
        device.coulomb = friction;
        device.encoder_step = step;
        encoders.columns.push_back(column_of(device, stiffnesses / 2));
      }
    // FACTS of people: a finger's mass, damping and stiffness from light to heavy
    for (const double share : {0.0, 0.5, 1.0}) {
      WallDevice device = device_at(devices[d], 1000);
      device.finger_mass = 0.004 + 0.016 * share;
      device.finger_damping = 1 + 7 * share;
      device.finger_stiffness = 200 + 600 * share;
      fingers.columns.push_back(column_of(device, stiffnesses));
    }
    for (const int integrator : {LOOP_EXACT, LOOP_EULER, LOOP_SEMI_IMPLICIT})
      for (const int substeps : {1, 2, 4, 8, 16}) {
        if (integrator == LOOP_EXACT && substeps > 1) continue;
        integrators.columns.push_back(column_of(device_at(devices[d], 1000), 2 * stiffnesses, integrator, substeps, 1000));
      }
  }
  return {map, delays, encoders, fingers, integrators, by_chance(quick ? 200 : 5000, seed)};
}

double integrator_limit(const WallDevice& device, int integrator, int substeps) {
  return largest_stable([&](double stiffness) {
    WallTrial trial = wall_trial(device, stiffness);
    trial.press.integrator = integrator;
    trial.press.substeps = substeps;
    return core_f64::late_energy(trial.press, WALL_SAMPLES, LATE_SAMPLES) <= trial.allowed;
  });
}

std::size_t count_points(const std::vector<WallSheet>& sheets) {
  std::size_t count = 0;
  for (const WallSheet& sheet : sheets)
    for (const WallColumn& column : sheet.columns) count += column.points.size();
  return count;
}

bool run_walls(std::vector<WallSheet>& sheets, const std::function<bool(std::size_t done)>& go_on) {
  std::size_t done = 0;
  for (WallSheet& sheet : sheets) {
    std::vector<WallCase> cases;
    std::vector<double> allowed;
    for (const WallColumn& column : sheet.columns)
      for (const WallPoint& point : column.points) {
        WallTrial trial = wall_trial(point.device, point.stiffness);
        trial.press.integrator = point.integrator;
        trial.press.substeps = point.substeps;
        cases.push_back(trial.press);
        allowed.push_back(trial.allowed);
      }
    std::vector<double> energies(cases.size());
    for (std::size_t first = 0; first < cases.size(); first += POINTS_AT_ONCE) {
      if (!go_on(done)) return false;
      const std::size_t count = std::min(POINTS_AT_ONCE, cases.size() - first);
      in_parallel(count, thread_count(), [&](std::size_t i) {
        energies[first + i] = core_f64::late_energy(cases[first + i], WALL_SAMPLES, LATE_SAMPLES);
      });
      done += count;
    }
    std::size_t i = 0;
    for (WallColumn& column : sheet.columns) {
      bool all_settle = true;
      column.theory.simulated = 0;
      for (WallPoint& point : column.points) {
        point.energy = energies[i] / allowed[i];
        ++i;
        if (!std::isfinite(point.energy)) point.energy = std::numeric_limits<double>::infinity();
        all_settle = all_settle && point.settles();
        if (all_settle) column.theory.simulated = point.stiffness;
      }
      if (all_settle) column.theory.simulated = std::numeric_limits<double>::infinity();
    }
  }
  return go_on(done);
}

std::string wall_csv(const std::vector<WallSheet>& sheets) {
  std::string csv =
      "sheet,mass_kg,damping_Nspm,rate_Hz,wall_damping_Nspm,delay_samples,encoder_um,coulomb_N,finger_kg,finger_Nspm,finger_Npm,"
      "integrator,substeps,stiffness_Npm,late_energy_over_allowed,settles\n";
  for (const WallSheet& sheet : sheets)
    for (const WallColumn& column : sheet.columns)
      for (const WallPoint& point : column.points) {
        const WallDevice& d = point.device;
        append_formatted(csv, "{},{:g},{:g},{:.7g},{:.7g},{},{:.7g},{:g},{:g},{:g},{:g},{},{},{:.7g},{:.4g},{}\n", sheet.name,
                         d.mass, d.damping, d.rate, d.wall_damping, d.delay, d.encoder_step * 1e6, d.coulomb, d.finger_mass,
                         d.finger_damping, d.finger_stiffness, INTEGRATOR_NAMES[point.integrator], point.substeps, point.stiffness,
                         point.energy, point.settles() ? 1 : 0);
      }
  return csv;
}

std::string wall_limits_csv(const std::vector<WallSheet>& sheets, const std::string& run) {
  std::string csv =
      "sheet,mass_kg,damping_Nspm,rate_Hz,wall_damping_Nspm,delay_samples,encoder_um,coulomb_N,finger_kg,finger_Nspm,finger_Npm,"
      "integrator,substeps,settles_up_to_Npm,next_tried_Npm,passive_Npm,linear_Npm,coulomb_Npm,device,driver,version,seed\n";
  for (const WallSheet& sheet : sheets)
    for (const WallColumn& column : sheet.columns) {
      const WallPoint& first = column.points.front();
      const WallDevice& d = first.device;
      const auto next = std::find_if(column.points.begin(), column.points.end(), [](const WallPoint& p) { return !p.settles(); });
      append_formatted(csv, "{},{:g},{:g},{:.7g},{:.7g},{},{:.7g},{:g},{:g},{:g},{:g},{},{},{},{},{},{},{},{}\n", sheet.name,
                       d.mass, d.damping, d.rate, d.wall_damping, d.delay, d.encoder_step * 1e6, d.coulomb, d.finger_mass,
                       d.finger_damping, d.finger_stiffness, INTEGRATOR_NAMES[first.integrator], first.substeps,
                       number_or_empty(column.theory.simulated),
                       next == column.points.end() ? "" : number_or_empty(next->stiffness), number_or_empty(column.theory.passive),
                       number_or_empty(column.theory.linear), number_or_empty(column.theory.coulomb), run);
    }
  return csv;
}

}  // namespace wholehand::device
