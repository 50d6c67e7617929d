// SPDX-License-Identifier: MIT
// wholehand devices: lists the devices to compute on and the grippers to feel with.
#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <string>

#include "app/commands/commands.h"
#include "app/commands/device_list.h"
#include "app/commands/validators.h"
#include "app/program/vulkan_environment.h"
#include "base/files/cache_folder.h"
#include "base/system/output.h"
#include "device/grippers/find_grippers.h"

namespace wholehand {
namespace {

ExitCode list_all_devices(const std::string& dhd_library) {
  prepare_vulkan_environment();
  print_devices();
  std::fflush(stdout);  // a device's library may end the program
  print(gripper_lines(device::find_grippers(dhd_library)) + cache_text());
  return ExitCode::done;
}

}  // namespace

void add_devices_command(CLI::App& app, Action& action) {
  const auto dhd_library = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("devices", "List the devices that compute, the grippers, what each can do, and the cache");
  command->add_option("--dhd-library", *dhd_library, "Path of Force Dimension's SDK (libdhd.so), for omega.7 and sigma.7")
      ->type_name("PATH")
      ->check(not_empty());
  command->callback([dhd_library, &action] { action = [dhd_library] { return list_all_devices(*dhd_library); }; });
}

}  // namespace wholehand
