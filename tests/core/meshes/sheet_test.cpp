// SPDX-License-Identifier: MIT
// Sheets without thickness that are given walls.
#include "core/meshes/sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/meshes/distance.h"
#include "tests/support/mesh_faults.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"
#include "tests/support/vessel_profiles.h"

namespace wholehand {
namespace {

constexpr double MM = 1e-3;

CheckedMesh thick(const TriangleMesh& mesh, double thickness) { return thickened(check_mesh(mesh, "sheet"), thickness, "cup.stl"); }

std::string sheet_refusal(const TriangleMesh& mesh, double thickness) {
  return refusal_line([&] { thick(mesh, thickness); });
}

// A box of 60 x 40 x 50 mm without its top.
TriangleMesh open_box() {
  TriangleMesh box = box_mesh({0, 0, 0}, {60 * MM, 40 * MM, 50 * MM});
  std::erase_if(box.triangles, [&](const Corners& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t corner) { return box.vertices[corner][1] > 39 * MM; });
  });
  return box;
}

TEST(Sheet, AFlatSquareBecomesAPlate) {
  const double side = 100 * MM, thickness = 3 * MM;
  CheckedMesh square;  // which a check refuses, as it encloses no volume
  square.mesh.vertices = {{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}};
  square.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  square.facts.triangles = 2;
  square.facts.open_edges = 4;
  square.facts.oriented = true;
  square.facts.area = side * side;
  const CheckedMesh plate = thickened(square, thickness, "plate.stl");
  EXPECT_NEAR(plate.facts.volume, side * side * thickness, 1e-15);
  EXPECT_TRUE(plate.facts.closed);
  EXPECT_TRUE(plate.facts.oriented);
  EXPECT_EQ(plate.facts.thickness, thickness);
  EXPECT_EQ(plate.facts.triangles, 2u) << "as read";
}

TEST(Sheet, WallsAtRightAnglesAreExact) {
  const double t = 2 * MM;
  const CheckedMesh box = thick(open_box(), t);
  EXPECT_NEAR(box.facts.volume, 60 * MM * 40 * MM * 50 * MM - (60 * MM - 2 * t) * (40 * MM - t) * (50 * MM - 2 * t), 1e-15);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(box.facts.low[k], 0);
    EXPECT_EQ(box.facts.high[k], (Triple{60 * MM, 40 * MM, 50 * MM})[k]) << "the drawn surface is the outside";
  }
  const MeshDistance distance(box);
  EXPECT_NEAR(distance.signed_distance({30 * MM, 20 * MM, 25 * MM}), 18 * MM, 1e-12) << "to the floor";
  EXPECT_NEAR(distance.signed_distance({5 * MM, 20 * MM, 25 * MM}), 3 * MM, 1e-12);
  EXPECT_LT(distance.signed_distance({1 * MM, 20 * MM, 25 * MM}), 0);
}

// Rows finer than the thickness fold over at a crease, within the wall of the next face.
TEST(Sheet, FineTrianglesBesideACreaseDoNoHarm) {
  constexpr int SIDES = 64;
  const double t = 2 * MM, share = polygon_share(SIDES), apothem = std::cos(PI / SIDES);
  const ProfilePoints outer = TurnedProfile(0, 0).line(30, 0).line(30, 80).points();
  const CheckedMesh coarse = thick(swept_mesh(outer, SIDES), t), fine = thick(swept_mesh(divided(outer, 0.4 * MM), SIDES), t);
  const double inside = 30 * MM - t / apothem;
  const double volume = PI * share * (30 * MM * 30 * MM * 80 * MM - inside * inside * 78 * MM);
  EXPECT_NEAR(coarse.facts.volume, volume, 0.02 * volume);
  EXPECT_NEAR(fine.facts.volume, volume, 0.02 * volume);
  const MeshDistance distance(fine);
  for (const double y : {0.3, 1.0, 1.7})
    for (const double r : {0.5, 20.0, 27.0, 29.0})
      EXPECT_LT(distance.signed_distance({r * MM, y * MM, 0.2 * MM}), 0) << r << " " << y;
  EXPECT_GT(distance.signed_distance({27 * MM, 3 * MM, 0}), 0);
  // a rounding of 1 mm, which is narrower than the wall is thick
  const ProfilePoints rounded = TurnedProfile(0, 0).line(29, 0).arc(30, 1, 29, 1).line(30, 80).points();
  EXPECT_NEAR(thick(swept_mesh(rounded, SIDES), t).facts.volume, volume, 0.01 * volume);
}

