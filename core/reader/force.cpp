// SPDX-License-Identifier: MIT
// [force], [strength], [score] and [output]: what is made of the states, and what is kept.
#include <fmt/format.h>

#include <algorithm>

#include "core/reader/parts.h"

namespace wholehand {
namespace {

// Names of result variables, each once.
void read_variables(const SceneTable& output, const char* key, std::string& place, std::vector<std::string>& names) {
  const SceneFile& file = output.file();
  place = file.text_of(output.place(key));
  for (const toml::node& node : *output.array(key, 0, ranges::LARGEST_KEEP, "names of result variables")) {
    const auto* name = node.as_string();
    if (!name || !is_plain_name(name->get()))
      file.refuse(place_of(node), fmt::format("a name in {} {}", key, found(node)), "allowed: names of result variables");
    if (std::find(names.begin(), names.end(), name->get()) != names.end()) {
      file.refuse(place_of(node), fmt::format("{} names {} a second time", key, in_quotes(name->get())), "allowed: each name once");
    }
    names.push_back(name->get());
  }
}

}  // namespace

void read_force(const SceneTable& root, ForceData& force) {
  const auto table =
      root.table("force", {"base_N", "range_N", "torque", "reference", "max_N", "k_open_N_m", "friction", "torsion_mm"});
  if (!table) return;
  table->read("base_N", ranges::BASE_FORCE, force.base);
  table->read("range_N", ranges::FORCE_RANGE, force.range);
  table->read("torque", {{"paper", Torque::paper}, {"exact", Torque::exact}}, force.torque);
  table->read("reference", {{"per_object", TorqueReference::per_object}, {"per_grip", TorqueReference::per_grip}}, force.reference);
  table->read("max_N", ranges::MAX_FORCE, force.max);
  table->read("k_open_N_m", ranges::OPENING_STIFFNESS, force.k_open);
  table->read("friction", ranges::FRICTION, force.friction);
  table->read("torsion_mm", ranges::TORSION, force.torsion);
}

void read_strength(const SceneTable& root, std::optional<StrengthData>& strength) {
  constexpr std::array<const char*, FINGER_COUNT + 1> KEYS{"thumb_N", "index_N", "middle_N", "ring_N", "little_N", "palm_N"};
  std::vector<std::string_view> keys{KEYS.begin(), KEYS.end()};
  keys.insert(keys.end(), {"opening", "efforts"});
  const auto table = root.table("strength", keys);
  if (!table) return;
  bool has_efforts = true;
  table->read_flag("efforts", has_efforts);
  if (!has_efforts) {
    keys.pop_back();
    for (const std::string_view key : keys)
      if (table->has(key))
        root.file().refuse(table->place(key), fmt::format("{} beside efforts = false", key),
                           "allowed: efforts = false alone, or the strengths without it");
    strength.reset();
    return;
  }
  strength.emplace();
  strength->place = root.file().text_of(table->place());
  for (std::size_t digit = 0; digit < KEYS.size(); ++digit)
    table->read(KEYS[digit], ranges::GRIP_STRENGTH, strength->digits[digit]);
  table->read("opening", {{"measured", true}, {"fixed", false}}, strength->by_opening);
}

void read_score(const SceneTable& root, bool has_tilts, ScoreWeights& weights) {
  const auto table = root.table("score", {"fingers", "contacts", "depth", "posture", "force", "hold"});
  if (!table) return;
  table->read("fingers", ranges::WEIGHT, weights.fingers);
  table->read("contacts", ranges::WEIGHT, weights.contacts);
  table->read("depth", ranges::WEIGHT, weights.depth);
  table->read("posture", ranges::WEIGHT, weights.posture);
  table->read("force", ranges::WEIGHT, weights.force);
  table->read("hold", ranges::WEIGHT, weights.hold);
  const double still = weights.fingers + weights.contacts + weights.depth + weights.posture;
  if (still > 0 || (has_tilts && still + weights.force + weights.hold > 0)) return;
  root.file().refuse(table->place(),
                     has_tilts || weights.force + weights.hold == 0
                         ? "[score] gives no term a weight"
                         : "[score] weighs only force and hold, and there are no [tilts]",
                     "allowed: at least one weight above 0 that counts");
}

void read_output(const SceneTable& root, OutputData& output) {
  const auto table = root.table("output", {"keep", "also", "best", "apart_mm"});
  if (!table) return;
  std::int64_t best = output.best;
  table->read("best", ranges::BEST, best);
  output.best = static_cast<int>(best);
  table->read("apart_mm", ranges::APART, output.apart);
  if (table->has("keep") && table->has("also")) {
    root.file().refuse(table->place("also"), "both also and keep are given",
                       "allowed: one of the two; also adds to the usual variables, keep replaces them");
  }
  if (table->has("keep")) read_variables(*table, "keep", output.keep_place, output.keep.emplace());
  if (table->has("also")) read_variables(*table, "also", output.also_place, output.also);
}

}  // namespace wholehand
