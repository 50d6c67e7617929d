// SPDX-License-Identifier: MIT
// sanitizers: none
#include "evidence/check/check.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/files/json.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "evidence/check/check_sample.h"
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

TEST(Check, SaysWhetherProductsAreRounded) {
  CheckReport report = report_of(true, true, 1);
  EXPECT_NE(check_text(report).find("  the driver rounds products before it adds them"), std::string::npos);
  EXPECT_EQ(parse_json(check_json(report))["contracted"].size(), 0u);
  report.contracted = {"float", "double"};
  EXPECT_NE(check_text(report).find(
                "does NOT round products before it adds them, as the kernels ask (NoContraction), in float and double\n"),
            std::string::npos);
  EXPECT_EQ(parse_json(check_json(report))["contracted"][0], "float");
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
  EXPECT_TRUE(json["contracted"].empty());
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
  broken.hand.fingers[2].radii[4] += 50e-6;  // the middle fingertip is 50 micrometers thicker on the device
  CheckOptions options;
  options.device_scene = &broken;
  const CheckReport report = check_scene(scene, options);
  const CheckVerdict verdict = verdict_of(report);
  EXPECT_FALSE(verdict.holds);
  EXPECT_EQ(verdict.advice, "sweep with --on core") << "neither precision of this device is right";
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
        EXPECT_TRUE(verdict.advice.starts_with("sweep with --")) << what << ": check itself has no such options";
        EXPECT_EQ(verdict.advice.find("--precision double") != std::string::npos, exact == 1) << what;
        EXPECT_EQ(verdict.advice.find("--precision float") != std::string::npos, translation && cost) << what;
        EXPECT_EQ(verdict.advice.find("--on core") != std::string::npos, exact != 1) << what;
      }
    }
  }
}

// A difference is the device's, unless the core in float is itself off there and the device in float no further.
TEST(Check, BlamesTheDeviceOnlyForWhatIsItsOwn) {
  const Scene scene = small_scene();
  const auto core = make_core_evaluator(scene);
  const std::vector<GripInput> grips = check_sample(scene, sweeps::Plan(scene, true), 0).grips;
  const GatheredPlanes right = gather(*core, compared_fields(scene), 0, grips);
  const auto score_off = [&](double by) {
    GatheredPlanes planes = right;
    for (std::size_t i = 0; i < planes.count; ++i) {
      double& score = planes.reals[static_cast<std::size_t>(planes.fields.plane[FIELD_SCORE]) * planes.count + i];
      if (score > 0) {
        score += by;
        break;
      }
    }
    return planes;
  };
  const auto of_precision = [&](const GatheredPlanes& device, const GatheredPlanes& core_float) {
    const auto compared = [&](const GatheredPlanes& a, const GatheredPlanes& b, Allowance allowed) {
      Comparer comparer(scene, *core, allowed);
      comparer.add(0, grips, a, b);
      return comparer;
    };
    const Comparer translation = compared(device, core_float, allowance(Precision::single));
    EXPECT_FALSE(translation.holds());
    return is_of_precision(translation, compared(core_float, right, float_against_double()),
                           compared(device, right, float_against_double()));
  };
  EXPECT_TRUE(of_precision(right, score_off(0.2))) << "the core in float alone is off";
  EXPECT_TRUE(of_precision(score_off(0.1), score_off(0.2))) << "both are off, the device less";
  EXPECT_FALSE(of_precision(score_off(0.2), right)) << "the device alone is off";
  EXPECT_FALSE(of_precision(score_off(0.4), score_off(0.2))) << "both are off, the device more";

  CheckReport report = report_of(false, false, 1);
  report.is_of_precision = true;
  EXPECT_EQ(verdict_of(report).text, "single precision costs this scene more than the tolerances");
  EXPECT_EQ(verdict_of(report).advice, "sweep with --precision double, which holds");
}

TEST(Check, ARemedyNamesTheCommandThatHasIt) {
  EXPECT_STREQ(check_error(failure_error("it was lost; try again", Remedy::or_core)).what(),
               "it was lost; try again, or sweep with --on core");
  EXPECT_STREQ(check_error(failure_error("no memory", Remedy::core)).what(), "no memory; sweep with --on core");
  EXPECT_EQ(check_error(failure_error("no memory", Remedy::core)).remedy, Remedy::none);
}

TEST(Check, RefusesTheCoreAsADevice) {
  CheckOptions options;
  options.on = "core";
  EXPECT_THROW(check_scene(small_scene(), options), Error);
}

}  // namespace
}  // namespace wholehand
