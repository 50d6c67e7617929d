// SPDX-License-Identifier: MIT
#include "sweeps/grips/report.h"

#include <cmath>

#include "base/text/error.h"
#include "core/counted_tilts.h"
#include "core/mesh_body.h"
#include "core/vectors.h"

namespace wholehand::sweeps {
namespace {

constexpr double COINCIDENT = 1e-6;  // m
constexpr double VERTICAL = 1e-9;    // sine of the angle to the axis, as the kernels' degenerate grips

}  // namespace

GripReport make_grip_report(const Scene& scene, std::size_t vessel, const GripInput& grip, const StateAxes& axes,
                            const GripMethods& methods) {
  GripReport report;
  report.scene = scene.name;
  report.vessel = scene.vessels[vessel].name;
  report.device = methods.device;
  report.grip = grip;
  report.answer = methods.answer(vessel, grip, axes);
  report.pour = pour_direction(scene, grip);
  report.has_liquid = scene.liquid.has_value();
  report.capacity = axes.capacity;
  if (const auto& mesh = scene.vessels[vessel].mesh; mesh && mesh->body) report.length_error = mesh->body->lattice_error;
  report.has_tilts = !scene.tilts.empty();
  report.score_fills = scene_axes(scene, vessel).fills;
  report.score_tilts = scene.tilts.size();
  report.counted_tilts = counted_tilts(scene, vessel);
  report.last_tilts = last_tilts(scene, vessel);
  return report;
}

void add_holding(GripReport& report, const Scene& scene, std::size_t vessel) {
  if (report.answer.result.reason != Reason::none || !scene.strength) return;
  add_holding(report, scene, vessel, *make_core_evaluator(scene));
}

void add_holding(GripReport& report, const Scene& scene, std::size_t vessel, const Evaluator& evaluator) {
  if (report.answer.result.reason != Reason::none || !scene.strength) return;
  const Holding holding(scene, evaluator, vessel, report.answer.result, report.pour);
  for (const GripState& state : report.answer.states) report.holds.push_back(holding.state(state));
  report.hold = report.answer.hold ? report.answer.hold : holding.over_states();
}

void add_quality(GripReport& report, const Scene& scene, std::size_t vessel) {
  if (report.answer.result.reason != Reason::none) return;
  const auto evaluator = make_core_evaluator(scene);
  report.quality = grip_quality(scene, *evaluator, vessel, report.answer.result);
  if (report.holds.empty()) return;
  const Holding holding(scene, *evaluator, vessel, report.answer.result, report.pour);
  for (std::size_t k = 0; k < report.holds.size(); ++k)
    report.holds[k].shares = holding.shares(report.answer.states[k], report.holds[k]);
}

// y x d for the direction d of the right hand's line; a left hand is that of the scene mirrored in x, which turns the sign.
Triple pour_direction(const Scene& scene, const GripInput& grip) {
  const double away = scene.hand.handedness == Handedness::right ? 1 : -1;
  const double sense = scene.liquid && scene.liquid->pour == Pour::towards ? -away : away;
  const double c = std::cos(grip.obliquity);
  if (std::abs(c) < VERTICAL) return {};
  const double side = c > 0 ? sense : -sense;
  return {-side * std::sin(grip.azimuth), 0, -side * std::cos(grip.azimuth)};
}

GripInput grip_through(const Triple& thumb, const Triple& index, double roll, double hand_scale) {
  const Triple across{index[0] - thumb[0], index[1] - thumb[1], index[2] - thumb[2]};
  const double apart = norm(across), level = std::hypot(across[0], across[2]);
  if (!(apart > COINCIDENT))
    throw usage_error("--thumb-mm and --index-mm are the same point; give two points of the vessel's surface");
  if (!(level > VERTICAL * apart))
    throw usage_error("--thumb-mm and --index-mm lie one above the other; the line between them must not be vertical");
  GripInput grip;
  grip.obliquity = std::atan2(across[1], level);
  grip.azimuth = std::atan2(-across[2], across[0]) + 0.0;  // no negative zero
  grip.roll = roll;
  grip.hand_scale = hand_scale;
  // in the horizontal plane: k along the line, e = k x y beside it
  const double kx = across[0] / level, kz = across[2] / level;
  grip.offset = -thumb[0] * kz + thumb[2] * kx;
  grip.height = thumb[1] - (thumb[0] * kx + thumb[2] * kz) * (across[1] / level);
  return grip;
}

}  // namespace wholehand::sweeps
