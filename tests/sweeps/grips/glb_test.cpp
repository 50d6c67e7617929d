// SPDX-License-Identifier: MIT
// A grip as glTF, opened again by tinygltf: nodes, places, bounds, the liquid's volume, and the extras.
// sanitizers: address
#include "sweeps/grips/glb.h"

#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "base/files/json.h"
#include "base/text/error.h"
#include "sweeps/grips/hand_nodes.h"
#include "sweeps/grips/states.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace wholehand::sweeps {
namespace {

const GripInput GRIP{0.0585, 0.5, 0.1, 0.38, 0.002, 1};

GripReport report_of(const Scene& scene, std::size_t vessel, const GripInput& grip, const StateAxes& axes) {
  return make_grip_report(scene, vessel, grip, axes, core_grip_methods(scene, make_core_evaluator(scene), "core"));
}

tinygltf::Model opened(const std::string& bytes) {
  tinygltf::Model model;
  std::string error, warning;
  EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromMemory(
      &model, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<unsigned int>(bytes.size())));
  EXPECT_EQ(error, "");
  EXPECT_EQ(warning, "");
  return model;
}

int index_of_node(const tinygltf::Model& model, const std::string& name) {
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    if (model.nodes[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

glm::dmat4 local_matrix(const tinygltf::Node& node) {
  glm::dmat4 m(1);
  const auto& t = node.translation;
  const auto& r = node.rotation;
  if (!t.empty()) m = glm::translate(m, glm::dvec3(t[0], t[1], t[2]));
  if (!r.empty()) m *= glm::mat4_cast(glm::dquat(r[3], r[0], r[1], r[2]));
  if (!node.scale.empty()) m = glm::scale(m, glm::dvec3(node.scale[0], node.scale[1], node.scale[2]));
  return m;
}

// Every node's place in the world, and how often each is reached from the scene.
void walk(const tinygltf::Model& model, int node, const glm::dmat4& above, std::map<std::string, glm::dmat4>& places) {
  const glm::dmat4 here = above * local_matrix(model.nodes[node]);
  EXPECT_TRUE(places.emplace(model.nodes[node].name, here).second) << model.nodes[node].name;
  for (const int child : model.nodes[node].children) walk(model, child, here, places);
}

std::map<std::string, glm::dmat4> places_of(const tinygltf::Model& model) {
  std::map<std::string, glm::dmat4> places;
  for (const int node : model.scenes[0].nodes) walk(model, node, glm::dmat4(1), places);
  return places;
}

// Numbers of an accessor, checked against its own least and largest.
std::vector<double> numbers(const tinygltf::Model& model, int index) {
  const tinygltf::Accessor& accessor = model.accessors[index];
  const tinygltf::BufferView& view = model.bufferViews[accessor.bufferView];
  const std::size_t width = static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
  std::vector<double> values(accessor.count * width);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const unsigned char* at = model.buffers[0].data.data() + view.byteOffset + accessor.byteOffset + 4 * i;
    float real = 0;
    std::uint32_t whole = 0;
    std::memcpy(&real, at, 4);
    std::memcpy(&whole, at, 4);
    values[i] = accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT ? static_cast<double>(real) : whole;
  }
  for (std::size_t k = 0; k < accessor.minValues.size(); ++k) {
    double low = values[k], high = values[k];
    for (std::size_t i = k; i < values.size(); i += width) {
      low = std::min(low, values[i]);
      high = std::max(high, values[i]);
    }
    EXPECT_EQ(accessor.minValues[k], low) << index;
    EXPECT_EQ(accessor.maxValues[k], high) << index;
  }
  return values;
}

const tinygltf::Primitive& primitive_of(const tinygltf::Model& model, const std::string& name) {
  return model.meshes[model.nodes[index_of_node(model, name)].mesh].primitives[0];
}

double volume_of(const tinygltf::Model& model, const std::string& name) {
  const tinygltf::Primitive& primitive = primitive_of(model, name);
  const std::vector<double> p = numbers(model, primitive.attributes.at("POSITION")), corners = numbers(model, primitive.indices);
  const auto point = [&](double corner) {
    const auto at = static_cast<std::size_t>(corner) * 3;
    return glm::dvec3(p[at], p[at + 1], p[at + 2]);
  };
  double six = 0;
  for (std::size_t t = 0; t < corners.size(); t += 3)
    six += glm::dot(point(corners[t]), glm::cross(point(corners[t + 1]), point(corners[t + 2])));
  return six / 6;
}

StateAxes one_state(double fill, double tilt_deg) { return {{fill}, {radians(tilt_deg)}}; }

TEST(GripGlb, JointsAreWhereTheHandIs) {
  for (const Handedness handedness : {Handedness::right, Handedness::left}) {
    Scene scene = three_beakers();
    scene.hand.handedness = handedness;
    const GripReport report = report_of(scene, 0, GRIP, one_state(0.5, 30));
    const tinygltf::Model model = opened(grip_glb(scene, 0, report));
    const auto places = places_of(model);
    // pivot, grip, vessel, liquid, wrist, 24 joints and their contact points
    EXPECT_EQ(model.nodes.size(), 5u + 24 + 24);
    EXPECT_EQ(places.size(), model.nodes.size());
    const HandNodes hand = hand_nodes(scene.hand, report.grip, report.answer.result);
    for (int j = 0; j < JOINT_COUNT; ++j) {
      const auto place = places.find(hand.joints[j].name);
      ASSERT_NE(place, places.end()) << hand.joints[j].name;
      const Triple& posed = report.answer.result.posed[j];
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(place->second[3][k], posed[k], 1e-6) << hand.joints[j].name;  // m; as float would do
        EXPECT_NEAR(places.at(std::string(hand.joints[j].name) + " contact")[3][k], posed[k], 1e-6);
      }
      const Quaternion& q = hand.joints[j].rotation;
      const glm::dmat3 expected = glm::mat3_cast(glm::dquat(q[3], q[0], q[1], q[2]));
      for (int axis = 0; axis < 3; ++axis) EXPECT_LT(glm::length(glm::dvec3(place->second[axis]) - expected[axis]), 1e-6);
      const tinygltf::Node& contact = model.nodes[index_of_node(model, std::string(hand.joints[j].name) + " contact")];
      EXPECT_DOUBLE_EQ(contact.scale[0], GLB_BALL_SHARE * hand.joints[j].radius);
      const std::string state = model.nodes[index_of_node(model, hand.joints[j].name)].extras.Get("state").Get<std::string>();
      EXPECT_EQ(model.meshes[contact.mesh].name, state);
      EXPECT_EQ(state, POINT_STYLES[static_cast<std::size_t>(point_state(report.answer.result, j))].name);
    }
  }
}

TEST(GripGlb, BonesReachTheNextJoint) {
  const Scene scene = three_beakers();
  const tinygltf::Model model = opened(grip_glb(scene, 2, report_of(scene, 2, GRIP, one_state(0.5, 0))));
  int bones = 0;
  for (const tinygltf::Node& node : model.nodes) {
    if (node.mesh < 0 || !model.meshes[node.mesh].name.ends_with(" bone")) continue;
    ++bones;
    const int child = node.children.back();  // the next joint is appended after the contact point
    const tinygltf::Accessor& accessor = model.accessors[model.meshes[node.mesh].primitives[0].attributes.at("POSITION")];
    const tinygltf::Node& next = model.nodes[child];
    EXPECT_NEAR(next.translation[0], 0, 1e-12) << node.name;
    EXPECT_NEAR(next.translation[1], 0, 1e-12) << node.name;
    const double far = -accessor.minValues[2] + next.translation[2];                       // what the bone goes beyond it
    EXPECT_NEAR(far, next.extras.Get("radius_m").GetNumberAsDouble(), 1e-8) << node.name;  // floats of less than 0.1 m
  }
  EXPECT_EQ(bones, 19);
}

// The hull of two balls is the union of all balls between them: the distance of a point to it is the least of theirs. It is convex
// along the bone, so thirds find it.
double hull_of_balls_distance(const glm::dvec3& p, const glm::dvec3& to, double near, double far) {
  const auto at = [&](double t) { return glm::length(p - t * to) - (near + t * (far - near)); };
  double low = 0, high = 1;
  for (int k = 0; k < 120; ++k) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (at(a) < at(b) ? high : low) = at(a) < at(b) ? b : a;
  }
  return at(0.5 * (low + high));
}

