// SPDX-License-Identifier: MIT
#include "sweeps/plan/rules.h"

#include <fmt/format.h>

#include <tuple>
#include <vector>

#include "base/text/readable.h"
#include "base/text/text.h"
#include "core/hand_size.h"
#include "core/planes.h"

namespace wholehand::sweeps {
namespace {

// What distinguishes a hand from the default one beside scale and side.
HandData build_of(const Scene& scene) {
  HandData build = scene.hand;
  build.place = "";
  build.scale = HandData().scale;
  build.handedness = HandData().handedness;
  return build;
}

std::string hand_text(const Scene& scene) {
  const HandSize size = size_of(scene.hand);
  return fmt::format("{}, {:.1f} x {:.1f} mm, scale {}{}", scene.hand.handedness == Handedness::right ? "right" : "left",
                     1e3 * size.length, 1e3 * size.breadth, plain_text(scene.hand.scale),
                     build_of(scene) == HandData() ? "" : ", other numbers than by default");
}

std::string strength_text(const Scene& scene) {
  if (!scene.strength) return "none";
  std::vector<std::string> digits;
  for (const double digit : scene.strength->digits) digits.push_back(plain_text(digit));
  return joined(digits, ", ") + (scene.strength->by_opening ? " N at the best opening" : " N");
}

std::string arm_text(const Scene& scene) {
  if (!scene.arm) return "none";
  std::vector<std::string> place;
  for (const double coordinate : scene.arm->shoulder) place.push_back(plain_text(coordinate * 1e3));
  return "shoulder at " + joined(place, ", ") + " mm";
}

// The scene's own forces; a vessel's own force_range_N is not compared.
auto force_of(const Scene& scene) {
  const ForceData& force = scene.force;
  return std::tuple(scene.pose, scene.gravity, force.base, force.range, force.torque, force.reference, force.max, force.friction,
                    force.torsion, scene.table ? scene.table->clearance : -1);
}

std::string force_text(const Scene& scene) {
  const ForceData& force = scene.force;
  return fmt::format("friction {}, torsion {} mm, {} to {} N, at most {} N, gravity {} m/s2, {}", plain_text(force.friction),
                     plain_text(1e3 * force.torsion), plain_text(force.base), plain_text(force.base + force.range),
                     plain_text(force.max), plain_text(scene.gravity), scene.table ? "a table" : "no table");
}

auto states_of(const Scene& scene) {
  return std::tuple(scene.tilts, scene.until_poured, scene.liquid ? scene.liquid->pour : Pour::away,
                    scene.liquid ? scene.liquid->density : 0, scene.liquid ? scene.liquid->fills : std::vector<double>(),
                    scene.liquid ? scene.liquid->volumes : std::vector<double>());
}

std::string states_text(const Scene& scene) {
  if (scene.tilts.empty()) return "none";
  return fmt::format("{} up to {} deg, {}{}{}", counted(scene.tilts.size(), "tilt"), plain_text(degrees(scene.tilts.back())),
                     scene.liquid ? counted(scene_fills(scene), "fill") : "no liquid",
                     scene.liquid && scene.liquid->pour == Pour::towards ? ", poured towards the holder" : "",
                     scene.until_poured ? ", until poured" : "");
}

std::string robust_text(const Scene& scene) {
  if (!scene.robust) return "none";
  const RobustData& robust = *scene.robust;
  std::string text = fmt::format("{} deviations, seed {}", robust.count, robust.seed);
  const auto add = [&](const char* name, double value, const char* unit) {
    if (value > 0) text += fmt::format(", {} {}{}", name, plain_text(value), unit);
  };
  add("height", 1e3 * robust.height, " mm");
  add("offset", 1e3 * robust.offset, " mm");
  add("azimuth", degrees(robust.azimuth), " deg");
  add("obliquity", degrees(robust.obliquity), " deg");
  add("roll", degrees(robust.roll), " deg");
  add("friction", robust.friction, "");
  add("hand scale", robust.hand_scale, "");
  return text;
}

}  // namespace

std::array<Rule, RULE_COUNT> scene_rules(const Scene& scene) {
  return {{{"hand", hand_text(scene)},
           {"strength", strength_text(scene)},
           {"arm", arm_text(scene)},
           {"force", force_text(scene)},
           {"states", states_text(scene)},
           {"weights", weights_text(scene)},
           {"gate", has_effort(scene) ? "a worst effort of at most 1" : "none"},
           {"robust settings", robust_text(scene)}}};
}

std::string rule_names() {
  std::vector<std::string> names;
  for (const Rule& rule : scene_rules(Scene())) names.emplace_back(rule.name);
  return joined(names, ", ");
}

std::array<bool, RULE_COUNT> shared_rules(const Scene& a, const Scene& b) {
  return {build_of(a) == build_of(b) && a.hand.scale == b.hand.scale && a.hand.handedness == b.hand.handedness,
          a.strength == b.strength,
          a.arm == b.arm,
          force_of(a) == force_of(b),
          states_of(a) == states_of(b),
          effective_weights(a) == effective_weights(b),
          has_effort(a) == has_effort(b),
          a.robust == b.robust};
}

std::string weights_text(const Scene& scene) {
  const auto weights = effective_weights(scene);
  const std::array<const char*, 6> names{"fingers", "contacts", "depth", "posture", "force", "hold"};
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < names.size(); ++k)
    if (weights[k] > 0) parts.push_back(fmt::format("{} {}", names[k], plain_text(weights[k])));
  return joined(parts, ", ");
}

}  // namespace wholehand::sweeps
