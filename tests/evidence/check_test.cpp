// SPDX-License-Identifier: MIT
// sanitizers: none
#include "evidence/check.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scene/reader.h"
#include "scene/shipped.h"
#include "system/json.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand {
namespace {

Scene small_scene() { return read_scene_file(find_scene("small")); }

// A report in which these hold; `exact` as well: -1 where the device has no double.
CheckReport report_of(bool translation, bool cost, int exact) {
  CheckReport report;
  report.translation.feasible = 5;
  report.translation.holds = translation;
  report.cost.holds = cost;
  if (exact >= 0) report.exact = CheckedPair{};
  if (exact >= 0) report.exact->holds = exact == 1;
  return report;
}

TEST(Check, AForeignNameIsNoFailure) {
  CheckReport report = report_of(true, true, 1);
  report.driver = "driver \xff";  // no UTF-8
  EXPECT_EQ(parse_json(check_json(report))["driver"], "driver \uFFFD");
}

TEST(Check, HoldsWhereTheTwinsAgree) {
  const CheckReport report = check_scene(small_scene(), {});
  EXPECT_TRUE(verdict_of(report).holds) << check_text(report);
  ASSERT_EQ(report.vessels.size(), 1u);
  EXPECT_EQ(report.vessels[0].own, 72u);
  EXPECT_EQ(report.vessels[0].between, 952u);
  EXPECT_EQ(report.translation.grips, 1024u);

  const std::string text = check_text(report);
  EXPECT_EQ(text.find("holds: the device computes what the core computes\n"), 0u) << text;
  EXPECT_NE(text.find("tumbler: 72 grips of the scene and 952 more between and around them"), std::string::npos) << text;

  const std::string line = check_json(report);
  EXPECT_EQ(line.find("{\"holds\":true,\"verdict\":"), 0u) << line;
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  const auto json = parse_json(line);
  EXPECT_EQ(json["scene"], "small");
  EXPECT_TRUE(json["advice"].is_null());
  EXPECT_EQ(json["vessels"][0]["grips_between"], 952);
  ASSERT_EQ(json["comparisons"].size(), json["precisions"].size() + 1);
  const auto& first = json["comparisons"][0];
  EXPECT_EQ(first["name"], "device_float_core_float");
  EXPECT_EQ(first["grips"], 1024);
  EXPECT_EQ(first["allowed"], allowed_flips(1024 - report.translation.grazing));
  for (const auto& quantity : first["quantities"]) {
    EXPECT_EQ(quantity["holds"], true) << quantity;
    EXPECT_EQ(quantity["where"].is_null(), quantity["worst"] == 0) << quantity;
  }
}

TEST(Check, SaysNoWhereAConstantDiffersOnOneSide) {
  const Scene scene = small_scene();
  Scene broken = scene;
  broken.hand.fingers[2].radii[4] += 50e-6;  // the middle fingertip is 50 micrometres thicker on the device
  CheckOptions options;
  options.device_scene = &broken;
  const CheckReport report = check_scene(scene, options);
  const CheckVerdict verdict = verdict_of(report);
  EXPECT_FALSE(verdict.holds);
  EXPECT_EQ(verdict.advice, "use --on core") << "neither precision of this device is right";
  EXPECT_EQ(check_text(report).find("DOES NOT HOLD: the device does NOT compute what the core computes"), 0u);
  const auto json = parse_json(check_json(report));
  EXPECT_EQ(json["holds"], false);
  EXPECT_EQ(json["comparisons"][1]["holds"], true) << "the core is not the device";
  bool found = false;
  for (const auto& quantity : json["comparisons"][0]["quantities"])
    found =
        found || (quantity["quantity"] == "posed joints" && quantity["outside"] > 100 && quantity["where"]["vessel"] == "tumbler");
  EXPECT_TRUE(found);
}

TEST(Check, HoldsWithoutAContactToleranceOrADepth) {
  Scene scene = small_scene();
  scene.hand.contact_tolerance = 0;
  scene.hand.depth_limit = 0;
  const CheckReport report = check_scene(scene, {});
  EXPECT_TRUE(verdict_of(report).holds) << check_text(report);
}

TEST(Check, SaysNoWhereNothingCouldBeCompared) {
  Scene scene = small_scene();
  scene.grips.offset.values = {0.2};  // every line misses the vessel
  const CheckReport report = check_scene(scene, {});
  EXPECT_EQ(check_text(report).find("DOES NOT HOLD: nothing was compared: no grip of the sample is feasible\n"), 0u);
}

TEST(Check, AdvisesWhatTheComparisonsHaveShown) {
  EXPECT_TRUE(verdict_of(report_of(true, true, 1)).holds);
  EXPECT_TRUE(verdict_of(report_of(true, true, -1)).holds);
  for (const bool translation : {false, true}) {
    for (const bool cost : {false, true}) {
      for (const int exact : {-1, 0, 1}) {
        if (translation && cost && exact != 0) continue;
        const CheckVerdict verdict = verdict_of(report_of(translation, cost, exact));
        const std::string what = std::to_string(translation) + std::to_string(cost) + std::to_string(exact) + " " + verdict.advice;
        EXPECT_FALSE(verdict.holds) << what;
        EXPECT_EQ(verdict.advice.find("--precision double") != std::string::npos, exact == 1) << what;
        EXPECT_EQ(verdict.advice.find("--precision float") != std::string::npos, translation && cost) << what;
        EXPECT_EQ(verdict.advice.find("--on core") != std::string::npos, exact != 1) << what;
      }
    }
  }
}

TEST(Check, RefusesTheCoreAsADevice) {
  CheckOptions options;
  options.on = "core";
  EXPECT_THROW(check_scene(small_scene(), options), Error);
}

}  // namespace
}  // namespace wholehand
