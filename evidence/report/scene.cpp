// SPDX-License-Identifier: MIT
#include "evidence/report/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/text/readable.h"
#include "base/text/text.h"
#include "core/mesh_body.h"
#include "core/prepare.h"
#include "sweeps/grips/methods.h"
#include "sweeps/plan/rules.h"
#include "sweeps/result/result_contents.h"

namespace wholehand {
namespace {

void write_pair(MarkupWriter& html, const char* name, const std::string& value) {
  html.open("div").element("dt", name).element("dd", value).close();
}

// "height 10 to 95 % of the vessel's (64 values)", ..
std::string grips_text(const ReportSource& source) {
  const sweeps::Plan& plan = source.plan;
  std::vector<std::string> parts;
  const auto add = [&](int place, const char* name, double scale, const std::string& unit) {
    parts.push_back(fmt::format("{} {}", name, axis_text(plan.axes()[place], scale, unit)));
  };
  if (source.scene.grips.height_is_fraction) {
    add(sweeps::PLACE_HEIGHT, "height", 100, " % of the vessel's height");
  } else {
    add(sweeps::PLACE_HEIGHT, "height", 1e3, " mm");
  }
  add(sweeps::PLACE_ROLL, "roll", degrees(1), "°");
  add(sweeps::PLACE_OBLIQUITY, "obliquity", degrees(1), "°");
  add(sweeps::PLACE_AZIMUTH, "azimuth", degrees(1), "°");
  add(sweeps::PLACE_OFFSET, "offset", 1e3, " mm");
  add(sweeps::PLACE_HAND_SCALE, "hand scale", 1, "");
  const std::string kind =
      plan.is_sobol() ? counted(plan.grips(), "point") + " of a Sobol sequence" : readable_number(plan.stored_grips());
  return fmt::format("{}: {}", kind, joined(parts, ", "));
}

std::string states_text(const Scene& scene) {
  if (scene.tilts.empty()) return "none: the scene has no tilts";
  const std::string tilts =
      scene.tilts.size() == 1 ? fmt::format("the tilt {}°", plain_number(degrees(scene.tilts[0])))
                              : fmt::format("{} from {}° to {}°", counted(scene.tilts.size(), "tilt"),
                                            plain_number(degrees(scene.tilts.front())), plain_number(degrees(scene.tilts.back())));
  if (!scene.liquid) return tilts + "; the vessels are empty";
  std::vector<std::string> fills;
  const bool has_volumes = !scene.liquid->volumes.empty();
  for (const double volume : scene.liquid->volumes) fills.push_back(plain_number(1e6 * volume));
  for (const double fill : scene.liquid->fills) fills.push_back(plain_number(100 * fill));
  const std::string shown = fills.size() > 12
                                ? fmt::format("{} from {} to {}", counted(fills.size(), "fill"), fills.front(), fills.back())
                                : fmt::format("fills {}", joined(fills, ", "));
  const std::string left_out = scene.until_poured
                                   ? fmt::format("; tilts beyond the first at which {} % of a fill has poured are left out",
                                                 plain_number(100 * *scene.until_poured))
                                   : "";
  return fmt::format("{}; {} {}, {} kg/m³, poured {} the palm{}", tilts, shown,
                     has_volumes ? "mL" : "% of what a vessel holds to the brim", plain_number(scene.liquid->density),
                     scene.liquid->pour == Pour::away ? "away from" : "towards", left_out);
}

std::string hand_text(const Scene& scene) {
  const char* pose = scene.pose == Pose::articulated
                         ? "articulated: bones keep their lengths while the fingers come to rest on the vessel"
                     : scene.pose == Pose::paper ? "as in the paper: each point is moved to the surface by itself"
                                                 : "rigged: the fingers are not brought to the vessel";
  const std::string table =
      scene.table ? fmt::format("; it must stay {} mm above the table", plain_number(scene.table->clearance * 1e3)) : "";
  std::string arm;
  if (scene.arm) {
    const Triple& shoulder = scene.arm->shoulder;
    arm = fmt::format("; the shoulder is {} mm to the {} of the vessel's base, {} mm above it and {} mm in front of it",
                      plain_number(std::abs(shoulder[0]) * 1e3), shoulder[0] < 0 ? "left" : "right",
                      plain_number(shoulder[1] * 1e3), plain_number(shoulder[2] * 1e3));
  }
  return fmt::format("{}, scale {}; pose {}{}{}", scene.hand.handedness == Handedness::right ? "right" : "left",
                     plain_number(scene.hand.scale), pose, table, arm);
}

std::string force_text(const Scene& scene) {
  const ForceData& force = scene.force;
  return fmt::format(
      "{} N, and with the torque up to {} N more (a vessel's own range replaces this number), at most {} N; the torque is {}, and "
      "its reference is {}",
      plain_number(force.base), plain_number(force.range), plain_number(force.max),
      force.torque == Torque::paper ? "as in the paper" : "exact",
      force.reference == TorqueReference::per_object ? "per vessel" : "per grip");
}

std::string hold_text(const Scene& scene) {
  const ForceData& force = scene.force;
  const std::string pinch =
      fmt::format("friction {}, torsion of a contact {} mm", plain_number(force.friction), plain_number(force.torsion * 1e3));
  if (!scene.strength) return fmt::format("{}, grip strength {} N", pinch, plain_number(force.grip_strength));
  std::vector<std::string> digits;
  for (std::size_t digit = 0; digit < scene.strength->digits.size(); ++digit) {
    const char* name = digit < FINGER_COUNT ? FINGER_NAMES[digit] : "palm";
    digits.push_back(fmt::format("{} {}", name, plain_number(scene.strength->digits[digit])));
  }
  return fmt::format("{}, strength of the digits in N{}: {}", pinch, scene.strength->by_opening ? " at the best opening" : "",
                     joined(digits, ", "));
}

std::string form_text(const VesselData& vessel) {
  if (vessel.mesh) return "mesh " + vessel.mesh->file;
  return fmt::format("outline of {}{}", counted(vessel.outline.size(), "element"),
                     vessel.surface == Surface::shell ? ", a shell" : "");
}

// The width of an outline that can be made ready; NaN for a mesh that is not there.
double widest(const ReportSource& source, const VesselData& vessel) {
  if (vessel.mesh && vessel.mesh->body) {
    const MeshBody& body = *vessel.mesh->body;
    return std::max(body.facts.high[0] - body.facts.low[0], body.facts.high[2] - body.facts.low[2]);
  }
  if (vessel.outline.empty() || !source.core) return std::nan("");
  return 2 * prepare_vessel(vessel, vessel.has_cavity()).largest_radius;
}

// An inner outline leaves walls of any thickness.
std::string wall_text(const VesselData& vessel) {
  if (!(vessel.wall > 0)) return "none";
  return vessel.inner.empty() ? plain_number(vessel.wall * 1e3) : shown_number(vessel.wall * 1e3, 2) + " and more";
}

// The facts of each mesh, a line each.
void write_meshes(MarkupWriter& html, const std::string& lines) {
  if (lines.empty()) return;
  html.open("ul");
  std::istringstream stream(lines);
  for (std::string line; std::getline(stream, line);) html.element("li", line);
  html.close();
}

void write_vessels(MarkupWriter& html, const ReportSource& source) {
  HtmlTable table(html, "The vessels",
                  {"vessel", "form", "width (mm)", "height (mm)", "wall (mm)", "mass (g)", "capacity (mL)", "force range (N)",
                   "guidance points"},
                  {1});
  for (std::size_t v = 0; v < source.scene.vessels.size(); ++v) {
    const VesselData& vessel = source.scene.vessels[v];
    const double mass = source.core ? source.core->empty_mass(v) : vessel.mass.value_or(std::nan(""));
    const double capacity = source.core && vessel.has_cavity() ? source.core->capacity(v) : std::nan("");
    table.row({vessel.name, form_text(vessel), shown_number(widest(source, vessel) * 1e3, 1),
               shown_number((vessel.height - vessel.base) * 1e3, 1), wall_text(vessel), shown_number(mass * 1e3, 1),
               shown_number(capacity * 1e6, 0), plain_number(vessel.force_range.value_or(source.scene.force.range)),
               vessel.guidance.empty() ? "none" : std::to_string(vessel.guidance.size())});
  }
  table.end();
}

}  // namespace

void write_scene(MarkupWriter& html, const ReportSource& source) {
  const Scene& scene = source.scene;
  html.open("section", {{"aria-labelledby", "asked"}}).element("h2", "What was asked", {{"id", "asked"}});
  html.open("dl");
  write_pair(html, "Grips of each vessel", grips_text(source));
  write_pair(html, "States of each grip", states_text(scene));
  write_pair(html, "Hand", hand_text(scene));
  if (!scene.tilts.empty()) write_pair(html, "Feedback force", force_text(scene));
  write_pair(html, "Holding", hold_text(scene));
  write_pair(html, "Score", "weights: " + sweeps::weights_text(scene));
  html.close();
  write_vessels(html, source);
  write_meshes(html, source.result.origin().meshes);
  html.open("details").element("summary", "The scene as it was written").element("pre", scene.text, {{"tabindex", "0"}}).close();
  html.close();
}

std::vector<std::string> left_out(const ReportSource& source) {
  const Scene& scene = source.scene;
  std::vector<std::string> sentences;
  const auto any = [&scene](auto is) { return std::any_of(scene.vessels.begin(), scene.vessels.end(), is); };
  if (source.plan.copies() > 1)
    sentences.push_back(fmt::format("{} of {} azimuths: the vessels are bodies of revolution, so one stands for all.",
                                    readable_number(source.plan.copies() - 1), readable_number(source.plan.copies())));
  if (scene.pose == Pose::rigged) sentences.emplace_back("The projection of the fingers: the pose is rigged.");
  if (scene.tilts.empty())
    sentences.emplace_back("The forces: the scene has no tilts. Their weights in the score went to the other terms.");
  if (!scene.strength && !scene.tilts.empty()) sentences.emplace_back("The effort of the whole hand: the scene has no strengths.");
  if (!scene.liquid) sentences.emplace_back("The liquid: the scene has no liquid.");
  if (!scene.table) sentences.emplace_back("The table: the scene has no table, so a hand may reach below the base of a vessel.");
  if (!scene.arm)
    sentences.emplace_back("The arm: the scene has no arm, so a hand may be where no wrist and no forearm of a person bring it.");
  if (any([](const VesselData& v) { return v.surface == Surface::solid && v.wall > 0; }))
    sentences.emplace_back("The inner wall: for the fingers the vessels are solid.");
  std::size_t possible = 0;
  std::vector<std::string> missing;
  for (const sweeps::Variable& variable : sweeps::variable_catalogue()) {
    if (variable.need == sweeps::Need::table && !scene.table) continue;
    if (variable.need == sweeps::Need::arm && !scene.arm) continue;
    ++possible;
    if (!source.result.find(variable.name)) missing.emplace_back(variable.name);
  }
  if (missing.size() == possible) {
    sentences.emplace_back("Every variable of the grips: the file holds only the best grips ([output] keep).");
  } else if (!missing.empty()) {
    sentences.push_back(fmt::format("{} of {} variables were not kept in the file ([output] keep): {}.", missing.size(), possible,
                                    joined(missing, ", ")));
  }
  return sentences;
}

void write_origin(MarkupWriter& html, const ReportSource& source) {
  const sweeps::SweepOrigin& origin = source.result.origin();
  const std::size_t vessels = source.scene.vessels.size();
  const double grips = static_cast<double>(source.plan.grips()) * static_cast<double>(vessels);
  const double states =
      grips * static_cast<double>(std::max<std::size_t>(1, source.scene.tilts.size() * scene_fills(source.scene)));
  html.open("section", {{"aria-labelledby", "ran"}}).element("h2", "How it ran", {{"id", "ran"}});
  html.open("dl");
  write_pair(html, "Device", origin.device);
  write_pair(html, "Driver", origin.driver);
  write_pair(html, "Arithmetic",
             fmt::format("{}, {} precision", origin.backend, origin.precision == Precision::single ? "single" : "double"));
  write_pair(html, "Program", "wholehand " + origin.version);
  write_pair(html, "Time",
             fmt::format("{} s in all, {} s of it in kernels", shown_number(origin.wall_seconds, 2),
                         shown_number(origin.kernel_seconds, 2)));
  write_pair(html, "Evaluated",
             fmt::format("{}{}", counted(static_cast<std::uint64_t>(grips), "grip"),
                         states > grips ? fmt::format(", {} states", readable_count(states)) : ""));
  write_pair(html, "Result file",
             fmt::format("{}, {}", source.result.path().substr(source.result.path().rfind('/') + 1), readable_bytes(origin.bytes)));
  html.close();
  html.element("h3", "Left out");
  html.open("ul");
  for (const std::string& sentence : left_out(source)) html.element("li", sentence);
  html.close().close();
}

}  // namespace wholehand
