// SPDX-License-Identifier: MIT
// The room in a mesh: what liquid fills from above, counted in points of a grid.
#include "core/meshes/room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "core/vectors.h"
#include "tests/support/meshes.h"

namespace wholehand {
namespace {

constexpr double STEP = 2e-3;  // m, of every grid here that is not turned
constexpr AxisDirection UP{}, DOWN{1, false};
// A plane is never at a point of the grid, so that a box whose sides are whole steps holds exactly as many points; sums of their cells round.
constexpr double COUNT_ROUNDING = 1e-12;  // relative

struct Filled {
  RoomGrid grid;
  Rooms rooms;
};

// The steps count from the mesh's lowest corner.
RoomGrid grid_of(const TriangleMesh& mesh) {
  Triple low = mesh.vertices[0], high = low;
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    for (const Triple& p : mesh.vertices) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
    longest = std::max(longest, high[k] - low[k]);
  }
  return {mesh, low, high, static_cast<int>(std::lround(longest / STEP))};
}

Filled fill(const TriangleMesh& mesh, const AxisDirection& up = UP) {
  RoomGrid grid = grid_of(mesh);
  Rooms rooms = find_rooms(grid, up);
  return {std::move(grid), std::move(rooms)};
}

void expect_volume(const std::optional<Room>& room, double volume, const std::string& what) {
  ASSERT_TRUE(room.has_value()) << what;
  EXPECT_NEAR(room->volume / volume, 1, COUNT_ROUNDING) << what;
}

// A rectangle across `axis` at `place`, between two corners (the next axis, the one after).
TriangleMesh rectangle(int axis, double place, const std::array<double, 2>& low, const std::array<double, 2>& high) {
  TriangleMesh mesh;
  for (int i = 0; i < 4; ++i) {
    Triple p{};
    p[axis] = place;
    p[(axis + 1) % 3] = (i & 1 ? high : low)[0];
    p[(axis + 2) % 3] = (i & 2 ? high : low)[1];
    mesh.vertices.push_back(p);
  }
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}};
  return mesh;
}

// The box's side in a direction, as a sheet.
TriangleMesh side_of(const Triple& low, const Triple& high, const AxisDirection& side) {
  const int u = (side.axis + 1) % 3, v = (side.axis + 2) % 3;
  return rectangle(side.axis, (side.is_positive ? high : low)[side.axis], {low[u], low[v]}, {high[u], high[v]});
}

std::vector<AxisDirection> directions() {
  std::vector<AxisDirection> all;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool is_positive : {false, true}) all.push_back({axis, is_positive});
  return all;
}

// Five sides as sheets.
TriangleMesh sheet_box(const Triple& low, const Triple& high, const AxisDirection& mouth = UP) {
  TriangleMesh mesh;
  for (const AxisDirection& side : directions())
    if (!(side == mouth)) mesh = joined(mesh, side_of(low, high, side));
  return mesh;
}

// Five sides as slabs that overlap.
TriangleMesh walled_box(const Triple& low, const Triple& high, double thickness, const AxisDirection& mouth = UP) {
  TriangleMesh mesh;
  for (const AxisDirection& side : directions()) {
    if (side == mouth) continue;
    Triple from = low, to = high;
    if (side.is_positive) {
      from[side.axis] = high[side.axis] - thickness;
    } else {
      to[side.axis] = low[side.axis] + thickness;
    }
    mesh = joined(mesh, box_mesh(from, to));
  }
  return mesh;
}

constexpr Triple LOW{-0.03, 0, -0.02}, HIGH{0.03, 0.08, 0.02};
constexpr double VOLUME = 0.06 * 0.08 * 0.04;

TEST(MeshRoom, AnOpenBoxHoldsItsVolumeTowardsItsMouthOnly) {
  constexpr double THICKNESS = 2 * STEP;
  for (const AxisDirection& mouth : directions()) {
    double volume = 1;
    for (int k = 0; k < 3; ++k) volume *= HIGH[k] - LOW[k] - THICKNESS * (k == mouth.axis ? 1 : 2);
    const TriangleMesh mesh = walled_box(LOW, HIGH, THICKNESS, mouth);
    for (const AxisDirection& up : directions()) {
      const std::string what = std::string("mouth ") + "xyz"[mouth.axis] + ", up " + "xyz"[up.axis];
      const Filled filled = fill(mesh, up);
      if (up == mouth) {
        expect_volume(filled.rooms.largest, volume, what);
      } else {
        EXPECT_FALSE(filled.rooms.largest.has_value()) << what;
      }
    }
  }
}

TEST(MeshRoom, AWallWithoutThicknessHolds) {
  for (const AxisDirection& mouth : directions())
    expect_volume(fill(sheet_box(LOW, HIGH, mouth), mouth).rooms.largest, VOLUME, "sheet");
}

