// SPDX-License-Identifier: MIT
// Triangle meshes of what a grip shows: the glass, its liquid, bones and contact points. m, right-handed, counter-clockwise from outside. Every mesh
// except a mesh vessel's is closed: two triangles share each edge, with the same vertex numbers.
#pragma once

#include <vector>

#include "core/prepare.h"
#include "core/result.h"
#include "sweeps/grips/surface.h"

namespace wholehand::sweeps {

// An outline turned about +y: `segments` flat faces around (a multiple of 4 touches the largest extents along x and z), arcs in steps of the same
// angle. Corners lie on the surface, so that all errors fall with the square of `segments`.
SurfaceMesh revolved_mesh(const std::vector<PreparedElement>& outline, int segments);

// The glass with its inner wall if the vessel has a wall, else its hull closed at the mouth; a mesh vessel's mesh unchanged (mesh_surface). Vessel
// frame. Throws Error as prepare_vessel.
SurfaceMesh vessel_mesh(const VesselData& vessel, int segments);

// Liquid of `volume` m3 at rest in the vessel tilted by `tilt` rad towards the horizontal unit direction `pour` (vessel frame): the cavity below the
// level plane, closed by the plane. Empty if there is none. `volume` is at most what the lip holds.
SurfaceMesh liquid_mesh(const VesselData& vessel, double volume, double tilt, const Triple& pour, int segments);

// A ball of radius 1 m at the origin.
SurfaceMesh ball_mesh(int segments);

// Rounded cone, the hull of two balls: radius `near` m at the origin and `far` m at `length` m along -z.
SurfaceMesh capsule_mesh(double length, double near, double far, int segments);

}  // namespace wholehand::sweeps
