// SPDX-License-Identifier: MIT
#include "tests/support/scenes.h"
#include "base/numbers/random_bits.h"
#include "core/result.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wholehand {

// ---- vessels ----

OutlineElement line_to(double r_mm, double y_mm) {
  OutlineElement element;
  element.end = {r_mm * 1e-3, y_mm * 1e-3};
  return element;
}

OutlineElement arc_to(double r_mm, double y_mm, double center_r_mm, double center_y_mm) {
  OutlineElement element = line_to(r_mm, y_mm);
  element.is_arc = true;
  element.center = {center_r_mm * 1e-3, center_y_mm * 1e-3};
  return element;
}

VesselData vessel_of(const std::string& name, std::vector<OutlineElement> outline, double wall_mm) {
  VesselData vessel;
  vessel.name = name;
  vessel.height = outline.back().end[1];
  vessel.outline = std::move(outline);
  vessel.wall = wall_mm * 1e-3;
  return vessel;
}

VesselData cylinder(const std::string& name, double diameter_mm, double height_mm, double wall_mm) {
  const double r = diameter_mm / 2;
  return vessel_of(name, {line_to(r, 0), line_to(r, height_mm), line_to(0, height_mm)}, wall_mm);
}

VesselData beaker1() {
  VesselData vessel = cylinder("beaker1", 80, 110, 1.5);
  vessel.force_range = 2;
  return vessel;
}

VesselData beaker2() {
  const double r = 42.5, neck = 17;
  const double meets = r + std::sqrt((r - neck) * (r + neck));  // where the sphere meets the neck
  VesselData vessel = vessel_of("beaker2", {arc_to(neck, meets, 0, r), line_to(neck, 140), line_to(0, 140)}, 1.5);
  vessel.force_range = 3;
  return vessel;
}

VesselData beaker3() {
  VesselData vessel =
      vessel_of("beaker3", {line_to(42.5, 0), line_to(42.5, 4), line_to(17, 105), line_to(17, 145), line_to(0, 145)}, 1.5);
  vessel.force_range = 4;
  return vessel;
}

VesselData vase() {
  return vessel_of("vase",
                   {line_to(18, 0), arc_to(24, 6, 18, 6),     // rounded foot
                    line_to(24, 14), arc_to(24, 38, 33, 26),  // waist, concave, a corner at either end
                    line_to(30, 44), arc_to(30, 60, 30, 52),  // belly, a half circle from pole to pole
                    arc_to(22, 68, 30, 68),                   // smooth and concave into the neck
                    line_to(22, 80), arc_to(26, 84, 26, 80),  // concave, smooth into the bead
                    arc_to(26, 92, 26, 88), line_to(24, 96), line_to(0, 96)},
                   1);
}

VesselData ledges() {
  VesselData vessel = vessel_of("ledges",
                                {line_to(24, 0), arc_to(30, 6, 24, 6), line_to(30, 20), arc_to(30, 44, 39, 32),  // waist
                                 line_to(36, 44),         // a level ledge seen from below
                                 arc_to(36, 60, 36, 52),  // half circle
                                 arc_to(30, 60, 33, 61),  // trough: concave, passes the bottom of its circle
                                 arc_to(24, 60, 27, 59),  // bump: convex, passes the top of its circle, smooth after the trough
                                 line_to(20, 78), arc_to(26, 84, 26, 78), line_to(26, 90), line_to(0, 90)},
                                0);
  vessel.mass = 0.12;
  vessel.center_of_mass = {0, 40e-3, 0};
  return vessel;
}

VesselData can() {
  VesselData vessel =
      vessel_of("can", {line_to(30, 0), arc_to(40, 10, 30, 10), line_to(40, 80), arc_to(30, 90, 30, 80), line_to(0, 90)}, 0);
  vessel.mass = 0.4;
  vessel.center_of_mass = {0, 45e-3, 0};
  return vessel;
}

VesselData spindle() {
  VesselData vessel = vessel_of("spindle", {line_to(20, 30), line_to(0, 80)}, 0);
  vessel.mass = 0.05;
  vessel.center_of_mass = {0, 35e-3, 0};
  return vessel;
}

VesselData lopsided() {
  VesselData vessel = beaker1();
  vessel.name = "lopsided";
  vessel.mass = 0.2;
  vessel.center_of_mass = {7e-3, 45e-3, -4e-3};
  return vessel;
}

VesselData shell_of(VesselData vessel) {
  vessel.name += "_shell";
  vessel.surface = Surface::shell;
  return vessel;
}

VesselData scaled(const VesselData& vessel, double factor) {
  VesselData result = vessel;
  result.name += "_scaled";
  for (OutlineElement& element : result.outline) {
    for (double& value : element.end) value *= factor;
    for (double& value : element.center) value *= factor;
  }
  result.height *= factor;
  result.wall *= factor;
  for (double& value : result.center_of_mass) value *= factor;
  return result;
}

