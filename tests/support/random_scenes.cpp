// SPDX-License-Identifier: MIT
#include "tests/support/random_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "base/text/error.h"
#include "core/evaluator.h"
#include "core/reader/reader.h"
#include "tests/support/scene_draw.h"

namespace wholehand {
namespace {

std::string key(const char* name, double value) { return fmt::format("{} = {:.9g}\n", name, value); }

// `count` distinct numbers of a range, ascending.
std::string ascending(SceneDraw& draw, int count, double low, double high) {
  std::set<double> values;
  while (static_cast<int>(values.size()) < count)
    values.insert(draw.chance(0.1) ? (draw.chance(0.5) ? low : high) : draw.between(low, high));
  std::string text = "[";
  for (const double value : values) text += fmt::format("{:.9g}, ", value);
  return text + "]";
}

// Outwards from the base and upwards, of segments and of arcs whose center is anywhere on the perpendicular through their middle.
std::string random_outline(SceneDraw& draw, double size) {
  double r = size * draw.between(0.1, 0.5), y = 0;
  std::string text = fmt::format("outline = [\n  {{ line = [{:.9g}, 0] }},\n", r);
  const int count = 1 + draw.of(8);
  for (int k = 0; k < count; ++k) {
    const double last_r = r, last_y = y;
    r = draw.chance(0.3) ? r : size * draw.between(0.08, 0.5);
    y += size * draw.between(0.05, 0.5);
    if (draw.chance(0.5)) {
      text += fmt::format("  {{ line = [{:.9g}, {:.9g}] }},\n", r, y);
      continue;
    }
    const double along = draw.over(0.02, 20) * (draw.chance(0.5) ? 1 : -1);
    text += fmt::format("  {{ arc = [{:.9g}, {:.9g}], center = [{:.12g}, {:.12g}] }},\n", r, y,
                        (r + last_r) / 2 + along * (last_y - y), (y + last_y) / 2 + along * (r - last_r));
  }
  return text + fmt::format("  {{ line = [0, {:.9g}] }},\n]\n", y);
}

// `size`: its largest diameter or about that, mm.
std::string random_form(SceneDraw& draw, double size) {
  const double height = size * draw.over(0.4, 4);
  switch (draw.of(4)) {
    case 0:
      return "shape = \"cylinder\"\n" + key("diameter_mm", size) + key("height_mm", height);
    case 1:
      return "shape = \"flask\"\n" + key("diameter_mm", size) + key("neck_mm", size * draw.between(0.1, 0.9)) +
             key("height_mm", size * draw.between(1.05, 2.5));
    case 2: {
      const double upright = draw.chance(0.3) ? 0 : height * draw.between(0.02, 0.4);
      return "shape = \"conical\"\n" + key("diameter_mm", size) + key("upright_mm", upright) +
             key("neck_mm", size * draw.between(0.1, 0.9)) + key("shoulder_mm", upright + height * draw.between(0.1, 0.4)) +
             key("height_mm", height);
    }
    default:
      return random_outline(draw, size);
  }
}

std::string random_vessel(SceneDraw& draw, int number, double size) {
  std::string text = fmt::format("\n[[vessel]]\nname = \"v{}\"\n", number) + random_form(draw, size);
  const bool has_mass = draw.chance(0.3), has_wall = !has_mass || draw.chance(0.5);
  if (has_wall) text += key("wall_mm", std::clamp(size * draw.over(0.003, 0.15), 0.05, 100.0));
  if (has_wall && draw.chance(0.4)) text += "surface = \"shell\"\n";
  if (has_mass) {
    text += key("mass_kg", draw.chance(0.8) ? draw.over(1e-3, 10) : draw.over(1e-6, 1e6));
    text += fmt::format("center_of_mass_mm = [{:.9g}, {:.9g}, {:.9g}]\n", size * draw.between(-0.3, 0.3), size * draw.between(0, 1),
                        size * draw.between(-0.3, 0.3));
  } else if (draw.chance(0.5)) {
    text += key("density_kg_m3", draw.over(100, 20000));
  }
  if (draw.chance(0.1)) text += key("force_range_N", draw.between(0, 100));
  return text;
}

// Proportions near the default's, so that the gap still falls as the hand closes; some of them bare points.
std::string random_fingers(SceneDraw& draw) {
  const HandData usual = paper_hand();
  std::string text;
  for (std::size_t f = 0; f < FINGER_COUNT; ++f) {
    const FingerData& finger = usual.fingers[f];
    const std::size_t segments = f == 0 ? 3 : 4;
    std::string lengths, radii;
    for (std::size_t k = 0; k < segments; ++k)
      lengths += fmt::format("{:.9g}, ", finger.segments[k] * 1e3 * draw.between(0.93, 1.07));
    const bool is_bare = draw.chance(0.1);
    for (std::size_t k = 0; k <= segments; ++k) radii += fmt::format("{:.9g}, ", is_bare ? 0 : draw.between(1, 12));
    text += fmt::format("[hand.{}]\nsegments_mm = [{}]\nradii_mm = [{}]\n", FINGER_NAMES[f], lengths, radii);
  }
  return text;
}

std::string random_hand(SceneDraw& draw, double scale) {
  std::string text = "[hand]\n" + key("scale", scale);
  if (draw.chance(0.5)) text += "handedness = \"left\"\n";
  if (draw.chance(0.6)) text += key("contact_tolerance_mm", draw.chance(0.3) ? 0 : draw.over(1e-5, 10));
  if (draw.chance(0.3)) text += key("depth_limit_mm", draw.chance(0.2) ? 0 : draw.over(0.1, 100));
  if (draw.chance(0.3)) text += key("max_angle_deg", draw.between(0, 180));
  if (draw.chance(0.3)) text += key("paper_max_angle_deg", draw.between(0, 60));
  if (draw.chance(0.2))
    text += fmt::format("joint_limit_deg = [{:.9g}, {:.9g}, {:.9g}]\n", draw.between(0, 180), draw.between(0, 180),
                        draw.between(0, 180));
  if (draw.chance(0.3)) text += random_fingers(draw);
  return text;
}

std::string random_forces(SceneDraw& draw) {
  std::string text, strength;
  if (draw.chance(0.6)) {
    text += fmt::format("[liquid]\nfills = {}\n", ascending(draw, 1 + draw.of(3), 0, 1));
    if (draw.chance(0.4)) text += key("density_kg_m3", draw.over(1, 25000));
    if (draw.chance(0.3)) text += "pour = \"towards\"\n";
  }
  if (draw.chance(0.6)) {
    text += "[force]\n";
    if (draw.chance(0.5)) text += key("base_N", draw.between(0, 10));
    if (draw.chance(0.5)) text += key("range_N", draw.chance(0.1) ? 0 : draw.over(0.1, 100));
    if (draw.chance(0.5)) text += key("max_N", draw.chance(0.1) ? 0 : draw.over(0.1, 1000));
    if (draw.chance(0.5)) text += key("friction", draw.chance(0.2) ? 0 : draw.over(0.01, 10));
    if (draw.chance(0.5)) text += key("torsion_mm", draw.chance(0.2) ? 0 : draw.over(0.01, 100));
    if (draw.chance(0.5)) strength = "[strength]\n" + key("thumb_N", draw.chance(0.2) ? draw.over(0.1, 10000) : draw.over(5, 100));
    if (draw.chance(0.5)) text += "torque = \"exact\"\n";
    if (draw.chance(0.5)) text += "reference = \"per_grip\"\n";
    text += strength;
  }
  if (draw.chance(0.8)) text += fmt::format("[tilts]\ndeg = {}\n", ascending(draw, 1 + draw.of(4), 0, 180));
  if (draw.chance(0.2))
    text += "[score]\n" + key("depth", draw.over(0.1, 1000)) + key("force", draw.between(0, 10)) + key("hold", draw.between(0, 10));
  return text;
}

// A number, a list or a range.
std::string random_axis(SceneDraw& draw, const char* name, double low, double high) {
  if (draw.chance(0.4)) return key(name, draw.between(low, high));
  if (draw.chance(0.5)) return fmt::format("{} = {}\n", name, ascending(draw, 2 + draw.of(2), low, high));
  const double from = draw.between(low, high);
  return fmt::format("{} = {{ from = {:.9g}, to = {:.9g}, count = {} }}\n", name, from, draw.between(from, high), 2 + draw.of(3));
}

// Whether thumb or index finger are bare points. On the very edge of a mouth such a point has no one normal, and whether it is in the
// mouth is a matter of rounding: there is nothing to compare.
bool has_bare_tips(const std::string& hand) {
  const auto bare = [&](const char* finger) {
    const std::size_t at = hand.find(finger);
    return at != std::string::npos && hand.compare(hand.find("radii_mm", at), 13, "radii_mm = [0") == 0;
  };
  return bare("[hand.thumb]") || bare("[hand.index]");
}

std::string random_grips(SceneDraw& draw, double size, bool beside_edges) {
  std::string text = "[grips]\n";
  const double least = beside_edges ? 1e-3 : 0;
  text += fmt::format("height_fraction = {}\n", ascending(draw, 2 + draw.of(3), least, 1 - least));
  if (draw.chance(0.5)) text += random_axis(draw, "azimuth_deg", -360, 360);
  if (draw.chance(0.6)) text += random_axis(draw, "obliquity_deg", -40, 40);
  text += random_axis(draw, "roll_deg", -120, 60);
  if (draw.chance(0.5)) text += random_axis(draw, "offset_mm", -0.3 * size, 0.3 * size);
  if (draw.chance(0.3)) text += random_axis(draw, "hand_scale", 0.8, 1.25);
  if (draw.chance(0.2)) text += fmt::format("sampling = \"sobol\"\ncount = {}\nseed = {}\n", 10 + draw.of(100), draw.of(1000));
  return text;
}

// A further key of a table that the scene has.
void add_key(std::string& text, const std::string& table, const std::string& key) {
  const std::size_t at = text.find(table + "\n");
  if (at != std::string::npos) text.insert(at + table.size() + 1, key);
}

// Drawn last, so that the rest of a scene is what it was before there were these keys.
void add_later_keys(SceneDraw& draw, std::string& text) {
  if (draw.chance(0.3)) text += "[table]\n" + key("clearance_mm", draw.between(0, 10));
  if (draw.chance(0.3) && text.find("[liquid]") != std::string::npos)
    add_key(text, "[tilts]", key("until_poured", draw.chance(0.2) ? 1 : draw.over(1e-3, 1)));
  for (const char* digit : {"index_N", "middle_N", "ring_N", "little_N", "palm_N"})
    if (draw.chance(0.5)) add_key(text, "[strength]", key(digit, draw.chance(0.2) ? draw.over(0.1, 10000) : draw.over(5, 100)));
  if (draw.chance(0.3)) text += "[output]\n" + key("apart_mm", draw.chance(0.2) ? 0 : draw.over(1, 100));
  if (draw.chance(0.2)) {
    text += "[robust]\n" + key("roll_deg", draw.over(0.01, 90));
    for (const char* name : {"height_mm", "azimuth_deg", "obliquity_deg", "offset_mm"})
      if (draw.chance(0.5)) text += key(name, draw.between(0, 30));
    if (draw.chance(0.3)) text += key("hand_scale", draw.between(0, 0.3));
    if (draw.chance(0.3)) text += key("friction", draw.between(0, 1));
    text += fmt::format("count = {}\nseed = {}\n", 8 + draw.of(20), draw.of(1000));
  }
  if (draw.chance(0.4)) add_key(text, "[hand]", fmt::format("between = {}\n", draw.of(9)));
  if (draw.chance(0.3)) {
    text += "[arm]\n";
    if (draw.chance(0.5))
      text += fmt::format("shoulder_mm = [{}, {}, {}]\n", draw.of(400) - 200, 100 + draw.of(500), 100 + draw.of(500));
    for (const char* name : {"flexion_deg", "extension_deg", "radial_deg", "ulnar_deg", "pronation_deg", "supination_deg"})
      if (draw.chance(0.3)) text += key(name, draw.over(1, 180));
  }
  if (text.find("[strength]") == std::string::npos) text += "[strength]\nefforts = false\n";
}

std::string random_scene_text(std::uint64_t seed) {
  SceneDraw draw(seed);
  std::string text = fmt::format("[scene]\nname = \"random-{}\"\npose = \"{}\"\n", seed,
                                 draw.word({"articulated", "articulated", "paper", "rigged"}));
  if (draw.chance(0.2)) text += key("gravity_m_s2", draw.chance(0.2) ? 0 : draw.between(0, 100));
  const double scale = draw.chance(0.5) ? draw.between(0.8, 1.2) : draw.chance(0.6) ? draw.over(0.2, 5) : draw.over(0.05, 20);
  const std::string hand = random_hand(draw, scale);
  text += hand + random_forces(draw);
  // most vessels are such as the hand can span; some are of any size
  const double size = std::clamp(scale * draw.between(15, 100), 1.0, 5000.0);
  text += random_grips(draw, size, has_bare_tips(hand));
  const int vessels = draw.chance(0.7) ? 1 : 2;
  for (int v = 0; v < vessels; ++v)
    text += random_vessel(draw, v, draw.chance(0.9) ? std::clamp(size * draw.between(0.7, 1.2), 1.0, 5000.0) : draw.over(2, 5000));
  add_later_keys(draw, text);
  return text;
}

}  // namespace

Scene random_scene(std::uint64_t seed) {
  constexpr std::uint64_t TRIES = 1000;  // an outline in three crosses itself, a hand in ten does not close
  for (std::uint64_t k = 0; k < TRIES; ++k) {
    try {
      Scene scene = parse_scene(random_scene_text(TRIES * seed + k), fmt::format("random-{}.toml", seed));
      make_core_evaluator(scene);  // which refuses hands that do not close
      return scene;
    } catch (const Error& error) {
      if (error.code != ExitCode::usage) throw;
    }
  }
  throw failure_error(fmt::format("random scene {}: the reader takes none of {} texts", seed, TRIES));
}

}  // namespace wholehand