TEST(Sheet, TheRimOfALeaningWallStaysLevel) {
  const double height = 90 * MM, t = 2 * MM;
  const CheckedMesh cone = thick(swept_mesh(TurnedProfile(0, 0).line(20, 0).line(45, 90).points(), 64), t);
  EXPECT_EQ(cone.facts.high[1], height);
  std::set<double> radii;  // of the rim's corners, um
  for (const Triple& vertex : cone.mesh.vertices)
    if (vertex[1] > height - 5 * MM) {
      EXPECT_NEAR(vertex[1], height, 1e-12);
      radii.insert(std::round(1e6 * std::hypot(vertex[0], vertex[2])));
    }
  ASSERT_EQ(radii.size(), 2u);
  const double slant = std::hypot(25, 90) / 90;
  EXPECT_NEAR(*radii.begin(), 45e3 - 2e3 * slant / std::cos(PI / 64), 5) << "as thick at the rim as elsewhere";
}

TEST(Sheet, ASheetOfTwoSidesBecomesTheSameBody) {
  const CheckedMesh one = thick(open_box(), 2 * MM), two = thick(two_sided(unjoined(open_box())), 2 * MM);
  EXPECT_EQ(two.facts.volume, one.facts.volume);
  EXPECT_EQ(two.facts.back_triangles, open_box().triangles.size());
  EXPECT_EQ(two.facts.triangles, 2 * open_box().triangles.size());
}

TEST(Sheet, AClosedMeshIsRefused) {
  EXPECT_EQ(sheet_refusal(box_mesh({0, 0, 0}, {1, 1, 1}), 1 * MM),
            "cup.stl: thickness_mm: no edge is open, so its walls have a thickness: leave out thickness_mm");
}

TEST(Sheet, AnEdgeOfThreeTrianglesIsRefused) {
  TriangleMesh box = open_box();
  const auto apex = static_cast<std::uint32_t>(box.vertices.size());
  box.vertices.push_back({30 * MM, 20 * MM, 25 * MM});
  box.triangles.push_back({box.triangles[0][0], box.triangles[0][1], apex});
  EXPECT_EQ(sheet_refusal(box, 2 * MM), "cup.stl: thickness_mm: more than two triangles meet at an edge: make one sheet of it");
}

TEST(Sheet, ANeckNarrowerThanItsWallsIsRefused) {
  const auto flask = [](double neck, int sides) {
    return swept_mesh(TurnedProfile(0, 0).line(30, 0).line(30, 50).line(neck, 70).line(neck, 100).points(), sides);
  };
  for (const int sides : {64, 12, 5}) {
    const std::string line = sheet_refusal(flask(1.5, sides), 2 * MM);
    EXPECT_NE(line.find("cup.stl: thickness_mm: 2 mm is too thick where walls face each other: at ("), line.npos) << line;
    EXPECT_EQ(sheet_refusal(flask(1.5, sides), 1 * MM), "") << sides;
    EXPECT_EQ(sheet_refusal(flask(4, sides), 2 * MM), "") << sides;
  }
  // the place is in the neck, and what fits is half of its width
  const std::string line = sheet_refusal(flask(1.5, 64), 2 * MM);
  double x = 0, y = 0, z = 0, width = 0, most = 0;
  ASSERT_EQ(std::sscanf(line.substr(line.find('(')).c_str(),
                        "(%lf, %lf, %lf) mm their outer sides are %lf mm apart, so give less than %lf", &x, &y, &z, &width, &most),
            5)
      << line;
  EXPECT_NEAR(std::hypot(x, z), 1.5, 0.02);
  EXPECT_GE(y, 69);
  EXPECT_LE(y, 100);
  EXPECT_NEAR(width, 3, 0.02);
  EXPECT_NEAR(most, 1.5, 0.02);
  EXPECT_EQ(sheet_refusal(flask(1.5, 64), 0.99 * most * MM), "") << "what the refusal says fits";
}

// Two flat walls are as far apart as they are long, at no narrow bend.
TEST(Sheet, ASlotNarrowerThanItsWallsIsRefused) {
  TriangleMesh slot = open_box();
  for (Triple& vertex : slot.vertices) vertex[0] /= 20;  // 3 mm wide
  EXPECT_NE(sheet_refusal(slot, 2 * MM).find("their outer sides are 3 mm apart, so give less than 1.5"), std::string::npos)
      << sheet_refusal(slot, 2 * MM);
  EXPECT_EQ(sheet_refusal(slot, 1.4 * MM), "");
}

TEST(Sheet, AShallowBowlThickerThanItsRadiusIsRefused) {
  const TriangleMesh bowl = swept_mesh(TurnedProfile(0, 0).cap(30, 10).points(), 64);
  EXPECT_EQ(sheet_refusal(bowl, 5 * MM), "");
  EXPECT_NE(sheet_refusal(bowl, 70 * MM).find("70 mm is more than its bends leave room for, as at ("), std::string::npos)
      << sheet_refusal(bowl, 70 * MM);
}

}  // namespace
}  // namespace wholehand
