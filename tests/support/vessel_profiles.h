// SPDX-License-Identifier: MIT
// Profiles of lines and arcs that turn about the y axis, with volumes in closed form, and meshes of them.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "core/meshes/triangles.h"

namespace wholehand {

using ProfilePoints = std::vector<std::array<double, 2>>;  // (r, y), m

// A path in the half-plane r >= 0. Its maker's numbers are millimeters, what it returns is in m.
class TurnedProfile {
 public:
  TurnedProfile(double r, double y) : from_{r, y} {}

  TurnedProfile& line(double r, double y);
  // The shorter way round. The center must be equally far from both ends: throws std::logic_error otherwise.
  TurnedProfile& arc(double r, double y, double center_r, double center_y);
  // The arc whose center is on the axis: a cap of a sphere.
  TurnedProfile& cap(double r, double y);

  // The integral of pi r^2 dy along the path, m3: exact for lines (frustums) and arcs (their antiderivative).
  double volume() const;
  // Its corners, and points on its arcs so close that no chord is farther than PROFILE_SAGITTA from its arc.
  ProfilePoints points() const;

 private:
  struct Element {
    std::array<double, 2> end{};
    std::array<double, 2> center{};
    double radius = 0;            // 0: a line
    double start = 0, sweep = 0;  // angles about the center, rad
  };

  std::array<double, 2> end() const { return elements_.empty() ? from_ : elements_.back().end; }

  std::array<double, 2> from_;
  std::vector<Element> elements_;
};

constexpr double PROFILE_SAGITTA = 0.02e-3;  // m

// The radius at height y of the circle about (center_r, center_y): on its side away from the axis, or towards it.
double outer_side(double center_r, double center_y, double radius, double y);
double inner_side(double center_r, double center_y, double radius, double y);

// The integral of pi r^2 dy along a chain of lines, m3.
double frustums(const ProfilePoints& points);
// The area of a regular polygon over that of the circle through its corners.
double polygon_share(int sides);
// The same chain with no step longer than `step`, m.
ProfilePoints divided(const ProfilePoints& points, double step);

// The place of a profile's point at an angle about the axis.
using RingShape = std::function<Triple(double r, double y, double angle)>;
Triple round_ring(double r, double y, double angle);
// A square of half-side r, with its sides across x and z.
Triple square_ring(double r, double y, double angle);

// The surface that the points sweep in `sides` steps. It faces outward if the path runs upward outside the body, and
// closed only if it ends on the axis too, or where it began.
TriangleMesh swept_mesh(const ProfilePoints& points, int sides, const RingShape& shape = round_ring);
// The body between an outer and an inner path. Both start on the axis, and a flat rim joins their ends.
TriangleMesh walled_mesh(const ProfilePoints& outer, const ProfilePoints& inner, int sides,
                         const RingShape& outer_shape = round_ring, const RingShape& inner_shape = round_ring);

// A round bar that leaves a wall along +x, turns back in a half circle, and ends in the wall below; m.
struct Handle {
  double bar = 0;       // radius of its section
  double bend = 0;      // radius of the half circle
  double end_x = 0;     // of both ends' flat faces
  double center_x = 0;  // of the half circle
  double center_y = 0;

  // What of it lies outside a cylinder about the y axis with that radius, m3: the half torus by Pappus, and each straight part from the cylinder on,
  // whose integral over the section has no closed form and is summed to the last digits.
  double volume_outside(double cylinder) const;
  // Exact values of the mesh below.
  double mesh_volume() const;
  TriangleMesh mesh() const;
};

}  // namespace wholehand
