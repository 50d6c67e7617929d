// SPDX-License-Identifier: MIT
// Finds the cavity of a mesh: what liquid fills when the vessel stands upright.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/meshes/cavity_outline.h"
#include "core/meshes/check.h"
#include "core/meshes/room.h"

namespace wholehand {

struct FoundCavity {
  Triple axis{};                      // a point of it; upright, m
  double floor = 0, brim = 0;         // heights on the axis, and where liquid runs over, m
  bool is_brim_rough = false;         // no level ray from the axis shows where: the brim is right to a step of the grid
  double capacity = 0;                // m3 up to the brim, as the mesh has it: by level rays
  double counted = 0;                 // m3, by the points of the grid
  double off_rays = 0;                // m3 that no level ray from the axis reaches, such as a spout; part of the capacity
  double beneath = 0;                 // m3 below the floor's height on the axis, which no outline holds; part of the capacity
  std::vector<ProfilePoint> profile;  // (least free radius about the axis, y), m, from the floor to the brim
  CavityOutline outline;              // as `inner_outline`; nowhere in glass
  double off_round = 0;               // m: most that the free radius at one height varies about the axis
  double off_round_height = 0;        // m, where that is
  int passing_rays = 0;               // the most level rays at one height that pass through a hole, of RAY_AZIMUTHS
  double passing_height = 0;          // m, where that is
};

struct CavitySearch {
  std::optional<FoundCavity> cavity;
  std::string refusal;  // why there is none: a clause without subject, such as "is closed above", with a remedy
};

// The cavity of an upright mesh (+y up, m). Liquid fills a grid of points from below until it meets the outside; rays from the axis of that room measure
// the free radius. The outline takes the least radius of each height, so that it is nowhere in glass.
CavitySearch find_cavity(const CheckedMesh& mesh);

// Whether a room holds enough to be a vessel's.
bool is_cavity(const Room& room, const MeshFacts& facts);

}  // namespace wholehand
