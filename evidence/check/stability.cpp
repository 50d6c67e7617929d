// SPDX-License-Identifier: MIT
#include "evidence/check/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "base/files/csv.h"
#include "base/files/files.h"
#include "base/files/folder_files.h"
#include "base/files/pictures.h"
#include "base/system/clock.h"
#include "base/system/interrupt.h"
#include "base/system/output.h"
#include "base/system/progress.h"
#include "base/system/version.h"
#include "base/text/printable.h"
#include "base/text/readable.h"
#include "base/text/text.h"
#include "core/core_backend.h"
#include "core/domain.h"
#include "device/loop/gains.h"
#include "device/loop/grip_loop.h"
#include "device/loop/wall_sweep.h"
#include "evidence/check/grip_loop_picture.h"
#include "evidence/check/wall_picture.h"

namespace wholehand {
namespace {

std::string newtons_per_meter(double limit) { return std::isfinite(limit) ? fixed_text(limit, 0) : std::string("no limit"); }

constexpr FolderTable STABILITY_TABLES[] = {{"wall.csv", "sheet,mass_kg,"},
                                            {"wall_limits.csv", "sheet,mass_kg,"},
                                            {"grip_loop.csv", "varied,base_N,"},
                                            {"extreme.csv", "case,backend,precision,"},
                                            {"stability.md", "# Stability"}};
constexpr const char* STABILITY_PICTURES[] = {"wall.svg", "wall_integrators.svg", "grip_loop.svg"};
constexpr std::array<double, 6> RATES{250, 500, 1000, 2000, 4000, 8000};

// What a map of walls must show, whatever the machine: a passive wall that does not settle is a wrong kernel.
struct WallFindings {
  std::size_t points = 0, passive = 0, passive_unsettled = 0;
  std::size_t by_chance = 0, chance_as_theory = 0;  // devices by chance; whose limit is within 1 % of the linear one
};
WallFindings look_at(const std::vector<device::WallSheet>& sheets) {
  WallFindings found;
  for (const device::WallSheet& sheet : sheets)
    for (const device::WallColumn& column : sheet.columns)
      for (const device::WallPoint& point : column.points) {
        ++found.points;
        // the rule is for a reading that is exact or blurred by less than friction holds, and for no delay
        const bool is_passive = point.integrator == LOOP_EXACT && point.device.delay == 0 && point.device.encoder_step == 0 &&
                                point.stiffness < column.theory.passive;
        if (!is_passive) continue;
        ++found.passive;
        found.passive_unsettled += point.settles() ? 0 : 1;
      }
  for (const device::WallSheet& sheet : sheets) {
    if (sheet.name != "chance") continue;
    for (const device::WallColumn& column : sheet.columns) {
      ++found.by_chance;
      found.chance_as_theory += column.points.front().settles() && !column.points.back().settles() ? 1 : 0;
    }
  }
  return found;
}

void write_walls(std::string& out, const std::vector<device::WallSheet>& sheets, const WallFindings& found) {
  append_formatted(
      out,
      "\n## The rendered wall\n\n"
      "The simulation pressed {} walls for 20,000 samples each. {} of them are passive by b > K T / 2 + |B|; {} of "
      "the passive walls did not settle. {} of {} random devices, fingers, walls and rates settle 1 % below their "
      "linear limit and do not settle 1 % above it.\n\n"
      "The table shows the largest stiffness K in N/m without wall damping: in simulation / linear limit / passive "
      "limit. The first two limits are lowest for a device that nobody holds. Only the passive limit is valid for every "
      "hand that holds the device.\n\n| device |",
      readable_number(found.points), readable_number(found.passive), readable_number(found.passive_unsettled),
      readable_number(found.chance_as_theory), readable_number(found.by_chance));
  for (const double rate : RATES) append_formatted(out, " {} Hz |", plain_text(rate));
  append_formatted(out, "\n|---|");
  for (std::size_t k = 0; k < RATES.size(); ++k) append_formatted(out, "---|");
  for (const device::NamedDevice& named : device::wall_devices()) {
    append_formatted(out, "\n| {} |", named.name);
    for (const double rate : RATES) {
      device::WallDevice device;
      device.mass = named.mass;
      device.damping = named.damping;
      device.rate = rate;
      const device::WallLimits limits = device::wall_limits(device);
      append_formatted(out, " {} / {} / {} |", newtons_per_meter(limits.simulated), newtons_per_meter(limits.linear),
                       newtons_per_meter(limits.passive));
    }
  }
  append_formatted(out, "\n\nThe linear limit over the delay, at 1 kHz, for {}:", device::wall_devices().front().name);
  device::WallDevice device;
  device.mass = device::wall_devices().front().mass;
  device.damping = device::wall_devices().front().damping;
  for (int delay = 0; delay <= LOOP_DELAYS; ++delay) {
    device.delay = delay;
    append_formatted(out, "{} {} samples {} N/m", delay == 0 ? "" : ",", delay,
                     newtons_per_meter(device::wall_theory(device).linear));
  }
  append_formatted(out, ".\n");
  for (const device::WallSheet& sheet : sheets) {
    if (sheet.name != "integrator") continue;
    append_formatted(out, "\nIf an integrator replaces the exact motion between samples, the limit moves (same device, 1 kHz):");
    const char* separator = "";
    for (const device::WallColumn& column : sheet.columns) {
      const device::WallPoint& first = column.points.front();
      if (first.device.mass != device.mass || first.device.damping != device.damping) continue;
      const std::string limit = newtons_per_meter(device::integrator_limit(first.device, first.integrator, first.substeps));
      if (first.integrator == LOOP_EXACT) {
        append_formatted(out, "{} exact {}", separator, limit);
      } else {
        append_formatted(out, "{} {} Euler, {} sub-step{}, {}", separator,
                         first.integrator == LOOP_EULER ? "explicit" : "semi-implicit", first.substeps,
                         first.substeps == 1 ? "" : "s", limit);
      }
      separator = ";";
    }
    append_formatted(out, " N/m.\n");
  }
}

void write_grips(std::string& out, const std::vector<device::GripLoopRow>& rows) {
  const device::GripLoop usual;
  append_formatted(
      out,
      "\n## The held grip\n\n"
      "The model has a gripper of {:g} g and {:g} N s/m, a finger of {:g} g, {:g} N s/m and {:g} N/m, and a user who reacts after "
      "{:g} ms with a time constant of {:g} ms and holds {:g} N more than F_base.\n\n"
      "The table shows the largest k_open in N/m for several grippers: in simulation / by the theory of the sampled spring, which "
      "has no user. The delayed answer of a user adds damping or removes damping; this depends on its phase.\n\n| gripper |",
      usual.device_mass * 1e3, usual.device_damping, usual.finger_mass * 1e3, usual.finger_damping, usual.finger_stiffness,
      usual.reaction * 1e3, usual.response * 1e3, usual.excess);
  for (const double rate : RATES) append_formatted(out, " {} Hz |", plain_text(rate));
  append_formatted(out, "\n|---|");
  for (std::size_t k = 0; k < RATES.size(); ++k) append_formatted(out, "---|");
  for (const auto& [mass, damping] : {std::pair{0.05, 0.5}, {0.02, 0.2}, {0.1, 1.0}, {0.1, 3.0}}) {
    append_formatted(out, "\n| {:g} g, {:g} N s/m |", mass * 1e3, damping);
    for (const double rate : RATES) {
      device::GripLoop loop;
      loop.device_mass = mass;
      loop.device_damping = damping;
      loop.rate = rate;
      append_formatted(out, " {} / {} |", newtons_per_meter(device::largest_k_open(loop)),
                       newtons_per_meter(device::sampled_k_open(loop)));
    }
  }
  append_formatted(
      out,
      "\n\nA slow user oscillates with softer springs, at every rate. For each reaction time, this is the k_open at "
      "which the oscillation no longer dies away, in simulation / in theory (in the sessions below and in the picture, "
      "even softer springs still oscillate at the end):");
  const char* separator = "";
  for (const double reaction : {0.2, 0.3, 0.4, 0.6}) {
    device::GripLoop loop;
    loop.reaction = reaction;
    append_formatted(out, "{} {:g} ms {} / {}", separator, reaction * 1e3, newtons_per_meter(device::largest_k_open(loop)),
                     newtons_per_meter(device::reaction_k_open(loop)));
    separator = ",";
  }
  std::array<std::size_t, device::GRIP_OUTCOMES> counts{};
  std::size_t all = 0;
  for (const device::GripLoopRow& row : rows) {
    if (row.varied != "products") continue;
    ++counts[static_cast<std::size_t>(row.result.outcome)];
    ++all;
  }
  append_formatted(out, ".\n\nThe outcomes of {} sessions that vary F_base, F_range, k_open, reaction, finger and tilt speed:",
                   readable_number(all));
  for (std::size_t k = 0; k < counts.size(); ++k) {
    append_formatted(out, "{} {} {:.1f} %", k == 0 ? "" : ",", device::GRIP_OUTCOME_NAMES[k],
                     100.0 * static_cast<double>(counts[k]) / static_cast<double>(std::max<std::size_t>(all, 1)));
  }
  const device::GripLoopResult result = device::hold_and_tilt(usual);
  append_formatted(out,
                   ". With the default values the grip settles {:.0f} ms after the grasp and opens by {:.2f} mm in the tilt.\n",
                   result.response_time * 1e3, result.opened * 1e3);
}

void write_gains(std::string& out) {
  append_formatted(
      out,
      "\n## Live gains\n\nWithout `--unsafe-gains`, a live session refuses larger gains than these. The gains are for "
      "the device, without delay. K is for a B of 1 N s/m, from the linear limit of the lightest device here that has a "
      "damping of 1 N s/m. k_open is from the simulation with the lightest finger and users who react after 60 to 90 "
      "ms.\n\n| rate | K | k_open |\n|---|---|---|\n");
  for (const double rate : RATES) {
    const device::GainLimits limits = device::gain_limits(rate, 1);
    append_formatted(out, "| {} Hz | {} | {} |\n", plain_text(rate), newtons_per_meter(limits.stiffness),
                     newtons_per_meter(limits.k_open));
  }
}

// Number of wrong rows of the extreme scenes: no value may be missing, and double on the device must agree with the core.
std::size_t wrong_rows(const std::vector<ExtremeRow>& rows) {
  return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [](const ExtremeRow& row) {
    return row.misplaced > 0 || (row.precision == Precision::full && !row.holds);
  }));
}

