// SPDX-License-Identifier: MIT
// Triangle meshes of what a grip shows: the glass, the liquid in it, bones and contact points. m, right-handed, counter-clockwise
// from outside. Every mesh but that of a mesh vessel is closed: two triangles meet in each edge, whose ends are the same numbers in
// both.
#pragma once

#include <vector>

#include "core/prepare.h"
#include "core/result.h"
#include "sweeps/grips/surface.h"

namespace wholehand {

// An outline turned about +y: `segments` flat faces round (a multiple of 4 touches the largest extents along x and z), arcs in
// steps of the same angle. Corners lie on the surface, so that all errors fall with the square of `segments`.
SurfaceMesh revolved_mesh(const std::vector<PreparedElement>& outline, int segments);

// The glass with its inner wall where the vessel has a wall, else its hull closed at the mouth; of a mesh vessel the mesh as it is
// (mesh_surface). Vessel frame. Throws Error as prepare_vessel.
SurfaceMesh vessel_mesh(const VesselData& vessel, int segments);

// Liquid of `volume` m3 at rest in the vessel tilted by `tilt` rad towards the horizontal unit direction `pour` (vessel frame): the
// cavity under the level plane, with the plane's part as its surface. Empty where there is none. `volume` is at most what the lip
// holds.
SurfaceMesh liquid_mesh(const VesselData& vessel, double volume, double tilt, const Triple& pour, int segments);

// A ball of radius 1 m at the origin.
SurfaceMesh ball_mesh(int segments);

// Rounded cone, the hull of two balls: radius `near` m at the origin and `far` m at `length` m along -z.
SurfaceMesh capsule_mesh(double length, double near, double far, int segments);

}  // namespace wholehand