TEST(MeshRoom, ItsPointsAreThoseOfItsVolumeInOrder) {
  const Filled filled = fill(sheet_box(LOW, HIGH));
  ASSERT_TRUE(filled.rooms.largest.has_value());
  const std::vector<std::size_t> points = points_of(filled.grid, *filled.rooms.largest, UP);
  EXPECT_NEAR(static_cast<double>(points.size()) * filled.grid.cell() / VOLUME, 1, COUNT_ROUNDING);
  EXPECT_TRUE(std::is_sorted(points.begin(), points.end()));
  for (const std::size_t point : points) {
    const Triple p = filled.grid.position(point);
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(p[k] > LOW[k] && p[k] < HIGH[k]) << point;
    EXPECT_EQ(filled.grid.index(filled.grid.place_of(point)), point);
  }
}

TEST(MeshRoom, ASealedBoxIsSealed) {
  for (const AxisDirection& up : directions()) {
    const Rooms rooms = fill(joined(box_mesh(LOW, HIGH), box_mesh({-0.02, 0.01, -0.01}, {0.02, 0.06, 0.01})), up).rooms;
    EXPECT_FALSE(rooms.largest.has_value());
    ASSERT_EQ(rooms.sealed.size(), 2u);
    constexpr double INNER = 0.04 * 0.05 * 0.02;
    EXPECT_NEAR(rooms.sealed[0].volume / (VOLUME - INNER), 1, COUNT_ROUNDING) << "the glass, which is larger";
    EXPECT_NEAR(rooms.sealed[1].volume / INNER, 1, COUNT_ROUNDING);
  }
}

// A partition at 24 of 60 mm.
TEST(MeshRoom, BasinsThatJoinBelowTheRimCountTogether) {
  const auto divided = [](double top) {
    return fill(joined(sheet_box(LOW, HIGH), rectangle(0, LOW[0] + 0.024, {LOW[1], LOW[2]}, {top, HIGH[2]}))).rooms;
  };
  expect_volume(divided(HIGH[1] - 2 * STEP).largest, VOLUME, "a low partition");
  expect_volume(divided(HIGH[1]).largest, 0.036 * 0.08 * 0.04, "one up to the rim: the larger basin");
}

// Upside down, a cup holds what its foot encloses.
TEST(MeshRoom, TheRingUnderAFootIsSmall) {
  TriangleMesh cup = sheet_box(LOW, HIGH);
  const Triple foot_low{-0.016, -STEP, -0.012}, foot_high{0.016, 0, 0.012};
  for (const AxisDirection& side : directions())
    if (side.axis != 1) cup = joined(cup, side_of(foot_low, foot_high, side));
  expect_volume(fill(cup, DOWN).rooms.largest, 0.032 * STEP * 0.024, "foot");
  expect_volume(fill(cup).rooms.largest, VOLUME, "cup");
}

// The side at the lowest x, but for a hole between two corners (y, z).
TriangleMesh holed_box(const std::array<double, 2>& low, const std::array<double, 2>& high) {
  TriangleMesh mesh;
  for (const AxisDirection& side : directions())
    if (!(side == UP) && !(side == AxisDirection{0, false})) mesh = joined(mesh, side_of(LOW, HIGH, side));
  mesh = joined(mesh, rectangle(0, LOW[0], {LOW[1], LOW[2]}, {low[0], HIGH[2]}));
  mesh = joined(mesh, rectangle(0, LOW[0], {high[0], LOW[2]}, {HIGH[1], HIGH[2]}));
  mesh = joined(mesh, rectangle(0, LOW[0], {low[0], LOW[2]}, {high[0], low[1]}));
  return joined(mesh, rectangle(0, LOW[0], {low[0], high[1]}, {high[0], HIGH[2]}));
}

TEST(MeshRoom, AHoleDrainsToItsLowerEdgeUnlessItIsNarrowerThanAStep) {
  const RoomGrid grid = grid_of(sheet_box(LOW, HIGH));
  const auto first_above = [&](int axis, double place) {  // point of the grid
    double at = grid.position(0)[axis];
    while (at < place) at += grid.step();
    return at;
  };
  const double y = first_above(1, 0.03), z = first_above(2, 0);
  expect_volume(fill(holed_box({y + 0.05 * STEP, z + 0.05 * STEP}, {y + 0.95 * STEP, z + 0.95 * STEP})).rooms.largest, VOLUME,
                "between the lines of the grid");
  // 1.1 steps: a line passes wherever the hole is. The layers below its lower edge are whole steps.
  for (const double lower : {0.03, 0.05})
    expect_volume(fill(holed_box({lower, 0.004}, {lower + 1.1 * STEP, 0.004 + 1.1 * STEP})).rooms.largest, VOLUME * lower / 0.08,
                  "wider than a step");
}

