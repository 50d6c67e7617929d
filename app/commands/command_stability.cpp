// SPDX-License-Identifier: MIT
// wholehand stability: where a haptic loop stops being trustworthy.
#include <CLI/CLI.hpp>

#include <memory>

#include "app/commands/commands.h"
#include "app/commands/validators.h"
#include "app/program/values.h"
#include "app/program/vulkan_environment.h"
#include "base/system/output.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "device/loop/wall.h"
#include "evidence/check/stability.h"

namespace wholehand {
namespace {

namespace wall_ranges {
constexpr Quantity MASS{1e-6, 1e3};
constexpr Quantity DAMPING{0, 1e6};
constexpr Quantity RATE{1, 1e5};
constexpr Quantity WALL_DAMPING{-1e6, 1e6};
constexpr IntegerRange DELAY{0, LOOP_DELAYS};
constexpr Quantity ENCODER_UM{0, 1e5};
constexpr Quantity COULOMB{0, 1e3};
constexpr Quantity FINGER{0, 1e6};
constexpr IntegerRange SEED{0, 1000000000};
}  // namespace wall_ranges

constexpr double SMALLEST_STEP = 1e-12;  // m: a picometer

struct WallArguments {
  std::string mass, damping, rate, wall_damping = "0", delay = "0", encoder = "0", coulomb = "0", finger;
  bool json = false;
};

ExitCode wall(const WallArguments& arguments) {
  device::WallDevice device;
  device.mass = parse_quantity(arguments.mass, "--mass-kg", wall_ranges::MASS);
  device.damping = parse_quantity(arguments.damping, "--damping-Nspm", wall_ranges::DAMPING);
  device.rate = parse_quantity(arguments.rate, "--rate-hz", wall_ranges::RATE);
  device.wall_damping = parse_quantity(arguments.wall_damping, "--wall-damping-Nspm", wall_ranges::WALL_DAMPING);
  device.delay = static_cast<int>(parse_integer(arguments.delay, "--delay-samples", wall_ranges::DELAY));
  device.encoder_step = parse_quantity(arguments.encoder, "--encoder-um", wall_ranges::ENCODER_UM) * 1e-6;
  if (device.encoder_step > 0 && device.encoder_step < SMALLEST_STEP)
    throw usage_error("--encoder-um " + arguments.encoder + ": allowed: 0 (exact), or 1e-06 and more");
  device.coulomb = parse_quantity(arguments.coulomb, "--coulomb-N", wall_ranges::COULOMB);
  if (!arguments.finger.empty()) {
    const Triple finger = parse_triple(arguments.finger, "--finger", wall_ranges::FINGER);
    device.finger_mass = finger[0];
    device.finger_damping = finger[1];
    device.finger_stiffness = finger[2];
  }
  const device::WallLimits limits = device::wall_limits(device);
  print(arguments.json ? device::wall_json(limits) : device::wall_table(device, limits));
  return ExitCode::done;
}

struct ReportArguments {
  std::string folder, on = "vulkan", seed = "1";
  bool quick = false;
};

ExitCode report_stability(const ReportArguments& arguments) {
  if (arguments.folder.empty()) {
    throw usage_error(
        "stability: the folder is missing; give -o DIR, or use `stability wall` for one device; see wholehand stability --help");
  }
  StabilityOptions options;
  options.folder = arguments.folder;
  options.on = arguments.on;
  options.quick = arguments.quick;
  options.seed = static_cast<std::uint64_t>(parse_integer(arguments.seed, "--seed", wall_ranges::SEED));
  for (const std::string& file : extreme_scene_files()) options.extremes.push_back(extreme_case(read_scene_file(file)));
  prepare_vulkan_environment(options.on);
  return run_stability(options);
}

}  // namespace

void add_stability_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("stability", "Find out where a haptic loop becomes unstable and where the kernels lose their accuracy");
  command->require_subcommand(0, 1);
  const auto report_arguments = std::make_shared<ReportArguments>();
  command->add_option("-o,--output", report_arguments->folder, "Folder for the tables, pictures and the summary")
      ->type_name("DIR")
      ->check(not_empty());
  command
      ->add_option("--on", report_arguments->on,
                   "Device that runs the extreme scenes beside the core: vulkan (the default), a name; or core")
      ->type_name("DEVICE")
      ->check(offered("core vulkan"))
      ->check(not_empty());
  command->add_flag("--quick", report_arguments->quick, "Use coarser maps; this takes less than a minute");
  command->add_option("--seed", report_arguments->seed, "Seed of the random devices and walls (default: 1)")->type_name("N");
  command->callback([command, report_arguments, &action] {
    if (!command->get_subcommands().empty()) {
      for (const char* option : {"--output", "--on", "--quick", "--seed"})
        if (command->count(option) > 0)
          throw usage_error(std::string("stability ") + option +
                            ": this option belongs to the report and not to `wall`; leave it out");
      return;
    }
    action = [report_arguments] { return report_stability(*report_arguments); };
  });
  const auto arguments = std::make_shared<WallArguments>();
  CLI::App* wall_command = command->add_subcommand("wall", "Compute the stiffest wall that a device can render");
  const auto add = [wall_command](const char* name, auto& value, const char* type, const char* help) {
    return wall_command->add_option(name, value, help)->type_name(type)->check(not_empty());
  };
  add("--mass-kg", arguments->mass, "M", "Moving mass of one axis of the device")->required();
  add("--damping-Nspm", arguments->damping, "b", "Damping of one axis of the device, N s/m")->required();
  add("--rate-hz", arguments->rate, "F", "Rate of the loop, samples per second")->required();
  add("--wall-damping-Nspm", arguments->wall_damping, "B", "Damping of the rendered wall, N s/m (default: 0)");
  add("--delay-samples", arguments->delay, "n", "Number of whole samples between reading and force (default: 0)");
  add("--encoder-um", arguments->encoder, "D", "Step of the encoder at the handle, micrometers (default: 0, exact)");
  add("--coulomb-N", arguments->coulomb, "f", "Coulomb friction of the device (default: 0)");
  add("--finger", arguments->finger, "m,b,k", "Mass, damping and stiffness of the finger that holds the device: kg, N s/m, N/m");
  wall_command->add_flag("--json", arguments->json, "Print one JSON object in one line");
  wall_command->callback([arguments, &action] { action = [arguments] { return wall(*arguments); }; });
}

}  // namespace wholehand
