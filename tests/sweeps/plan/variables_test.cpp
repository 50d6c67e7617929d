// SPDX-License-Identifier: MIT
#include "sweeps/plan/variables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "base/text/error.h"
#include "tests/support/fake_backend.h"
#include "tests/support/refusal.h"

namespace wholehand::sweeps {
namespace {

std::vector<std::string> names(const std::vector<const Variable*>& variables) {
  std::vector<std::string> out;
  for (const Variable* variable : variables) out.push_back(variable->name);
  return out;
}

bool holds(const std::vector<std::string>& all, const std::string& name) {
  return std::find(all.begin(), all.end(), name) != all.end();
}

std::string refusal(const Scene& scene) {
  return refusal_line([&] { choose_variables(scene); });
}

TEST(Variables, NamesAreUniqueAndEveryOneHasUnitsAndAName) {
  std::set<std::string> seen;
  for (const Variable& variable : variable_catalogue()) {
    EXPECT_TRUE(seen.insert(variable.name).second) << variable.name;
    EXPECT_STRNE(variable.units, "") << variable.name;
    EXPECT_STRNE(variable.long_name, "") << variable.name;
    EXPECT_EQ(variable.type == NumberType::real, variable.value == nullptr) << variable.name;
    EXPECT_EQ(variable.type == NumberType::real, variable.field < REAL_FIELDS) << variable.name;
  }
}

TEST(Variables, PlanesFillTheirFields) {
  const Scene scene = fake_scene();
  std::array<int, FIELDS> planes{};
  for (const Variable& variable : variable_catalogue()) {
    if (variable.type == NumberType::real) planes[variable.field] += static_cast<int>(variable_planes(variable, scene));
  }
  for (int field = 0; field < REAL_FIELDS; ++field) {
    EXPECT_EQ(planes[field], field_planes(field, scene_fills(scene), scene.tilts.size())) << "field " << field;
  }
}

TEST(Variables, DefaultHasTermsAndMasksButNoStates) {
  const auto chosen = names(choose_variables(fake_scene()));
  for (const char* name : {"score",
                           "score_fingers",
                           "score_contacts",
                           "score_depth",
                           "score_posture",
                           "score_force",
                           "score_hold",
                           "reason",
                           "plausible",
                           "antipodal",
                           "blocked_mask",
                           "closure",
                           "gap",
                           "phalanx_depth",
                           "palm_depth",
                           "fingers_used",
                           "points_touching",
                           "touch_mask",
                           "used_mask",
                           "projected_tip",
                           "projected_finger",
                           "projected_inner",
                           "projected_tip_mask",
                           "projected_finger_mask",
                           "projected_inner_mask",
                           "contact_angles",
                           "peak_feedback_force",
                           "peak_feedback_tilt",
                           "largest_hold_force",
                           "largest_safe_tilt"}) {
    EXPECT_TRUE(holds(chosen, name)) << name;
  }
  for (const char* name : {"joints", "posed", "proxies", "separation", "midpoint", "torque", "hold_force"}) {
    EXPECT_FALSE(holds(chosen, name)) << name;
  }
  EXPECT_FALSE(keeps_vectors(choose_variables(fake_scene())));
}

TEST(Variables, SceneWithoutTiltsOrProjectionHasNone) {
  Scene scene = fake_scene();
  scene.tilts.clear();
  scene.pose = Pose::rigged;
  const auto chosen = names(choose_variables(scene));
  for (const char* name :
       {"score_force", "score_hold", "peak_feedback_force", "largest_safe_tilt", "projected_tip", "blocked_mask"}) {
    EXPECT_FALSE(holds(chosen, name)) << name;
  }
  scene.pose = Pose::paper;
  EXPECT_TRUE(holds(names(choose_variables(scene)), "projected_tip"));
  EXPECT_FALSE(holds(names(choose_variables(scene)), "blocked_mask"));
}

TEST(Variables, KeepChoosesInTheCataloguesOrderEachOnce) {
  Scene scene = fake_scene();
  scene.output.keep = {{"joints", "score", "reason", "score"}};
  EXPECT_EQ(names(choose_variables(scene)), (std::vector<std::string>{"score", "reason", "joints"}));
  EXPECT_EQ(variable_fields(choose_variables(scene)), (std::vector<int>{FIELD_JOINTS, FIELD_SCORE, FIELD_STATUS}));
  EXPECT_TRUE(keeps_vectors(choose_variables(scene)));
  scene.output.keep = {{"gap"}};
  EXPECT_EQ(variable_fields(choose_variables(scene)), (std::vector<int>{FIELD_GAP, FIELD_STATUS}))
      << "the status tells what is missing";
  scene.output.keep = std::vector<std::string>{};
  EXPECT_TRUE(choose_variables(scene).empty());
  EXPECT_TRUE(variable_fields({}).empty());
}

TEST(Variables, AlsoAddsToTheUsualOnes) {
  Scene scene = fake_scene();
  const auto usual = names(choose_variables(scene));
  scene.output.also = std::vector<std::string>{"joints", "score"};
  auto more = names(choose_variables(scene));
  EXPECT_EQ(more.size(), usual.size() + 1);
  EXPECT_TRUE(holds(more, "joints"));
  std::erase(more, "joints");
  EXPECT_EQ(more, usual);
  scene.output.also = std::vector<std::string>{"jonts"};
  EXPECT_NE(refusal(scene).find("fake.toml: [output] also: unknown variable \"jonts\""), std::string::npos) << refusal(scene);
  scene.output.also = std::vector<std::string>{"torque"};
  scene.tilts.clear();
  EXPECT_NE(refusal(scene).find("[output] also: \"torque\" needs [tilts]"), std::string::npos) << refusal(scene);
}

// Bit operations take whole numbers without exception: a missing value would be one with bits.
TEST(Variables, MasksLackNothing) {
  for (const Variable& variable : variable_catalogue()) {
    const bool is_mask = std::string_view(variable.name).ends_with("_mask");
    EXPECT_EQ(variable.bits > 0, is_mask) << variable.name;
    if (is_mask) {
      EXPECT_EQ(variable.missing, 0) << variable.name;
      EXPECT_FALSE(variable.has_missing()) << variable.name;
      EXPECT_EQ(variable.bits, variable.type == NumberType::byte ? FINGER_COUNT : JOINT_COUNT) << variable.name;
    }
  }
}

TEST(Variables, UnknownNamesAreListedWithTheKnown) {
  Scene scene = fake_scene();
  scene.output.keep = {{"score", "scor", "gapp"}};
  const std::string line = refusal(scene);
  EXPECT_NE(line.find("fake.toml: [output] keep: unknown variables \"gapp\", \"scor\""), std::string::npos) << line;
  EXPECT_NE(line.find("score_fingers, "), std::string::npos) << line;
  EXPECT_NE(line.find("hold_force"), std::string::npos) << line;
}

TEST(Variables, WhatTheSceneCannotHaveIsRefused) {
  Scene scene = fake_scene();
  scene.tilts.clear();
  scene.output.keep = {{"torque"}};
  EXPECT_NE(refusal(scene).find("\"torque\" needs [tilts]"), std::string::npos) << refusal(scene);
  scene.pose = Pose::rigged;
  scene.output.keep = {{"projected_inner"}};
  EXPECT_NE(refusal(scene).find("pose other than \"rigged\""), std::string::npos) << refusal(scene);
  scene.output.keep = {{"blocked_mask"}};
  EXPECT_NE(refusal(scene).find("pose = \"articulated\""), std::string::npos) << refusal(scene);
  for (const char* name : {"table_depth", "through_table"}) {
    scene.table.reset();
    scene.output.keep = {{name}};
    EXPECT_NE(refusal(scene).find("needs [table], which this scene does not have"), std::string::npos) << refusal(scene);
    scene.table.emplace();
    EXPECT_EQ(names(choose_variables(scene)), std::vector<std::string>{name});
    scene.output.keep.reset();
    EXPECT_FALSE(holds(names(choose_variables(scene)), name)) << "it is kept on request";
  }
  for (const char* name : {"wrist_share", "beyond_wrist"}) {
    scene.arm.reset();
    scene.output.keep = {{name}};
    EXPECT_NE(refusal(scene).find("needs [arm], which this scene does not have"), std::string::npos) << refusal(scene);
    scene.output.keep.reset();
    EXPECT_FALSE(holds(names(choose_variables(scene)), name));
    scene.arm.emplace();
    EXPECT_TRUE(holds(names(choose_variables(scene)), name)) << "it is kept by default";
  }
  for (const char* name : {"self_depth", "self_overlap"}) {
    scene.hand.between = 0;
    scene.output.keep = {{name}};
    EXPECT_NE(refusal(scene).find("needs [hand] between, which this scene does not have"), std::string::npos) << refusal(scene);
    scene.hand.between = 1;
    EXPECT_EQ(names(choose_variables(scene)), std::vector<std::string>{name});
    scene.output.keep.reset();
    EXPECT_FALSE(holds(names(choose_variables(scene)), name)) << "it is kept on request";
  }
}

TEST(Variables, WordsAreTakenApart) {
  const auto value = [](const char* name, std::uint32_t word) {
    for (const Variable& variable : variable_catalogue()) {
      if (std::string(name) == variable.name) return variable.value(word);
    }
    ADD_FAILURE() << name;
    return -99;
  };
  const std::uint32_t status = REASON_NONE | STATUS_PLAUSIBLE | (0x14u << STATUS_BLOCKED_SHIFT) | (0x3u << STATUS_UNSETTLED_SHIFT);
  EXPECT_EQ(value("plausible", status), 1);
  EXPECT_EQ(value("antipodal", status), 0);
  EXPECT_EQ(value("antipodal", status | STATUS_ANTIPODAL), 1);
  EXPECT_EQ(value("grazing", STATUS_GRAZING), 1);
  EXPECT_EQ(value("undecided", status), 0);
  EXPECT_EQ(value("undecided", status | STATUS_CONTACT_UNDECIDED), 1);
  EXPECT_EQ(value("proxy_unsettled", STATUS_PROXY_UNSETTLED), 1);
  EXPECT_EQ(value("through_table", status), 0);
  EXPECT_EQ(value("through_table", status | STATUS_THROUGH_TABLE), 1);
  EXPECT_EQ(value("beyond_wrist", status), 0);
  EXPECT_EQ(value("beyond_wrist", status | STATUS_BEYOND_WRIST), 1);
  EXPECT_EQ(value("self_overlap", status), 0);
  EXPECT_EQ(value("self_overlap", status | STATUS_SELF_OVERLAP), 1);
  EXPECT_EQ(value("blocked_mask", status), 0x14);
  EXPECT_EQ(value("unsettled_mask", status), 0x3);
  EXPECT_EQ(value("reason", status | REASON_TOO_NARROW), REASON_TOO_NARROW);
  EXPECT_EQ(value("points_touching", 0xFFFFFF), 24);
  EXPECT_EQ(value("touch_mask", 0xFFFFFF), 0xFFFFFF);
  EXPECT_EQ(value("fingers_used", 0x15), 3);
  EXPECT_EQ(value("projected_inner", 0x101), 2);
}

// Where a scene leaves out no tilt, every comment is the catalogue's.
TEST(Variables, CommentsTellWhichTiltsAreLeftOut) {
  Scene scene = fake_scene();
  for (const Variable& variable : variable_catalogue()) EXPECT_EQ(variable_comment(variable, scene), variable.comment);
  scene.until_poured = 0.25;
  const auto comment = [&](std::string_view name) {
    for (const Variable& variable : variable_catalogue())
      if (name == variable.name) return variable_comment(variable, scene);
    return std::string("no such variable");
  };
  const std::string tilts = "the tilts beyond the first at which 0.25 of the fill has poured (until_poured)";
  EXPECT_EQ(comment("feedback_force"), "normal force clamped to [0, F_max]; NaN at " + tilts);
  EXPECT_EQ(comment("pivot_length"), "NaN at " + tilts);
  EXPECT_EQ(comment("peak_feedback_force"), "leaves out " + tilts);
  EXPECT_EQ(
      comment("largest_hold_force"),
      "infinite where no such force holds the vessel: without strengths where the pinch is not antipodal; with strengths NaN where "
      "the grip is implausible; leaves out " +
          tilts);
  EXPECT_TRUE(comment("score_hold").ends_with("; leaves out " + tilts));
  EXPECT_EQ(comment("gap"), "");
  EXPECT_EQ(comment("score_depth").find("until_poured"), std::string::npos);
}

TEST(Variables, BytesPerGripAreThoseOfTheFile) {
  Scene scene = fake_scene();
  scene.output.keep = {{"score", "joints", "reason", "touch_mask", "torque"}};
  EXPECT_EQ(bytes_per_grip(choose_variables(scene), scene, 4), 4 + 72 * 4 + 1 + 4 + 8 * 4);
}

}  // namespace
}  // namespace wholehand::sweeps