void write_extremes(std::string& out, const std::vector<ExtremeCase>& cases, const std::vector<ExtremeRow>& rows) {
  std::uint64_t grips = 0, misplaced = 0;
  for (const ExtremeRow& row : rows) {
    grips += row.grips;
    misplaced += row.misplaced;
  }
  append_formatted(
      out,
      "\n## Extreme scenes\n\nThere are {} scenes, with {} grips on all sides together; {} values are not finite where "
      "they should be. The table shows the largest differences from the core in double, for the grips whose outcomes "
      "agree: core float / device float / device double.\n\n"
      "| scene | what must come out | feasible | separation, um | joints, um | feedback, mN | hold, mN | beyond the "
      "tolerances of `check` |\n|---|---|---|---|---|---|---|---|\n",
      cases.size(), readable_number(grips), readable_number(misplaced));
  for (const ExtremeCase& extreme : cases) {
    std::array<std::string, 4> cells;
    std::string feasible, beyond;
    for (const ExtremeRow& row : rows) {
      if (row.name != extreme.name) continue;
      if (row.backend == "core" && row.precision == Precision::full) {
        feasible = fmt::format("{} of {}", row.feasible, row.grips);
        continue;
      }
      const std::array<double, 4> values{row.separation * 1e6, row.posed * 1e6, row.feedback * 1e3, row.hold * 1e3};
      for (std::size_t k = 0; k < cells.size(); ++k) cells[k] += fmt::format("{}{:.1e}", cells[k].empty() ? "" : " / ", values[k]);
      if (!row.holds)
        beyond += fmt::format("{}{} {}", beyond.empty() ? "" : ", ", row.backend == "core" ? "core" : "device",
                              row.precision == Precision::single ? "float" : "double");
    }
    append_formatted(out, "| {} | {} | {} | {} | {} | {} | {} | {} |\n", extreme.name, extreme.expected, feasible, cells[0],
                     cells[1], cells[2], cells[3], beyond);
  }
  append_formatted(out,
                   "\nFloat agrees with double to 10 um in the separations of 999 of 1,000 grips, to 10 um in the joints of 99 of "
                   "100 grips, and to 10 mN in the forces of 999 of 1,000 grips. This is true for a hand scale of {:g} to {:g}, "
                   "coordinates up to {:g} m and hold forces up to {:g} kN, at every size (1 mm to 10 m) and tilt of the vessel "
                   "(docs/evidence.md). Commands warn of a scene outside of this range.\n",
                   float_domain::SMALLEST_HAND, float_domain::LARGEST_HAND, float_domain::LARGEST_COORDINATE,
                   float_domain::LARGEST_HOLD * 1e-3);
}

