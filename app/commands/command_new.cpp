// SPDX-License-Identifier: MIT
// wholehand new: a scene of one vessel, to sweep at once and to edit.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/commands/commands.h"
#include "app/commands/validators.h"
#include "app/program/values.h"
#include "base/files/files.h"
#include "base/system/output.h"
#include "base/text/readable.h"
#include "core/capacity.h"
#include "core/meshes/survey.h"
#include "core/reader/new_scene.h"
#include "core/reader/reader.h"

namespace wholehand {
namespace {

struct NewArguments {
  std::string name, shape, mesh, fill;
  std::vector<std::string> numbers = std::vector<std::string>(new_scene_keys().size());  // texts; empty: not given
};

std::string option_of(const std::string& key) {
  std::string option = "--" + key;
  std::replace(option.begin(), option.end(), '_', '-');
  return option;
}

// A number in the unit of its option, as the text has it.
double checked(const std::string& text, const std::string& option, const Quantity& range) {
  parse_quantity(text, option, range);
  return std::stod(text);
}

// With a mesh, the text has the keys that a survey finds; the findings go to standard error.
std::string scene_text(NewScene wanted, const std::string& mesh, const std::string& file) {
  if (mesh.empty()) return new_scene(wanted);
  SurveyRequest request{mesh, {}, {}, {}, {}};
  for (const auto& [key, value] : wanted.numbers)
    if (key == "mesh_scale") request.scale = value;
  const MeshSurvey survey = survey_mesh(request);
  for (const std::string& line : survey_lines(survey)) print_note(line);
  wanted.mesh = std::filesystem::proximate(mesh, std::filesystem::absolute(file).parent_path()).string();
  return scene_of_mesh(wanted, survey);
}

ExitCode write_new(const NewArguments& arguments) {
  const std::filesystem::path given(arguments.name);
  std::filesystem::path file = given;
  if (given.extension() != ".toml") file += ".toml";
  NewScene wanted;
  wanted.name = file.stem().string();
  if (!arguments.shape.empty()) wanted.shape = arguments.shape;
  for (std::size_t k = 0; k < arguments.numbers.size(); ++k) {
    const NewSceneKey& key = new_scene_keys()[k];
    if (!arguments.numbers[k].empty())
      wanted.numbers.emplace_back(key.name, checked(arguments.numbers[k], option_of(key.name), key.range));
  }
  if (!arguments.mesh.empty()) {
    if (!std::filesystem::is_regular_file(arguments.mesh))
      throw usage_error(fmt::format("--mesh {}: no such file", arguments.mesh));
  }
  if (!arguments.fill.empty()) wanted.fill = checked(arguments.fill, "--fill-ml", ranges::FILL_VOLUME);
  check_output_path(file.string(), "new");
  check_overwrites_nothing(file.string(), "new");
  std::string text;
  try {
    text = scene_text(wanted, arguments.mesh, file.string());
  } catch (const Error& error) {
    throw usage_error(fmt::format("new: {}", error.what()));
  }
  write_whole_file(file.string(), text, false);
  const double capacity = capacity_of(parse_scene(text, file.string()).vessels[0]);
  print(fmt::format("Wrote {0}{1}. Next: wholehand sweep {0}\n", file.string(),
                    capacity > 0 ? fmt::format(", a vessel that holds {} mL", fixed_text(1e6 * capacity, 0)) : ""));
  return ExitCode::done;
}

}  // namespace

void add_new_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<NewArguments>();
  CLI::App* command = app.add_subcommand("new", "Write a scene of one vessel, to sweep at once and to edit");
  const auto add = [command](const std::string& name, std::string& value, const char* type, const char* help) {
    return command->add_option(name, value, help)->type_name(type)->check(not_empty());
  };
  add("name", arguments->name, "NAME", "Name of the scene, which is written to NAME.toml")->required()->check(not_an_option());
  auto* shape = add("--shape", arguments->shape, "SHAPE", "cylinder (the default), flask or conical")
                    ->check(offered("cylinder flask conical"));
  add("--mesh", arguments->mesh, "FILE",
      "Instead of a shape: a mesh (.glb, .gltf, .stl, .obj, .ply, .off or .dae), with the keys that `wholehand mesh` finds")
      ->excludes(shape);
  for (std::size_t k = 0; k < arguments->numbers.size(); ++k)
    add(option_of(new_scene_keys()[k].name), arguments->numbers[k], "N", new_scene_keys()[k].help);
  add("--fill-ml", arguments->fill, "V",
      "Judge the vessel empty and with V mL; 0: only empty (default: five fills up to the brim)");
  command->callback([arguments, &action] { action = [arguments] { return write_new(*arguments); }; });
}

}  // namespace wholehand
