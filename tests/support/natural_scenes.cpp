// SPDX-License-Identifier: MIT
#include "tests/support/natural_scenes.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/text/error.h"
#include "core/evaluator.h"
#include "core/reader/reader.h"
#include "tests/support/meshes.h"
#include "tests/support/scene_draw.h"

namespace wholehand {
namespace {

// A number as a person writes it.
std::string natural_key(const char* name, double value) { return fmt::format("{} = {:.3g}\n", name, value); }

std::string natural_range(double from, double to, int count) {
  return fmt::format("{{ from = {:.3g}, to = {:.3g}, count = {} }}", from, to, count);
}

// Upright or leaning walls, with a rounded foot and a lip; or a bowl on a stem; or a bottle.
std::string natural_outline(SceneDraw& draw) {
  const double r = draw.between(22, 45), h = r * draw.between(1.6, 4);
  switch (draw.of(3)) {
    case 0:
      return fmt::format(
          "outline = [{{ line = [{0:.6g}, 0] }}, {{ arc = [{1:.6g}, {2:.6g}], center = [{0:.6g}, {2:.6g}] }}, "
          "{{ line = [{3:.6g}, {4:.6g}], fillet_mm = {5:.3g} }}, {{ line = [{6:.6g}, {7:.6g}] }}, {{ line = [0, {7:.6g}] }}]\n",
          r - 4, r, 4.0, r * draw.between(0.9, 1.2), 0.85 * h, 1 + draw.between(0, 2), r * draw.between(1, 1.3), h);
    case 1:
      return fmt::format(
          "outline = [{{ line = [{0:.6g}, 0] }}, {{ line = [{0:.6g}, 4] }}, {{ line = [5, 9], fillet_mm = 1 }}, "
          "{{ line = [5, {1:.6g}], fillet_mm = 1 }}, {{ arc_through = [{2:.6g}, {3:.6g}], to = [{4:.6g}, {5:.6g}] }}, "
          "{{ line = [{6:.6g}, {7:.6g}] }}, {{ line = [0, {7:.6g}] }}]\nfloor_mm = {8:.6g}\n",
          0.85 * r, 0.9 * r + 20, 0.72 * r, 1.15 * r + 20, r, 2 * r + 20, r * draw.between(0.75, 1), 3 * r + 20, 0.9 * r + 25);
    default:
      return fmt::format(
          "outline = [{{ line = [{0:.6g}, 0], fillet_mm = 3 }}, {{ line = [{0:.6g}, {1:.6g}] }}, "
          "{{ arc = [{2:.6g}, {3:.6g}], center = [{2:.6g}, {1:.6g}] }}, {{ line = [{2:.6g}, {4:.6g}] }}, {{ line = [0, {4:.6g}] "
          "}}]\n",
          r, 0.6 * h + 10, 0.45 * r, 0.6 * h + 10 + 0.55 * r, h + 10 + 0.55 * r);
  }
}

std::string natural_form(SceneDraw& draw) {
  const double d = draw.between(40, 95), h = d * draw.between(0.8, 2.5), neck = d * draw.between(0.3, 0.6);
  switch (draw.of(4)) {
    case 0:
      return "shape = \"cylinder\"\n" + natural_key("diameter_mm", d) + natural_key("height_mm", h);
    case 1:
      return "shape = \"flask\"\n" + natural_key("diameter_mm", d) + natural_key("neck_mm", neck) +
             natural_key("height_mm", d * draw.between(1.2, 1.9));
    case 2:
      return "shape = \"conical\"\n" + natural_key("diameter_mm", d) + natural_key("upright_mm", draw.chance(0.3) ? 0 : 0.06 * d) +
             natural_key("neck_mm", neck) + natural_key("shoulder_mm", h * draw.between(0.6, 0.8)) + natural_key("height_mm", h);
    default:
      return natural_outline(draw);
  }
}

std::string natural_vessel(SceneDraw& draw, int number) {
  std::string text =
      fmt::format("\n[[vessel]]\nname = \"v{}\"\n", number) + natural_form(draw) + natural_key("wall_mm", draw.between(1, 4));
  if (draw.chance(0.4)) text += "surface = \"shell\"\n";
  if (draw.chance(0.2)) {
    text +=
        natural_key("mass_kg", draw.over(0.03, 1.5)) + fmt::format("center_of_mass_mm = [{:.3g}, {:.3g}, {:.3g}]\n",
                                                                   draw.between(-5, 5), draw.between(20, 70), draw.between(-5, 5));
  } else if (draw.chance(0.7)) {
    text += "density_kg_m3 = " + draw.word({"900", "1200", "2230", "2500", "2700", "7800"}) + "\n";
  }
  if (draw.chance(0.3)) text += natural_key("force_range_N", draw.between(1, 5));
  return text;
}

std::string natural_hand(SceneDraw& draw) {
  std::string text = "[hand]\n";
  switch (draw.of(4)) {
    case 0:
    case 1:
      text += fmt::format("person = {{ sex = \"{}\", percentile = {:.3g} }}\n", draw.word({"female", "male"}), draw.between(1, 99));
      break;
    case 2:
      text += natural_key("length_mm", draw.between(150, 215));
      break;
    default:
      if (draw.chance(0.5)) text += natural_key("scale", draw.between(0.8, 1.15));
  }
  if (draw.chance(0.4)) text += "handedness = \"left\"\n";
  if (draw.chance(0.2)) text += natural_key("contact_tolerance_mm", draw.over(0.05, 1));
  if (draw.chance(0.2)) text += natural_key("depth_limit_mm", draw.between(1, 8));
  if (draw.chance(0.2)) text += natural_key("max_angle_deg", draw.between(20, 70));
  if (draw.chance(0.3)) text += fmt::format("between = {}\n", draw.of(5));
  return text;
}

std::string natural_liquid(SceneDraw& draw) {
  std::string text = "[liquid]\ndensity_kg_m3 = " + draw.word({"1000", "789", "1030", "1260", "1400"}) + "\n";
  text += draw.word({"fills = [0.5]\n", "fills = [0, 0.25, 0.9]\n", "fills = [0, 0.25, 0.5, 0.75, 1]\n", "fills_ml = [20, 50]\n"});
  if (draw.chance(0.4)) text += "pour = \"towards\"\n";
  return text;
}

std::string natural_force(SceneDraw& draw) {
  std::string text = "[force]\n";
  if (draw.chance(0.4)) text += natural_key("base_N", draw.between(0.3, 2));
  if (draw.chance(0.4)) text += natural_key("range_N", draw.between(1, 5));
  if (draw.chance(0.4)) text += natural_key("max_N", draw.between(4, 12));
  if (draw.chance(0.8)) text += natural_key("friction", draw.over(0.15, 1.2));
  if (draw.chance(0.7)) text += natural_key("torsion_mm", draw.chance(0.1) ? 0 : draw.between(1, 12));
  if (draw.chance(0.5)) text += "torque = \"exact\"\n";
  if (draw.chance(0.5)) text += "reference = \"per_grip\"\n";
  return text;
}

std::string natural_strength(SceneDraw& draw) {
  std::string text = "[strength]\n";
  const double person = draw.between(0.5, 1.6);
  const auto digit = [&](const char* name, double usual) {
    if (draw.chance(0.5)) text += natural_key(name, person * usual * draw.between(0.7, 1.3));
  };
  digit("thumb_N", 40);
  digit("index_N", 25);
  digit("middle_N", 35);
  digit("ring_N", 25);
  digit("little_N", 14);
  digit("palm_N", 80);
  return text;
}

std::string natural_grips(SceneDraw& draw) {
  std::string text = "[grips]\n";
  text += draw.chance(0.8)
              ? "height_fraction = " + natural_range(draw.between(0.1, 0.3), draw.between(0.6, 0.95), 4 + draw.of(5)) + "\n"
              : "height_mm = " + natural_range(draw.between(10, 25), draw.between(35, 60), 4 + draw.of(4)) + "\n";
  text += "roll_deg = " + natural_range(draw.between(-110, -60), draw.between(0, 40), 4 + draw.of(5)) + "\n";
  text += "obliquity_deg = " + draw.word({"[-20, 0, 20]", "[-15, 0]", "0", "{ from = -20, to = 20, count = 5 }"}) + "\n";
  if (draw.chance(0.4)) text += fmt::format("offset_mm = [0, {:.3g}]\n", draw.between(1, 8));
  if (draw.chance(0.2)) text += "hand_scale = [0.95, 1.05]\n";
  if (draw.chance(0.2)) text += fmt::format("sampling = \"sobol\"\ncount = {}\nseed = {}\n", 100 + draw.of(400), draw.of(1000));
  return text;
}

std::string natural_scene_text(std::uint64_t seed) {
  SceneDraw draw(seed);
  std::string text = fmt::format("[scene]\nname = \"natural-{}\"\npose = \"{}\"\n", seed,
                                 draw.word({"articulated", "articulated", "paper", "rigged"}));
  text += natural_hand(draw);
  const bool has_liquid = draw.chance(0.7);
  if (has_liquid) text += natural_liquid(draw);
  if (draw.chance(0.7)) text += natural_force(draw);
  text += draw.chance(0.7) ? natural_strength(draw) : "[strength]\nefforts = false\n";
  text += natural_grips(draw);
  if (draw.chance(0.5)) text += "[table]\n" + (draw.chance(0.5) ? natural_key("clearance_mm", draw.between(0, 6)) : std::string());
  if (draw.chance(0.9)) {
    text += "[tilts]\ndeg = " + natural_range(0, 15 * (3 + draw.of(8)), 3 + draw.of(8)) + "\n";
    if (has_liquid && draw.chance(0.3)) text += natural_key("until_poured", draw.between(0.2, 1));
  }
  if (draw.chance(0.2))
    text += "[robust]\nroll_deg = 5\nheight_mm = 4\nobliquity_deg = 3\ncount = 8\n" +
            (draw.chance(0.3) ? natural_key("friction", 0.1) : std::string());
  if (draw.chance(0.2))
    text += "[score]\n" + natural_key("hold", draw.between(0.1, 0.6)) + natural_key("depth", draw.between(0.1, 0.7));
  const int vessels = draw.chance(0.6) ? 1 : 2;
  for (int v = 0; v < vessels; ++v) text += natural_vessel(draw, v);
  if (draw.chance(0.5)) text += "[arm]\n";
  return text;
}

// Now and then a vessel becomes a mesh of its outer form, as exported from a program for drawing.
void draw_mesh(SceneDraw& draw, Scene& scene) {
  constexpr int AROUND = 32;
  constexpr double CHORD = 2e-3, SPACING = 3e-3;  // m
  if (!draw.chance(0.1)) return;
  VesselData hull = scene.vessels[0];
  hull.surface = Surface::solid;
  VesselData& vessel = scene.vessels[0] = vessel_of_mesh(hull.name, turned_mesh(hull, AROUND, CHORD), SPACING);
  vessel.density = hull.density;
  vessel.fills.assign(hull.fills.size(), 0);  // it holds nothing
}

}  // namespace

Scene natural_scene(std::uint64_t seed) {
  constexpr std::uint64_t TRIES = 1000;  // a fillet may not fit, a fill be more than a vessel holds
  for (std::uint64_t k = 0; k < TRIES; ++k) {
    try {
      Scene scene = parse_scene(natural_scene_text(TRIES * seed + k), fmt::format("natural-{}.toml", seed));
      SceneDraw draw(TRIES * seed + k + (std::uint64_t{1} << 40));
      make_core_evaluator(scene);
      draw_mesh(draw, scene);
      make_core_evaluator(scene);
      return scene;
    } catch (const Error& error) {
      if (error.code != ExitCode::usage) throw;
    }
  }
  throw failure_error(fmt::format("natural scene {}: the reader takes none of {} texts", seed, TRIES));
}

}  // namespace wholehand
