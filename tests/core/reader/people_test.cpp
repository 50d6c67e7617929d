// SPDX-License-Identifier: MIT
// [people]: every key and what is refused, and the page that has their sources.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/people_data.h"
#include "core/reader/reader.h"
#include "tests/support/files.h"
#include "tests/support/scene_texts.h"

namespace wholehand {
namespace {

const Spread& spread_of(const Scene& scene, Trait trait) { return scene.people.traits[static_cast<std::size_t>(trait)]; }

TEST(ScenePeople, AreThePublishedOnesWithoutTheTable) {
  const PeopleData people = scene_from(VESSEL).people;
  EXPECT_EQ(people.women, 0.5);
  EXPECT_EQ(people.scatter, 1);
  for (std::size_t k = 0; k < TRAIT_COUNT; ++k) EXPECT_EQ(people.traits[k].person, trait_facts()[k].spread.person);
}

TEST(ScenePeople, EveryNumberCanBeChanged) {
  const Scene scene = scene_from(
      "[people]\nwomen = 0.25\nscatter = 2\nsize = 0.5\nproportions = 0\nheight_mm = { person = 3 }\nroll_deg = { mean = -30, "
      "person "
      "= 0, grasp = 2 }\nreaction_s = { mean = 0.1, person = 0.02, grasp = 0 }\n" +
      VESSEL);
  EXPECT_EQ(scene.people.women, 0.25);
  EXPECT_EQ(scene.people.scatter, 2);
  EXPECT_EQ(scene.people.size, 0.5);
  EXPECT_EQ(scene.people.proportions, 0);
  EXPECT_EQ(spread_of(scene, Trait::height).person, 3e-3);
  EXPECT_EQ(spread_of(scene, Trait::height).grasp, 7e-3);
  EXPECT_EQ(spread_of(scene, Trait::roll).mean, radians(-30));
  EXPECT_EQ(spread_of(scene, Trait::roll).grasp, radians(2));
  EXPECT_EQ(spread_of(scene, Trait::reaction).mean, 0.1);
  EXPECT_EQ(spread_of(scene, Trait::gain).mean, 1);
}

TEST(ScenePeople, RefusesWhatNoPopulationHas) {
  expect_refusal("[people]\nheight_mm = { person = @-3 }\n" + VESSEL, "person = -3; allowed: 0 to 100");
  expect_refusal("[people]\nroll_deg = { grasp = @-1 }\n" + VESSEL, "grasp = -1; allowed: 0 to 90");
  expect_refusal("[people]\nmargin = { mean = @1 }\n" + VESSEL, "mean = 1; allowed: 0.001 to 0.9");
  expect_refusal("[people]\nreaction_s = { mean = @0 }\n" + VESSEL, "mean = 0; allowed: 0.001 to 0.5");
  expect_refusal("[people]\ngain = @2\n" + VESSEL, "gain = 2; allowed: a table");
  expect_refusal("[people]\nscatter = @-1\n" + VESSEL, "scatter = -1; allowed: 0 to 10");
  expect_refusal("[people]\nwomen = @50\n" + VESSEL, "women = 50; allowed: 0 to 1");
  expect_refusal("[people]\n@hight_mm = { person = 1 }\n" + VESSEL,
                 "unknown key 'hight_mm' in [people]; the nearest known key is 'height_mm'");
  expect_refusal("[people]\ngain = { @spread = 1 }\n" + VESSEL, "unknown key 'spread' in [people.gain]");
}

constexpr std::array<const char*, 3> ORIGINS{"published", "mean published, spread ours", "ours"};  // in the order of Origin

// In the unit of the key.
double shown(const char* key, double si) {
  const std::string_view name(key);
  const double value = name.ends_with("_mm") ? si * 1e3 : name.ends_with("_deg") ? degrees(si) : si;
  return std::round(value * 1e9) / 1e9;
}

TEST(ScenePeople, EveryNumberIsInTheReferenceWithItsSource) {
  const std::string page = file_text(std::string(WHOLEHAND_SOURCE_DIR) + "/docs/people.md");
  const std::string scene = file_text(std::string(WHOLEHAND_SOURCE_DIR) + "/docs/scene.md");
  for (const TraitFacts& fact : trait_facts()) {
    const Spread& s = fact.spread;
    const auto numbers = [&](double value) { return fmt::format("{:g}", shown(fact.key, value)); };
    const std::string row = fmt::format("| `{}` | {} | {} | {} | {} |", fact.key, numbers(s.mean), numbers(s.person),
                                        numbers(s.grasp), ORIGINS[static_cast<std::size_t>(fact.origin)]);
    EXPECT_NE(page.find(row), std::string::npos) << "docs/people.md lacks " << row;
    EXPECT_NE(scene.find(fmt::format("`{}`", fact.key)), std::string::npos) << "docs/scene.md lacks " << fact.key;
  }
}

}  // namespace
}  // namespace wholehand
