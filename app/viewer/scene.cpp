// SPDX-License-Identifier: MIT
#include "app/viewer/scene.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/files/json.h"
#include "base/system/version.h"
#include "base/text/printable.h"
#include "core/closure.h"
#include "core/contact.h"
#include "core/joints.h"
#include "core/load.h"
#include "core/mesh_body.h"
#include "core/outline_points.h"
#include "core/prepare.h"
#include "core/vectors.h"
#include "device/session/hand_view.h"

namespace wholehand {
namespace {

using Json = nlohmann::ordered_json;
using Point2 = std::array<double, 2>;  // (r, y), m

constexpr const char* MODES[] = {"live", "recording", "grips"};

// From the middle of the floor up the inner wall to the rim.
std::vector<Point2> inner_wall(const PreparedVessel& vessel) {
  std::vector<Point2> points = outline_points(vessel.cavity, vessel.cavity.size(), ARC_STEP);
  if (!points.empty() && points.front()[0] > 1e-9) points.insert(points.begin(), {0, vessel.floor_height});
  return points;
}

// Where a ray from the axis leaves the vessel, as a session finds it (in the mirrored scene for a left hand: the same points).
Json guidance_points(const VesselData& data, const PreparedVessel& prepared) {
  Json points = Json::array();
  if (data.guidance.empty()) return points;
  const core_f64::Quadrature quadrature = core_f64::load_quadrature(prepare_quadrature(QUADRATURE_POINTS));
  core_f64::Vessel vessel = core_f64::load_vessel(prepared, data, quadrature, false, Handedness::right);
  if (data.mesh) core_f64::use_lattice(vessel, core_f64::load_lattice(data.mesh->body->lattice));
  for (const GuidancePoint& point : data.guidance) {
    const core_f64::Vec3 out = core_f64::grip_direction(point.azimuth, 0), axis(0, point.height, 0);
    const core_f64::Trace trace = core_f64::trace_tip(vessel, axis, out, 1, 0);
    const core_f64::Vec3 at = trace.reason == REASON_NONE ? axis + trace.t * out : axis;
    points.push_back(to_triple(at));
  }
  return points;
}

Json vessel_json(const Scene& scene, std::size_t v) {
  const VesselData& data = scene.vessels[v];
  const PreparedVessel prepared = prepare_vessel(data, data.has_cavity());
  Json json{{"name", data.name}, {"place", data.place}};
  const std::vector<Point2> inner = inner_wall(prepared);
  if (data.mesh) {
    json["mesh"] = "meshes/" + std::to_string(v) + ".bin";
  } else {
    // solid glass is closed at its mouth, the hull's last element
    json["outline"] = outline_points(prepared.hull, prepared.hull.size() - (inner.empty() ? 0 : 1), ARC_STEP);
  }
  if (!inner.empty()) json["inner"] = inner;
  json["base"] = data.base;
  json["height"] = data.height;
  json["radius"] = prepared.largest_radius;
  json["liquid"] = data.liquid_name.empty() ? Json(nullptr) : Json(data.liquid_name);
  json["guidance"] = guidance_points(data, prepared);
  return json;
}

Json joints_json(const HandData& hand) {
  Json joints = Json::array();
  for (int f = 0; f < FINGER_COUNT; ++f) {
    for (int k = 0; k < finger_joints(f); ++k) {
      const int j = finger_start(f) + k;
      joints.push_back(
          {{"name", JOINT_NAMES[j].webxr}, {"parent", k == 0 ? -1 : j - 1}, {"radius", hand.scale * hand.fingers[f].radii[k]}});
    }
  }
  return joints;
}

void append_number(std::string& bytes, std::uint32_t number) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>(number >> shift & 0xff));
}

}  // namespace

std::string view_scene_json(const Scene& scene, const ViewFacts& facts) {
  Json json{{"mode", MODES[static_cast<std::size_t>(facts.mode)]},
            {"title", one_line(facts.title)},
            {"version", version()},
            {"device", one_line(facts.device)},
            {"handedness", scene.hand.handedness == Handedness::left ? "left" : "right"},
            {"control", !facts.control_limits.empty()}};
  if (!facts.control_limits.empty()) json["control_limits"] = parse_ordered_json(facts.control_limits);
  json["joints"] = joints_json(scene.hand);
  json["vessels"] = Json::array();
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) json["vessels"].push_back(vessel_json(scene, v));
  json["table_y"] = device::table_height(scene);
  json["target"] = nullptr;
  json["destination"] = nullptr;
  json["amounts"] = Json::array();
  json["tolerance_m3"] = nullptr;
  if (scene.task) {
    json["target"] = {
        {"place", scene.task->target_place}, {"diameter", scene.task->target_diameter}, {"wall", device::TARGET_WALL}};
    json["destination"] = scene.task->destination;
    for (const auto& [liquid, volume] : scene.task->amounts) json["amounts"].push_back({{"liquid", liquid}, {"target_m3", volume}});
    json["tolerance_m3"] = scene.task->tolerance;
  }
  json["force"] = {
      {"base", scene.force.base}, {"max", scene.force.max}, {"most", facts.most_force > 0 ? facts.most_force : scene.force.max}};
  if (scene.strength) json["strength"] = scene.strength->digits;
  if (scene.live.slide && facts.mode != ViewMode::grips) json["slides"] = true;
  json["states"] = device::SESSION_STATE_NAMES;
  if (facts.mode == ViewMode::recording) json["duration"] = facts.duration;
  if (facts.mode != ViewMode::grips) json["rate"] = facts.rate;
  if (!facts.grips.empty()) {
    json["fills"] = facts.fills.empty() ? std::vector<double>{0} : facts.fills;
    json["tilts"] = facts.tilts;
    json["grips"] = parse_ordered_json(facts.grips);
  }
  return json_text(json);
}

std::string mesh_bytes(const VesselData& vessel) {
  std::string bytes;
  if (!vessel.mesh || !vessel.mesh->body) return bytes;
  const MeshBody& body = *vessel.mesh->body;
  append_number(bytes, static_cast<std::uint32_t>(body.vertices.size()));
  append_number(bytes, static_cast<std::uint32_t>(body.triangles.size()));
  for (const Triple& vertex : body.vertices) {
    for (const double x : vertex) append_number(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(x)));
  }
  for (const auto& triangle : body.triangles) {
    for (const std::uint32_t index : triangle) append_number(bytes, index);
  }
  return bytes;
}

}  // namespace wholehand
