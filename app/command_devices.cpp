// wholehand devices: what there is to compute on.
#include <CLI/CLI.hpp>

#include "app/commands.h"
#include "sweeps/devices.h"

namespace wholehand {

void add_devices_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("devices", "Vulkan devices and what each can do");
  command->callback([&action] { action = [] { return list_devices(); }; });
}

}  // namespace wholehand