TEST(GripGlb, BonesAreTheRoundedConesOfTheirJoints) {
  Scene scene = three_beakers();
  for (FingerData& finger : scene.hand.fingers) finger.radii = {9e-3, 8e-3, 6.5e-3, 7e-3, 5e-3};
  scene.hand.fingers[0].radii = {10e-3, 9e-3, 6e-3, 7e-3, 0};
  const tinygltf::Model model = opened(grip_glb(scene, 0, report_of(scene, 0, GRIP, one_state(0.5, 0))));
  int bones = 0;
  for (const tinygltf::Node& node : model.nodes) {
    if (node.mesh < 0 || !model.meshes[node.mesh].name.ends_with(" bone")) continue;
    ++bones;
    const tinygltf::Node& next = model.nodes[node.children.back()];
    const glm::dvec3 to(next.translation[0], next.translation[1], next.translation[2]);
    const double near = node.extras.Get("radius_m").GetNumberAsDouble(), far = next.extras.Get("radius_m").GetNumberAsDouble();
    EXPECT_NE(near, far);
    const tinygltf::Primitive& bone = model.meshes[node.mesh].primitives[0];
    const std::vector<double> places = numbers(model, bone.attributes.at("POSITION")), corners = numbers(model, bone.indices);
    const auto corner = [&](std::size_t k) {
      const auto at = 3 * static_cast<std::size_t>(corners[k]);
      return glm::dvec3(places[at], places[at + 1], places[at + 2]);
    };
    // of 20 faces round, and of arcs in steps of the same angle: each of both takes 1 - cos(pi / 20) of the radius between corners
    const double within = 2 * std::max(near, far) * (1 - std::cos(PI / 20));
    double deepest = 0;
    for (std::size_t t = 0; t < corners.size(); t += 3) {
      // floats of less than 0.1 m are 4e-9 m apart at most, and so are three coordinates together within 1e-8
      for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(hull_of_balls_distance(corner(t + k), to, near, far), 0, 1e-8) << node.name;
      const double middle = hull_of_balls_distance((corner(t) + corner(t + 1) + corner(t + 2)) / 3.0, to, near, far);
      EXPECT_LT(middle, 1e-8) << node.name;
      EXPECT_GT(middle, -within) << node.name;
      deepest = std::min(deepest, middle);
    }
    EXPECT_LT(deepest, -0.1 * within) << "the surface is round, and the faces are flat";
  }
  EXPECT_EQ(bones, 19);
}

