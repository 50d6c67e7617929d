// SPDX-License-Identifier: MIT
#include "evidence/wall_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <memory>
#include <random>
#include <thread>

#include "core/core_backend.h"
#include "core/wall_run.h"
#include "host/wall_map.h"
#include "system/gnuplot.h"

namespace wholehand {
namespace {

constexpr std::size_t POINTS_AT_ONCE = 16384;  // seconds on two cores, and enough to fill a large device

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
  double between(double low, double high) { return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53); }
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

const WallSheet& sheet_of(const std::vector<WallSheet>& sheets, const std::string& name) {
  return *std::find_if(sheets.begin(), sheets.end(), [&](const WallSheet& sheet) { return sheet.name == name; });
}

std::string number_or_empty(double value) { return std::isfinite(value) ? fmt::format("{:.7g}", value) : ""; }

// One panel: what settles and what does not as areas, the limits as lines.
struct Panel {
  std::string title, axis;
  bool is_logarithmic = true;
  std::vector<const WallColumn*> columns;
  std::vector<double> at;  // of each column, on the panel's axis, ascending
};

// The columns of a sheet that are in it.
template <class IsIn, class At>
Panel panel_of(const WallSheet& sheet, const std::string& title, const std::string& axis, bool is_logarithmic, const IsIn& is_in,
               const At& at) {
  Panel panel{title, axis, is_logarithmic, {}, {}};
  for (const WallColumn& column : sheet.columns) {
    const WallDevice& device = column.points.front().device;
    if (!is_in(device)) continue;
    panel.columns.push_back(&column);
    panel.at.push_back(at(column.points.front()));
  }
  return panel;
}

// Half way between neighbours, on the axis as it is drawn; as far beyond the ends.
std::vector<double> edges_of(std::vector<double> at, bool is_logarithmic) {
  const auto drawn = [is_logarithmic](double x) { return is_logarithmic ? std::log(x) : x; };
  for (double& x : at) x = drawn(x);
  const std::size_t n = at.size();
  std::vector<double> edges{n > 1 ? at[0] - 0.5 * (at[1] - at[0]) : at[0] - 0.5};
  for (std::size_t k = 0; k + 1 < n; ++k) edges.push_back(0.5 * (at[k] + at[k + 1]));
  edges.push_back(n > 1 ? at[n - 1] + 0.5 * (at[n - 1] - at[n - 2]) : at[0] + 0.5);
  if (is_logarithmic)
    for (double& x : edges) x = std::exp(x);
  return edges;
}

// Boxes of the points of one column that settle, or that do not: a run of neighbours is one box.
void draw_runs(std::back_insert_iterator<std::string> out, const WallColumn& column, bool settled, double left, double right) {
  std::vector<double> stiffness;
  for (const WallPoint& point : column.points) stiffness.push_back(point.stiffness);
  const std::vector<double> edges = edges_of(stiffness, true);
  for (std::size_t k = 0; k < column.points.size();) {
    std::size_t end = k;
    while (end < column.points.size() && column.points[end].settles() == column.points[k].settles()) ++end;
    if (column.points[k].settles() == settled) {
      fmt::format_to(out, "{:.6g} {:.6g} {:.6g} {:.6g} {:.6g} {:.6g}\n", left, edges[k], left, right, edges[k], edges[end]);
    }
    k = end;
  }
}

enum class Rule { passive, friction, none };

void draw_panel(std::back_insert_iterator<std::string> out, const Panel& panel, Rule rule) {
  const std::vector<double> edges = edges_of(panel.at, panel.is_logarithmic);
  fmt::format_to(out, "set title {} textcolor '#202020'\nset xlabel {} textcolor '#202020'\n{}\nset xrange [{:.6g}:{:.6g}]\n",
                 gnuplot_quoted(panel.title), gnuplot_quoted(panel.axis),
                 panel.is_logarithmic ? "set logscale x" : "unset logscale x", edges.front(), edges.back());
  fmt::format_to(out,
                 "plot '-' using 1:2:3:4:5:6 with boxxyerror fillcolor '#b9d7ea' title 'settles', "
                 "'-' using 1:2:3:4:5:6 with boxxyerror fillcolor '#f6d2a9' title 'does not', "
                 "'-' with lines linewidth 2 linecolor '#1f4e79' title 'linear limit'{}\n",
                 rule == Rule::none ? ""
                                    : fmt::format(", '-' with lines linewidth 2 dashtype 2 linecolor '#b03a00' title '{}'",
                                                  rule == Rule::friction ? "min(2b/T, 2f_c/D)" : "b = KT/2 + |B|"));
  for (const bool settled : {true, false}) {
    for (std::size_t c = 0; c < panel.columns.size(); ++c) draw_runs(out, *panel.columns[c], settled, edges[c], edges[c + 1]);
    fmt::format_to(out, "NaN NaN NaN NaN NaN NaN\ne\n");
  }
  for (const bool linear : {true, false}) {
    if (!linear && rule == Rule::none) continue;
    for (std::size_t c = 0; c < panel.columns.size(); ++c) {
      const WallLimits& theory = panel.columns[c]->theory;
      const double limit = linear ? theory.linear : rule == Rule::friction ? theory.coulomb : theory.passive;
      if (limit > 0 && std::isfinite(limit)) fmt::format_to(out, "{:.6g} {:.6g}\n", panel.at[c], limit);
    }
    fmt::format_to(out, "NaN NaN\ne\n");
  }
}

}  // namespace