// Level lids of one box: two triangles, and slivers about a corner of the fan to points of the rim, each far narrower than a step.
TEST(MeshRoom, SliversBlockWhatTheyCover) {
  constexpr int PER_SIDE = 2500;
  TriangleMesh fan;
  fan.vertices.push_back({0.0123, HIGH[1], -0.0067});
  const std::array<Triple, 4> rim{{{LOW[0], HIGH[1], LOW[2]}, {HIGH[0], HIGH[1], LOW[2]}, HIGH, {LOW[0], HIGH[1], HIGH[2]}}};
  for (std::size_t side = 0; side < 4; ++side)
    for (int k = 0; k < PER_SIDE; ++k) {
      const Triple &a = rim[side], &b = rim[(side + 1) % 4];
      const double t = static_cast<double>(k) / PER_SIDE;
      fan.vertices.push_back({a[0] + t * (b[0] - a[0]), HIGH[1], a[2] + t * (b[2] - a[2])});
    }
  for (std::uint32_t k = 0; k < 4 * PER_SIDE; ++k) fan.triangles.push_back({0, k + 1, (k + 1) % (4 * PER_SIDE) + 1});
  const TriangleMesh open = sheet_box(LOW, HIGH);
  // about each axis, so that rows run along slivers as well as across
  for (const Triple& turn : {Triple{}, Triple{PI / 2, 0, 0}, Triple{0, 0, PI / 2}}) {
    const TriangleMesh by_two = placed_mesh(joined(open, side_of(LOW, HIGH, UP)), turn, {});
    const RoomGrid expected = grid_of(by_two), grid = grid_of(placed_mesh(joined(open, fan), turn, {}));
    ASSERT_EQ(grid.points(), expected.points());
    int different = 0;
    for (std::size_t point = 0; point < grid.points(); ++point)
      for (int axis = 0; axis < 3; ++axis) different += grid.is_blocked(point, axis) != expected.is_blocked(point, axis);
    EXPECT_EQ(different, 0);
    EXPECT_EQ(find_rooms(grid, UP).sealed.size(), 1u);
  }
}

// Four triangles about a corner on a line of the grid: the line meets all of them, and does not pass between.
TEST(MeshRoom, ALineThroughACornerIsBlocked) {
  const TriangleMesh open = sheet_box(LOW, HIGH);
  const RoomGrid grid = grid_of(open);
  const Triple at = grid.position(grid.index({12, 0, 9}));
  TriangleMesh lid;
  lid.vertices = {{at[0], HIGH[1], at[2]},
                  {LOW[0], HIGH[1], LOW[2]},
                  {HIGH[0], HIGH[1], LOW[2]},
                  {HIGH[0], HIGH[1], HIGH[2]},
                  {LOW[0], HIGH[1], HIGH[2]}};
  lid.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
  const Rooms rooms = fill(joined(open, lid)).rooms;
  EXPECT_FALSE(rooms.largest.has_value());
  ASSERT_EQ(rooms.sealed.size(), 1u);
  EXPECT_NEAR(rooms.sealed[0].volume / VOLUME, 1, COUNT_ROUNDING);
}

struct Measures {
  double volume = 0, area = 0;
};

Measures measure(const TriangleMesh& mesh) {
  Measures measures;
  for (const Corners& triangle : mesh.triangles) {
    const glm::dvec3 a = to_vec3(mesh.vertices[triangle[0]]), b = to_vec3(mesh.vertices[triangle[1]]),
                     c = to_vec3(mesh.vertices[triangle[2]]);
    measures.volume += glm::dot(a, glm::cross(b, c)) / 6;
    measures.area += glm::length(glm::cross(b - a, c - a)) / 2;
  }
  return measures;
}

// However a surface lies in the grid, and however its triangles are cut, no line passes between two of them: a leak would empty it. Points and volume
// differ by at most the cells that the surface meets, which lie within half a cell's diagonal of it.
TEST(MeshRoom, NoTurnMakesAClosedSurfaceLeak) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> angle(-PI, PI);
  for (int tries = 0; tries < 20; ++tries) {
    const Triple turn{angle(random), angle(random), angle(random)};
    for (const TriangleMesh& mesh : {box_mesh(LOW, HIGH), icosphere(0.03, 3), torus(0.03, 0.012, 60, 24)}) {
      const Filled filled = fill(placed_mesh(mesh, turn, {angle(random), 0, 0}));
      double sealed = 0;
      for (const Room& room : filled.rooms.sealed) sealed += room.volume;
      const auto [volume, area] = measure(mesh);
      EXPECT_NEAR(sealed, volume, area * filled.grid.step() * std::sqrt(3.0) / 2) << tries;
    }
  }
}

// A cup turned about its axis: per layer, points and area differ by at most the strip of half a cell's diagonal along the rim.
TEST(MeshRoom, AnAwkwardlyTurnedBoxHoldsAsMuch) {
  for (const double turn : {0.1, 0.5, 0.7853981, 1.2}) {
    const Filled filled = fill(placed_mesh(sheet_box(LOW, HIGH), {0, turn, 0}, {}));
    ASSERT_TRUE(filled.rooms.largest.has_value());
    const double step = filled.grid.step(), reach = step / std::sqrt(2.0), area = 0.06 * 0.04;
    const double strip = 2 * (0.06 + 0.04) * reach + PI * reach * reach;
    const double layers = std::ceil(0.08 / step);
    EXPECT_NEAR(filled.rooms.largest->volume, area * 0.08, strip * layers * step + area * step) << turn;
  }
}

}  // namespace
}  // namespace wholehand
