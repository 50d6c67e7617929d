// SPDX-License-Identifier: MIT
// The room in a mesh that liquid fills from above.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/meshes/triangles.h"

namespace wholehand {

// A direction along an axis: 0 x, 1 y, 2 z.
struct AxisDirection {
  int axis = 1;
  bool is_positive = true;

  bool operator==(const AxisDirection&) const = default;
};

// Points at equal steps about a mesh, m. A step between two neighbors is blocked if a triangle lies across it, so that walls of any thickness, even of
// none, keep liquid in. What is narrower than a step may be missed.
class RoomGrid {
 public:
  // `cells`: along the longest side of the mesh's box.
  RoomGrid(const TriangleMesh& mesh, const Triple& low, const Triple& high, int cells);

  // From each point to its next along the axis.
  bool is_blocked(std::size_t point, int axis) const { return (blocked_[point] >> axis & 1) != 0; }
  std::size_t index(const std::array<int, 3>& place) const {
    return (static_cast<std::size_t>(place[2]) * size_[1] + place[1]) * size_[0] + place[0];
  }
  std::array<int, 3> place_of(std::size_t point) const;
  Triple position(std::size_t point) const;
  const std::array<int, 3>& size() const { return size_; }
  std::size_t points() const { return blocked_.size(); }
  double step() const { return step_; }
  double cell() const { return step_ * step_ * step_; }  // m3
  // Distance of a point's index to its next along the axis.
  std::size_t stride(int axis) const {
    return axis == 0 ? 1 : axis == 1 ? size_[0] : static_cast<std::size_t>(size_[0]) * size_[1];
  }

 private:
  void block(const std::array<Triple, 3>& corners, int axis);

  Triple origin_{};
  double step_ = 0;
  std::array<int, 3> size_{};
  std::vector<std::uint8_t> blocked_;
};

// Liquid in one place, up to where it would run over.
struct Room {
  double volume = 0;     // m3, to about a step's share of the surface
  std::size_t seed = 0;  // one of its points
  int first_out = 0;     // the layer of points, along the direction, in which it meets the outside
};

struct Rooms {
  std::optional<Room> largest;  // of those open to that direction
  std::vector<Room> sealed;     // those that never meet the outside, glass among them, the largest first
};

// Fills the grid layer by layer against the direction of gravity, `up`.
Rooms find_rooms(const RoomGrid& grid, const AxisDirection& up);

// The points of a room, ascending.
std::vector<std::size_t> points_of(const RoomGrid& grid, const Room& room, const AxisDirection& up);

}  // namespace wholehand