const std::vector<NamedDevice>& wall_devices() {
  static const std::vector<NamedDevice> devices{
      {"100 g, 1 N s/m", 0.1, 1}, {"20 g, 1 N s/m", 0.02, 1}, {"100 g, 0.1 N s/m", 0.1, 0.1}, {"220 g, 2 N s/m", 0.22, 2}};
  return devices;
}

WallRunner open_wall_runner(const std::string& on, BackendInfo& info, double& kernel_seconds) {
  if (on == "core") {
    const unsigned threads = std::max(1u, std::thread::hardware_concurrency());
    info = core_info(Precision::full, static_cast<int>(threads));
    return [threads](const std::vector<WallCase>& cases, int samples, int late) {
      std::vector<double> energies(cases.size());
      std::atomic<std::size_t> next{0};
      std::vector<std::jthread> workers;
      for (unsigned k = 0; k < threads; ++k)
        workers.emplace_back([&] {
          for (std::size_t i = next++; i < cases.size(); i = next++) energies[i] = core_f64::late_energy(cases[i], samples, late);
        });
      workers.clear();
      return energies;
    };
  }
  const auto map = std::make_shared<host::WallMap>(on, Precision::single);
  info = {"vulkan", map->device().name, map->device().driver, Precision::single, map->device().kind == host::DeviceKind::cpu};
  return [map, &kernel_seconds](const std::vector<WallCase>& cases, int samples, int late) {
    auto energies = map->late_energies(cases, samples, late);
    kernel_seconds = map->kernel_seconds();
    return energies;
  };
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

// A sheet at a time: with friction a sample costs many times more, and cases of one dispatch wait for each other.
bool run_walls(std::vector<WallSheet>& sheets, const WallRunner& runner, const std::function<bool(std::size_t done)>& go_on) {
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
    std::vector<double> energies;
    for (std::size_t first = 0; first < cases.size(); first += POINTS_AT_ONCE) {
      if (!go_on(done)) return false;
      const auto begin = cases.begin() + static_cast<std::ptrdiff_t>(first);
      const std::vector<WallCase> part(begin, begin + static_cast<std::ptrdiff_t>(std::min(POINTS_AT_ONCE, cases.size() - first)));
      const std::vector<double> some = runner(part, WALL_SAMPLES, LATE_SAMPLES);
      energies.insert(energies.end(), some.begin(), some.end());
      done += part.size();
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
  auto out = std::back_inserter(csv);
  for (const WallSheet& sheet : sheets)
    for (const WallColumn& column : sheet.columns)
      for (const WallPoint& point : column.points) {
        const WallDevice& d = point.device;
        fmt::format_to(out, "{},{:g},{:g},{:.7g},{:.7g},{},{:.7g},{:g},{:g},{:g},{:g},{},{},{:.7g},{:.4g},{}\n", sheet.name, d.mass,
                       d.damping, d.rate, d.wall_damping, d.delay, d.encoder_step * 1e6, d.coulomb, d.finger_mass, d.finger_damping,
                       d.finger_stiffness, INTEGRATOR_NAMES[point.integrator], point.substeps, point.stiffness, point.energy,
                       point.settles() ? 1 : 0);
      }
  return csv;
}

std::string wall_limits_csv(const std::vector<WallSheet>& sheets, const std::string& run) {
  std::string csv =
      "sheet,mass_kg,damping_Nspm,rate_Hz,wall_damping_Nspm,delay_samples,encoder_um,coulomb_N,finger_kg,finger_Nspm,finger_Npm,"
      "integrator,substeps,settles_up_to_Npm,next_tried_Npm,passive_Npm,linear_Npm,coulomb_Npm,device,driver,version,seed\n";
  auto out = std::back_inserter(csv);
  for (const WallSheet& sheet : sheets)
    for (const WallColumn& column : sheet.columns) {
      const WallPoint& first = column.points.front();
      const WallDevice& d = first.device;
      const auto next = std::find_if(column.points.begin(), column.points.end(), [](const WallPoint& p) { return !p.settles(); });
      fmt::format_to(out, "{},{:g},{:g},{:.7g},{:.7g},{},{:.7g},{:g},{:g},{:g},{:g},{},{},{},{},{},{},{},{}\n", sheet.name, d.mass,
                     d.damping, d.rate, d.wall_damping, d.delay, d.encoder_step * 1e6, d.coulomb, d.finger_mass, d.finger_damping,
                     d.finger_stiffness, INTEGRATOR_NAMES[first.integrator], first.substeps,
                     number_or_empty(column.theory.simulated), next == column.points.end() ? "" : number_or_empty(next->stiffness),
                     number_or_empty(column.theory.passive), number_or_empty(column.theory.linear),
                     number_or_empty(column.theory.coulomb), run);
    }
  return csv;
}

std::string wall_script(const std::vector<WallSheet>& sheets, const std::string& folder, std::vector<std::string>& files) {
  const NamedDevice& named = wall_devices().front();
  const auto is_named = [&named](const WallDevice& d) { return d.mass == named.mass && d.damping == named.damping; };
  const auto is_kilohertz = [](const WallDevice& d) { return std::abs(d.rate - 1000) < 0.5; };
  const WallSheet& map = sheet_of(sheets, "stiffness_damping_rate");
  // wall.svg last: gnuplot writes the last subscript that it set into the titles of later pictures
  std::string script;
  auto out = std::back_inserter(script);
  files.push_back(folder + "/wall_integrators.svg");
  script += gnuplot_style(640, 440) + gnuplot_output(files.back());
  fmt::format_to(
      out,
      "set title 'What an integrator makes of the limit: {}, 1 kHz' textcolor '#202020'\n"
      "set xlabel 'sub-steps a sample' textcolor '#202020'\nset ylabel 'settles up to K / (N/m)' textcolor '#202020'\n"
      "set logscale x 2\nset logscale y 10\nset key top right nobox vertical inside\nset xrange [0.8:20]\nset yrange [500:*]\n"
      "plot '-' with linespoints pointtype 7 linewidth 2 linecolor '#b03a00' title 'explicit Euler', "
      "'-' with linespoints pointtype 5 linewidth 2 linecolor '#1f4e79' title 'semi-implicit Euler', "
      "'-' with lines linewidth 2 dashtype 2 linecolor '#404040' title 'exact'\n",
      named.name);
  for (const int integrator : {LOOP_EULER, LOOP_SEMI_IMPLICIT, LOOP_EXACT}) {
    for (const WallColumn& column : sheet_of(sheets, "integrator").columns) {
      const WallPoint& first = column.points.front();
      if (first.integrator != integrator || !is_named(first.device)) continue;
      const double limit = integrator_limit(first.device, integrator, first.substeps);
      if (integrator == LOOP_EXACT) {
        fmt::format_to(out, "1 {:.6g}\n16 {:.6g}\n", limit, limit);
      } else {
        fmt::format_to(out, "{} {:.6g}\n", first.substeps, limit);
      }
    }
    fmt::format_to(out, "e\n");
  }
  fmt::format_to(out, "set output\nreset\n");

  files.push_back(folder + "/wall.svg");
  script += gnuplot_style(960, 760) + gnuplot_output(files.back());
  fmt::format_to(out,
                 "set multiplot layout 2,2 title 'A rendered wall on a device of {}' textcolor '#202020'\n"
                 "set logscale y\nset ylabel 'stiffness K / (N/m)' textcolor '#202020'\nset format y '10^{{%L}}'\n"
                 "set termoption enhanced\nset key above horizontal samplen 1.2\nset style fill solid 1.0 noborder\n"
                 "set tics front\n",
                 named.name);
  fmt::format_to(out, "set xtics (250, 500, 1000, 2000, 4000, 8000)\n");
  draw_panel(out,
             panel_of(
                 map, "no wall damping", "rate / Hz", true,
                 [&](const WallDevice& d) { return is_named(d) && std::abs(d.wall_damping) < 1e-9; },
                 [](const WallPoint& p) { return p.device.rate; }),
             Rule::passive);
  fmt::format_to(out, "set xtics autofreq\n");
  draw_panel(
      out,
      panel_of(
          map, "1 kHz", "wall damping B / (N s/m)", false, [&](const WallDevice& d) { return is_named(d) && is_kilohertz(d); },
          [](const WallPoint& p) { return p.device.wall_damping; }),
      Rule::passive);
  draw_panel(
      out,
      panel_of(
          sheet_of(sheets, "delay"), "1 kHz, no wall damping", "delay / samples", false,
          [&](const WallDevice& d) { return is_named(d) && is_kilohertz(d); }, [](const WallPoint& p) { return p.device.delay; }),
      Rule::none);
  draw_panel(out,
             panel_of(
                 sheet_of(sheets, "encoder"), "1 kHz, friction f_c = 0.2 N", "encoder step D / um", true,
                 [&](const WallDevice& d) { return is_named(d) && d.coulomb == 0.2; },
                 [](const WallPoint& p) { return p.device.encoder_step * 1e6; }),
             Rule::friction);
  fmt::format_to(out, "unset multiplot\nset output\nreset\n");
  return script;
}

}  // namespace wholehand
