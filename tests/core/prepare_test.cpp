// SPDX-License-Identifier: MIT
// What the kernels are given: outlines split where y turns, the hand's frames, Gauss-Legendre points; and what is refused.
#include "core/prepare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/text/error.h"
#include "core/mesh_body.h"
#include "core/mirror.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

TEST(Prepare, ArcsAreSplitAtTheirPoles) {
  // from the base outwards, an arc over the widest point of a circle about (0, 30), radius 30: y is monotone, one element; the
  // circle about (20, 30) of radius 10 from its lowest to its highest point by the right: two quarters are one monotone half
  const VesselData vessel = vessel_of("v", {line_to(20, 20), arc_to(20, 40, 20, 30), line_to(0, 40)}, 0);
  for (const PreparedElement& element : monotone_elements(vessel.outline)) {
    if (element.side == 0) continue;
    EXPECT_NEAR(element.radius, 0.01, 1e-15);
    EXPECT_EQ(element.side, 1);
    EXPECT_LT(element.a[1], element.b[1]);
  }
  // counter-clockwise over the top of a circle: the pole is inside the arc
  const VesselData domed = vessel_of("d", {line_to(30, 0), arc_to(10, 20, 10, 0), line_to(0, 20)}, 0);
  std::size_t arcs = 0;
  for (const PreparedElement& element : monotone_elements(domed.outline)) arcs += element.side != 0 ? 1 : 0;
  EXPECT_EQ(arcs, 1u);
  const VesselData over = vessel_of("o", {line_to(30, 0), arc_to(6, 12, 15, 0), line_to(0, 12)}, 0);  // radius 15, past its pole
  arcs = 0;
  for (const PreparedElement& element : monotone_elements(over.outline)) arcs += element.side != 0 ? 1 : 0;
  EXPECT_EQ(arcs, 2u);
}

TEST(Prepare, AnArcIsAsWideAsItReaches) {
  // about a place within the vessel and far above: the circle is 150 mm wide, the vessel 50
  const PreparedVessel shallow =
      prepare_vessel(vessel_of("s", {line_to(30, 0), arc_to(50, 65, -350, 165), line_to(0, 65)}, 0), false);
  EXPECT_NEAR(shallow.largest_radius, 0.05, 1e-15);
  // one that reaches its equator, at 20 + 10 mm
  const PreparedVessel belly = prepare_vessel(vessel_of("b", {line_to(20, 20), arc_to(20, 40, 20, 30), line_to(0, 40)}, 0), false);
  EXPECT_NEAR(belly.largest_radius, 0.03, 1e-15);
}

TEST(Prepare, AMeshIsItsBodyAndItsInnerOutline) {
  VesselData vessel;
  vessel.name = "cup";
  vessel.mesh = MeshData{};
  EXPECT_THROW(prepare_vessel(vessel, false), Error) << "not read";
  MeshBody body;
  body.vertices = {{0.03, -0.02, 0.04}, {0, 0.08, 0}, {0, -0.02, 0}};
  body.facts.low = {0, -0.02, 0};
  body.facts.high = {0.03, 0.08, 0.04};
  vessel.base = -0.02;
  vessel.height = 0.08;
  // floor at -15 mm, a level step out, a quarter circle, and straight up to the mouth
  vessel.inner = {line_to(0, -15), line_to(10, -15), arc_to(20, -5, 10, -5), line_to(20, 70)};
  vessel.mesh->body = std::make_shared<MeshBody>(body);
  const PreparedVessel prepared = prepare_vessel(vessel, vessel.has_cavity());
  EXPECT_TRUE(prepared.hull.empty() && prepared.outline.empty());
  EXPECT_EQ(prepared.lid, -1);
  ASSERT_EQ(prepared.cavity.size(), 2u) << "the level step holds nothing";
  EXPECT_EQ(prepared.cavity[0].side, 1);
  EXPECT_EQ(prepared.floor_height, -15e-3);
  EXPECT_EQ(prepared.mouth_height, 70e-3);
  EXPECT_EQ(prepared.mouth_radius, 20e-3);
  EXPECT_NEAR(prepared.largest_radius, 0.05, 1e-15);
  EXPECT_NEAR(prepared.bound_height, 0.03, 1e-15);
  EXPECT_NEAR(prepared.bound_radius, std::hypot(0.05, 0.05), 1e-15);
  EXPECT_TRUE(prepare_vessel(vessel, false).cavity.empty());
}

TEST(Prepare, AMirroredLatticeIsTheMirrorImageToTheBit) {
  for (const bool halves : {false, true}) {
    PreparedLattice lattice;
    lattice.origin = {-0.3, 0.1, 0.2};
    lattice.spacing = 0.1;
    lattice.nx = 3;
    lattice.ny = 2;
    lattice.nz = 2;
    lattice.halves = halves;
    lattice.words = std::make_shared<const std::vector<std::uint32_t>>(
        halves ? std::vector<std::uint32_t>{0x00010000, 0x00030002, 0x00050004, 0x00070006, 0x00090008, 0x000B000A}
               : std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
    const PreparedLattice image = mirrored(lattice, Handedness::left);
    EXPECT_NEAR(image.origin[0], 0.1, 1e-15);
    EXPECT_EQ(image.origin[1], lattice.origin[1]);
    EXPECT_EQ(*image.words,
              halves ? (std::vector<std::uint32_t>{0x00010002, 0x00050000, 0x00030004, 0x00070008, 0x000B0006, 0x0009000A})
                     : (std::vector<std::uint32_t>{2, 1, 0, 5, 4, 3, 8, 7, 6, 11, 10, 9}));
    EXPECT_EQ(mirrored(lattice, Handedness::right).words, lattice.words);
    EXPECT_EQ(*mirrored(image, Handedness::left).words, *lattice.words);
  }
}

// The points are taken over the angle whose cosine runs over [-1, 1]: the integral of x^k is 2 / (k + 1), or 0. Its integrand,
// cos^k sin, has no frequency above k + 1, which 32 points resolve to rounding.
TEST(Prepare, QuadratureIntegratesPolynomials) {
  const PreparedQuadrature rule = prepare_quadrature(32);
  ASSERT_EQ(rule.cosine.size(), 32u);
  for (int degree = 0; degree <= 20; ++degree) {
    double sum = 0;
    for (std::size_t i = 0; i < rule.cosine.size(); ++i) sum += rule.weight[i] * std::pow(rule.cosine[i], degree);
    EXPECT_NEAR(sum, degree % 2 == 0 ? 2.0 / (degree + 1) : 0.0, 1e-14) << degree;  // 32 roundings
  }
}

}  // namespace
}  // namespace wholehand
