// SPDX-License-Identifier: MIT
#include "core/meshes/room.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace wholehand {
namespace {

// The grid's origin relative to a step: no point lies in the plane of a face that is level or upright in round numbers.
constexpr Triple OFF_ROUND{0.3819660113, 0.4142135624, 0.3660254038};
constexpr int MARGIN = 2;             // points beyond the box on each side
constexpr double ON_EDGE = 1e-9;      // of a triangle's doubled area: a line through its edge meets it
constexpr double ON_POINT = 1e-6;     // of a step: a triangle through a point blocks both steps from it
constexpr std::uint32_t OUTSIDE = 0;  // the set of points from which liquid runs away

// Sets of points that liquid joins, by union with path halving.
class PointSets {
 public:
  explicit PointSets(std::size_t points) : parent_(points + 1), settled_(points + 1), added_(points + 1) {
    std::iota(parent_.begin(), parent_.end(), 0U);
    seed_ = parent_;
  }

  std::uint32_t root(std::uint32_t set) {
    while (parent_[set] != set) set = parent_[set] = parent_[parent_[set]];
    return set;
  }
  void add(std::uint32_t set) { added_[set] = 1; }
  // Returns how many points of the layers before a set had when it met the outside, 0 if neither is the outside or both are; `seed`: one of them.
  std::size_t unite(std::uint32_t a, std::uint32_t b, std::uint32_t& seed) {
    a = root(a);
    b = root(b);
    if (a == b) return 0;
    if (b < a) std::swap(a, b);  // the outside, which is 0, stays a root
    const std::size_t held = a == OUTSIDE ? settled_[b] : 0;
    seed = seed_[b];
    parent_[b] = a;
    if (settled_[a] == 0) seed_[a] = seed_[b];
    settled_[a] += settled_[b];
    added_[a] += added_[b];
    return held;
  }
  // The points added since the last call count as those of a layer before.
  void settle(std::uint32_t set) {
    const std::uint32_t top = root(set);
    settled_[top] += added_[top];
    added_[top] = 0;
  }
  std::size_t count(std::uint32_t set) const { return settled_[set] + added_[set]; }

 private:
  std::vector<std::uint32_t> parent_, settled_, added_;
  std::vector<std::uint32_t> seed_;  // a point of each set, of a layer before if it has one
};

// The first and the last point of a row that lie between two places, in steps; points on them count.
int first_at(double place) { return static_cast<int>(std::ceil(place - ON_POINT)); }
int last_at(double place) { return static_cast<int>(std::floor(place + ON_POINT)); }

// From where to where along v a triangle reaches within ON_POINT of the line u = row. What lies across the line to ON_EDGE is nearer than that: such
// points lie in the triangle when it grows by 3 ON_EDGE of its size, which is a few hundred steps at most.
std::pair<double, double> row_span(const std::array<Triple, 3>& p, int u, int v, double row) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (int c = 0; c < 3; ++c) {
    const Triple &a = p[c], &b = p[(c + 1) % 3];
    if (std::min(a[u], b[u]) > row + 2 * ON_POINT || std::max(a[u], b[u]) < row - 2 * ON_POINT) continue;  // twice: rounding
    const double per_step = a[u] == b[u] ? 0 : 1 / (b[u] - a[u]);  // of a level side, the other end is the next side's first
    for (const double side : {row - ON_POINT, row + ON_POINT}) {
      const double place = a[v] + std::clamp((side - a[u]) * per_step, 0.0, 1.0) * (b[v] - a[v]);
      low = std::min(low, place);
      high = std::max(high, place);
    }
  }
  return {low, high};
}

// The layers of a grid along a direction.
struct Layers {
  const RoomGrid& grid;
  AxisDirection up;
  int first() const { return up.is_positive ? 0 : grid.size()[up.axis] - 1; }
  int count() const { return grid.size()[up.axis]; }
  int place(int layer) const { return up.is_positive ? layer : first() - layer; }
  int layer_of(std::size_t point) const {
    const int at = grid.place_of(point)[up.axis];
    return up.is_positive ? at : first() - at;
  }

  // Calls `visit(point, is_border)` for each point of a layer.
  template <class Visit>
  void for_each(int layer, const Visit& visit) const {
    const int u = (up.axis + 1) % 3, v = (up.axis + 2) % 3;
    std::array<int, 3> at{};
    at[up.axis] = place(layer);
    const bool is_end = layer == 0 || layer + 1 == count();
    for (at[u] = 0; at[u] < grid.size()[u]; ++at[u])
      for (at[v] = 0; at[v] < grid.size()[v]; ++at[v])
        visit(grid.index(at), is_end || at[u] == 0 || at[v] == 0 || at[u] + 1 == grid.size()[u] || at[v] + 1 == grid.size()[v]);
  }
};

}  // namespace

RoomGrid::RoomGrid(const TriangleMesh& mesh, const Triple& low, const Triple& high, int cells) {
  step_ = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]}) / cells;
  for (int k = 0; k < 3; ++k) {
    origin_[k] = low[k] - (MARGIN - OFF_ROUND[k]) * step_;
    size_[k] = static_cast<int>(std::ceil((high[k] - low[k]) / step_)) + 2 * MARGIN + 1;
  }
  blocked_.resize(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2]);
  for (const Corners& triangle : mesh.triangles) {
    const std::array corners{mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]};
    for (int axis = 0; axis < 3; ++axis) block(corners, axis);
  }
}

