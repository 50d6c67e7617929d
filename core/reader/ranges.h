// SPDX-License-Identifier: MIT
// The range of every quantity in a scene file or on a command line, in the unit of its key. Wide ranges catch slips (a length in meters, an angle in
// radians by the hundred) and values that the kernels cannot handle, not unusual scenes. docs/scene.md lists them beside the keys.
#pragma once

#include <cstddef>
#include <cstdint>

namespace wholehand {

// Unit of a number in a file; `si`: taken as it is (SI, or a pure number).
enum class Unit { si, mm, deg, ml };

// Range of a quantity, both ends allowed, in its own unit.
struct Quantity {
  double low = 0;
  double high = 0;
  Unit unit = Unit::si;
};

// Whole numbers, both ends allowed.
struct IntegerRange {
  std::int64_t low = 0;
  std::int64_t high = 0;
};

// From a file's unit to m, rad or m3. Divides, so that 22.5 mm becomes exactly the double nearest to 0.0225.
double to_si(double value, Unit unit);

namespace ranges {

constexpr std::size_t LARGEST_FILE = 1 << 20;  // bytes
constexpr std::size_t LARGEST_KEY_DEPTH = 8;   // parts of a dotted key
constexpr std::size_t LARGEST_NAME = 64;       // characters of a vessel's, liquid's or scene's name
constexpr std::size_t LARGEST_PATH = 4096;     // characters
constexpr std::size_t LARGEST_VESSELS = 64;
constexpr std::size_t LARGEST_OUTLINE = 1000;   // elements
constexpr std::size_t LARGEST_GUIDANCE = 1000;  // points
constexpr std::size_t LARGEST_FILLS = 64;
constexpr std::size_t LARGEST_TILTS = 2048;
constexpr std::size_t LARGEST_AXIS = 1000000;  // values
constexpr std::size_t LARGEST_PARTS = 1000;
constexpr std::size_t LARGEST_KEEP = 1000;  // variable names

constexpr Quantity GRAVITY{0, 100};
constexpr Quantity SCALE{0.05, 20};  // of the hand, and hand_scale of a grip

constexpr Quantity HAND_LENGTH{100, 300, Unit::mm};
constexpr Quantity PERCENTILE{0.01, 99.99};

constexpr Quantity CONTACT_TOLERANCE{0, 10, Unit::mm};
constexpr Quantity DEPTH_LIMIT{0, 100, Unit::mm};
constexpr Quantity TURN{0, 180, Unit::deg};  // max_angle, paper_max_angle, joint limits
constexpr Quantity HAND_BASE{-500, 500, Unit::mm};
constexpr Quantity HAND_SPREAD{-90, 90, Unit::deg};  // splay, arch
constexpr Quantity SEGMENT{1, 500, Unit::mm};
constexpr Quantity JOINT_RADIUS{0, 100, Unit::mm};
constexpr Quantity JOINT_ANGLE{-180, 180, Unit::deg};
constexpr Quantity DIP_PER_PIP{0, 2};

constexpr Quantity DIAMETER{1, 10000, Unit::mm};
constexpr Quantity HEIGHT{1, 10000, Unit::mm};
constexpr Quantity UPRIGHT{0, 10000, Unit::mm};
constexpr Quantity OUTLINE_R{0, 5000, Unit::mm};
constexpr Quantity OUTLINE_Y{-10000, 10000, Unit::mm};
constexpr Quantity CENTER{-25000, 25000, Unit::mm};  // of an arc, r and y
constexpr Quantity WALL{0.05, 100, Unit::mm};
constexpr Quantity FLOOR{0.05, 10000, Unit::mm};  // height of a cavity's floor
constexpr Quantity FILLET{0.01, 5000, Unit::mm};
constexpr Quantity VESSEL_DENSITY{1, 25000};  // kg/m3
constexpr Quantity MASS{1e-6, 1e6};           // kg
constexpr Quantity CENTER_OF_MASS{-10000, 10000, Unit::mm};
constexpr Quantity MESH_SCALE{1e-6, 1e6};
constexpr Quantity ROTATION{-360, 360, Unit::deg};  // also azimuth and roll
constexpr Quantity LATTICE_SPACING{0.05, 100, Unit::mm};
constexpr Quantity PLACE{-10000, 10000, Unit::mm};

constexpr Quantity LIQUID_DENSITY{1, 25000};  // kg/m3
constexpr Quantity FRACTION{0, 1};            // fill, height fraction
constexpr Quantity FILL_VOLUME{0, 1e10, Unit::ml};

constexpr Quantity BASE_FORCE{0, 100};         // N
constexpr Quantity FORCE_RANGE{0, 100};        // N
constexpr Quantity MAX_FORCE{0, 1000};         // N
constexpr Quantity OPENING_STIFFNESS{0, 1e6};  // N/m
constexpr Quantity FRICTION{0, 10};
constexpr Quantity TORSION{0, 100, Unit::mm};
constexpr Quantity GRIP_STRENGTH{0.1, 10000};  // N

constexpr Quantity GRIP_HEIGHT{-10000, 20000, Unit::mm};
constexpr Quantity OBLIQUITY{-90, 90, Unit::deg};
constexpr Quantity OFFSET{-10000, 10000, Unit::mm};
constexpr Quantity POINT{-25000, 25000, Unit::mm};  // a fingertip given on the command line
constexpr Quantity TILT{0, 180, Unit::deg};
constexpr Quantity POURED_SHARE{1e-6, 1};
constexpr Quantity MESH_ORIGIN{-1e12, 1e12, Unit::mm};  // a mesh has coordinates up to a million km
constexpr IntegerRange PART{1, 100000};                 // of a mesh
constexpr IntegerRange BETWEEN{0, 8};
constexpr IntegerRange AXIS_COUNT{1, LARGEST_AXIS};
constexpr IntegerRange SOBOL_COUNT{1, 1000000000000000};
constexpr IntegerRange SEED{0, INT64_MAX};

constexpr Quantity TABLE_CLEARANCE{0, 100, Unit::mm};

constexpr Quantity ARM_LENGTH{10, 5000, Unit::mm};
constexpr Quantity ARM_RADIUS{1, 500, Unit::mm};
constexpr Quantity RANGE_OF_MOTION{1, 180, Unit::deg};  // of wrist and forearm, one way

constexpr Quantity LENGTH_DEVIATION{0, 100, Unit::mm};
constexpr Quantity ANGLE_DEVIATION{0, 90, Unit::deg};
constexpr Quantity FRICTION_DEVIATION{0, 1};
constexpr Quantity SCALE_DEVIATION{0, 0.3};
constexpr IntegerRange DEVIATION_COUNT{8, 4096};
constexpr Quantity SCATTER{0, 10};  // factors on the deviations of [people]

constexpr Quantity WEIGHT{0, 1000};
constexpr IntegerRange BEST{0, 100000};
constexpr Quantity APART{0, 10000, Unit::mm};

constexpr Quantity RATE{250, 8000};             // Hz
constexpr Quantity COUPLING_STIFFNESS{0, 1e5};  // N/m
constexpr Quantity COUPLING_DAMPING{0, 1000};   // N s/m
constexpr Quantity SLIP{0.1, 1000, Unit::mm};
constexpr Quantity RAMP{0, 60};       // s
constexpr Quantity SLEW{1, 1e7};      // N/s
constexpr Quantity JUMP{0.01, 1000};  // m/s
constexpr IntegerRange LATE_STEPS{1, 1000};

constexpr Quantity GAP{0, 1000, Unit::mm};
constexpr Quantity WORKSPACE_SCALE{0.01, 100};
constexpr IntegerRange BUTTON{0, 31};

constexpr Quantity AMOUNT{0, 1e6, Unit::ml};
constexpr Quantity AMOUNT_TOLERANCE{1e-3, 1e6, Unit::ml};

constexpr IntegerRange THREADS{1, 1024};  // command line

}  // namespace ranges
}  // namespace wholehand
