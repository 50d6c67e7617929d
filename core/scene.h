// SPDX-License-Identifier: MIT
// A scene as plain data: what a scene file says, in SI units (m, kg, s, N, rad), before anything is computed from it.
// Everything here is double, whatever the precision of the kernels that are prepared from it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/people_data.h"

namespace wholehand {

using Triple = std::array<double, 3>;    // a point or vector, m unless said otherwise
using Rotation = std::array<double, 9>;  // row-major; its columns are the turned frame's axes
constexpr Rotation NO_ROTATION{1, 0, 0, 0, 1, 0, 0, 0, 1};

constexpr double PI = 3.14159265358979323846;
constexpr double radians(double degrees) { return degrees * (PI / 180); }
constexpr double degrees(double radians) { return radians * (180 / PI); }

enum class Pose { articulated, paper, rigged };
enum class Handedness { right, left };
enum class Surface { solid, shell };
enum class Pour { away, towards };
enum class Torque { paper, exact };
enum class TorqueReference { per_object, per_grip };
enum class Sampling { grid, sobol };
enum class SlideBy { tips, hand };

constexpr int FINGER_COUNT = 5;  // thumb, index, middle, ring, little
constexpr int JOINT_COUNT = 24;  // thumb 0..3, then five each: 4..8, 9..13, 14..18, 19..23
extern const std::array<const char*, FINGER_COUNT> FINGER_NAMES;

// One finger of the hand at scale 1. The thumb uses three segments, four radii and no arch.
struct FingerData {
  Triple base{};                     // metacarpal base in the hand frame, m
  double splay = 0;                  // rad, about +y: thumb Ry(splay), fingers Ry(-splay)
  double arch = 0;                   // rad, about +x, fingers only
  std::array<double, 4> segments{};  // L0..L3, m (thumb: L0..L2)
  std::array<double, 5> radii{};     // metacarpal base .. tip, m (thumb: four)

  bool operator==(const FingerData&) const = default;
};

// An angle's value at closure 0 and 1, rad.
struct AngleRange {
  double open = 0;
  double closed = 0;

  bool operator==(const AngleRange&) const = default;
};

// The default hand is the mean adult's, for equally many women and men: length and breadth of ANSUR II, segment means of Buryanov & Kotiuk 2010 with
// the pulp added (docs/method.md). core/hand_size.h has others.
struct HandData {
  std::string place;  // file:line:column of [hand], for messages; empty: none
  double scale = 1;
  Handedness handedness = Handedness::right;
  double contact_tolerance = 0.2e-3;                                          // m, not scaled
  double max_angle = radians(45);                                             // articulated: largest further turn of one joint
  double paper_max_angle = radians(5);                                        // paper: largest turn of a point
  double depth_limit = 5e-3;                                                  // m
  int between = 2;                                                            // spheres on each bone between its two joints
  std::array<double, 3> joint_limit{radians(90), radians(100), radians(80)};  // MCP, PIP, DIP, rad
  std::array<FingerData, FINGER_COUNT> fingers{{
      {{-22.03e-3, -9.01e-3, -18.03e-3},
       radians(10),
       0,
       {46.29e-3, 31.62e-3, 27.38e-3, 0},
       {9.61e-3, 9.61e-3, 9.61e-3, 9.61e-3, 0}},
      {{-13.02e-3, 0, -28.04e-3},
       radians(-8),
       0,
       {68.22e-3, 39.84e-3, 22.41e-3, 19.69e-3},
       {9.61e-3, 9.61e-3, 9.01e-3, 8.41e-3, 8.41e-3}},
      {{2.10e-3, 1.50e-3, -30.04e-3},
       0,
       0,
       {64.69e-3, 44.69e-3, 26.37e-3, 21.38e-3},
       {9.61e-3, 9.61e-3, 9.01e-3, 8.41e-3, 8.41e-3}},
      {{15.53e-3, 0, -28.04e-3},
       radians(7),
       radians(4),
       {58.08e-3, 41.43e-3, 25.69e-3, 21.28e-3},
       {9.61e-3, 9.61e-3, 9.01e-3, 8.41e-3, 8.41e-3}},
      {{27.68e-3, -3.00e-3, -24.03e-3},
       radians(15),
       radians(8),
       {53.77e-3, 32.79e-3, 18.14e-3, 19.72e-3},
       {9.61e-3, 9.61e-3, 9.01e-3, 8.41e-3, 8.41e-3}},
  }};
  AngleRange thumb_abduction{radians(60), radians(55)};
  AngleRange thumb_mcp{radians(4), radians(5)};
  AngleRange thumb_ip{radians(2), radians(45)};
  AngleRange mcp{radians(4), radians(66)};
  AngleRange pip{radians(12), radians(40)};
  double dip_per_pip = 0.6;

