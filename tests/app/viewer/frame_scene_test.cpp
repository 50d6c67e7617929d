// SPDX-License-Identifier: MIT
// The scene of a view as the page gets it: what does not change while the frames come.
// sanitizers: address
#include "app/viewer/scene.h"
#include "core/joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

#include <nlohmann/json.hpp>

#include "base/files/json.h"
#include "core/mesh_body.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "device/session/hand_view.h"
#include "sweeps/grips/hand_nodes.h"
#include "tests/support/live_script.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using nlohmann::json;

TEST(ViewScene, TellsWhatDoesNotChange) {
  const Scene scene = read_scene_file(find_scene("mixing_board"));
  ViewFacts facts;
  facts.title = "a \"board\"";
  facts.device = "sim";
  facts.rate = 1000;
  const json seen = parse_json(view_scene_json(scene, facts));
  EXPECT_EQ(seen["mode"], "live");
  EXPECT_EQ(seen["title"], "a \"board\"");
  EXPECT_EQ(seen["device"], "sim");
  EXPECT_EQ(seen["handedness"], "right");
  EXPECT_EQ(seen["control"], false);
  EXPECT_FALSE(seen.contains("control_limits") || seen.contains("duration") || seen.contains("grips"));
  EXPECT_EQ(seen["rate"], 1000);
  ASSERT_EQ(seen["joints"].size(), static_cast<std::size_t>(JOINT_COUNT));
  for (int f = 0; f < FINGER_COUNT; ++f) {
    for (int k = 0; k < finger_joints(f); ++k) {
      const int j = finger_start(f) + k;
      const json& joint = seen["joints"][static_cast<std::size_t>(j)];
      EXPECT_EQ(joint["name"], JOINT_NAMES[j].webxr);
      EXPECT_EQ(joint["parent"], k == 0 ? -1 : j - 1);
      EXPECT_EQ(joint["radius"], scene.hand.fingers[f].radii[k]);
    }
  }
  EXPECT_EQ(seen["table_y"], 0);
  EXPECT_EQ(seen["target"]["place"], json(scene.task->target_place));
  EXPECT_EQ(seen["target"]["diameter"], scene.task->target_diameter);
  EXPECT_EQ(seen["target"]["wall"], device::TARGET_WALL);
  EXPECT_EQ(seen["destination"], json(scene.task->destination));
  ASSERT_EQ(seen["amounts"].size(), 3u);
  EXPECT_EQ(seen["amounts"][0], json({{"liquid", "blue"}, {"target_m3", 50e-6}}));
  EXPECT_EQ(seen["tolerance_m3"], 5e-6);
  EXPECT_EQ(seen["force"], json({{"base", 0.8}, {"max", 8.0}, {"most", 8.0}})) << "no gripper says less";
  facts.most_force = 5;
  EXPECT_EQ(parse_json(view_scene_json(scene, facts))["force"]["most"], 5.0);
  EXPECT_EQ(seen["states"], json({"free", "touching", "lift", "tilt", "maintain", "slipped", "released", "let go"}));
}

TEST(ViewScene, StrengthsAreThereWhereTheSceneHasThem) {
  Scene scene = live_scene();
  EXPECT_FALSE(parse_json(view_scene_json(scene, {})).contains("strength"));
  scene.strength = StrengthData{{1, 2, 3, 4, 5, 6}, true, {}};
  EXPECT_EQ(parse_json(view_scene_json(scene, {}))["strength"], json({1.0, 2.0, 3.0, 4.0, 5.0, 6.0}));
}

TEST(ViewScene, SaysWhereVesselsSlide) {
  Scene scene = live_scene();
  EXPECT_FALSE(parse_json(view_scene_json(scene, {})).contains("slides"));
  scene.live.slide = true;
  EXPECT_EQ(parse_json(view_scene_json(scene, {}))["slides"], true);
  ViewFacts grips;
  grips.mode = ViewMode::grips;
  EXPECT_FALSE(parse_json(view_scene_json(scene, grips)).contains("slides")) << "a listed grip holds still";
}

TEST(ViewScene, ATitleMayBeAnyBytes) {
  ViewFacts facts;
  facts.title = "m\xfc.nc";  // a file's name in Latin-1
  EXPECT_EQ(parse_json(view_scene_json(live_scene(), facts))["title"], "m\\xfc.nc");
}

// The distance of a point of the half plane from a polyline.
double distance_to(const json& line, double r, double y) {
  double least = 1;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const double ar = line[k][0], ay = line[k][1], br = line[k + 1][0], by = line[k + 1][1];
    const double length = (br - ar) * (br - ar) + (by - ay) * (by - ay);
    const double t = length > 0 ? std::clamp(((r - ar) * (br - ar) + (y - ay) * (by - ay)) / length, 0.0, 1.0) : 0;
    least = std::min(least, std::hypot(r - ar - t * (br - ar), y - ay - t * (by - ay)));
  }
  return least;
}

