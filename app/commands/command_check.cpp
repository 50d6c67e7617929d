// SPDX-License-Identifier: MIT
// wholehand check: does the device compute what the core computes?
#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <vector>

#include "app/commands/commands.h"
#include "app/commands/validators.h"
#include "app/program/vulkan_environment.h"
#include "base/system/output.h"
#include "core/meshes/vessel.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "evidence/check/check.h"
#include "host/open_backend.h"
#include "sweeps/plan/cavity_notes.h"
#include "sweeps/plan/idle_notes.h"

namespace wholehand {
namespace {

struct CheckArguments {
  std::string scene, on = "vulkan";
  bool json = false;
};

}  // namespace

void add_check_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<CheckArguments>();
  CLI::App* command =
      app.add_subcommand("check", "Compare the device with the core, in float and in double: each kernel, and whole grips");
  command->add_option("scene", arguments->scene, "Scene file or name of a shipped scene (default: three_beakers)")
      ->type_name("SCENE")
      ->check(not_empty());
  command->add_option("--on", arguments->on, "vulkan (the best device; the default) or the name of a device")
      ->type_name("DEVICE")
      ->check(offered("vulkan"))
      ->check(not_empty());
  command->add_flag("--json", arguments->json, "Print one JSON object in one line; the verdict comes first");
  command->callback([arguments, &action] {
    action = [arguments] {
      CheckOptions options;
      options.on = arguments->on;
      prepare_vulkan_environment(options.on);
      Scene scene = read_scene_file(find_scene(arguments->scene));
      load_meshes(scene, [&] {
        try {
          return largest_buffer(options.on);
        } catch (const Error& error) {
          throw check_error(error);
        }
      });
      for (const std::string& line : check_warnings(scene)) print_note(line);
      sweeps::print_cavity_notes(scene);
      if (const std::string note = sweeps::idle_strength_note(scene); !note.empty()) print_note(note);
      const CheckReport report = check_scene(scene, options);
      print(arguments->json ? check_json(report) : check_text(report));
      return verdict_of(report).holds ? ExitCode::done : ExitCode::no;
    };
  });
}

}  // namespace wholehand