double largest_radius(const VesselData& vessel) {
  double largest = 0;
  std::array<double, 2> start{};
  for (const OutlineElement& element : vessel.outline) {
    largest = std::max(largest, element.end[0]);
    const bool spans_its_side = element.is_arc && (start[1] - element.center[1]) * (element.end[1] - element.center[1]) <= 0;
    if (spans_its_side && start[0] + element.end[0] >= 2 * element.center[0]) {
      largest =
          std::max(largest, element.center[0] + std::hypot(element.end[0] - element.center[0], element.end[1] - element.center[1]));
    }
    start = element.end;
  }
  return largest;
}

// ---- hands ----

HandData left_hand() {
  HandData hand = paper_hand();
  hand.handedness = Handedness::left;
  return hand;
}

HandData tiny_hand() {
  HandData hand = paper_hand();
  hand.scale = 0.1;
  return hand;
}

HandData large_hand() {
  HandData hand = paper_hand();
  hand.scale = 3;
  return hand;
}

HandData odd_hand() {
  HandData hand = paper_hand();
  hand.scale = 1.13;
  hand.contact_tolerance = 0.5e-3;
  hand.max_angle = radians(30);
  hand.paper_max_angle = radians(8);
  hand.depth_limit = 3e-3;
  hand.joint_limit = {radians(75), radians(60), radians(50)};
  hand.fingers = {{
      {{-24e-3, -8e-3, -15e-3}, radians(13), 0, {44e-3, 33e-3, 29e-3, 0}, {9e-3, 8.5e-3, 8e-3, 6e-3, 0}},
      {{-14e-3, 1e-3, -29e-3}, radians(-7), radians(1), {66e-3, 41e-3, 23e-3, 20e-3}, {8e-3, 7.8e-3, 7.1e-3, 6.5e-3, 5e-3}},
      {{-3e-3, 2e-3, -31e-3}, radians(1), radians(2), {63e-3, 43e-3, 27e-3, 22e-3}, {8.1e-3, 7.7e-3, 7e-3, 6.4e-3, 0}},
      {{7e-3, 1e-3, -27e-3}, radians(8), radians(5), {59e-3, 42e-3, 26e-3, 20.5e-3}, {7.9e-3, 7.5e-3, 0, 6.3e-3, 6e-3}},
      {{18e-3, -2e-3, -25e-3}, radians(17), radians(9), {52e-3, 31e-3, 19e-3, 18.7e-3}, {7.5e-3, 7e-3, 6.5e-3, 6e-3, 5.5e-3}},
  }};
  hand.thumb_abduction = {radians(62), radians(56)};
  hand.thumb_mcp = {radians(3), radians(7)};
  hand.thumb_ip = {radians(1), radians(40)};
  hand.mcp = {radians(2), radians(64)};
  hand.pip = {radians(10), radians(43)};
  hand.dip_per_pip = 0.55;
  return hand;
}

// ---- scenes ----

std::vector<double> linspace(double from, double to, int count) {
  std::vector<double> values(static_cast<std::size_t>(count), from);
  for (int i = 1; i < count; ++i) values[static_cast<std::size_t>(i)] = i == count - 1 ? to : from + (to - from) * i / (count - 1);
  return values;
}

Axis axis_of(double from, double to, int count) { return {linspace(from, to, count), true}; }

Scene three_beakers() {
  Scene scene = scene_of({beaker1(), beaker2(), beaker3()});
  scene.name = "three_beakers";
  scene.liquid = LiquidData{};
  scene.liquid->fills = {0, 0.25, 0.5, 0.75, 1};
  scene.grips.height = axis_of(0.10, 0.95, 64);
  scene.grips.obliquity = axis_of(radians(-20), radians(20), 9);
  scene.grips.roll = axis_of(radians(-90), radians(30), 16);
  scene.tilts = linspace(0, radians(150), 31);
  return scene;
}

void take_few_grips(Scene& wet) {
  wet.liquid->fills = {1};
  wet.tilts = {0, radians(60)};
  wet.grips.height = {linspace(0.2, 0.9, 24)};
  wet.grips.roll = {linspace(radians(-60), radians(10), 12)};
  wet.grips.obliquity = {linspace(radians(-10), radians(10), 6)};
}

Scene scene_of(std::vector<VesselData> vessels, Pose pose, const HandData& hand) {
  Scene scene;
  scene.name = "test";
  scene.pose = pose;
  scene.hand = hand;
  scene.hand.between = 0;
  scene.vessels = std::move(vessels);
  return scene;
}

// ---- made ready for core_f64 ----

core_f64::Hand ready_hand(const HandData& hand) {
  core_f64::Hand ready = core_f64::load_hand(prepare_hand(hand), hand);
  ready.between = 0;
  return ready;
}

core_f64::Vessel ready_vessel(const VesselData& vessel, bool with_liquid) {
  const PreparedVessel prepared = prepare_vessel(vessel, vessel.wall > 0);
  return core_f64::load_vessel(prepared, vessel, core_f64::load_quadrature(prepare_quadrature(QUADRATURE_POINTS)), with_liquid,
                               Handedness::right);
}

core_f64::Grip ready_grip(const GripInput& grip) {
  return {grip.height, grip.azimuth, grip.obliquity, grip.roll, grip.offset, grip.hand_scale};
}

