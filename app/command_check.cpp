// wholehand check: is the device's answer the core's answer?
#include <CLI/CLI.hpp>

#include <memory>

#include "app/commands.h"
#include "app/paths.h"
#include "app/scene_reader.h"
#include "app/validators.h"
#include "sweeps/check.h"
#include "sweeps/mesh_vessel.h"

namespace wholehand {
namespace {

struct CheckArguments {
  std::string scene, on = "vulkan";
};

}  // namespace

void add_check_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<CheckArguments>();
  CLI::App* command =
      app.add_subcommand("check", "Compare the device with the core in float and in double, kernel by kernel and whole");
  command->add_option("scene", arguments->scene, "Scene file, or the name of a shipped one (three_beakers)")
      ->type_name("SCENE")
      ->check(not_empty());
  command->add_option("--on", arguments->on, "vulkan (the best device, the default) or a device's name")
      ->type_name("DEVICE")
      ->check(not_empty());
  command->callback([arguments, &action] {
    action = [arguments] {
      CheckOptions options;
      options.on = arguments->on;
      Scene scene = read_scene_file(find_scene(arguments->scene));
      load_meshes(scene, options.on);
      return run_check(scene, options);
    };
  });
}

}  // namespace wholehand