TEST(GripGlb, VesselIsTheOutline) {
  const Scene scene = three_beakers();
  for (std::size_t v = 0; v < 3; ++v) {
    GripInput grip = GRIP;
    grip.height = 0.05;
    grip.roll = 0;
    const tinygltf::Model model = opened(grip_glb(scene, v, report_of(scene, v, grip, one_state(0.5, 0))));
    const auto& accessor = model.accessors[primitive_of(model, "vessel").attributes.at("POSITION")];
    const double radius = largest_radius(scene.vessels[v]);
    EXPECT_NEAR(accessor.minValues[1], 0, 1e-9);
    EXPECT_NEAR(accessor.maxValues[1], scene.vessels[v].height, 1e-8);  // m: float of 0.1
    // the belly of the flask lies between two steps of its arc: R (1 - cos(pi / 64)) = 1.2e-3 R
    for (const int k : {0, 2}) EXPECT_NEAR(accessor.maxValues[k], radius, v == 1 ? 6e-5 : 1e-8) << v;
    const glm::dmat4 place = places_of(model).at("vessel");
    EXPECT_LT(glm::length(glm::dvec3(place[3])), 1e-15);  // upright in its own frame
    const tinygltf::Material& material = model.materials[primitive_of(model, "vessel").material];
    EXPECT_EQ(material.alphaMode, "BLEND");
    EXPECT_LT(material.pbrMetallicRoughness.baseColorFactor[3], 1);
  }
}

TEST(GripGlb, LiquidIsThatOfItsState) {
  const Scene scene = three_beakers();
  for (const double tilt : {0.0, 40.0}) {
    const GripReport report = report_of(scene, 2, {0.03, 0.5, 0, 0, 0, 1}, one_state(0.5, tilt));
    const double volume = report.answer.states[0].liquid.volume;
    std::vector<double> errors;
    for (const int segments : {32, 64, 128})
      errors.push_back(volume_of(opened(grip_glb(scene, 2, report, segments)), "liquid") / volume - 1);
    for (int k = 1; k < 3; ++k) EXPECT_LT(std::abs(errors[k]), std::abs(errors[k - 1]) / 3) << tilt;
    EXPECT_LT(std::abs(errors[2]), 1e-3) << tilt;  // (2 pi / 128)^2 / 6 = 4e-4 of a circle's area
    EXPECT_NE(errors[2], 0);
    const tinygltf::Model model = opened(grip_glb(scene, 2, report));
    const tinygltf::Value& extras = model.nodes[index_of_node(model, "liquid")].extras;
    EXPECT_EQ(extras.Get("liquid_volume_m3").GetNumberAsDouble(), volume);
    EXPECT_EQ(extras.Get("tilt_rad").GetNumberAsDouble(), radians(tilt));
  }
}

