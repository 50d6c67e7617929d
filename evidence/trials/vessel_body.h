// SPDX-License-Identifier: MIT
// The vessel as a model for a physics engine: convex pieces of its outer form, and the weight of vessel and contents.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/evaluator.h"
#include "core/prepared.h"
#include "core/scene.h"
#include "evidence/trials/convex_cells.h"

namespace wholehand {

constexpr double FORM_TOLERANCE = 0.05e-3;  // m, between an arc and the cones that stand for it
constexpr int FORM_SIDES = 256;             // of a piece of FEW_RINGS at most: its normals are off by 0.7 degrees
constexpr int ROUNDED_SIDES = 64;           // of one with more rings: by 2.8 degrees, like those of its arcs
constexpr std::size_t FEW_RINGS = 8;

enum class PieceShape { hull, cylinder, ball };

// A part of a vessel, vessel frame, m. Shapes that the engine knows are exact: on a wall of flat sides, a tip that presses near its friction limit
// slides off where the round wall would hold it.
struct ConvexPiece {
  PieceShape shape = PieceShape::hull;
  std::vector<Triple> vertices;          // points whose hull it is; for a cylinder and a ball they lie on it
  double radius = 0, low = 0, high = 0;  // of a cylinder or a ball, and the heights of its ends
};

// The form of a vessel as the engine takes it.
struct VesselForm {
  std::vector<ConvexPiece> pieces;
  double error =
      0;  // m, of a mesh: no piece reaches farther out of it, and of a file of pieces, the mesh no farther out of the pieces
  std::string file;  // the file of pieces; empty: the program's own
};

// The outer form of an outline, closed across its mouth, and a mesh with its own walls. A body of revolution is cut where its outline is not convex.
// The part between two cuts is an upright cylinder, a ball whose rest lies within the pieces above it, or the hull of a stack of frusta. A mesh is one
// piece if it equals its convex hull to CONVEX_TOLERANCE, else it is covered by pieces, or those of a file beside it (piece_file.h). `folder`: where
// the mesh's path starts. Throws Error (usage), with the vessel's name and the reason: a shell, whose wall has two sides; an outline that goes down
// again; a mesh whose pieces leave it by more than MOST_PIECE_ERROR.
VesselForm vessel_form(const VesselData& vessel, const std::string& folder, std::size_t most_pieces = MOST_PIECES);
// The pieces alone, of a vessel without a file of pieces.
std::vector<ConvexPiece> convex_pieces(const VesselData& vessel);
// "42 convex pieces, which leave the mesh by at most 0.50 mm".
std::string form_text(const VesselForm& form);

// Mass, center, and inertia about that center with axes along the frame's. Vessel frame, kg, m, kg m2.
struct RigidLoad {
  double mass = 0;
  Triple center{};
  std::array<double, 9> inertia{};  // rows
};

// The glass of a vessel and the remaining liquid at a state: mass and inertia of both, frozen.
class VesselLoad {
 public:
  // `pour` is the horizontal direction towards which the vessel tilts. Both must outlive this.
  VesselLoad(const Scene& scene, const Evaluator& evaluator, std::size_t vessel, const Triple& pour);

  // Mass and center are kernel 6's. The inertia of the wall is computed by slices; that of the liquid is the upright vessel's with as much in it,
  // about its own center. `mass`, if not NaN, replaces the total mass, with everything else in proportion.
  RigidLoad at(double fill, double tilt, double mass) const;

 private:
  RigidLoad glass() const;
  RigidLoad liquid(const LiquidResult& liquid) const;

  const Scene& scene_;
  const Evaluator& evaluator_;
  std::size_t vessel_;
  Triple pour_;
  PreparedVessel prepared_;
  std::vector<std::array<double, 2>> hull_, cavity_;  // (r, y), m
  RigidLoad glass_;
};

// Both as one body.
RigidLoad joined(const RigidLoad& a, const RigidLoad& b);
// Interpolates each number at `share` of the way from a to b, two states that are near each other.
RigidLoad load_between(const RigidLoad& a, const RigidLoad& b, double share);

}  // namespace wholehand
