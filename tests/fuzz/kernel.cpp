// SPDX-License-Identifier: MIT
// Whatever a scene may say and wherever it is gripped, kernels answer with finite numbers where a value must be: bytes become a
// scene that the reader takes (what it or the preparation refuses is passed over), grips within its ranges, and both precisions'
// answers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "base/text/error.h"
#include "core/absent.h"
#include "core/evaluator.h"
#include "core/reader/ranges.h"
#include "core/reader/reader.h"
#include "sweeps/lists/robust.h"
#include "tests/fuzz/choices.h"
#include "tests/fuzz/must.h"

namespace wholehand {
namespace {

constexpr int LARGEST_ELEMENTS = 10, LARGEST_STATES = 3, GRIPS = 6;

std::string key(const char* name, double value) { return fmt::format("{} = {:.17g}\n", name, value); }

// Upwards for the most part, so that few outlines cross themselves; lengths in mm, about `size`.
std::string outline_of(Choices& choose, double size) {
  std::string text = "outline = [";
  double r = choose.keep(size * (0.05 + choose.share())), y = 0;
  text += fmt::format("{{ line = [{:.17g}, 0] }}", r);
  const int count = choose.of(LARGEST_ELEMENTS);
  for (int k = 0; k < count; ++k) {
    const double last_r = r, last_y = y;
    r = choose.yes() ? r : choose.keep(size * (0.05 + choose.share()));
    y = choose.of(4) == 0 ? y : choose.keep(y + size * choose.share() * (choose.of(8) == 0 ? 1e-4 : 1));
    if (r == last_r && y == last_y) y += choose.keep(size * 0.1);
    if (choose.of(3) > 0) {
      text += fmt::format(", {{ line = [{:.17g}, {:.17g}] }}", r, y);
    } else {  // its center somewhere on the perpendicular through the middle
      const double along = std::exp(8 * choose.share() - 4) * (choose.yes() ? 1 : -1);
      const double center_r = (r + last_r) / 2 + along * (last_y - y), center_y = (y + last_y) / 2 + along * (r - last_r);
      text += fmt::format(", {{ arc = [{:.17g}, {:.17g}], center = [{:.17g}, {:.17g}] }}", r, y, center_r, center_y);
    }
  }
  return text + fmt::format(", {{ line = [0, {:.17g}] }}]\n", y);
}

std::string vessel_of(Choices& choose) {
  const double size = std::exp(choose.share() * std::log(1e4));  // mm, 1 to 10,000
  std::string text = "[[vessel]]\nname = \"v\"\n";
  const auto length = [&] {
    return choose.keep(std::clamp(size * (0.02 + choose.share()), ranges::DIAMETER.low, ranges::DIAMETER.high));
  };
  switch (choose.of(4)) {
    case 0:
      text += "shape = \"cylinder\"\n" + key("diameter_mm", length()) + key("height_mm", length());
      break;
    case 1: {
      const double diameter = length();
      text += "shape = \"flask\"\n" + key("diameter_mm", diameter) + key("neck_mm", diameter * choose.share()) +
              key("height_mm", diameter + length());
      break;
    }
    case 2: {
      const double diameter = length(), upright = choose.yes() ? 0 : length(), shoulder = upright + length();
      text += "shape = \"conical\"\n" + key("diameter_mm", diameter) + key("upright_mm", upright) +
              key("neck_mm", diameter * choose.share()) + key("shoulder_mm", choose.keep(shoulder)) +
              key("height_mm", shoulder + length());
      break;
    }
    default:
      text += outline_of(choose, size);
  }
  const bool has_mass = choose.yes(), has_wall = !has_mass || choose.yes();
  if (has_wall)
    text += key("wall_mm",
                std::max(ranges::WALL.low, std::min(ranges::WALL.high, choose.keep(size * std::exp(-1 - 7 * choose.share())))));
  if (has_mass) {
    text += key("mass_kg", std::exp(std::log(1e-6) + choose.share() * std::log(1e12)));
    text += fmt::format("center_of_mass_mm = [{:.17g}, {:.17g}, {:.17g}]\n", choose.in({-size, size}), choose.in({-size, size}),
                        choose.in(ranges::CENTER_OF_MASS));
  }
  if (has_wall && choose.yes()) text += "surface = \"shell\"\n";
  return text;
}

// Ascending numbers of a range, at least one.
std::string ascending(Choices& choose, const char* name, const Quantity& range) {
  std::vector<double> values;
  for (int k = choose.of(LARGEST_STATES) + 1; k > 0; --k) values.push_back(choose.in(range));
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  std::string text = std::string(name) + " = [";
  for (const double value : values) text += fmt::format("{:.17g}, ", value);
  return text + "]\n";
}

std::string scene_of(Choices& choose) {
  static constexpr const char* POSES[] = {"articulated", "paper", "rigged"};
  std::string text = fmt::format("[scene]\npose = \"{}\"\n", POSES[choose.of(3)]) + key("gravity_m_s2", choose.in(ranges::GRAVITY));
  text += "[hand]\n" + key("scale", choose.in(ranges::SCALE)) + key("contact_tolerance_mm", choose.in(ranges::CONTACT_TOLERANCE));
  if (choose.yes()) text += "handedness = \"left\"\n";
  text += vessel_of(choose);
  if (choose.yes()) {
    text += "[liquid]\n" + ascending(choose, "fills", ranges::FRACTION) + key("density_kg_m3", choose.in(ranges::LIQUID_DENSITY));
    if (choose.yes()) text += "pour = \"towards\"\n";
  }
  if (choose.yes()) {
    text += "[force]\n" + key("base_N", choose.in(ranges::BASE_FORCE)) + key("range_N", choose.in(ranges::FORCE_RANGE)) +
            key("max_N", choose.in(ranges::MAX_FORCE)) + key("friction", choose.in(ranges::FRICTION)) +
            key("torsion_mm", choose.in(ranges::TORSION));
    const double strength = choose.in(ranges::GRIP_STRENGTH);
    if (choose.yes()) text += "torque = \"exact\"\n";
    if (choose.yes()) text += "reference = \"per_grip\"\n";
    text += "[strength]\n" + key("thumb_N", strength);
  }
  return text + "[tilts]\n" + ascending(choose, "deg", ranges::TILT);
}

// A further key of a table that the scene has.
void add_key(std::string& text, const std::string& table, const std::string& key) {
  const std::size_t at = text.find(table + "\n");
  if (at != std::string::npos) text.insert(at + table.size() + 1, key);
}

std::string robust_of(Choices& choose) {
  std::string text = "[robust]\n" + fmt::format("count = {}\n", ranges::DEVIATION_COUNT.low);
  for (const auto& [name, range] : {std::pair("height_mm", ranges::LENGTH_DEVIATION),
                                    {"offset_mm", ranges::LENGTH_DEVIATION},
                                    {"azimuth_deg", ranges::ANGLE_DEVIATION},
                                    {"obliquity_deg", ranges::ANGLE_DEVIATION},
                                    {"roll_deg", ranges::ANGLE_DEVIATION},
                                    {"friction", ranges::FRICTION_DEVIATION},
                                    {"hand_scale", ranges::SCALE_DEVIATION}})
    if (choose.yes()) text += key(name, choose.in(range));
  return text;
}

// What was added to scenes later: chosen after all else, so that a seed that was found before is still the scene that it was.
void add_later_keys(Choices& choose, std::string& text) {
  for (const char* digit : {"index_N", "middle_N", "ring_N", "little_N", "palm_N"})
    if (choose.yes()) add_key(text, "[strength]", key(digit, choose.in(ranges::GRIP_STRENGTH)));
  if (choose.yes() && text.find("[liquid]") != std::string::npos)
    add_key(text, "[tilts]", key("until_poured", choose.in(ranges::POURED_SHARE)));
  if (choose.yes()) text += "[table]\n" + key("clearance_mm", choose.in(ranges::TABLE_CLEARANCE));
  if (choose.yes()) text += "[output]\n" + key("apart_mm", choose.in(ranges::APART));
  if (choose.yes()) add_key(text, "[hand]", fmt::format("between = {}\n", choose.of(static_cast<int>(ranges::BETWEEN.high) + 1)));
  if (choose.yes()) text += robust_of(choose);
  if (text.find("[strength]") == std::string::npos) text += "[strength]\nefforts = false\n";
}

// The same grips once more, as the robust score deviates them.
void add_deviated(const Scene& scene, std::vector<GripInput>& grips) {
  if (!scene.robust) return;
  const std::vector<sweeps::Deviation> all = sweeps::deviations(*scene.robust);
  must(all.size() == static_cast<std::size_t>(scene.robust->count), "deviations are missing");
  for (std::size_t k = 0; k < GRIPS; ++k) grips.push_back(sweeps::deviated(grips[k], all[k]));
  for (const double friction : sweeps::robust_frictions(scene))
    must(friction >= 0 && std::isfinite(friction), "a friction is none");
}

std::vector<GripInput> grips_of(Choices& choose, const Scene& scene) {
  const double height = scene.vessels[0].height;
  const auto si = [&](const Quantity& range) { return to_si(choose.in(range), range.unit); };
  double widest = 0;
  for (const OutlineElement& element : scene.vessels[0].outline) widest = std::max(widest, element.end[0]);
  std::vector<GripInput> grips(GRIPS);
  for (GripInput& grip : grips) {
    grip.height = choose.of(4) == 0 ? si(ranges::GRIP_HEIGHT) : choose.share() * height;
    grip.azimuth = si(ranges::ROTATION);
    grip.obliquity = choose.yes() ? 0 : si(ranges::OBLIQUITY);
    grip.roll = si(ranges::ROTATION);
    grip.offset = choose.yes() ? 0 : choose.of(4) == 0 ? si(ranges::OFFSET) : (2 * choose.share() - 1) * widest;
    // most hands span the vessel
    const double spanning = widest / (0.04 * scene.hand.scale) * (0.4 + 2.6 * choose.share());
    grip.hand_scale = choose.of(4) == 0 ? choose.in(ranges::SCALE) : std::clamp(spanning, ranges::SCALE.low, ranges::SCALE.high);
  }
  return grips;
}

void check(const Scene& scene, const Evaluator& core, const std::vector<GripInput>& grips, const char* precision) {
  std::vector<int> every(FIELDS);
  std::iota(every.begin(), every.end(), 0);
  const FieldSet fields = make_field_set(every, scene);
  std::vector<double> reals(fields.real_planes * grips.size());
  std::vector<std::uint32_t> uints(fields.uint_planes * grips.size());
  core.planes(0, grips.data(), grips.size(), fields, grips.size(), reals.data(), uints.data());
  const Misplaced misplaced = misplaced_values(scene, 0, fields, grips.size(), grips.size(), reals.data(), uints.data(), true);
  must(misplaced.count == 0, fmt::format("{}: {}\n{}", precision, describe(misplaced), scene.text));
  const VesselConstants constants = core.constants(0);
  for (const double value : {constants.capacity, constants.mass, constants.center_of_mass[0], constants.center_of_mass[1],
                             constants.center_of_mass[2], constants.torque_reference, constants.largest_mass})
    must(std::isfinite(value), fmt::format("{}: a constant of the vessel is {}\n{}", precision, value, scene.text));
  if (!scene.liquid) return;
  for (const double fill : scene.liquid->fills) {
    for (const double tilt : scene.tilts) {
      const LiquidResult liquid = core.liquid(0, fill, tilt);
      for (const double value : {liquid.volume, liquid.mass, liquid.lean, liquid.height, liquid.poured})
        must(std::isfinite(value), fmt::format("{}: liquid is {}\n{}", precision, value, scene.text));
    }
  }
}

}  // namespace
}  // namespace wholehand

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace wholehand;
  Choices choose(data, size);
  try {
    std::string text = scene_of(choose);
    std::vector<GripInput> grips = grips_of(choose, parse_scene(text, "fuzz.toml"));
    add_later_keys(choose, text);
    const Scene scene = parse_scene(text, "fuzz.toml");
    add_deviated(scene, grips);
    check(scene, *make_core_evaluator(scene), grips, "double");
    check(scene, *make_core_float_evaluator(scene), grips, "float");
  } catch (const Error& error) {
    if (error.code != ExitCode::usage) std::abort();
    if (std::getenv("WHOLEHAND_FUZZ_REFUSALS")) std::fprintf(stderr, "%s\n", error.what());
  }
  return 0;
}