TEST(GripGlb, NoLiquidNoNode) {
  Scene scene = three_beakers();
  const tinygltf::Model empty = opened(grip_glb(scene, 0, report_of(scene, 0, GRIP, one_state(0, 0))));
  EXPECT_EQ(index_of_node(empty, "liquid"), -1);
  EXPECT_TRUE(empty.animations.empty());  // one tilt
  scene.liquid.reset();
  scene.tilts.clear();
  const tinygltf::Model still = opened(grip_glb(scene, 0, report_of(scene, 0, GRIP, scene_axes(scene, 0))));
  EXPECT_EQ(index_of_node(still, "liquid"), -1);
  EXPECT_EQ(still.nodes.size(), 3u + 1 + 48);
}

TEST(GripGlb, AnimationTurnsTheMouthTowardsThePour) {
  for (const Handedness handedness : {Handedness::right, Handedness::left}) {
    Scene scene = three_beakers();
    scene.hand.handedness = handedness;
    const GripReport report = report_of(scene, 0, GRIP, {{0, 0.5}, {0, radians(30), radians(90)}});
    const tinygltf::Model model = opened(grip_glb(scene, 0, report));
    ASSERT_EQ(model.animations.size(), 1u);
    ASSERT_EQ(model.animations[0].channels.size(), 2u);
    const auto& turn = model.animations[0].samplers[0];
    EXPECT_EQ(model.animations[0].channels[0].target_node, index_of_node(model, "pivot"));
    const std::vector<double> times = numbers(model, turn.input), q = numbers(model, turn.output);
    ASSERT_EQ(times.size(), 3u);
    EXPECT_EQ(times[0], 0);
    EXPECT_LT(times[1], times[2]);
    // at 90 degrees the vessel's up is the direction of the pour
    const glm::dvec3 up = glm::dquat(q[11], q[8], q[9], q[10]) * glm::dvec3(0, 1, 0);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(up[k], report.pour[k], 1e-6);
    // the liquid, of 50 % at tilt 0, is shown there alone
    const auto& show = model.animations[0].samplers[1];
    EXPECT_EQ(model.animations[0].channels[1].target_node, index_of_node(model, "liquid"));
    EXPECT_EQ(show.interpolation, "STEP");
    EXPECT_EQ(numbers(model, show.output), (std::vector<double>{1, 1, 1, 0, 0, 0, 0, 0, 0}));
    const glm::dvec3 pivot(places_of(model).at("pivot")[3]);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(pivot[k], report.answer.result.midpoint[k], 1e-12);
  }
}

TEST(GripGlb, ExtrasAreTheNumbersOfTheGrip) {
  const Scene scene = three_beakers();
  const GripReport report = report_of(scene, 0, GRIP, one_state(0.5, 30));
  const auto json = parse_json(grip_json(report));
  const tinygltf::Model model = opened(grip_glb(scene, 0, report));
  const tinygltf::Value& extras = model.nodes[index_of_node(model, "grip")].extras;
  EXPECT_EQ(extras.Get("vessel").Get<std::string>(), "beaker1");
  EXPECT_EQ(extras.Get("score").GetNumberAsDouble(), json["score"].get<double>());
  EXPECT_EQ(extras.Get("grip").Get("height_m").GetNumberAsDouble(), 0.0585);
  EXPECT_EQ(extras.Get("score_terms").Get("hold").GetNumberAsDouble(), json["score_terms"]["hold"].get<double>());
  ASSERT_EQ(extras.Get("states").ArrayLen(), 1u);
  EXPECT_EQ(extras.Get("states").Get(0).Get("feedback_force_N").GetNumberAsDouble(),
            json["states"][0]["feedback_force_N"].get<double>());
  ASSERT_EQ(extras.Get("projected").ArrayLen(), 24u);  // its nulls keep their places
  for (int j = 0; j < JOINT_COUNT; ++j) {
    const auto& role = json["projected"][j];
    EXPECT_EQ(extras.Get("projected").Get(j).Get<std::string>(), role.is_null() ? "none" : role.get<std::string>());
  }
}

