// SPDX-License-Identifier: MIT
// wholehand live: a session with a gripper, or with a simulated one.
#include <CLI/CLI.hpp>

#include <memory>

#include "app/commands/commands.h"
#include "app/commands/live.h"
#include "app/commands/validators.h"
#include "app/program/values.h"
#include "app/program/vulkan_environment.h"
#include "core/reader/ranges.h"

namespace wholehand {
namespace {

constexpr Quantity LIVE_SECONDS{0.01, 1e6};
constexpr IntegerRange PERSON{0, 1'000'000'000};

struct LiveArguments {
  LiveOptions options;
  std::string rate, seconds, seed = "1", person, view_port;
};

ExitCode live(const LiveArguments& arguments) {
  LiveOptions options = arguments.options;
  if (!arguments.rate.empty()) options.rate = parse_quantity(arguments.rate, "--rate", ranges::RATE);
  if (!arguments.seconds.empty()) options.seconds = parse_quantity(arguments.seconds, "--seconds", LIVE_SECONDS);
  options.seed = static_cast<std::uint64_t>(parse_integer(arguments.seed, "--seed", ranges::SEED));
  if (!arguments.person.empty()) options.person = static_cast<std::uint64_t>(parse_integer(arguments.person, "--person", PERSON));
  options.view_port = parse_view_port(arguments.view_port, options.view);
  if (options.advise) prepare_vulkan_environment(options.advise_on.empty() ? "vulkan" : options.advise_on);
  return run_live(options);
}

}  // namespace

void add_live_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<LiveArguments>();
  LiveOptions& options = arguments->options;
  CLI::App* command =
      app.add_subcommand("live", "Run a session with a gripper: the user feels the forces, and the session can be recorded");
  const auto add = [command](const char* name, std::string& value, const char* type, const char* help) {
    return command->add_option(name, value, help)->type_name(type)->check(not_empty());
  };
  add("scene", options.scene, "SCENE",
      "Scene file or name of a shipped scene (default: mixing_board; for a replay: the recorded scene)");
  add("--device", options.device, "DEVICE",
      "sim (the default), view (the page of --view), replay:FILE, hid[:PATH], usb[:VID:PID], omega[:N], haply, or osc:[HOST:]PORT "
      "for a "
      "hand over the network; see wholehand devices and docs/devices.md")
      ->check(offered("sim view replay:.nc hid usb omega haply osc:"));
  add("--rate", arguments->rate, "HZ", "Rate of the force loop (default: the scene's)");
  add("--record", options.record, "FILE", "Record every tick in a NetCDF file; see wholehand session");
  add("--seconds", arguments->seconds, "S", "End after this time (default: when the simulated user is done, or on Ctrl-C)");
  add("--seed", arguments->seed, "N", "Seed of the simulated user, and of the population for --person (default: 1)");
  add("--person", arguments->person, "K",
      "Person K of the population in the scene's [people] is the simulated user, with a hand of their own (default: the median "
      "person)");
  add("--dhd-library", options.dhd_library, "PATH", "Path of Force Dimension's SDK (libdhd.so), for omega.7 and sigma.7");
#ifdef HAS_VIEWER
  command->add_flag("--view", options.view, "Show the session in the browser: print the address, and open it on a desktop");
  add("--view-port", arguments->view_port, "N", "Port of the view on 127.0.0.1 (default: any free port)");
  add("--stream", options.stream, "URL",
      "Send the session to osc://HOST:PORT at display rate, for engines and patches; see docs/stream.md");
#endif
  command->add_flag(
      "--advise", options.advise,
      "Say which grip of a near vessel would take less of the hand, while the session runs: in words, in the view and in "
      "the stream; see docs/advice.md");
  add("--advise-on", options.advise_on, "DEVICE",
      "Compute the advice on core, vulkan or a device's name (default: vulkan, and core where there is no Vulkan device)")
      ->check(offered("core vulkan"));
  command->add_flag("--follow-advice", options.follow_advice,
                    "The simulated user takes the advised grips; only with --advise and sim");
  command->add_flag("--unsafe-gains", options.unsafe_gains, "Allow gains that may make a light device unstable");
  command->add_flag("--no-clock", options.no_clock, "Run as fast as possible, without a clock; only with sim and replay");
  command->add_flag("--json", options.json, "Print the report at the end as JSON, and nothing else");
  command->callback([arguments, &action] { action = [arguments] { return live(*arguments); }; });
}

}  // namespace wholehand