  bool operator==(const HandData&) const = default;
};

// One element of a half outline in (r, y), m: from the previous element's end (the first from (0, 0)) to `end`. An arc is the
// shorter way round its center; of two equal ways the one further from the axis.
struct OutlineElement {
  bool is_arc = false;
  std::array<double, 2> end{};
  std::array<double, 2> center{};
  int line = 0;  // place in the scene file, for messages; 0: none
  int column = 0;
};

struct MeshBody;  // core/mesh_body.h

// A mesh vessel as the scene file names it.
struct MeshData {
  std::string place;  // of the key, as above
  std::string file;
  double scale = 1;
  bool z_is_up = false;      // of the file: its z becomes y before `rotate`
  bool says_up = false;      // the scene says which way is up
  bool close_holes = false;  // closes flat and small ones before the mesh is used
  Triple rotate{};           // rad
  bool origin_at_base = true;
  std::optional<Triple> origin;           // m: the point of the turned file at which the vessel's frame begins, instead of the base
  std::vector<int> parts;                 // numbers from 1 of those that are taken (core/meshes/parts.h); empty: all
  std::optional<double> thickness;        // m, of a sheet that has none
  std::optional<double> lattice_spacing;  // m; absent: as wide as the wanted accuracy allows
  std::shared_ptr<const MeshBody> body;   // the file's body, once read (core/meshes/vessel.h); null before
};

struct GuidancePoint {
  double height = 0;   // m
  double azimuth = 0;  // rad
};

struct VesselData {
  std::string name;
  std::vector<OutlineElement> outline;  // from the axis at the base to the axis at the mouth; the last element is the mouth
  std::optional<MeshData> mesh;         // instead of an outline
  double base = 0;                      // y of the lowest point, m; not 0 only for a mesh whose origin is as it is
  double height = 0;                    // y of the mouth, m; of a mesh, of the highest point, once it is read
  // The cavity: the inner outline if there is one, else the room further than the wall from the outline and above the floor.
  std::vector<OutlineElement> inner;  // from [0, 0] along the axis to the cavity's floor, then rising to its mouth; empty: none
  double wall = 0;                    // m; beside an inner outline the thinnest place; 0: neither given, or a mesh
  double floor = 0;                   // y of the cavity's floor, m; 0: as the wall leaves it
  std::string cavity_place;           // of the key that gives the cavity, as above
  Surface surface = Surface::solid;
  double density = 2230;              // of the wall, kg/m3
  std::optional<double> mass;         // kg, with center_of_mass: both given or neither; of a mesh also alone
  Triple center_of_mass{};            // vessel frame, m; NaN: not given, computed from what the mesh encloses
  std::optional<double> force_range;  // N; the scene's when absent
  std::vector<GuidancePoint> guidance;
  Triple place{};           // live scene, m
  std::string liquid_name;  // live task
  double liquid_fill = 0;
  int line = 0;  // place in the scene file, for messages
  int column = 0;

  std::vector<double> fills;  // of the scene's liquid, fractions of this vessel's capacity; empty if those of LiquidData apply

  bool has_cavity() const { return !inner.empty() || wall > 0; }
  // A body of revolution about its axis, in mass as well as in shape.
  bool is_symmetric() const { return !mesh && (!mass || (center_of_mass[0] == 0 && center_of_mass[2] == 0)); }
};

struct LiquidData {
  double density = 1000;        // kg/m3
  std::vector<double> fills;    // fractions of the capacity upright to the brim, strictly ascending; empty where volumes are given
  std::vector<double> volumes;  // m3, strictly ascending; each vessel then has its own fractions. One of the two has entries
  Pour pour = Pour::away;
};

struct ForceData {
  double base = 0.8;  // F_base, N
  double range = 3;   // F_range, N
  Torque torque = Torque::paper;
  TorqueReference reference = TorqueReference::per_object;
  double max = 8;             // F_max, N
  double k_open = 600;        // N/m of the device's gap
  double friction = 0.6;      // mu
  double torsion = 5e-3;      // gamma, m
  double grip_strength = 40;  // N, of two fingers, where the scene has no strengths; no key of a scene
};

// The largest sum of normal forces of each digit's contacts, N: thumb, index, middle, ring, little, palm. docs/method.md has the
// sources.
struct StrengthData {
  std::array<double, FINGER_COUNT + 1> digits{40, 25, 35, 25, 14, 80};
  bool by_opening = true;  // strengths fall as the hand opens; false: the same at every opening
  std::string place;       // of [strength], as above; empty: by default