TEST(GripGlb, BarePointsAreStillSeen) {
  Scene scene = three_beakers();
  for (FingerData& finger : scene.hand.fingers) finger.radii = {};
  scene.pose = Pose::paper;
  const tinygltf::Model model = opened(grip_glb(scene, 0, report_of(scene, 0, {0.05, 0, 0, 0, 0, 1}, one_state(0.5, 0))));
  EXPECT_DOUBLE_EQ(model.nodes[index_of_node(model, "thumb-tip contact")].scale[0], GLB_BALL_SHARE * 1.5e-3);
  EXPECT_EQ(model.nodes[index_of_node(model, "thumb-tip")].extras.Get("radius_m").GetNumberAsDouble(), 0);
}

// Drawn with the outline's grip: the nodes depend on the report, the vessel's on the mesh alone.
TEST(GripGlb, AMeshVesselIsItsMesh) {
  Scene scene = three_beakers();
  const GripReport report = report_of(scene, 0, GRIP, one_state(0.5, 30));
  const TriangleMesh mesh = turned_mesh(beaker1(), 40, 5e-3);
  scene.vessels[0] = vessel_of_mesh("mug", placed_mesh(mesh, {}, {0, 0.02, 0}), 5e-3);
  scene.vessels[0].mesh->file = "folder/of/mug.glb";
  const tinygltf::Model model = opened(grip_glb(scene, 0, report));
  EXPECT_EQ(index_of_node(model, "liquid"), -1);
  EXPECT_EQ(model.nodes.size(), 4u + 24 + 24);
  EXPECT_NEAR(volume_of(model, "vessel") / body_of(mesh).volume, 1, 1e-6);  // floats
  const tinygltf::Primitive& primitive = primitive_of(model, "vessel");
  EXPECT_EQ(model.accessors[primitive.indices].count, 3 * mesh.triangles.size());
  EXPECT_EQ(model.accessors[primitive.attributes.at("POSITION")].count,
            mesh.vertices.size() + 2 * 40);  // creases at base and mouth
  EXPECT_EQ(model.accessors[primitive.attributes.at("NORMAL")].count, mesh.vertices.size() + 2 * 40);
  EXPECT_EQ(model.materials[primitive.material].alphaMode, "BLEND");
  const tinygltf::Value& extras = model.nodes[index_of_node(model, "vessel")].extras;
  EXPECT_EQ(extras.Get("name").Get<std::string>(), "mug");
  EXPECT_EQ(extras.Get("mesh").Get<std::string>(), "mug.glb");
  EXPECT_EQ(extras.Get("lattice_spacing_m").GetNumberAsDouble(), 5e-3);
  EXPECT_EQ(extras.Get("lattice_error_m").GetNumberAsDouble(), scene.vessels[0].mesh->body->lattice_error);
  EXPECT_GT(extras.Get("lattice_error_m").GetNumberAsDouble(), 0);
  EXPECT_NEAR(extras.Get("base_m").GetNumberAsDouble(), 0.02, 1e-12);
  EXPECT_NEAR(extras.Get("height_m").GetNumberAsDouble(), 0.13 - 0.02, 1e-12);
  EXPECT_FALSE(extras.Has("wall_m"));
  scene.vessels[0].mesh->body.reset();
  EXPECT_THROW(grip_glb(scene, 0, report), Error);
}

TEST(GripGlb, AMeshVesselHoldsItsLiquid) {
  Scene scene = three_beakers();
  const GripReport report = report_of(scene, 0, GRIP, one_state(0.5, 40));
  const double of_outline = volume_of(opened(grip_glb(scene, 0, report)), "liquid");
  scene.vessels[0] = vessel_of_mesh("mug", turned_mesh(beaker1(), 40, 5e-3), 0);
  scene.vessels[0].inner = {line_to(0, 1.5), line_to(38.5, 1.5), line_to(38.5, 110)};
  const tinygltf::Model model = opened(grip_glb(scene, 0, report));
  EXPECT_NEAR(volume_of(model, "liquid") / of_outline, 1, 1e-9);
  EXPECT_EQ(model.nodes[index_of_node(model, "liquid")].extras.Get("tilt_rad").GetNumberAsDouble(), radians(40));
}

TEST(GripGlb, NothingToDraw) {
  const Scene scene = three_beakers();
  const GripReport report = report_of(scene, 0, {0.3, 0, 0, 0, 0, 1}, one_state(0.5, 0));
  ASSERT_NE(report.answer.result.reason, Reason::none);
  try {
    grip_glb(scene, 0, report);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("not feasible (misses)"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace wholehand::sweeps
