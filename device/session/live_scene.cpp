// SPDX-License-Identifier: MIT
#include "device/session/live_scene.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/text/error.h"
#include "core/closure.h"
#include "core/held.h"
#include "core/load.h"
#include "core/mesh_body.h"
#include "core/mirror.h"
#include "core/planes.h"
#include "core/prepare.h"
#include "core/vectors.h"
#include "device/session/inertia.h"
#include "device/session/tick.h"
#include "device/session/workspace.h"

namespace wholehand::device {

using core_f64::Vec3;

namespace {

LiveVessel load_live_vessel(const Scene& scene, const VesselData& data, const core_f64::Quadrature& quadrature) {
  const Mirror mirror(scene.hand.handedness);
  if (data.liquid_fill > 0 && !(scene.liquid && data.has_cavity())) {
    throw usage_error(at_place(scene.file, "vessel '" + data.name + "' has liquid in it; that needs [liquid] and " +
                                               (data.mesh ? "'inner_outline'" : "'wall_mm' or 'inner_outline'")));
  }
  LiveVessel live;
  const PreparedVessel prepared = prepare_vessel(data, data.has_cavity());
  live.radius = prepared.largest_radius;
  live.vessel = core_f64::load_vessel(prepared, data, quadrature, scene.liquid.has_value(), scene.hand.handedness);
  live.inertia = wall_inertia(prepared, data, live.vessel, quadrature, scene.hand.handedness);
  if (data.mesh) core_f64::use_lattice(live.vessel, core_f64::load_lattice(mirror(data.mesh->body->lattice)));
  live.force = core_f64::load_force(scene, data);
  live.home = mirror.in(data.place);
  double most = 0;
  core_f64::LiquidState liquid;
  liquid.height = live.vessel.floor_height;
  if (scene.liquid) {
    live.volume = data.liquid_fill * live.vessel.capacity;
    most = std::max(vessel_fills(scene, data).back(), data.liquid_fill) * live.vessel.capacity;
    liquid = core_f64::liquid_at(live.vessel, quadrature, most, 0, 1);
  }
  const double density = scene.liquid ? scene.liquid->density : 0;
  live.largest = core_f64::load_with(live.vessel, most * density, liquid.lean, liquid.height);
  live.force.reference = core_f64::object_reference(live.largest, live.force.gravity, data.base, data.height);
  for (const GuidancePoint& point : data.guidance) {
    const Vec3 out = core_f64::grip_direction(mirror(GripInput{point.height, point.azimuth}).azimuth, 0), axis(0, point.height, 0);
    const core_f64::Trace trace = core_f64::trace_tip(live.vessel, axis, out, 1, 0);
    live.guidance.push_back(trace.reason == REASON_NONE ? axis + trace.t * out : axis);
  }
  return live;
}

// By the cylinders about them.
bool stand_in_each_other(const LiveVessel& a, double height_a, const LiveVessel& b, double height_b) {
  const Vec3 apart = b.home - a.home;
  return std::hypot(apart.x, apart.z) < a.radius + b.radius && apart.y < height_a && -apart.y < height_b;
}

}  // namespace

LiveScene::LiveScene(const Scene& given) : scene(given), mirror(scene.hand.handedness) {
  if (scene.vessels.empty() || scene.vessels.size() > LIVE_VESSELS) {
    throw usage_error(at_place(scene.file, "a live session has 1 to " + std::to_string(LIVE_VESSELS) + " vessels; this scene has " +
                                               std::to_string(scene.vessels.size())));
  }
  hand = core_f64::load_hand(prepare_hand(scene.hand), scene.hand);
  quadrature = core_f64::load_quadrature(prepare_quadrature(QUADRATURE_POINTS));
  for (const VesselData& data : scene.vessels) {
    if (tutorial < 0 && scene.task && data.liquid_name.empty()) tutorial = static_cast<int>(vessels.size());
    vessels.push_back(load_live_vessel(scene, data, quadrature));
    for (std::size_t v = 0; v + 1 < vessels.size(); ++v) {
      if (!stand_in_each_other(vessels[v], scene.vessels[v].height, vessels.back(), data.height)) continue;
      throw usage_error(at_place(scene.file, "vessels '" + scene.vessels[v].name + "' and '" + data.name +
                                                 "' stand in each other; a live session needs place_mm for each"));
    }
  }
}

}  // namespace wholehand::device
