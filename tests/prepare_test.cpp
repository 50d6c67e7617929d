// What the kernels are given: outlines split where y turns, the hand's frames, Gauss-Legendre points; and what is refused.
#include "core/prepare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/error.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

TEST(Prepare, ArcsAreSplitAtTheirPoles) {
  // from the base outwards, an arc over the widest point of a circle about (0, 30), radius 30: y is monotone, one element; the circle
  // about (20, 30) of radius 10 from its lowest to its highest point by the right: two quarters are one monotone half
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

TEST(Prepare, MeshesAreRefusedWithTheirPlace) {
  Scene scene = scene_of({beaker1(), beaker2()});
  EXPECT_NO_THROW(refuse_meshes(scene));
  scene.vessels[1].mesh = MeshData{};
  scene.vessels[1].mesh->place = "cups.toml:7:3";
  try {
    refuse_meshes(scene);
    ADD_FAILURE() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).rfind("cups.toml:7:3: vessel 'beaker2' is a mesh", 0), 0u) << error.what();
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