// What a run finds.
struct Stability {
  std::vector<device::WallSheet> sheets;
  double wall_seconds = 0;
  WallFindings walls;
  std::vector<device::GripLoopRow> grips;
  std::vector<ExtremeRow> extremes;
};

// False: interrupted.
bool compute_stability(const StabilityOptions& options, InterruptGuard& interrupt, Stability& stability) {
  show_status("limits by theory");
  stability.sheets = device::wall_sheets(options.quick, options.seed);
  const double start = monotonic_now();
  const std::size_t points = device::count_points(stability.sheets);
  const bool walls_done = device::run_walls(stability.sheets, [&](std::size_t done) {
    show_status(fmt::format("walls {} of {}", done, points));
    return !interrupt.flag();
  });
  if (!walls_done) return false;
  stability.wall_seconds = monotonic_now() - start;
  stability.walls = look_at(stability.sheets);
  show_status("held grips");
  stability.grips = device::grip_loop_rows(options.quick);
  ExtremeOptions extreme_options;
  extreme_options.on = options.on;
  if (options.quick) extreme_options.grips = 40;
  for (const ExtremeCase& extreme : options.extremes) {
    if (interrupt.flag()) return false;
    show_status(extreme.name);
    const auto found_there = evaluate_extreme(extreme, extreme_options);
    stability.extremes.insert(stability.extremes.end(), found_there.begin(), found_there.end());
  }
  return !interrupt.flag();
}

