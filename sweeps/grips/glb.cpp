// SPDX-License-Identifier: MIT
#include "sweeps/grips/glb.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/files/json.h"
#include "base/system/version.h"
#include "base/text/error.h"
#include "core/mesh_body.h"
#include "core/vectors.h"
#include "sweeps/grips/hand_nodes.h"
#include "sweeps/grips/mesh.h"
#include "sweeps/grips/states.h"

namespace wholehand::sweeps {
namespace {

constexpr double LEAST_DRAWN_RADIUS = 1.5e-3;  // m
constexpr int BONE_SEGMENTS = 20;              // round a bone
constexpr int BALL_SEGMENTS = 32;              // round a contact point
constexpr double TURN_SPEED = 0.5;             // of the animation, rad/s
constexpr std::array<int, 3> BONE_COLOR{222, 200, 178};
constexpr std::array<int, 3> GLASS_COLOR{200, 225, 235};
constexpr std::array<int, 3> LIQUID_COLOR{86, 180, 233};

// glTF's color factors are linear.
double linear_light(int srgb) {
  const double value = srgb / 255.0;
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

// tinygltf leaves out what is null: so absent in objects, and "none" in lists, whose places count.
tinygltf::Value gltf_value(const nlohmann::ordered_json& json, bool in_list = false) {
  if (json.is_boolean()) return tinygltf::Value(json.get<bool>());
  if (json.is_number()) return tinygltf::Value(json.get<double>());
  if (json.is_string()) return tinygltf::Value(json.get<std::string>());
  if (json.is_array()) {
    tinygltf::Value::Array list;
    for (const auto& item : json) list.push_back(gltf_value(item, true));
    return tinygltf::Value(std::move(list));
  }
  if (json.is_object()) {
    tinygltf::Value::Object object;
    for (const auto& item : json.items()) {
      const bool is_empty = item.value().is_null() || (item.value().is_array() && item.value().empty());
      if (!is_empty) object[item.key()] = gltf_value(item.value());
    }
    return tinygltf::Value(std::move(object));
  }
  return in_list ? tinygltf::Value(std::string("none")) : tinygltf::Value();
}

// A glTF model with one buffer, to which meshes, nodes and animations are appended; each answers its index.
class GlbBuilder {
 public:
  GlbBuilder() {
    model_.asset.version = "2.0";
    model_.asset.generator = std::string("wholehand ") + version();
    model_.buffers.resize(1);
    model_.scenes.resize(1);
    model_.defaultScene = 0;
  }

  int add_material(const std::string& name, const std::array<int, 3>& color, double alpha, double roughness) {
    tinygltf::Material material;
    material.name = name;
    material.pbrMetallicRoughness.baseColorFactor = {linear_light(color[0]), linear_light(color[1]), linear_light(color[2]), alpha};
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = roughness;
    if (alpha < 1) material.alphaMode = "BLEND";
    model_.materials.push_back(material);
    return static_cast<int>(model_.materials.size()) - 1;
  }

  // Positions, normals and corners of a mesh as accessors, which meshes of several materials may share.
  tinygltf::Primitive add_primitive(const SurfaceMesh& mesh) {
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.attributes["POSITION"] = add_floats<3>(mesh.positions, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
    primitive.attributes["NORMAL"] = add_floats<3>(mesh.normals, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
    const int view = add_view(mesh.triangles.data(), mesh.triangles.size() * 4, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    primitive.indices = add_accessor(view, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, mesh.triangles.size());
    return primitive;
  }

  int add_mesh(const std::string& name, tinygltf::Primitive primitive, int material) {
    tinygltf::Mesh mesh;
    mesh.name = name;
    primitive.material = material;
    mesh.primitives.push_back(primitive);
    model_.meshes.push_back(mesh);
    return static_cast<int>(model_.meshes.size()) - 1;
  }

  // A node below `parent`, -1: of the scene.
  int add_node(const std::string& name, int parent) {
    const int index = static_cast<int>(model_.nodes.size());
    model_.nodes.emplace_back();
    model_.nodes.back().name = name;
    (parent < 0 ? model_.scenes[0].nodes : model_.nodes[parent].children).push_back(index);
    return index;
  }
  tinygltf::Node& node(int index) { return model_.nodes[index]; }

  // A channel of the one animation: `path` of `node` takes `values` at `times` (s, ascending).
  template <std::size_t N>
  void animate(int node, const std::string& path, const std::string& interpolation, const std::vector<double>& times,
               const std::vector<std::array<double, N>>& values) {
    if (model_.animations.empty()) {
      model_.animations.emplace_back();
      model_.animations[0].name = "tilt";
      std::vector<std::array<double, 1>> scalars;
      for (const double time : times) scalars.push_back({time});
      times_ = add_floats<1>(scalars, TINYGLTF_TYPE_SCALAR, 0);
    }
    tinygltf::Animation& animation = model_.animations[0];
    tinygltf::AnimationSampler sampler;
    sampler.input = times_;
    sampler.output = add_floats<N>(values, N == 4 ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3, 0);
    sampler.interpolation = interpolation;
    tinygltf::AnimationChannel channel;
    channel.sampler = static_cast<int>(animation.samplers.size());
    channel.target_node = node;
    channel.target_path = path;
    animation.samplers.push_back(sampler);
    animation.channels.push_back(channel);
  }

  std::string bytes() {
    std::ostringstream stream;
    if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model_, stream, false, true)) throw failure_error("cannot write glTF");
    return stream.str();
  }

 private:
  // Everything here is made of 4-byte numbers, so all views stay aligned.
  int add_view(const void* data, std::size_t size, int target) {
    std::vector<unsigned char>& buffer = model_.buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.size();
    view.byteLength = size;
    view.target = target;
    buffer.resize(buffer.size() + size);
    std::memcpy(buffer.data() + view.byteOffset, data, size);
    model_.bufferViews.push_back(view);
    return static_cast<int>(model_.bufferViews.size()) - 1;
  }

  int add_accessor(int view, int component, int type, std::size_t count) {
    tinygltf::Accessor accessor;
    accessor.bufferView = view;
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = count;
    model_.accessors.push_back(accessor);
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  // With the least and the largest, of the floats that are stored.
  template <std::size_t N>
  int add_floats(const std::vector<std::array<double, N>>& values, int type, int target) {
    std::vector<float> floats;
    std::vector<double> low(N, HUGE_VAL), high(N, -HUGE_VAL);
    for (const auto& value : values) {
      for (std::size_t k = 0; k < N; ++k) {
        floats.push_back(static_cast<float>(value[k]) + 0.0F);  // no negative zero
        low[k] = std::min(low[k], static_cast<double>(floats.back()));
        high[k] = std::max(high[k], static_cast<double>(floats.back()));
      }
    }
    const int accessor =
        add_accessor(add_view(floats.data(), floats.size() * 4, target), TINYGLTF_COMPONENT_TYPE_FLOAT, type, values.size());
    model_.accessors[accessor].minValues = low;
    model_.accessors[accessor].maxValues = high;
    return accessor;
  }

  tinygltf::Model model_;
  int times_ = -1;
};

void place_node(tinygltf::Node& node, const Triple& position, const Quaternion& rotation) {
  node.translation.assign(position.begin(), position.end());
  node.rotation.assign(rotation.begin(), rotation.end());
}

double drawn_radius(double radius) { return std::max(radius, LEAST_DRAWN_RADIUS); }

// The joints below the wrist, with bones and contact points.
void add_hand_nodes(GlbBuilder& glb, int parent, const HandNodes& hand, const GripResult& result) {
  const int bone_material = glb.add_material("bone", BONE_COLOR, 1, 0.7);
  const tinygltf::Primitive ball = glb.add_primitive(ball_mesh(BALL_SEGMENTS));
  std::array<int, 3> balls{-1, -1, -1};  // of the states that there are
  const auto ball_of = [&](PointState state) {
    int& mesh = balls[static_cast<std::size_t>(state)];
    const PointStyle& style = POINT_STYLES[static_cast<std::size_t>(state)];
    if (mesh < 0) mesh = glb.add_mesh(style.name, ball, glb.add_material(style.name, style.color, 1, 0.5));
    return mesh;
  };
  const int wrist = glb.add_node(hand.wrist.name, parent);
  place_node(glb.node(wrist), hand.wrist.position, hand.wrist.rotation);
  glb.node(wrist).extras = gltf_value({{"openxr_joint", hand.wrist.openxr}});
  std::array<int, JOINT_COUNT> nodes{};
  for (int j = 0; j < JOINT_COUNT; ++j) {
    const HandNode& joint = hand.joints[j];
    const HandNode& above = joint.parent < 0 ? hand.wrist : hand.joints[joint.parent];
    nodes[j] = glb.add_node(joint.name, joint.parent < 0 ? wrist : nodes[joint.parent]);
    place_node(glb.node(nodes[j]), relative_position(above, joint.position), relative_rotation(above, joint.rotation));
    if (j + 1 < JOINT_COUNT && hand.joints[j + 1].parent == j) {
      const Triple to_next = relative_position(joint, hand.joints[j + 1].position);
      const double near = drawn_radius(joint.radius), far = drawn_radius(hand.joints[j + 1].radius);
      const double length = norm(to_next);
      const std::string name = fmt::format("{} bone", joint.name);
      glb.node(nodes[j]).mesh =
          glb.add_mesh(name, glb.add_primitive(capsule_mesh(length, near, far, BONE_SEGMENTS)), bone_material);
    }
    const PointState state = point_state(result, j);
    glb.node(nodes[j]).extras = gltf_value({{"openxr_joint", joint.openxr},
                                            {"state", POINT_STYLES[static_cast<std::size_t>(state)].name},
                                            {"radius_m", joint.radius},
                                            {"separation_m", result.separation[j]}});
    const int contact = glb.add_node(fmt::format("{} contact", joint.name), nodes[j]);
    glb.node(contact).mesh = ball_of(state);
    glb.node(contact).scale.assign(3, GLB_BALL_SHARE * drawn_radius(joint.radius));
  }
}

nlohmann::ordered_json vessel_extras(const VesselData& vessel) {
  nlohmann::ordered_json extras{{"name", vessel.name}};
  if (vessel.mesh) {
    extras["mesh"] = std::filesystem::path(vessel.mesh->file).filename().string();
    extras["base_m"] = vessel.base;
    extras["lattice_spacing_m"] = vessel.mesh->body->lattice.spacing;
    extras["lattice_error_m"] = vessel.mesh->body->lattice_error;
  } else {
    extras["wall_m"] = vessel.wall;
  }
  extras["height_m"] = vessel.height - vessel.base;
  return extras;
}

// The liquid's node; -1: there is none.
int add_liquid_node(GlbBuilder& glb, int parent, const VesselData& vessel, const GripReport& report,
                    const nlohmann::ordered_json& json, int segments) {
  const GripState* state = drawn_liquid(report);
  if (!state) return -1;
  const SurfaceMesh mesh = liquid_mesh(vessel, state->liquid.volume, state->tilt, report.pour, segments);
  if (mesh.triangles.empty()) return -1;
  const int node = glb.add_node("liquid", parent);
  glb.node(node).mesh = glb.add_mesh("liquid", glb.add_primitive(mesh), glb.add_material("liquid", LIQUID_COLOR, 0.55, 0.1));
  glb.node(node).extras = gltf_value(json["states"][static_cast<std::size_t>(state - report.answer.states.data())]);
  return node;
}

// Turns the pivot through the tilts asked for, ascending, towards report.pour: about y x n.
void add_tilt_animation(GlbBuilder& glb, int pivot, int liquid, const GripReport& report) {
  std::vector<double> tilts;
  for (const GripState& state : report.answer.states) tilts.push_back(state.tilt);
  std::sort(tilts.begin(), tilts.end());
  tilts.erase(std::unique(tilts.begin(), tilts.end(), [](double a, double b) { return b - a < 1e-6; }), tilts.end());
  if (tilts.size() < 2) return;
  std::vector<double> times;
  std::vector<Quaternion> rotations;
  std::vector<Triple> shown;
  for (const double tilt : tilts) {
    times.push_back((tilt - tilts.front()) / TURN_SPEED);
    const double s = std::sin(tilt / 2);
    rotations.push_back({s * report.pour[2], 0, -s * report.pour[0], std::cos(tilt / 2)});
    const bool is_own = liquid >= 0 && std::abs(tilt - drawn_liquid(report)->tilt) < 1e-6;
    shown.push_back(is_own ? Triple{1, 1, 1} : Triple{0, 0, 0});
  }
  glb.animate<4>(pivot, "rotation", "LINEAR", times, rotations);
  if (liquid >= 0) glb.animate<3>(liquid, "scale", "STEP", times, shown);
}

}  // namespace

std::string grip_glb(const Scene& scene, std::size_t vessel, const GripReport& report, int segments) {
  check_drawable(report, "--glb");
  const VesselData& data = scene.vessels[vessel];
  const GripResult& result = report.answer.result;
  const nlohmann::ordered_json json = parse_ordered_json(grip_json(report));
  GlbBuilder glb;
  const int pivot = glb.add_node("pivot", -1);
  glb.node(pivot).translation.assign(result.midpoint.begin(), result.midpoint.end());
  const int grip = glb.add_node("grip", pivot);
  for (const double m : result.midpoint) glb.node(grip).translation.push_back(-m);
  glb.node(grip).extras = gltf_value(json);
  add_hand_nodes(glb, grip, hand_nodes(scene.hand, report.grip, result), result);
  const int liquid = add_liquid_node(glb, grip, data, report, json, segments);
  const SurfaceMesh glass = vessel_mesh(data, segments);
  const int node = glb.add_node("vessel", grip);
  glb.node(node).mesh = glb.add_mesh(data.name, glb.add_primitive(glass), glb.add_material("glass", GLASS_COLOR, 0.3, 0.05));
  glb.node(node).extras = gltf_value(vessel_extras(data));
  add_tilt_animation(glb, pivot, liquid, report);
  return glb.bytes();
}

}  // namespace wholehand::sweeps
