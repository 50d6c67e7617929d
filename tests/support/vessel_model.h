// SPDX-License-Identifier: MIT
// A vessel made by code, and its true values.
#pragma once

#include <cstddef>
#include <string>

#include "core/meshes/triangles.h"
#include "tests/support/vessel_profiles.h"

namespace wholehand {

// Values describe the smooth vessel that the mesh approaches as its facets shrink, unless a comment in vessel_models.cpp says otherwise. Facets of n
// sides take the share 1 - sin(2 pi/n) / (2 pi/n) of glass and cavity alike (7.1e-4 of 96 sides); chords of arcs are within PROFILE_SAGITTA of them.
struct VesselModel {
  std::string name{};
  // m, +y up, base at y = 0, the cavity's axis at x = z = 0; closed and outward unless the name says otherwise. Where there are several bodies, the
  // vessel comes first: so many triangles, with its handle and its sealed void.
  TriangleMesh mesh{};
  std::size_t vessel_triangles = 0;
  double volume = 0;      // of the vessel's glass, m3
  double capacity = 0;    // to the brim, upright, m3; 0: holds nothing
  ProfilePoints inner{};  // the cavity's profile (r, y), m, from the axis at the floor to the brim; empty: no cavity
  bool is_round = true;   // its cavity is; otherwise `inner` has the circle of equal area at each height
  double brim = 0;        // the height at which it spills, m
  double thickness = 0;   // of an open sheet, whose drawn surface is the outer one, m; 0: a body
  std::string refusal{};  // words that the refusal must contain; empty: it is a vessel

  // Exact values of the vessel's facets; NaN where only their limit has a formula.
  double mesh_volume = 0;    // the signed sum over the vessel's triangles: what lies in two of its parts counts twice
  double mesh_capacity = 0;  // to the brim
};

}  // namespace wholehand
