// SPDX-License-Identifier: MIT
// sanitizers: address
// (Embree starts workers that the thread sanitizer cannot see into, and then reports what they were given.)
// Distances to meshes against closed forms and the outline's own, and the side of a million points.
#include "core/meshes/distance.h"
#include "core/vectors.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/files/json.h"
#include "core/meshes/winding_tree.h"
#include "core/sdf.h"
#include "tests/support/meshes.h"
#include "tests/support/sanitized.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

constexpr double ROUNDING = 1e-15;  // m: double precision of some 10 cm
constexpr int MANY = IS_SANITIZED ? 100'000 : 1'000'000;

Triple random_point(Random& random, double reach) {
  const double x = random.uniform(-reach, reach), y = random.uniform(-reach, reach);
  return {x, y, random.uniform(-reach, reach)};
}

double sphere_distance(double radius, const Triple& p) { return norm(p) - radius; }

double torus_distance(double large, double small, const Triple& p) {
  return std::hypot(std::hypot(p[0], p[2]) - large, p[1]) - small;
}

// Exact, of the box from -half to half.
double box_distance(const Triple& half, const Triple& p) {
  Triple beyond{};
  double deepest = -std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    deepest = std::max(deepest, std::abs(p[k]) - half[k]);
    beyond[k] = std::max(std::abs(p[k]) - half[k], 0.0);
  }
  return deepest <= 0 ? deepest : norm(beyond);
}

double largest_difference(const VesselData& vessel, int around, double chord) {
  const CheckedMesh mesh = check_mesh(turned_mesh(vessel, around, chord), vessel.name);
  EXPECT_TRUE(mesh.facts.closed && mesh.facts.oriented && !mesh.facts.was_inside_out);
  const MeshDistance distance(mesh);
  const core_f64::Vessel exact = ready_vessel(vessel);
  Random random(3);
  double largest = 0;
  for (int i = 0; i < 4000; ++i) {
    Triple p = random_point(random, 0.1);
    p[1] += 0.06;
    largest = std::max(largest, std::abs(distance.signed_distance(p) - core_f64::signed_distance(exact, {p[0], p[1], p[2]})));
  }
  return largest;
}

TEST(MeshDistance, ABoxIsExact) {
  const Triple half{0.03, 0.05, 0.02};
  const CheckedMesh mesh = check_mesh(box_mesh({-0.03, -0.05, -0.02}, half), "box");
  const MeshDistance distance(mesh);
  EXPECT_EQ(distance.sign(), MeshSign::crossings);
  // a lattice on the faces, the edges, the corners and the diagonals: every tie there is
  for (int i = -14; i <= 14; ++i)
    for (int j = -14; j <= 14; ++j)
      for (int k = -14; k <= 14; ++k) {
        const Triple p{0.005 * i, 0.005 * j, 0.005 * k};
        ASSERT_NEAR(distance.signed_distance(p), box_distance(half, p), ROUNDING) << i << " " << j << " " << k;
      }
  const Triple far{3, -4, 1e3};
  EXPECT_NEAR(distance.signed_distance(far), box_distance(half, far), 1e-12);
}

TEST(MeshDistance, ASphereToItsTessellation) {
  // chords lie within the sphere: 0 <= d - d0 <= (radius of a triangle's circle)^2 / (2 R), edges up to 1.4 / 2^4 of R
  const double radius = 0.05, sagitta = radius * (1.4 / 16) * (1.4 / 16) / 6;
  const CheckedMesh mesh = check_mesh(icosphere(radius, 4), "sphere");
  const MeshDistance distance(mesh);
  Random random(1);
  for (int i = 0; i < 20'000; ++i) {
    const Triple p = random_point(random, 0.1);
    const double beyond = distance.signed_distance(p) - sphere_distance(radius, p);
    ASSERT_GE(beyond, -ROUNDING);
    ASSERT_LE(beyond, sagitta);
  }
}

