// SPDX-License-Identifier: MIT
#include "host/scene_arrays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <numeric>

#include "core/counted_tilts.h"
#include "core/extreme_points.h"
#include "core/gather.h"
#include "core/hand_size.h"
#include "core/mirror.h"
#include "core/planes.h"
#include "core/prepare.h"
#include "core/touch.h"
#include "shaders/layout.h"

namespace wholehand::host {
namespace {

void append_elements(std::vector<double>& out, const std::vector<PreparedElement>& elements) {
  for (const auto& e : elements)
    out.insert(out.end(), {e.a[0], e.a[1], e.b[0], e.b[1], e.center[0], e.center[1], e.radius,
                           static_cast<double>(ELEMENT_CODE(e.side, e.supports))});
}

std::vector<double> hand_table(const PreparedHand& prepared, const HandData& data) {
  std::vector<double> table(4 * HAND_VECTORS, 0.0);
  const auto put = [&](int vector, const Triple& xyz, double w) {
    for (int k = 0; k < 3; ++k) table[4 * vector + k] = xyz[k];
    table[4 * vector + 3] = w;
  };
  for (int f = 0; f < FINGER_COUNT; ++f) {
    const auto& finger = prepared.fingers[f];
    const int at = HAND_FINGER_STRIDE * f;
    put(at, finger.base, finger.length[0]);
    put(at + 1, finger.forward, finger.length[1]);
    put(at + 2, finger.palmward, finger.length[2]);
    put(at + 3, {finger.radius[0], finger.radius[1], finger.radius[2]}, finger.radius[3]);
    put(at + 4, {finger.radius[4], finger.length[3], 0}, 0);
  }
  put(HAND_THUMB_OPEN, prepared.thumb_open, data.max_angle);
  put(HAND_THUMB_SWING, prepared.thumb_swing, data.paper_max_angle);
  put(HAND_FINGER_OPEN, prepared.finger_open, judged_contact_tolerance(data));
  put(HAND_FINGER_SWING, prepared.finger_swing, judged_depth_limit(data));
  put(HAND_JOINT_LIMIT, data.joint_limit, data.scale);
  put(HAND_GAP, {prepared.gap_open, prepared.gap_closed, 0}, 0);
  std::copy(prepared.gap_table.begin(), prepared.gap_table.end(), table.begin() + 4 * HAND_TABLE);
  return table;
}

void set_lattice(VesselArrays& arrays, const PreparedLattice& lattice) {
  arrays.lattice = lattice.words;
  arrays.halves = lattice.halves;
  auto& p = arrays.parameters;
  p.lattice_x = lattice.origin[0];
  p.lattice_y = lattice.origin[1];
  p.lattice_z = lattice.origin[2];
  p.lattice_spacing = lattice.spacing;
  p.lattice_nx = lattice.nx;
  p.lattice_ny = lattice.ny;
  p.lattice_nz = lattice.nz;
}

void set_scene_scalars(Parameters<double>& p, const Scene& scene, const VesselData& vessel) {
  p.gravity = scene.gravity;
  p.force_base = scene.force.base;
  p.force_range = vessel.force_range.value_or(scene.force.range);
  p.force_max = scene.force.max;
  p.friction = scene.force.friction;
  p.torsion = scene.force.torsion;
  p.friction_angle = std::atan(scene.force.friction);
  // with efforts a safe tilt does not depend on the pinch
  p.grip_strength = has_effort(scene) ? std::numeric_limits<double>::infinity() : scene.force.grip_strength;
  if (scene.strength) {
    const auto& digits = scene.strength->digits;
    p.thumb_strength = digits[0];
    p.index_strength = digits[1];
    p.middle_strength = digits[2];
    p.ring_strength = digits[3];
    p.little_strength = digits[4];
    p.palm_strength = digits[5];
    p.tip_radii = scene.strength->by_opening ? scene.hand.scale * tip_radii(scene.hand) : 0;
  }
  p.table_top = scene.table ? table_top(scene, vessel) : 0;
  if (scene.arm) {
    const Triple shoulder = mirrored(shoulder_place(scene, vessel), scene.hand.handedness);
    p.shoulder_x = shoulder[0];
    p.shoulder_y = shoulder[1];
    p.shoulder_z = shoulder[2];
    p.upper_arm = scene.arm->upper_arm;
    p.forearm = scene.arm->forearm;
    p.wrist_radius = scene.arm->wrist_radius;
    p.elbow_radius = scene.arm->elbow_radius;
    p.flexion = scene.arm->flexion;
    p.extension = scene.arm->extension;
    p.ulnar = scene.arm->ulnar;
    p.radial = scene.arm->radial;
    p.pronation = scene.arm->pronation;
    p.supination = scene.arm->supination;
  }
  p.pour_sense = scene.liquid && scene.liquid->pour == Pour::towards ? -1 : 1;
  const auto weights = effective_weights(scene);
  p.weight_fingers = weights[0];
  p.weight_contacts = weights[1];
  p.weight_depth = weights[2];
  p.weight_posture = weights[3];
  p.weight_force = weights[4];
  p.weight_hold = weights[5];
  p.fills = static_cast<std::uint32_t>(scene_fills(scene));
  p.tilts = static_cast<std::uint32_t>(scene.tilts.size());
}

void add_loads(VesselArrays& vessel, const Scene& scene, const Evaluator& core, std::size_t v) {
  vessel.liquid = core_liquid(scene, core, v);
  const std::vector<LiquidResult> states = scene.liquid ? vessel.liquid : std::vector<LiquidResult>(scene.tilts.size());
  const double own = core.constants(v).mass;
  for (const LiquidResult& state : states) {
    const double together = own + state.mass, share = together > 0 ? state.mass / together : 0;
    vessel.loads.insert(vessel.loads.end(), {together, share, share * state.lean, share * state.height});
  }
}

}  // namespace

SceneArrays make_scene_arrays(const Scene& scene, const Evaluator& core, const EvaluatorOptions& options) {
  SceneArrays arrays;
  arrays.hand = hand_table(prepare_hand(scene.hand, options.gap_table > 0 ? options.gap_table : GAP_TABLE_SIZE), scene.hand);
  for (const double tilt : scene.tilts) arrays.tilts.insert(arrays.tilts.end(), {std::sin(tilt), std::cos(tilt), tilt});
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const VesselData& data = scene.vessels[v];
    const PreparedVessel prepared = prepare_vessel(data, data.has_cavity());
    const VesselConstants constants = core.constants(v);
    VesselArrays vessel;
    append_elements(vessel.outline, prepared.outline);
    vessel.outline_count = static_cast<int>(prepared.outline.size());
    auto& p = vessel.parameters;
    set_scene_scalars(p, scene, data);
    p.bound_height = prepared.bound_height;
    p.bound_radius = prepared.bound_radius;
    const Triple center = mirrored(constants.center_of_mass, scene.hand.handedness);
    p.center_x = center[0];
    p.center_y = center[1];
    p.center_z = center[2];
    p.reference = constants.torque_reference;
    p.largest_mass = constants.largest_mass;
    p.largest_share = constants.largest_share;
    p.largest_height = constants.largest_height;
    p.outline_count = vessel.outline_count;
    p.lid = NO_LID;
    p.lid_height = std::numeric_limits<double>::infinity();
    if (const PreparedLattice* lattice = core.lattice(v)) {
      set_lattice(vessel, *lattice);
    } else if (prepared.lid >= 0) {
      p.lid = static_cast<std::uint32_t>(prepared.lid);
      p.lid_radius = prepared.outline[prepared.lid].a[0];
      p.lid_height = prepared.outline[prepared.lid].a[1];
    }
    vessel.counted_tilts = counted_tilts(scene, v);
    add_loads(vessel, scene, core, v);
    arrays.vessels.push_back(std::move(vessel));
  }
  return arrays;
}