std::array<int, 3> RoomGrid::place_of(std::size_t point) const {
  const std::size_t row = point / size_[0];
  return {static_cast<int>(point % size_[0]), static_cast<int>(row % size_[1]), static_cast<int>(row / size_[1])};
}

Triple RoomGrid::position(std::size_t point) const {
  const std::array<int, 3> at = place_of(point);
  return {origin_[0] + step_ * at[0], origin_[1] + step_ * at[1], origin_[2] + step_ * at[2]};
}

// Blocks the steps along the axis that the triangle lies across. A line through an edge meets both of its triangles, so that none passes between.
void RoomGrid::block(const std::array<Triple, 3>& corners, int axis) {
  std::array<Triple, 3> p{};  // in steps from the origin
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < 3; ++k) p[c][k] = (corners[c][k] - origin_[k]) / step_;
  const auto low = [&](int k) { return std::min({p[0][k], p[1][k], p[2][k]}); };
  const auto high = [&](int k) { return std::max({p[0][k], p[1][k], p[2][k]}); };
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (high(u) - low(u) > high(v) - low(v)) std::swap(u, v);  // the fewer rows
  const double area = (p[1][u] - p[0][u]) * (p[2][v] - p[0][v]) - (p[1][v] - p[0][v]) * (p[2][u] - p[0][u]);
  if (area == 0 || first_at(low(v)) > last_at(high(v))) return;
  std::array<int, 3> at{};
  for (at[u] = first_at(low(u)); at[u] <= last_at(high(u)); ++at[u]) {
    const auto [from, to] = row_span(p, u, v, at[u]);
    for (at[v] = first_at(from); at[v] <= last_at(to); ++at[v]) {
      std::array<double, 3> share{};
      for (int c = 0; c < 3; ++c) {
        const auto &a = p[(c + 1) % 3], &b = p[(c + 2) % 3];
        share[c] = ((a[u] - at[u]) * (b[v] - at[v]) - (a[v] - at[v]) * (b[u] - at[u])) / area;
      }
      if (std::min({share[0], share[1], share[2]}) < -ON_EDGE) continue;
      const double place = share[0] * p[0][axis] + share[1] * p[1][axis] + share[2] * p[2][axis];
      for (const double near : {place - ON_POINT, place + ON_POINT}) {
        at[axis] = std::clamp(static_cast<int>(std::floor(near)), 0, size_[axis] - 1);
        blocked_[index(at)] |= static_cast<std::uint8_t>(1U << axis);
      }
    }
  }
}

Rooms find_rooms(const RoomGrid& grid, const AxisDirection& up) {
  const Layers layers{grid, up};
  PointSets sets(grid.points());
  Rooms rooms;
  std::size_t most = 0;
  int layer = 0;
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    std::uint32_t seed = 0;
    const std::size_t held = sets.unite(a, b, seed);
    if (held <= most) return;
    most = held;
    rooms.largest = Room{static_cast<double>(held) * grid.cell(), seed - 1, layer};
  };
  const auto join_next = [&](std::size_t point, int axis) {  // to the one before along the axis
    const std::size_t before = point - grid.stride(axis);
    if (!grid.is_blocked(before, axis)) join(static_cast<std::uint32_t>(point + 1), static_cast<std::uint32_t>(before + 1));
  };
  for (; layer < layers.count(); ++layer) {
    layers.for_each(layer, [&](std::size_t point, bool is_border) {
      sets.add(static_cast<std::uint32_t>(point + 1));
      if (is_border) join(OUTSIDE, static_cast<std::uint32_t>(point + 1));
    });
    layers.for_each(layer, [&](std::size_t point, bool) {
      const std::array<int, 3> at = grid.place_of(point);
      for (int axis = 0; axis < 3; ++axis) {
        if (axis != up.axis && at[axis] > 0) join_next(point, axis);
      }
      if (layer == 0) return;
      if (up.is_positive)
        join_next(point, up.axis);
      else
        join_next(point + grid.stride(up.axis), up.axis);
    });
    layers.for_each(layer, [&](std::size_t point, bool) { sets.settle(static_cast<std::uint32_t>(point + 1)); });
  }
  for (std::size_t point = 0; point < grid.points(); ++point) {
    const auto set = static_cast<std::uint32_t>(point + 1);
    if (sets.root(set) == set) rooms.sealed.push_back({static_cast<double>(sets.count(set)) * grid.cell(), point, layers.count()});
  }
  std::sort(rooms.sealed.begin(), rooms.sealed.end(), [](const Room& a, const Room& b) { return a.volume > b.volume; });
  return rooms;
}

std::vector<std::size_t> points_of(const RoomGrid& grid, const Room& room, const AxisDirection& up) {
  const Layers layers{grid, up};
  std::vector<bool> is_in(grid.points());
  std::vector<std::size_t> points{room.seed};
  is_in[room.seed] = true;
  const auto take = [&](std::size_t point) {
    if (is_in[point] || layers.layer_of(point) >= room.first_out) return;
    is_in[point] = true;
    points.push_back(point);
  };
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t point = points[k];
    const std::array<int, 3> at = grid.place_of(point);
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t stride = grid.stride(axis);
      if (at[axis] + 1 < grid.size()[axis] && !grid.is_blocked(point, axis)) take(point + stride);
      if (at[axis] > 0 && !grid.is_blocked(point - stride, axis)) take(point - stride);
    }
  }
  std::sort(points.begin(), points.end());
  return points;
}

}  // namespace wholehand
