// SPDX-License-Identifier: MIT
// [people]: how far people differ, and a person from grasp to grasp.
#include <cmath>

#include "core/reader/parts.h"

namespace wholehand {
namespace {

Unit unit_of(std::string_view key) { return key.ends_with("_mm") ? Unit::mm : key.ends_with("_deg") ? Unit::deg : Unit::si; }

// Whole numbers of mm and degrees, so that messages show them as such.
double in_unit(double si, Unit unit) {
  return unit == Unit::mm ? std::round(si * 1e6) / 1e3 : unit == Unit::deg ? std::round(degrees(si) * 1e3) / 1e3 : si;
}

}  // namespace

void read_people(const SceneTable& root, PeopleData& people) {
  std::vector<std::string_view> keys{"women", "scatter", "size", "proportions"};
  for (const TraitFacts& fact : trait_facts()) keys.emplace_back(fact.key);
  const auto table = root.table("people", keys);
  if (!table) return;
  table->read("women", ranges::FRACTION, people.women);
  table->read("scatter", ranges::SCATTER, people.scatter);
  table->read("size", ranges::SCATTER, people.size);
  table->read("proportions", ranges::SCATTER, people.proportions);
  for (std::size_t k = 0; k < TRAIT_COUNT; ++k) {
    const TraitFacts& fact = trait_facts()[k];
    const auto spread = table->table(fact.key, {"mean", "person", "grasp"});
    if (!spread) continue;
    const Unit unit = unit_of(fact.key);
    const Quantity mean{in_unit(fact.low, unit), in_unit(fact.high, unit), unit}, deviation{0, in_unit(fact.widest, unit), unit};
    spread->read("mean", mean, people.traits[k].mean);
    spread->read("person", deviation, people.traits[k].person);
    spread->read("grasp", deviation, people.traits[k].grasp);
  }
}

}  // namespace wholehand