TEST(ViewScene, OutlinesAndWallsAreThoseOfTheVessels) {
  const Scene scene = read_scene_file(find_scene("mixing_board"));
  const json seen = parse_json(view_scene_json(scene, {}));
  const device::LiveScene live(scene);
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const json& vessel = seen["vessels"][v];
    EXPECT_EQ(vessel["name"], scene.vessels[v].name);
    EXPECT_EQ(vessel["place"], json(scene.vessels[v].place));
    EXPECT_EQ(vessel["liquid"], scene.vessels[v].liquid_name.empty() ? json(nullptr) : json(scene.vessels[v].liquid_name));
    EXPECT_EQ(vessel["base"], scene.vessels[v].base);
    EXPECT_EQ(vessel["height"], scene.vessels[v].height);
    EXPECT_EQ(vessel["radius"], live.vessels[v].radius);
    EXPECT_FALSE(vessel.contains("mesh"));
    const json &outline = vessel["outline"], &inner = vessel["inner"];
    EXPECT_EQ(outline.front()[0], 0);
    EXPECT_EQ(inner.front()[0], 0);
    EXPECT_NEAR(outline.back()[1].get<double>(), scene.vessels[v].height, 1e-12) << "up to the rim";
    EXPECT_NEAR(inner.back()[1].get<double>(), scene.vessels[v].height, 1e-12);
    EXPECT_NEAR(inner.back()[0].get<double>(), live.vessels[v].vessel.mouth_radius, 1e-12);
    for (const json& point : outline) {
      const core_f64::Vec3 p(point[0].get<double>(), point[1].get<double>(), 0);
      EXPECT_NEAR(core_f64::signed_distance(live.vessels[v].vessel, p), 0, 1e-9);
    }
    // each point of the inner wall is a wall's thickness from the outer one, which the polyline is but for its sagitta
    for (const json& point : inner) {
      const double away = distance_to(outline, point[0], point[1]);
      EXPECT_LE(away, scene.vessels[v].wall + 1e-9);
      EXPECT_GE(away, scene.vessels[v].wall - 20e-6) << point;
    }
    ASSERT_EQ(vessel["guidance"].size(), live.vessels[v].guidance.size());
    for (std::size_t k = 0; k < live.vessels[v].guidance.size(); ++k) {
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(vessel["guidance"][k][static_cast<std::size_t>(axis)].get<double>(), live.vessels[v].guidance[k][axis], 1e-9);
    }
  }
}

TEST(ViewScene, ALeftHandsGuidanceIsInTheScenesOwnWorld) {
  Scene scene = read_scene_file(find_scene("mixing_board"));
  scene.vessels[1].guidance[0].azimuth = 0.4;
  const json right = parse_json(view_scene_json(scene, {}));
  scene.hand.handedness = Handedness::left;
  const json left = parse_json(view_scene_json(scene, {}));
  EXPECT_EQ(left["handedness"], "left");
  EXPECT_EQ(left["vessels"], right["vessels"]);
  // and where the session has it, mirrored
  const device::LiveScene live(scene);
  const core_f64::Vec3 there = live.vessels[1].guidance[0];
  EXPECT_NEAR(left["vessels"][1]["guidance"][0][0].get<double>(), -there.x, 1e-9);
  EXPECT_NEAR(left["vessels"][1]["guidance"][0][2].get<double>(), there.z, 1e-9);
}

TEST(ViewScene, SolidGlassIsClosedAndASceneWithoutATaskHasNoTarget) {
  const Scene scene = scene_of({ledges()});
  const json seen = parse_json(view_scene_json(scene, {}));
  EXPECT_FALSE(seen["vessels"][0].contains("inner"));
  EXPECT_EQ(seen["vessels"][0]["outline"].back()[0], 0);
  EXPECT_TRUE(seen["target"].is_null() && seen["destination"].is_null() && seen["tolerance_m3"].is_null());
  EXPECT_TRUE(seen["amounts"].empty());
}

TEST(ViewScene, AMeshIsTwoCountsPositionsAndIndices) {
  VesselData vessel = beaker1();
  EXPECT_EQ(mesh_bytes(vessel), "");
  auto body = std::make_shared<MeshBody>();
  body->vertices = {{0, 0, 0}, {0.1, 0, 0}, {0, -0.25, 0}, {0, 0, 1}};
  body->triangles = {{0, 1, 2}, {3, 2, 1}};
  vessel.mesh = MeshData{};
  vessel.mesh->body = body;
  const std::string bytes = mesh_bytes(vessel);
  ASSERT_EQ(bytes.size(), 4u * (2 + 12 + 6));
  const auto whole = [&](std::size_t k) {
    std::uint32_t value = 0;
    for (std::size_t b = 0; b < 4; ++b)
      value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[4 * k + b])) << (8 * b);
    return value;
  };
  const auto real = [&](std::size_t k) {
    const std::uint32_t bits = whole(k);
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  };
  EXPECT_EQ(whole(0), 4u);
  EXPECT_EQ(whole(1), 2u);
  EXPECT_EQ(real(2 + 3), 0.1f);
  EXPECT_EQ(real(2 + 7), -0.25f);
  EXPECT_EQ(real(2 + 11), 1.0f);
  EXPECT_EQ(whole(14 + 0), 0u);
  EXPECT_EQ(whole(14 + 3), 3u);
  EXPECT_EQ(whole(14 + 5), 1u);
}

}  // namespace
}  // namespace wholehand