TEST(MeshDistance, ATorusToItsTessellation) {
  const double sagitta = 0.07 * std::pow(std::numbers::pi / 200, 2) / 2 + 0.02 * std::pow(std::numbers::pi / 100, 2) / 2;
  const CheckedMesh mesh = check_mesh(torus(0.05, 0.02, 200, 100), "torus");
  const MeshDistance distance(mesh);
  Random random(2);
  for (int i = 0; i < 20'000; ++i) {
    const Triple p = random_point(random, 0.1);
    ASSERT_NEAR(distance.signed_distance(p), torus_distance(0.05, 0.02, p), 2 * sagitta);
  }
}

TEST(MeshDistance, BeakersConvergeAtSecondOrder) {
  for (const VesselData& vessel : {beaker1(), beaker2(), beaker3()}) {
    const double coarse = largest_difference(vessel, 48, 8e-3), fine = largest_difference(vessel, 96, 4e-3);
    EXPECT_LT(coarse, 0.3e-3) << vessel.name;
    EXPECT_GT(coarse / fine, 3.5) << vessel.name;
    EXPECT_LT(coarse / fine, 4.5) << vessel.name;
  }
}

TEST(MeshDistance, TheSideOfAMillionPoints) {
  struct Body {
    TriangleMesh mesh;
    std::function<double(const Triple&)> distance;
    double sagitta;
  };
  const core_f64::Vessel flask = ready_vessel(beaker2());
  const std::vector<Body> bodies{{icosphere(0.05, 5), [](const Triple& p) { return sphere_distance(0.05, p); }, 2e-5},
                                 {torus(0.05, 0.02, 200, 100), [](const Triple& p) { return torus_distance(0.05, 0.02, p); }, 3e-5},
                                 {turned_mesh(beaker2(), 200, 1e-3),
                                  [&](const Triple& p) {
                                    return core_f64::signed_distance(flask, {p[0], p[1], p[2]});
                                  },
                                  3e-5}};
  for (const Body& body : bodies) {
    const CheckedMesh mesh = check_mesh(body.mesh, "body");
    const MeshDistance distance(mesh);
    Random random(4);
    int wrong = 0, inside = 0;
    for (int i = 0; i < MANY; ++i) {
      const Triple p = random_point(random, 0.09);
      const double exact = body.distance(p);
      if (std::abs(exact) < body.sagitta) continue;
      wrong += distance.is_inside(p) != (exact < 0) ? 1 : 0;
      inside += exact < 0 ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(inside, MANY / 30);
  }
}

TEST(MeshDistance, RaysThroughCornersAndEdgesTellTheSide) {
  const CheckedMesh mesh = check_mesh(icosphere(0.05, 3), "sphere");
  const MeshDistance distance(mesh);
  // what a ray from here along any of the first directions meets is a corner, or the middle of an edge
  int wrong = 0;
  for (const auto& [a, b, c] : mesh.mesh.triangles)
    for (const glm::dvec3 along : {glm::dvec3(0.86F, 0.37F, 0.35F), glm::dvec3(-0.41F, 0.83F, 0.37F)}) {
      const Triple &p = mesh.mesh.vertices[a], &q = mesh.mesh.vertices[b];
      for (const double back : {0.01, 0.03, 0.2}) {
        const Triple to_corner{p[0] - back * along.x, p[1] - back * along.y, p[2] - back * along.z};
        const Triple to_edge{(p[0] + q[0]) / 2 - back * along.x, (p[1] + q[1]) / 2 - back * along.y,
                             (p[2] + q[2]) / 2 - back * along.z};
        for (const Triple& from : {to_corner, to_edge}) {
          const double exact = sphere_distance(0.05, from);
          if (std::abs(exact) > 3e-4) wrong += distance.is_inside(from) != (exact < 0) ? 1 : 0;
        }
      }
    }
  EXPECT_EQ(wrong, 0);
}

TEST(MeshDistance, TurnedAndMovedCopiesGiveTheSame) {
  const Triple turn{0.3, -1.2, 2.5}, move{0.4, -0.2, 0.7};
  const CheckedMesh mesh = check_mesh(turned_mesh(beaker3(), 60, 3e-3), "a");
  const CheckedMesh copy = check_mesh(placed_mesh(turned_mesh(beaker3(), 60, 3e-3), turn, move), "b");
  const MeshDistance here(mesh), there(copy);
  Random random(6);
  for (int i = 0; i < 5000; ++i) {
    const Triple p = random_point(random, 0.1);
    const Triple q = placed_mesh({{p}, {}}, turn, move).vertices[0];
    ASSERT_NEAR(here.signed_distance(p), there.signed_distance(q), 10 * ROUNDING);
  }
}

// As TurnedAndMovedCopiesGiveTheSame, but by the file's nodes and by the scene's scale and rotation: the distances scale with the
// body.
TEST(MeshDistance, CopiesPlacedByNodesAndByTheSceneGiveTheSame) {
  const std::string path = testing::TempDir() + "wholehand-placed-" + std::to_string(::getpid()) + ".glb";
  const std::string plain = glb_text(turned_mesh(beaker3(), 60, 3e-3));
  MeshData data;
  data.file = path;
  data.origin_at_base = false;
  const auto read = [&](const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
    return check_mesh(read_mesh(data, ""), "flask");
  };
  const CheckedMesh mesh = read(plain);
  std::uint32_t json_size = 0;
  std::memcpy(&json_size, plain.data() + 12, 4);
  nlohmann::json json = parse_json(plain.substr(20, json_size));
  // the outer node is moved and turned about y, the inner one turned about x, moved and made half as large
  json["nodes"] = {{{"children", {1}}, {"translation", {0.4, -0.2, 0.7}}, {"rotation", {0, std::sin(0.6), 0, std::cos(0.6)}}},
                   {{"mesh", 0},
                    {"translation", {0, 0.1, 0}},
                    {"rotation", {std::sin(0.15), 0, 0, std::cos(0.15)}},
                    {"scale", {0.5, 0.5, 0.5}}}};
  data.scale = 3;
  data.rotate = {-0.7, 0.9, 2.1};
  const CheckedMesh copy = read(glb_text(json_text(json), plain.substr(20 + json_size + 8)));
  std::filesystem::remove(path);
  const auto place = [&](Triple p) {
    for (double& x : p) x *= 0.5;
    p = placed_mesh({{p}, {}}, {0.3, 0, 0}, {0, 0.1, 0}).vertices[0];
    p = placed_mesh({{p}, {}}, {0, 1.2, 0}, {0.4, -0.2, 0.7}).vertices[0];
    for (double& x : p) x *= 3;
    return placed_mesh({{p}, {}}, data.rotate, {}).vertices[0];
  };
  const MeshDistance here(mesh), there(copy);
  Random random(11);
  for (int i = 0; i < 5000; ++i) {
    const Triple p = random_point(random, 0.1);
    ASSERT_NEAR(1.5 * here.signed_distance(p), there.signed_distance(place(p)), 10 * ROUNDING);  // m: some 3 m from the origin
  }
}

TEST(MeshDistance, OverlappingBodiesAreOneAndCavitiesAreOutside) {
  const CheckedMesh two = check_mesh(joined(box_mesh({0, 0, 0}, {2, 1, 1}), box_mesh({1, 0.25, 0.25}, {3, 0.75, 0.75})), "two");
  const MeshDistance both(two);
  for (const double x : {0.5, 1.5, 2.5}) EXPECT_TRUE(both.is_inside({x, 0.5, 0.5})) << x;
  EXPECT_FALSE(both.is_inside({2.5, 0.9, 0.5}));
  TriangleMesh inner = icosphere(0.03, 3);
  for (auto& triangle : inner.triangles) std::swap(triangle[0], triangle[1]);
  const CheckedMesh hollow = check_mesh(joined(icosphere(0.05, 3), inner), "hollow");
  const MeshDistance shell(hollow);
  EXPECT_FALSE(shell.is_inside({0, 0, 0}));
  EXPECT_TRUE(shell.is_inside({0, 0.04, 0}));
}

TEST(MeshDistance, TrianglesThatFaceInwardAreOutvotedByParity) {
  CheckedMesh checked = check_mesh(icosphere(0.05, 3), "sphere");
  for (std::size_t i = 0; i < checked.mesh.triangles.size(); i += 3)
    std::swap(checked.mesh.triangles[i][0], checked.mesh.triangles[i][1]);
  checked.facts.oriented = false;  // as of a surface with one side, which cannot be turned
  const MeshDistance distance(checked);
  EXPECT_EQ(distance.sign(), MeshSign::parity);
  Random random(7);
  for (int i = 0; i < 20'000; ++i) {
    const Triple p = random_point(random, 0.07);
    const double exact = sphere_distance(0.05, p);
    if (std::abs(exact) > 3e-4) {
      ASSERT_EQ(distance.is_inside(p), exact < 0);
    }
  }
}

TEST(MeshDistance, AnOpenHemisphereByItsWindingNumber) {
  const double radius = 0.05;
  const CheckedMesh mesh = check_mesh(open_hemisphere(radius, 5), "bowl");
  const MeshDistance distance(mesh);
  EXPECT_EQ(distance.sign(), MeshSign::winding);
  // on the axis the hole is a disc of the solid angle 2 pi (1 - h / hypot(h, R)), which the bowl lacks
  for (const double y : {-0.2, -0.05, -0.01, 0.01, 0.03, 0.045}) {
    const double hole = 0.5 * (1 - std::abs(y) / std::hypot(y, radius));
    EXPECT_NEAR(distance.winding_number({0, y, 0}), y < 0 ? hole : 1 - hole, 2e-3) << y;
    EXPECT_EQ(distance.is_inside({0, y, 0}), y > 0) << y;
  }
  EXPECT_LT(distance.winding_number({0, 0.06, 0}), 0);
  Random random(8);
  for (int i = 0; i < 20'000; ++i) {
    const Triple p = random_point(random, 0.07);
    const double exact = sphere_distance(radius, p);
    if ((p[1] > 1e-3 && std::abs(exact) > 1e-4) || exact > 1e-4) {
      ASSERT_EQ(distance.is_inside(p), exact < 0);
    }
  }
}

TEST(MeshDistance, TheWindingTreeIsNearTheSum) {
  const TriangleMesh mesh = open_hemisphere(0.05, 5);
  const WindingTree tree(mesh);
  Random random(9);
  double coarse = 0, fine = 0;
  for (int i = 0; i < 1000; ++i) {
    const Triple p = random_point(random, 0.08);
    const glm::dvec3 at = to_vec3(p);
    const double exact = tree.winding_number(at, std::numeric_limits<double>::infinity());
    coarse = std::max(coarse, std::abs(tree.winding_number(at, 2) - exact));
    fine = std::max(fine, std::abs(tree.winding_number(at, 8) - exact));
  }
  EXPECT_LT(coarse, 0.06);  // the doubt within which the side is asked for again
  EXPECT_LT(fine, 1e-3);
}

// Whichever triangle the search starts from, it finds the nearest one: none is rejected by its disk that should not be. Needles have normals that
// are rounding.
TEST(MeshDistance, EveryStartFindsTheNearestTriangle) {
  Random random(7);
  const auto place = [&](double size) {
    const double x = random.uniform(-size, size), y = random.uniform(-size, size);
    return Triple{x, y, random.uniform(-size, size)};
  };
  CheckedMesh soup;
  for (int i = 0; i < 150; ++i) {
    const Triple a = place(0.1), along = place(i % 3 == 0 ? 0.05 : 0.005), aside = place(i % 5 == 0 ? 1e-12 : 0.005);
    const auto first = static_cast<std::uint32_t>(soup.mesh.vertices.size());
    soup.mesh.vertices.push_back(a);
    soup.mesh.vertices.push_back({a[0] + along[0], a[1] + along[1], a[2] + along[2]});
    soup.mesh.vertices.push_back({a[0] + along[0] / 3 + aside[0], a[1] + along[1] / 3 + aside[1], a[2] + along[2] / 3 + aside[2]});
    soup.mesh.triangles.push_back({first, first + 1, first + 2});
  }
  soup.facts.low = {-0.2, -0.2, -0.2};
  soup.facts.high = {0.2, 0.2, 0.2};
  soup.facts.closed = soup.facts.oriented = true;
  const MeshDistance distance(soup);
  for (int i = 0; i < 200; ++i) {
    const Triple p = place(i % 2 == 0 ? 0.1 : 0.3);
    std::uint32_t nearest = 0;
    const double first = distance.distance(p, nearest);
    for (std::uint32_t start = 1; start < soup.mesh.triangles.size(); ++start) {
      std::uint32_t found = start;
      EXPECT_EQ(distance.distance(p, found), first) << start;
    }
  }
}

// On its axis the winding number of a disk of radius R changes by R2 / (2 (R2 + z2)^1.5) per m; the bound lacks the slant of the rim's pull.
TEST(MeshDistance, TheSlopeOfTheWindingNumberIsThatOfItsRim) {
  const CheckedMesh bowl = check_mesh(open_hemisphere(0.05, 5), "bowl");
  const MeshDistance distance(bowl);
  for (const double z : {-0.2, -0.05, 0.0, 0.04, 0.3}) {
    const double squared = 0.05 * 0.05 + z * z, slope = distance.winding_slope({0, z, 0}, 0);
    EXPECT_GE(slope, 0.05 * 0.05 / (2 * std::pow(squared, 1.5)));
    // edges of 2.5 mm, each counted from its nearer end
    EXPECT_NEAR(slope, 0.05 / (2 * squared), 0.06 * slope);
    EXPECT_GT(distance.winding_slope({0, z, 0}, 0.01), slope);
  }
  EXPECT_EQ(distance.winding_slope({0.045, 0, 0}, 0.01), std::numeric_limits<double>::infinity());
  const CheckedMesh ball = check_mesh(icosphere(0.05, 3), "ball");
  EXPECT_EQ(MeshDistance(ball).winding_slope({0, 0, 0}, 1), 0);
  EXPECT_EQ(MeshDistance(ball).side({0, 0, 0}).room, std::numeric_limits<double>::infinity());
}

TEST(MeshDistance, NoWindingNumberChangesFasterThanItsSlope) {
  const CheckedMesh bowl = check_mesh(wavy_bowl(0.05, 4, 0.01), "bowl");
  const MeshDistance distance(bowl);
  Random random(8);
  int compared = 0;
  for (int i = 0; i < 20'000; ++i) {
    const auto place = [&](double size) {
      const double x = random.uniform(-size, size), y = random.uniform(-size, size);
      return Triple{x, y, random.uniform(-size, size)};
    };
    const Triple p = place(0.1), step = place(0.01), q{p[0] + step[0], p[1] + step[1], p[2] + step[2]};
    std::uint32_t nearest = 0;
    const double way = norm(step), slope = distance.winding_slope(p, way);
    if (!(distance.distance(p, nearest) > way) || slope > 1e9) continue;
    ++compared;
    EXPECT_LE(std::abs(distance.winding_number(q) - distance.winding_number(p)), slope * way + 2e-3) << "each is right to 1e-3";
  }
  EXPECT_GT(compared, 10'000);
}

}  // namespace
}  // namespace wholehand
