// From a scene to what the kernels need, in plain doubles: outlines split into y-monotone elements, the cavity as the inner offset of
// the outline, the shell, bounding spheres, the hand's frames and the table of its gap. Done once a scene, off the tick path.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/result.h"
#include "core/scene.h"
#include "shaders/layout.h"

namespace wholehand {

// As core/sdf.h's Element: from a to b in (r, y), m; side 0: line, +1: arc on the half r >= center r, -1: on the other. `center` of a line
// is its unit normal to the right of a -> b, which is outward on a hull.
struct PreparedElement {
  std::array<double, 2> a{}, b{}, center{};
  double radius = 0;
  int side = 0;
};

struct PreparedVessel {
  std::vector<PreparedElement> hull;     // the outer outline, mouth included (last)
  std::vector<PreparedElement> outline;  // what the signed distance is measured to: the hull, or the shell's outline
  int lid = -1;                          // index of the mouth in `outline`; -1 for a shell
  std::vector<PreparedElement> cavity;   // y ascending, empty without a wall
  double floor_height = 0, mouth_height = 0, mouth_radius = 0;
  double bound_height = 0, bound_radius = 0;
  double largest_radius = 0;  // of the hull, or of the mesh about the axis
};

struct PreparedHand {
  struct Finger {
    Triple base{}, forward{}, palmward{};
    std::array<double, 4> length{};
    std::array<double, 5> radius{};
  };
  std::array<Finger, FINGER_COUNT> fingers{};
  Triple thumb_open{}, thumb_swing{}, finger_open{}, finger_swing{};
  double gap_open = 0, gap_closed = 0;
  std::vector<double> gap_table;  // closures at equal steps of the gap
};

// A vessel's signed distance on a regular lattice, as core/sdf.h's Grid takes it: what every precision and device then reads.
struct PreparedGrid {
  Triple origin{};
  double spacing = 1;
  int nx = 0, ny = 0, nz = 0;
  bool halves = false;
  std::shared_ptr<const std::vector<std::uint32_t>> words;
};

// Gauss-Legendre of `points` on a cosine map: cosines of the angles and weights times sin(theta) pi / 2.
struct PreparedQuadrature {
  std::vector<double> cosine, weight;
};

// Splits arcs at the poles of their circles, so that y is monotone along each element.
std::vector<PreparedElement> monotone_elements(const std::vector<OutlineElement>& outline);

// The inner wall: where the distance to the outline without its mouth equals `wall`, from the vessel's `floor`, or where the wall leaves
// room, to the mouth. Throws Error (usage) with the vessel's name where the wall leaves no cavity, fills it above the floor, closes it half
// way up, or makes it fold over itself.
std::vector<PreparedElement> inner_offset(const std::vector<PreparedElement>& hull, double wall, const VesselData& vessel);

// The cavity of an inner outline; its level elements, which hold nothing, are left out.
std::vector<PreparedElement> inner_cavity(const std::vector<OutlineElement>& inner);

// What a vessel with a cavity holds, by its inner outline or its wall; a mesh need not have been read. Throws as inner_offset.
std::vector<PreparedElement> prepare_cavity(const VesselData& vessel);

// A mesh has neither hull nor outline: its distance is its body's lattice. Throws Error: (usage) for what inner_offset refuses, (failure)
// for a mesh that has not been read.
PreparedVessel prepare_vessel(const VesselData& vessel, bool needs_cavity);

// Throws Error (usage) where the gap is not strictly decreasing at 1,025 equal steps of the closure, naming where it turns.
PreparedHand prepare_hand(const HandData& hand, int gap_entries = GAP_TABLE_SIZE);

// Largest radius on an element, m: that of an arc's circle only where the arc reaches it.
double widest_on(const PreparedElement& element);

// Samples of the distance to the vessel's outline, taken in double, `samples` along the longest side; the lattice reaches `margin` (m) and
// two cells beyond the vessel. Stored with 32 bits each or with 16 (`halves`).
PreparedGrid prepare_grid(const PreparedVessel& vessel, int samples, bool halves, double margin = 0);

// The margin with which a lattice holds every point of the scene's hand whose skin is within GRID_BAND of a vessel: beyond it only a bound
// of the distance is known.
constexpr double GRID_BAND = 1e-3;  // m
double grid_margin(const Scene& scene);

PreparedQuadrature prepare_quadrature(int points);

// A left hand is the right hand in the scene mirrored in x: the grip of that mirrored scene, and a point mirrored back.
GripInput mirrored(const GripInput& grip, Handedness handedness);
Triple mirrored(const Triple& point, Handedness handedness);
PreparedGrid mirrored(const PreparedGrid& grid, Handedness handedness);

}  // namespace wholehand