namespace {

// A load at a tilt as numbers in which the wrench is linear, for any grip: kg, and kg at a length of 100 mm. With y upwards and n the pour direction
// its force is along cos y - sin n; the moments of the glass's own center, if it lies on the axis, and of the liquid's are along n x y.
Point5 load_point(const double* load, double sine, double cosine, const Parameters<double>& vessel) {
  constexpr double LENGTH = 0.1;
  const double mass = load[0], own = 1 - load[1];
  double moment = load[2] * cosine + load[3] * sine;
  if (vessel.center_x == 0 && vessel.center_z == 0) {
    moment += own * vessel.center_y * sine;
    return {mass * cosine, mass * sine, mass * moment / LENGTH, 0, 0};
  }
  return {mass * cosine, mass * sine, mass * moment / LENGTH, mass * own * cosine, mass * own * sine};
}

}  // namespace

// The worst state is mostly a full one at a large tilt, so those come first, and the others are soon skipped.
EffortStates effort_states(const Scene& scene, std::size_t v, const VesselArrays& vessel) {
  const std::vector<double>& loads = vessel.loads;
  EffortStates found;
  std::vector<Point5> points;
  std::vector<double> states;  // with the angle and the fill
  for (std::size_t state = 0; state < loads.size() / LOAD_STRIDE; ++state) {
    const std::size_t fill = state / scene.tilts.size(), tilt = state % scene.tilts.size();
    if (tilt >= vessel.counted_tilts[fill]) continue;
    const double* load = loads.data() + LOAD_STRIDE * state;
    const double sine = std::sin(scene.tilts[tilt]), cosine = std::cos(scene.tilts[tilt]);
    const double fraction = scene.liquid ? vessel_fills(scene, scene.vessels[v])[fill] : 0;
    points.push_back(load_point(load, sine, cosine, vessel.parameters));
    states.insert(states.end(), {load[0], load[1], load[2], load[3], sine, cosine, scene.tilts[tilt], fraction});
    found.safe.insert(found.safe.end(), {load[0], load[1], load[2], load[3], sine, cosine, tilt > 0 ? scene.tilts[tilt - 1] : -1,
                                         static_cast<double>(fill)});
  }
  std::vector<std::size_t> extreme;
  if (scene.force.torsion > 0) {
    extreme = extreme_points(points);
  } else {  // an effort is not convex in the load if a lever may count as 0
    extreme.resize(points.size());
    std::iota(extreme.begin(), extreme.end(), std::size_t(0));
  }
  if (extreme.empty()) extreme.push_back(0);  // nothing to hold: the first state
  for (std::size_t i = extreme.size(); i-- > 0;) {
    const auto state = states.begin() + static_cast<std::ptrdiff_t>(STATE_STRIDE * extreme[i]);
    found.worst.insert(found.worst.end(), state, state + STATE_STRIDE);
  }
  return found;
}

// Reals first, whole numbers after them, each a scalar: the block is the same list in both.
template <class Real>
Parameters<Real> convert(const Parameters<double>& from) {
  Parameters<Real> to{};
  constexpr std::size_t REALS = offsetof(Parameters<double>, outline_count) / sizeof(double);
  static_assert(offsetof(Parameters<Real>, outline_count) == REALS * sizeof(Real));
  std::array<double, REALS> source;
  std::array<Real, REALS> target;
  std::memcpy(source.data(), &from, sizeof source);
  std::copy(source.begin(), source.end(), target.begin());
  std::memcpy(&to, target.data(), sizeof target);
  to.outline_count = from.outline_count;
  to.lid = from.lid;
  to.lattice_nx = from.lattice_nx;
  to.lattice_ny = from.lattice_ny;
  to.lattice_nz = from.lattice_nz;
  to.fills = from.fills;
  to.tilts = from.tilts;
  return to;
}

template Parameters<float> convert<float>(const Parameters<double>&);
template Parameters<double> convert<double>(const Parameters<double>&);

}  // namespace wholehand::host