  bool operator==(const StrengthData& other) const { return digits == other.digits && by_opening == other.by_opening; }
};

// Values of one axis of the grips, as the scene asks for them.
struct Axis {
  std::vector<double> values{0.0};  // SI; never empty
  bool is_range = false;            // from the first value to the last: Sobol points fill it, a grid has the values
};

struct GripsData {
  std::string place;               // as above
  bool height_is_fraction = true;  // `height` holds fractions of the vessel's height
  Axis height{{0.5}}, azimuth, obliquity, roll, offset, hand_scale{{1.0}};
  Sampling sampling = Sampling::grid;
  std::uint64_t count = 0;  // Sobol points a vessel
  std::uint64_t seed = 0;
};

struct ScoreWeights {
  // Fitted to trials in a physics engine, and rounded to 0.01 (docs/trials.md, "The default weights")
  double fingers = 0.02, contacts = 0.02, depth = 0.69, posture = 0.02, force = 0.13, hold = 0.12;
};

struct OutputData {
  std::string keep_place;                        // as above
  std::optional<std::vector<std::string>> keep;  // variable names; absent: the default set
  std::string also_place;                        // as above
  std::vector<std::string> also;                 // variables in addition to the default set
  int best = 20;
  double apart = 25e-3;  // m, by which some joint of the hand must differ between any two of the best grips; 0: any two differ
};

// The level plane at a vessel's lowest point, on which it stands until it is lifted.
struct TableData {
  double clearance = 2e-3;  // m, that the hand must keep above it
};

// The arm of a person who sits in front of a vessel, and how far the wrist turns from neutral, where hand and forearm are in line and the thumb is
// up. docs/people.md has the sources.
struct ArmData {
  Triple shoulder{0.2, 0.35, 0.4};                    // from the vessel's base: to the right, up and to the person, m
  double upper_arm = 0.315, forearm = 0.247;          // m
  double wrist_radius = 26e-3, elbow_radius = 45e-3;  // m
  double flexion = radians(76), extension = radians(75);
  double radial = radians(22), ulnar = radians(36);
  double pronation = radians(76), supination = radians(82);

  bool operator==(const ArmData&) const = default;
};

// How far a person's grip deviates from the plan: standard deviations, and how many deviations of each of the best grips are scored.
struct RobustData {
  double height = 0, offset = 0;                // m
  double azimuth = 0, obliquity = 0, roll = 0;  // rad
  double friction = 0;
  double hand_scale = 0;  // of the grip's
  int count = 64;
  std::uint64_t seed = 1;

  bool operator==(const RobustData&) const = default;
};

struct LiveData {
  double rate = 1000, stiffness = 800, damping = 1, slip = 8e-3, ramp = 0.5, slew = 2000, jump = 5;
  int late_steps = 3;
  bool slide = false;                // a held vessel slides where the grip is too weak
  SlideBy slide_by = SlideBy::tips;  // whose hold force counts there
};

struct DeviceData {
  std::array<double, 2> gap{};  // closed, open, m
  bool has_gap = false;
  double workspace_scale = 1;
  Triple origin{};
  std::array<std::string, 3> axes{{"x", "y", "z"}};
  int clutch_button = -1;
  std::string library;
};

struct TaskData {
  Triple target_place{};
  double target_diameter = 0;
  std::vector<std::pair<std::string, double>> amounts;  // liquid name, m3
  Triple destination{};
  double tolerance = 0;  // m3
};

// An absent table of the file is an absent optional here: that part of the work is left out.
struct Scene {
  std::string name;
  Pose pose = Pose::articulated;
  double gravity = 9.80665;  // m/s2
  HandData hand;
  std::vector<VesselData> vessels;
  std::optional<LiquidData> liquid;
  std::optional<StrengthData> strength;  // absent: no effort is computed; a scene file without [strength] has the default
  ForceData force;                       // a scene without [force] has these defaults
  GripsData grips;
  std::vector<double> tilts;           // rad, strictly ascending in [0, pi]; empty: no [tilts], no force kernel
  std::optional<double> until_poured;  // share of a fill, (0, 1]: tilts after the first at which it has poured are left out
  ScoreWeights score;
  OutputData output;
  std::optional<TableData> table;
  std::optional<ArmData> arm;
  std::optional<RobustData> robust;  // absent: no robust scores
  PeopleData people;                 // for what draws people
  LiveData live;
  DeviceData device;
  std::optional<TaskData> task;
  std::string file;  // where it was read from
  std::string text;  // its text, kept in the results
};

}  // namespace wholehand
