// SPDX-License-Identifier: MIT
#include "sweeps/rules.h"

#include <fmt/format.h>

#include <vector>

#include "core/planes.h"
#include "core/text.h"
#include "system/readable.h"

namespace wholehand {
namespace {

// What tells a hand from the default one beside scale and side.
HandData build_of(const Scene& scene) {
  HandData build = scene.hand;
  build.place = "";
  build.scale = HandData().scale;
  build.handedness = HandData().handedness;
  return build;
}

std::string hand_text(const Scene& scene) {
  return fmt::format("{}, scale {}{}", scene.hand.handedness == Handedness::right ? "right" : "left", plain_text(scene.hand.scale),
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

std::array<Rule, RULE_COUNT> rules_of(const Scene& scene) {
  return {{{"hand", hand_text(scene)},
           {"strength", strength_text(scene)},
           {"arm", arm_text(scene)},
           {"weights", weights_text(scene)},
           {"gate", has_effort(scene) ? "a worst effort of at most 1" : "none"},
           {"robust settings", robust_text(scene)}}};
}

std::array<bool, RULE_COUNT> shared_rules(const Scene& a, const Scene& b) {
  return {build_of(a) == build_of(b) && a.hand.scale == b.hand.scale && a.hand.handedness == b.hand.handedness,
          a.strength == b.strength,
          a.arm == b.arm,
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

}  // namespace wholehand
