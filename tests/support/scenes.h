// SPDX-License-Identifier: MIT
// What the tests are run on: vessels, hands and scenes built in C++ (no file, no reader), the same made ready for the core in
// double precision, sampled grips, and the hand by rotation matrices: the specification read a second time.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/grip.h"
#include "core/hand_size.h"
#include "core/load.h"
#include "core/prepare.h"
#include "core/result.h"
#include "core/scene.h"

namespace wholehand {

// ---- vessels; dimensions in mm, as in a scene file ----

OutlineElement line_to(double r_mm, double y_mm);
OutlineElement arc_to(double r_mm, double y_mm, double center_r_mm, double center_y_mm);
VesselData vessel_of(const std::string& name, std::vector<OutlineElement> outline, double wall_mm);
VesselData cylinder(const std::string& name, double diameter_mm, double height_mm, double wall_mm);
VesselData beaker1();   // the default scene's cylinder, 80 x 110
VesselData beaker2();   // its round-bottom flask: an arc that starts at its circle's pole on the axis
VesselData beaker3();   // its conical flask
VesselData vase();      // twelve elements, six of them arcs, convex and concave, smooth joints and corners; has a cavity
VesselData can();       // base and rim rounded: no tangent has anything beyond it; no wall, mass given
VesselData spindle();   // two cones, with tips on the axis; no wall, mass given
VesselData ledges();    // twelve elements with level ledges, overhangs and arcs that pass their circle's pole; no wall, mass given
VesselData lopsided();  // beaker1 with its mass and a center of mass off the axis given
VesselData shell_of(VesselData vessel);                      // the same with surface = shell
VesselData scaled(const VesselData& vessel, double factor);  // every length of it
double largest_radius(const VesselData& vessel);             // m

// ---- hands ----

// All but the odd one have the proportions of the paper's.
HandData left_hand();
HandData tiny_hand();   // scale 0.1
HandData large_hand();  // scale 3
HandData odd_hand();    // every number another than the paper's, no two fingers alike, radii 0 among them

// ---- scenes ----

constexpr double G = 9.80665;  // m/s2, what a scene has where it says nothing else
std::vector<double> linspace(double from, double to, int count);
Axis axis_of(double from, double to, int count);
Scene three_beakers();  // the default scene with a quarter of its grips, and without hand, table, arm, strengths and deviations
void take_few_grips(Scene& wet);  // 1,728 of each vessel, brim-full, at 0 and 60 degrees: they are several chunks
// A scene with these vessels and hand (the paper's, for which many tests know numbers), the default in everything else: no liquid, no tilts; the hand
// is its 24 points alone, without spheres between them.
Scene scene_of(std::vector<VesselData> vessels, Pose pose = Pose::articulated, const HandData& hand = paper_hand());

// ---- made ready for core_f64 ----

core_f64::Hand ready_hand(const HandData& hand);
core_f64::Vessel ready_vessel(const VesselData& vessel, bool with_liquid = false);
// The vessel's lattice of so many samples along its longest side.
core_f64::Lattice lattice_of(const VesselData& vessel, int samples, int bits = 32);
// The vessel with that lattice in place of the outline.
core_f64::Vessel lattice_vessel(const VesselData& vessel, int samples, int bits = 32);
core_f64::Grip ready_grip(const GripInput& grip);

// ---- samples that are the same everywhere ----

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double uniform(double low, double high);  // in [low, high)

 private:
  std::uint64_t state_;
};

// Grips spread over heights 5 to 95 %, all azimuths, obliquity +-25 and roll -100 to 40 degrees, offset +-40 % of the radius.
std::vector<GripInput> sample_grips(const VesselData& vessel, int count, std::uint64_t seed);

// The same grip in the scene mirrored in x: the line's direction loses its sign in x, and what lies to one side of it is on the other.
GripInput mirrored_grip(GripInput grip);

// ---- the hand by rotation matrices, in long double: R p, with p0 = base and p_{k+1} = p_k + R (0, 0, -L) ----

using Long3 = std::array<long double, 3>;
using LongRotation = std::array<Long3, 3>;  // rows

LongRotation rotation_x(long double angle);
LongRotation rotation_y(long double angle);
LongRotation rotation_z(long double angle);
LongRotation operator*(const LongRotation& a, const LongRotation& b);
Long3 operator*(const LongRotation& a, const Long3& p);
Long3 operator+(const Long3& a, const Long3& b);
Long3 operator-(const Long3& a, const Long3& b);
Long3 operator*(long double s, const Long3& a);
long double dot(const Long3& a, const Long3& b);
Long3 cross(const Long3& a, const Long3& b);
long double length(const Long3& a);

// Joint angles on the trajectory, rad: abduction, MCP, IP of the thumb; MCP, PIP, DIP of a finger.
Long3 reference_thumb_angles(const HandData& hand, long double closure);
Long3 reference_finger_angles(const HandData& hand, long double closure);
// The joints of one finger in the hand frame, scale included: 4 for finger 0, the thumb, 5 for the others.
std::vector<Long3> reference_finger(const HandData& hand, int finger, const Long3& angles);
std::array<Long3, JOINT_COUNT> reference_hand(const HandData& hand, long double closure);
long double reference_gap(const HandData& hand, long double closure);

}  // namespace wholehand