// ---- samples ----

double Random::uniform(double low, double high) { return low + (high - low) * unit_interval(split_mix(state_)); }

GripInput mirrored_grip(GripInput grip) {
  grip.azimuth = PI - grip.azimuth;
  grip.offset = -grip.offset;
  return grip;
}

std::vector<GripInput> sample_grips(const VesselData& vessel, int count, std::uint64_t seed) {
  Random random(seed);
  const double radius = largest_radius(vessel);
  std::vector<GripInput> grips(static_cast<std::size_t>(count));
  for (GripInput& grip : grips) {
    grip.height = vessel.height * random.uniform(0.05, 0.95);
    grip.azimuth = random.uniform(-PI, PI);
    grip.obliquity = radians(random.uniform(-25, 25));
    grip.roll = radians(random.uniform(-100, 40));
    grip.offset = radius * random.uniform(-0.4, 0.4);
  }
  return grips;
}

// ---- the hand by rotation matrices ----

LongRotation rotation_x(long double angle) {
  const long double c = std::cos(angle), s = std::sin(angle);
  return {{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
}

LongRotation rotation_y(long double angle) {
  const long double c = std::cos(angle), s = std::sin(angle);
  return {{{c, 0, s}, {0, 1, 0}, {-s, 0, c}}};
}

LongRotation rotation_z(long double angle) {
  const long double c = std::cos(angle), s = std::sin(angle);
  return {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
}

LongRotation operator*(const LongRotation& a, const LongRotation& b) {
  LongRotation product{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) product[i][j] += a[i][k] * b[k][j];
    }
  }
  return product;
}

Long3 operator*(const LongRotation& a, const Long3& p) { return {dot(a[0], p), dot(a[1], p), dot(a[2], p)}; }
Long3 operator+(const Long3& a, const Long3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Long3 operator-(const Long3& a, const Long3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Long3 operator*(long double s, const Long3& a) { return {s * a[0], s * a[1], s * a[2]}; }
long double dot(const Long3& a, const Long3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Long3 cross(const Long3& a, const Long3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
long double length(const Long3& a) { return std::sqrt(dot(a, a)); }

Long3 reference_thumb_angles(const HandData& hand, long double closure) {
  const auto at = [closure](const AngleRange& range) {
    return range.open + closure * (static_cast<long double>(range.closed) - range.open);
  };
  return {at(hand.thumb_abduction), at(hand.thumb_mcp), at(hand.thumb_ip)};
}

Long3 reference_finger_angles(const HandData& hand, long double closure) {
  const auto at = [closure](const AngleRange& range) {
    return range.open + closure * (static_cast<long double>(range.closed) - range.open);
  };
  return {at(hand.mcp), at(hand.pip), hand.dip_per_pip * at(hand.pip)};
}

std::vector<Long3> reference_finger(const HandData& hand, int finger, const Long3& angles) {
  const FingerData& data = hand.fingers[static_cast<std::size_t>(finger)];
  const bool is_thumb = finger == 0;
  const std::vector<LongRotation> turns =
      is_thumb
          ? std::vector<LongRotation>{rotation_y(data.splay) * rotation_x(-angles[0]), rotation_x(angles[1]), rotation_x(angles[2])}
          : std::vector<LongRotation>{
                rotation_y(-static_cast<long double>(data.splay)) * rotation_x(-static_cast<long double>(data.arch)),
                rotation_x(-angles[0]), rotation_x(-angles[1]), rotation_x(-angles[2])};
  const long double scale = hand.scale;
  std::vector<Long3> joints{{scale * data.base[0], scale * data.base[1], scale * data.base[2]}};
  LongRotation R = rotation_x(0);
  for (std::size_t k = 0; k < turns.size(); ++k) {
    R = R * turns[k];
    joints.push_back(joints.back() + R * Long3{0, 0, -scale * data.segments[k]});
  }
  return joints;
}

std::array<Long3, JOINT_COUNT> reference_hand(const HandData& hand, long double closure) {
  std::array<Long3, JOINT_COUNT> joints{};
  std::size_t next = 0;
  for (int finger = 0; finger < FINGER_COUNT; ++finger) {
    const Long3 angles = finger == 0 ? reference_thumb_angles(hand, closure) : reference_finger_angles(hand, closure);
    for (const Long3& joint : reference_finger(hand, finger, angles)) joints[next++] = joint;
  }
  return joints;
}

long double reference_gap(const HandData& hand, long double closure) {
  const auto joints = reference_hand(hand, closure);
  return length(joints[INDEX_TIP] - joints[THUMB_TIP]);
}

core_f64::Lattice lattice_of(const VesselData& vessel, int samples, int bits) {
  return core_f64::load_lattice(prepare_lattice(prepare_vessel(vessel, vessel.wall > 0), samples, bits == 16));
}

core_f64::Vessel lattice_vessel(const VesselData& vessel, int samples, int bits) {
  core_f64::Vessel ready = ready_vessel(vessel);
  core_f64::use_lattice(ready, lattice_of(vessel, samples, bits));
  return ready;
}

}  // namespace wholehand