std::string summary_of(const StabilityOptions& options, const Stability& stability) {
  std::string summary;
  append_formatted(summary, "# Stability\n\nwholehand {}, seed {}, {} run. Walls and held grips are computed on the core in double",
                   version(), options.seed, options.quick ? "quick" : "full");
  const auto device = std::ranges::find_if(stability.extremes, [](const ExtremeRow& row) { return row.backend != "core"; });
  if (device != stability.extremes.end())
    append_formatted(summary, ", extreme scenes on {} ({}) too", device->device, device->driver);
  summary += ".\n";
  write_walls(summary, stability.sheets, stability.walls);
  append_formatted(summary, "\nThese walls took {:.1f} s.\n", stability.wall_seconds);
  write_grips(summary, stability.grips);
  write_gains(summary);
  if (!options.extremes.empty()) write_extremes(summary, options.extremes, stability.extremes);
  return summary;
}

void write_stability_tables(const StabilityOptions& options, const Stability& stability) {
  const auto path = [&options](const char* name) { return options.folder + "/" + name; };
  const std::string stamp = fmt::format("{},{}", version(), options.seed);
  const std::string on_core = fmt::format("core,{},{}", csv_text(core_info(Precision::full, 1).driver), stamp);
  write_whole_file(path("wall.csv"), device::wall_csv(stability.sheets), false);
  write_whole_file(path("wall_limits.csv"), device::wall_limits_csv(stability.sheets, on_core), false);
  write_whole_file(path("grip_loop.csv"), device::grip_loop_csv(stability.grips, on_core), false);
  if (!options.extremes.empty()) write_whole_file(path("extreme.csv"), extreme_csv(stability.extremes), false);
}

void draw_stability_pictures(const std::string& folder, const std::vector<device::WallSheet>& sheets) {
  const std::vector<PictureFile> pictures{{folder + "/grip_loop.svg", grip_loop_picture()},
                                          {folder + "/wall_integrators.svg", integrator_picture(sheets)},
                                          {folder + "/wall.svg", wall_picture(sheets)}};
  for (const PictureFile& picture : pictures)
    std::remove(picture.path.c_str());  // one of another run beside these tables would mislead
  const std::string failure = write_pictures(pictures);
  if (!failure.empty()) print_note(failure);
}

}  // namespace

ExitCode run_stability(const StabilityOptions& options) {
  Stability stability;
  if (options.on != "core") host::choose_device(host::list_devices(), options.on);  // a wrong one leaves no folder
  make_output_folder(options.folder);
  check_folder_files(options.folder, "stability", STABILITY_TABLES, STABILITY_PICTURES);
  InterruptGuard interrupt;
  if (!compute_stability(options, interrupt, stability)) {
    show_status("");
    print_note("interrupted; nothing was written");
    return ExitCode::interrupted;
  }
  show_status("summary");
  const std::string summary = summary_of(options, stability);
  write_stability_tables(options, stability);
  draw_stability_pictures(options.folder, stability.sheets);
  write_whole_file(options.folder + "/stability.md", summary, false);
  show_status("");
  print(fmt::format("{}\nwritten to {}\n", summary, one_line(options.folder)));
  return stability.walls.passive_unsettled == 0 && wrong_rows(stability.extremes) == 0 ? ExitCode::done : ExitCode::no;
}

}  // namespace wholehand
