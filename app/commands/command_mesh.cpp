// SPDX-License-Identifier: MIT
// wholehand mesh: what a mesh file is, and the scene that makes a vessel of it.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/commands/commands.h"
#include "app/commands/validators.h"
#include "app/program/values.h"
#include "base/files/file_set.h"
#include "base/files/files.h"
#include "base/system/output.h"
#include "core/meshes/survey.h"
#include "sweeps/grips/vessel_section.h"

namespace wholehand {
namespace {

struct MeshArguments {
  std::string file, scale, up, thickness, output;
  std::vector<std::string> parts;
  bool json = false;
};

SurveyRequest request_from(const MeshArguments& arguments) {
  SurveyRequest request{arguments.file, {}, {}, {}, {}};
  if (!arguments.scale.empty()) request.scale = parse_quantity(arguments.scale, "--scale", ranges::MESH_SCALE);
  if (!arguments.up.empty()) {
    if (arguments.up != "y" && arguments.up != "z") throw usage_error(fmt::format("--up '{}'; allowed: y or z", arguments.up));
    request.z_is_up = arguments.up == "z";
  }
  for (const std::string& part : arguments.parts)
    request.parts.push_back(static_cast<int>(parse_integer(part, "--part", ranges::PART)));
  if (!arguments.thickness.empty()) request.thickness = parse_quantity(arguments.thickness, "--thickness-mm", ranges::WALL);
  return request;
}

std::string scene_text(const MeshSurvey& survey, const std::string& output) {
  NewScene wanted;
  wanted.name = std::filesystem::path(output).stem().string();
  wanted.mesh = std::filesystem::proximate(survey.data.file, std::filesystem::absolute(output).parent_path()).string();
  try {
    return scene_of_mesh(wanted, survey);
  } catch (const Error& error) {
    throw usage_error(fmt::format("mesh: {}", error.what()));
  }
}

std::string findings(const MeshSurvey& survey) {
  std::string text;
  for (const std::string& line : survey_lines(survey)) text += line + "\n";
  text += "\n";
  for (const SceneKey& key : scene_keys(survey)) text += fmt::format("{} = {}\n", key.key, key.value);
  return text;
}

ExitCode survey_file(const MeshArguments& arguments) {
  const std::string& output = arguments.output;
  const std::string picture = std::filesystem::path(output).replace_extension(".svg").string();
  if (!output.empty()) {
    if (std::filesystem::path(output).extension() != ".toml")
      throw usage_error(fmt::format("mesh: --output {}; allowed: a name that ends in .toml", output));
    for (const std::string& file : {output, picture}) {
      check_output_path(file, "mesh");
      check_overwrites_nothing(file, "mesh");
    }
  }
  const MeshSurvey survey = survey_mesh(request_from(arguments));
  const std::string text = arguments.json ? survey_json(survey) + "\n" : findings(survey);
  if (output.empty()) {
    print(text);
    return ExitCode::done;
  }
  constexpr const char* REMEDY = "free space, or name another place with --output";
  FileSet files;
  files.write(output, scene_text(survey, output), REMEDY);
  files.write(picture, sweeps::vessel_section(survey, survey.data.file), REMEDY);
  files.commit(REMEDY);
  print(text);
  print_note(fmt::format("wrote {0} and {1}; next: wholehand sweep {0}", output, picture));
  return ExitCode::done;
}

}  // namespace

void add_mesh_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<MeshArguments>();
  CLI::App* command =
      app.add_subcommand("mesh", "Survey a mesh file: size, unit, up axis, parts, holes, cavity; write a scene of it");
  const auto add = [command](const std::string& name, std::string& value, const char* type, const char* help) {
    return command->add_option(name, value, help)->type_name(type)->check(not_empty());
  };
  add("file", arguments->file, "FILE", "Mesh (.glb, .gltf, .stl, .obj, .ply, .off or .dae)")->required()->check(not_an_option());
  add("--scale", arguments->scale, "S", "Size of the file's unit in m (default: the likeliest)");
  add("--up", arguments->up, "AXIS", "Upward axis of the file: y or z (default: where it opens)")->check(offered("y z"));
  command->add_option("--part", arguments->parts, "Take only this part; may be repeated (default: the vessel)")
      ->type_name("N")
      ->check(not_empty());
  add("--thickness-mm", arguments->thickness, "T", "Thickness of a sheet that has none (default: 2)");
  add("-o,--output", arguments->output, "FILE.toml", "Write a complete scene, and FILE.svg: the section with outline and liquid")
      ->check(not_an_option());
  command->add_flag("--json", arguments->json, "Print everything as JSON: lengths in mm, volumes in mL");
  command->callback([arguments, &action] { action = [arguments] { return survey_file(*arguments); }; });
}

}  // namespace wholehand
