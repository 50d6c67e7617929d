// SPDX-License-Identifier: MIT
// wholehand grip: one grip with every intermediate value.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <vector>

#include "app/commands/commands.h"
#include "app/commands/driver_watch.h"
#include "app/commands/result_scene.h"
#include "app/commands/validators.h"
#include "app/commands/view_grip.h"
#include "app/program/remedy.h"
#include "app/program/values.h"
#include "app/program/vulkan_environment.h"
#include "base/files/files.h"
#include "base/system/output.h"
#include "base/text/printable.h"
#include "base/text/readable.h"
#include "core/capacity.h"
#include "core/meshes/vessel.h"
#include "core/reader/fills.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "core/reader/text.h"
#include "host/open_backend.h"
#include "sweeps/grips/glb.h"
#include "sweeps/grips/report.h"
#include "sweeps/grips/svg.h"
#include "sweeps/lists/robust.h"
#include "sweeps/plan/cavity_notes.h"
#include "sweeps/plan/idle_notes.h"
#include "sweeps/result/grip_lists.h"
#include "sweeps/result/output_names.h"
#include "sweeps/run/auto_backend.h"

namespace wholehand {
namespace {

struct GripArguments {
  std::string scene, vessel, height, azimuth = "0", obliquity = "0", roll = "0", offset = "0", hand_scale, thumb, index;
  std::string rank, list;
  std::vector<std::string> fills, volumes, tilts;
  std::string on = sweeps::ON_AUTO, precision, glb, svg, view_port;
  bool json = false, view = false, quality = false, refined = false;
};

std::optional<double> read_hand_scale(const GripArguments& arguments) {
  if (arguments.hand_scale.empty()) return std::nullopt;
  return parse_quantity(arguments.hand_scale, "--hand-scale", ranges::SCALE);
}

GripInput read_grip(const GripArguments& arguments) {
  const double roll = parse_quantity(arguments.roll, "--roll-deg", ranges::ROTATION);
  const double hand_scale = read_hand_scale(arguments).value_or(1);
  if (!arguments.thumb.empty()) {
    return sweeps::grip_through(parse_triple(arguments.thumb, "--thumb-mm", ranges::POINT),
                                parse_triple(arguments.index, "--index-mm", ranges::POINT), roll, hand_scale);
  }
  if (arguments.height.empty())
    throw usage_error("grip: the place of the grip is missing; give --height-mm, or --thumb-mm and --index-mm");
  GripInput grip;
  grip.height = parse_quantity(arguments.height, "--height-mm", ranges::GRIP_HEIGHT);
  grip.azimuth = parse_quantity(arguments.azimuth, "--azimuth-deg", ranges::ROTATION);
  grip.obliquity = parse_quantity(arguments.obliquity, "--obliquity-deg", ranges::OBLIQUITY);
  grip.roll = roll;
  grip.offset = parse_quantity(arguments.offset, "--offset-mm", ranges::OFFSET);
  grip.hand_scale = hand_scale;
  return grip;
}

sweeps::StateAxes read_states(const GripArguments& arguments, const Scene& scene, std::size_t vessel) {
  sweeps::StateAxes axes = sweeps::scene_axes(scene, vessel);
  if (!arguments.tilts.empty()) {
    axes.tilts.clear();
    for (const auto& text : arguments.tilts) axes.tilts.push_back(parse_quantity(text, "--tilt-deg", ranges::TILT));
  }
  if (arguments.fills.empty() && arguments.volumes.empty()) return axes;
  const char* option = arguments.volumes.empty() ? "--fill" : "--fill-ml";
  if (!scene.liquid)
    throw usage_error(
        fmt::format("{0}: {1} has no [liquid]; add one with its fills, or leave {0} out", option, in_quotes(scene.file)));
  if (axes.tilts.empty())
    throw usage_error(fmt::format("{}: {} has no [tilts]; give --tilt-deg too", option, in_quotes(scene.file)));
  axes.fills.clear();
  for (const auto& text : arguments.fills) axes.fills.push_back(parse_quantity(text, option, ranges::FRACTION));
  const VesselData& held = scene.vessels[vessel];
  axes.capacity = arguments.volumes.empty() ? 0 : capacity_of(held);
  for (const auto& text : arguments.volumes) {
    const double volume = parse_quantity(text, option, ranges::FILL_VOLUME);
    axes.fills.push_back(fraction_of_capacity(held, axes.capacity, volume, fmt::format("{} {}", option, text)));
  }
  return axes;
}

// Refuses what it can before any work.
void check_drawing_files(const GripArguments& arguments, const Scene& scene) {
  const auto check = [&scene](const std::string& path, const char* option, std::string_view mark, const char* what) {
    if (path.empty()) return;
    check_output_path(path, option);
    sweeps::check_not_the_scene(path, scene, option);
    check_overwrites_marked(path, mark, what, option);
  };
  check(arguments.glb, "--glb", sweeps::GRIP_GLB_MARK, "glTF binary of wholehand's");
  check(arguments.svg, "--svg", sweeps::GRIP_SVG_MARK, "drawing of wholehand's");
  const auto resolved = [](const std::string& path) {
    std::error_code unresolved;  // then no other way to it is known
    const auto whole = std::filesystem::weakly_canonical(std::filesystem::absolute(followed(path)), unresolved);
    return unresolved ? std::filesystem::path(path) : whole;
  };
  if (!arguments.glb.empty() && !arguments.svg.empty() && resolved(arguments.glb) == resolved(arguments.svg))
    throw usage_error(fmt::format("--glb and --svg name the same file, {}; give two different names", arguments.glb));
}

// Both are made before either is written.
void write_drawings(const GripArguments& arguments, const Scene& scene, std::size_t vessel, const sweeps::GripReport& report) {
  const std::string glb = arguments.glb.empty() ? "" : sweeps::grip_glb(scene, vessel, report);
  const std::string svg = arguments.svg.empty() ? "" : sweeps::grip_svg(scene, vessel, report);
  if (!glb.empty()) write_whole_file(arguments.glb, glb, false);
  if (!svg.empty()) write_whole_file(arguments.svg, svg, false);
}

// A grip of a vessel of a scene.
struct ChosenGrip {
  Scene scene;
  std::size_t vessel = 0;
  GripInput input;
};

ChosenGrip asked_grip(const GripArguments& arguments) {
  if (arguments.refined) throw usage_error("--refined: the rank of the grip is missing; give --rank");
  if (!arguments.list.empty()) throw usage_error("--list: the rank of the grip is missing; give --rank");
  if (is_result(arguments.scene))
    throw usage_error(fmt::format("{}: this is a result, and the rank of the grip is missing; give --rank", arguments.scene));
  ChosenGrip chosen;
  chosen.input = read_grip(arguments);
  chosen.scene = read_scene_file(find_scene(arguments.scene));
  check_drawing_files(arguments, chosen.scene);
  chosen.vessel = find_vessel(chosen.scene, arguments.vessel);
  return chosen;
}

// The index of the hand scale among those that the sweep lists.
std::size_t find_hand_scale(const GripArguments& arguments, const sweeps::Plan& plan) {
  const std::optional<double> wanted = read_hand_scale(arguments);
  if (plan.hand_scales() == 1) {
    if (wanted) throw usage_error("--hand-scale: the sweep has one list for all hand scales; leave the option out");
    return 0;
  }
  std::vector<double> known;
  for (std::size_t s = 0; s < plan.hand_scales(); ++s) {
    known.push_back(plan.hand_scale(s));
    if (wanted && std::abs(*wanted - known.back()) <= 1e-6 * known.back()) return s;  // as they are printed
  }
  throw usage_error(fmt::format("--hand-scale {}: the sweep has one list for each of the hand scales {:.6g}; give one of them",
                                arguments.hand_scale.empty() ? "is missing" : in_quotes(arguments.hand_scale),
                                fmt::join(known, ", ")));
}

// The place to which the sweep refined the grip of a rank.
GripInput refined_grip(const sweeps::SweepResult& result, const sweeps::Plan& plan, std::size_t vessel, std::size_t list,
                       std::size_t rank) {
  const auto refined = result.refined(vessel, list % plan.hand_scales());
  if (!refined[rank - 1])
    throw usage_error(
        fmt::format("--refined: {} has no refined grip of rank {}; sweep again without --no-refine", result.path(), rank));
  return refined[rank - 1]->grip;
}

// A grip of a sweep's best, or of a list made from its result.
ChosenGrip ranked_grip(const GripArguments& arguments) {
  const auto rank = static_cast<std::size_t>(parse_integer(arguments.rank, "--rank", {1, ranges::BEST.high}));
  sweeps::SweepResult result(arguments.scene);
  ChosenGrip chosen;
  chosen.scene = whole_scene_of_result(result);
  check_drawing_files(arguments, chosen.scene);
  chosen.vessel = find_vessel(chosen.scene, arguments.vessel);
  const sweeps::Plan plan(chosen.scene, sweeps::keeps_vectors(result.variables()));
  result.use(chosen.scene, plan);
  const bool is_own = arguments.list.empty();
  if (arguments.refined && !is_own) throw usage_error("--refined: only the sweep's own list has refined grips; leave --list out");
  const sweeps::GripLists lists = is_own ? sweeps::lists_of_sweep(result, chosen.scene, plan)
                                         : sweeps::read_grip_lists(arguments.list, result, chosen.scene, plan);
  const std::size_t place = chosen.vessel * plan.hand_scales() + find_hand_scale(arguments, plan);
  for (const sweeps::RankedCandidate& ranked : lists[place]) {
    if (ranked.rank != rank) continue;
    chosen.input = plan.grip(chosen.vessel, ranked.candidate.index);
    if (arguments.refined) chosen.input = refined_grip(result, plan, chosen.vessel, place, rank);
    return chosen;
  }
  std::string remedy;
  if (is_own && lists[place].empty() && has_effort(chosen.scene)) {
    remedy = fmt::format(
        "; `wholehand rank {} --least-bad -o LIST.csv`, where none holds, and --list LIST.csv show the nearest to holding",
        one_line(result.path()));
  }
  throw usage_error(fmt::format("--rank {}: {} lists {} of {}{}", rank, is_own ? result.path() : arguments.list,
                                counted(lists[place].size(), "grip"), sweeps::list_name(chosen.scene, plan, place), remedy));
}

ExitCode grip(const GripArguments& given) {
  GripArguments arguments = given;
  if (arguments.on == sweeps::ON_AUTO) arguments.on = "core";
  prepare_vulkan_environment(arguments.on);
  [[maybe_unused]] const int port = parse_view_port(arguments.view_port, arguments.view);
  auto [scene, vessel, input] = arguments.rank.empty() ? asked_grip(arguments) : ranked_grip(arguments);
  const sweeps::StateAxes axes = read_states(arguments, scene, vessel);
  Precision precision = arguments.on == "core" ? Precision::full : Precision::single;
  if (!arguments.precision.empty()) precision = parse_precision(arguments.precision);
  Scene asked = scene;
  asked.grips.hand_scale = {{input.hand_scale}};
  load_meshes(asked, [&] { return largest_buffer(arguments.on); });  // lattices as wide as this hand needs
  scene.vessels = asked.vessels;
  sweeps::print_cavity_notes(scene);
  // --tilt-deg adds the efforts of these tilts
  if (const std::string note = sweeps::idle_strength_note(scene); !note.empty() && axes.tilts.empty()) print_note(note);
  print_float_warnings(asked, precision);
  sweeps::GripReport report;
  {
    const DriverWatch watch(arguments.on);
    report = sweeps::make_grip_report(scene, vessel, input, axes, sweeps::open_grip_methods(scene, arguments.on, precision));
  }
  sweeps::add_holding(report, scene, vessel);
  if (!arguments.json) sweeps::add_held_share(report, scene, vessel);
  if (arguments.quality) sweeps::add_quality(report, scene, vessel);
  write_drawings(arguments, scene, vessel, report);
  if (arguments.json && arguments.on != "core") print_note("on " + report.device);
  print(arguments.json ? sweeps::grip_json(report) + "\n"
                       : sweeps::grip_verdict(scene, report) + "\n" + sweeps::grip_table(report));
  for (const std::string& path : {arguments.glb, arguments.svg}) {
    if (!path.empty() && !arguments.json) print(fmt::format("wrote {}\n", one_line(path)));
  }
#ifdef HAS_VIEWER
  if (arguments.view) view_grip(scene, vessel, input, report.vessel, axes, port, arguments.json);
#endif
  return report.answer.result.reason == Reason::none ? ExitCode::done : ExitCode::no;
}

}  // namespace

void add_grip_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<GripArguments>();
  CLI::App* command =
      app.add_subcommand("grip", "Show one grip with every intermediate value; exit code 1 where it is not feasible");
  const auto add = [command](const char* name, auto& value, const char* type, const char* help) {
    return command->add_option(name, value, help)->type_name(type);
  };
  add("scene", arguments->scene, "SCENE", "Scene file or name of a shipped scene; with --rank: a result of `wholehand sweep`")
      ->required();
  add("--vessel", arguments->vessel, "V", "Name of the vessel")->required();
  auto* height = add("--height-mm", arguments->height, "H",
                     "Height of the thumb-index line over the vessel's base; over the origin of a mesh whose origin is \"as_is\"");
  auto* azimuth =
      add("--azimuth-deg", arguments->azimuth, "A", "Direction of the thumb-index line about the vessel's axis (default: 0)");
  auto* obliquity = add("--obliquity-deg", arguments->obliquity, "B",
                        "Angle of the thumb-index line to the horizontal; above 0 the index finger is higher (default: 0)");
  auto* roll = add("--roll-deg", arguments->roll, "Q",
                   "Turn of the hand about the thumb-index line: 0 is beside the vessel, -90 above it (default: 0)");
  auto* offset =
      add("--offset-mm", arguments->offset, "S", "Distance at which the thumb-index line passes the vessel's axis (default: 0)");
  add("--hand-scale", arguments->hand_scale, "K",
      "Size of the hand, times the scene's own scale (default: 1); with --rank: the hand scale of the list")
      ->check(not_empty());
  auto* thumb = add("--thumb-mm", arguments->thumb, "X,Y,Z",
                    "Instead of height, azimuth, obliquity and offset: a point of the thumb-index line on the thumb's side");
  auto* index =
      add("--index-mm", arguments->index, "X,Y,Z", "With --thumb-mm: a point of the thumb-index line on the index finger's side");
  thumb->needs(index);
  index->needs(thumb);
  for (auto* other : {height, azimuth, obliquity, offset}) thumb->excludes(other);
  auto* rank =
      add("--rank", arguments->rank, "N", "Instead of the options above: the grip of this rank in a result")->check(not_empty());
  for (auto* other : {height, azimuth, obliquity, roll, offset, thumb, index}) rank->excludes(other);
  add("--list", arguments->list, "LIST.csv",
      "With --rank: take the grip from this list of `wholehand rank` (default: the sweep's own list)")
      ->check(not_empty());
  command->add_flag("--refined", arguments->refined, "With --rank: the grip where the sweep refined it, not where it swept it");
  auto* fill = add("--fill", arguments->fills, "F", "Fills, as fractions of the capacity (default: the scene's)");
  add("--fill-ml", arguments->volumes, "V", "Instead of --fill: fills in mL")->excludes(fill);
  add("--tilt-deg", arguments->tilts, "T", "Tilts (default: the scene's)");
  add("--on", arguments->on, "DEVICE", "auto (the default, means core for one grip), core, vulkan or the name of a device")
      ->check(offered("auto core vulkan"));
  add("--precision", arguments->precision, "P", "float or double (default: double on the core, float on Vulkan)")
      ->check(offered("float double"));
  command->add_flag("--quality", arguments->quality,
                    "Measure the grasp: epsilon and the volume of the wrenches, and how much each finger presses; takes seconds");
  add("--glb", arguments->glb, "FILE", "Write the hand, the vessel and the liquid as glTF binary")->check(not_empty());
  add("--svg", arguments->svg, "FILE", "Write a drawing with the front, side and top view")->check(not_empty());
#ifdef HAS_VIEWER
  command->add_flag("--view", arguments->view, "Show the grip in the browser, at any fill and tilt, until Ctrl-C");
  add("--view-port", arguments->view_port, "N", "Port of the view on 127.0.0.1 (default: any free port)")->check(not_empty());
#endif
  command->add_flag("--json", arguments->json, "Print one JSON object, in SI units");
  command->callback([arguments, &action] { action = [arguments] { return grip(*arguments); }; });
}

}  // namespace wholehand
