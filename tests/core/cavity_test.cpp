// SPDX-License-Identifier: MIT
// The inner offset that makes shells and cavities.
#include "core/sdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/text/error.h"
#include "tests/support/refusal.h"
#include "tests/support/sampled_outline.h"

namespace wholehand {
namespace {

// ---- inner offset ----

void expect_cavity_at_wall(const VesselData& data) {
  const PreparedVessel prepared = prepare_vessel(data, true);
  const Sampled open(open_pieces(data), FEWER_SAMPLES), hull(pieces_of(data), FEWER_SAMPLES);
  ASSERT_FALSE(prepared.cavity.empty()) << data.name;
  EXPECT_NEAR(prepared.cavity.front().a[1], prepared.floor_height, 1e-12);  // a level floor is no piece of r(y)
  EXPECT_NEAR(open.distance({0, prepared.floor_height}), data.wall, 1e-12) << data.name;
  EXPECT_NEAR(prepared.cavity.back().b[0], prepared.mouth_radius, 1e-12);
  EXPECT_NEAR(prepared.cavity.back().b[1], data.height, 1e-12);
  EXPECT_EQ(prepared.mouth_height, data.height);
  for (std::size_t i = 0; i < prepared.cavity.size(); ++i) {
    const PreparedElement& element = prepared.cavity[i];
    EXPECT_LE(element.a[1], element.b[1]) << data.name;  // y ascending
    if (i > 0) {
      // 1e-8 m: at an arc's pole r is the root of a rounding, (2 x 30 mm x 1e-17 m)^(1/2) and its few units
      EXPECT_NEAR(element.a[0], prepared.cavity[i - 1].b[0], 1e-8) << data.name << ", piece " << i;
      EXPECT_NEAR(element.a[1], prepared.cavity[i - 1].b[1], 1e-12) << data.name << ", piece " << i;
    }
    for (int n = 0; n <= 40; ++n) {
      const double t = n / 40.0;
      Vec2 q{element.a[0] + t * (element.b[0] - element.a[0]), element.a[1] + t * (element.b[1] - element.a[1])};
      if (element.side != 0) {
        const double chord = q.y - element.center[1];
        q.x = element.center[0] + element.side * std::sqrt(std::max(0.0, element.radius * element.radius - chord * chord));
      }
      // 1e-9 m: the specification's; at an arc's pole a rounding of y alone moves r by the root of it, but not the distance
      ASSERT_NEAR(open.distance(q), data.wall, 1e-9) << data.name << ", piece " << i << " at " << q.x << ", " << q.y;
      if (n > 0 && n < 40) {
        ASSERT_TRUE(q.x < 1e-6 || hull.inside({q.x, std::min(q.y, data.height - 1e-9)})) << data.name;
      }
    }
  }
}

TEST(Sdf, CavityIsAWallAwayFromTheOpenOutline) {
  for (const VesselData& data : {beaker1(), beaker2(), beaker3(), vase(), scaled(vase(), 2.7)}) expect_cavity_at_wall(data);
}

TEST(Sdf, CavityOfAThickWallStillIsAWallAway) {
  // the fillet of the foot (6 mm) and the bead (4 mm) are gone from the inside
  for (const double wall : {3e-3, 5e-3, 8e-3}) {
    VesselData data = vase();
    data.wall = wall;
    expect_cavity_at_wall(data);
  }
}

TEST(Sdf, CavityRadiusAgreesWithBisection) {
  for (const VesselData& data : {beaker2(), beaker3(), vase()}) {
    const PreparedVessel prepared = prepare_vessel(data, true);
    const Sampled open(open_pieces(data), FEWER_SAMPLES);
    for (const double fraction : {0.05, 0.31, 0.5, 0.64, 0.93, 1.0}) {
      const double y = prepared.floor_height + fraction * (data.height - prepared.floor_height);
      double cavity = -1;
      for (const PreparedElement& element : prepared.cavity) {
        if (y < element.a[1] || y > element.b[1] || element.a[1] == element.b[1]) continue;
        const double chord = y - element.center[1];
        cavity = element.side == 0
                     ? element.a[0] + (element.b[0] - element.a[0]) * (y - element.a[1]) / (element.b[1] - element.a[1])
                     : element.center[0] + element.side * std::sqrt(element.radius * element.radius - chord * chord);
      }
      double high = 0.1e-3;  // from the axis outwards to the first place that is nearer than the wall
      while (open.distance({high, y}) > data.wall) high += 0.1e-3;
      double low = high - 0.1e-3;
      for (int step = 0; step < 50; ++step) {
        const double middle = (low + high) / 2;
        (open.distance({middle, y}) > data.wall ? low : high) = middle;
      }
      EXPECT_NEAR(cavity, low, 1e-9) << data.name << " at " << y;
    }
  }
}

TEST(Sdf, CavityOfACylinderInClosedForm) {
  const PreparedVessel prepared = prepare_vessel(beaker1(), true);
  EXPECT_NEAR(prepared.floor_height, 1.5e-3, 1e-15);  // rounding
  EXPECT_NEAR(prepared.mouth_radius, 38.5e-3, 1e-15);
  EXPECT_EQ(prepared.mouth_height, 110e-3);
  EXPECT_EQ(prepared.lid, static_cast<int>(prepared.outline.size()) - 1);
}

std::string refusal(const VesselData& vessel) {
  return refusal_line([&] { prepare_vessel(vessel, true); });
}

TEST(Sdf, WallThickerThanTheRadiusIsRefused) {
  for (const double wall : {40e-3, 41e-3, 0.2}) {
    VesselData vessel = beaker1();
    vessel.wall = wall;
    EXPECT_NE(refusal(vessel).find("beaker1"), std::string::npos) << wall;
  }
  VesselData vessel = beaker1();
  vessel.wall = 39.9e-3;  // a bore is left
  EXPECT_EQ(refusal(vessel), "");
}

TEST(Sdf, WallThickerThanTheHeightIsRefused) {
  VesselData dish = cylinder("dish", 120, 20, 20);
  EXPECT_NE(refusal(dish).find("dish"), std::string::npos);
  dish.wall = 19e-3;
  EXPECT_EQ(refusal(dish), "");
}

TEST(Sdf, WallThatClosesTheNeckIsRefused) {
  for (VesselData vessel : {beaker2(), beaker3()}) {
    vessel.wall = 17.5e-3;  // the neck's radius is 17 mm, the body's 42.5
    EXPECT_NE(refusal(vessel).find(vessel.name), std::string::npos);
    vessel.wall = 16e-3;
    EXPECT_EQ(refusal(vessel), "") << vessel.name;
  }
}

TEST(Sdf, WallThatClosesTheWaistIsRefused) {
  VesselData vessel = vase();
  vessel.wall = 18.5e-3;  // 18 mm at the waist, between foot and belly
  EXPECT_NE(refusal(vessel).find("vase"), std::string::npos);
}

TEST(Sdf, CavityThatFoldsOverItselfIsRefused) {
  VesselData vessel = ledges();  // a trough in a level ledge: one height, three radii
  vessel.wall = 0.5e-3;
  EXPECT_NE(refusal(vessel).find("ledges"), std::string::npos);
}

TEST(Sdf, ShellWithoutACavityIsRefused) {
  VesselData vessel = shell_of(beaker1());
  vessel.wall = 50e-3;
  EXPECT_NE(refusal(vessel), "");
}

}  // namespace
}  // namespace wholehand
