// SPDX-License-Identifier: MIT
// Kernel 2 on a lattice of samples in place of the outline.
#include "core/sdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "tests/support/sampled_outline.h"

namespace wholehand {
namespace {

using core_f64::Lattice;
using core_f64::Vessel;

Vec3 lattice_point(const Lattice& lattice, double i, double j, double k) {
  return lattice.origin + lattice.spacing * Vec3{i, j, k};
}

TEST(Sdf, LatticeHoldsTheDistanceAtItsSamples) {
  const Vessel outline = ready_vessel(vase());
  const Lattice lattice = lattice_of(vase(), 24);
  ASSERT_EQ(lattice.words->size(), static_cast<std::size_t>(lattice.nx * lattice.ny * lattice.nz));
  for (int k = 0; k < lattice.nz; ++k) {
    for (int j = 0; j < lattice.ny; ++j) {
      for (int i = 0; i < lattice.nx; ++i) {
        const Vec3 p = lattice_point(lattice, i, j, k);
        // a float holds half a unit of its 24th bit; 1e-15 m: the place of a sample is rounded to 1e-17 m, its cell coordinates to
        // 1e-15
        const double exact = core_f64::signed_distance(outline, p);
        ASSERT_NEAR(core_f64::lattice_distance(lattice, p), exact, 0x1p-24 * std::abs(exact) + 1e-15) << i << " " << j << " " << k;
      }
    }
  }
}

TEST(Sdf, LatticeOfHalvesIsOffByTheirSpacing) {
  for (const VesselData& data : {vase(), beaker2()}) {
    const Lattice floats = lattice_of(data, 41), halves = lattice_of(data, 41, 16);
    EXPECT_EQ(halves.words->size(), (floats.words->size() + 1) / 2);
    int differ = 0;
    for (int k = 0; k < halves.nz; ++k) {
      for (int j = 0; j < halves.ny; ++j) {
        for (int i = 0; i < halves.nx; ++i) {
          const double exact = core_f64::lattice_sample(floats, i, j, k), stored = core_f64::lattice_sample(halves, i, j, k);
          differ += stored != exact;
          // half a unit of the 11th bit, or for the smallest halves half of 2^-24 in units of 2^-10 m
          ASSERT_NEAR(stored, exact, std::max(0x1p-11 * std::abs(exact), 0x1p-35)) << i << " " << j << " " << k;
        }
      }
    }
    EXPECT_GT(differ, 1000);
    // a mean of samples is off by no more than they are
    Random random(11);
    for (int n = 0; n < 5000; ++n) {
      const Vec3 p = lattice_point(halves, random.uniform(0, halves.nx - 1), random.uniform(0, halves.ny - 1),
                                   random.uniform(0, halves.nz - 1));
      const double exact = core_f64::lattice_distance(floats, p);
      ASSERT_NEAR(core_f64::lattice_distance(halves, p), exact, 0x1p-11 * (std::abs(exact) + 2 * halves.spacing));
    }
  }
}

TEST(Sdf, LatticeIsTrilinearBetweenItsSamples) {
  const Lattice lattice = lattice_of(vase(), 24);
  Random random(9);
  for (int n = 0; n < 1000; ++n) {
    const int i = static_cast<int>(random.uniform(0, lattice.nx - 1)), j = static_cast<int>(random.uniform(0, lattice.ny - 1)),
              k = static_cast<int>(random.uniform(0, lattice.nz - 1));
    const double u = random.uniform(0, 1), v = random.uniform(0, 1), w = random.uniform(0, 1);
    double expected = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const int di = corner & 1, dj = corner >> 1 & 1, dk = corner >> 2;
      expected +=
          (di ? u : 1 - u) * (dj ? v : 1 - v) * (dk ? w : 1 - w) * core_f64::lattice_sample(lattice, i + di, j + dj, k + dk);
    }
    ASSERT_NEAR(core_f64::lattice_distance(lattice, lattice_point(lattice, i + u, j + v, k + w)), expected, 1e-15);  // as above
  }
}

TEST(Sdf, LatticeReachesTwoCellsBeyondTheVessel) {
  const VesselData data = beaker3();
  const Lattice lattice = lattice_of(data, 24);
  const Vec3 low = lattice.origin, high = lattice_point(lattice, lattice.nx - 1, lattice.ny - 1, lattice.nz - 1);
  const double r = largest_radius(data), reach = 2 * lattice.spacing - 1e-12;
  EXPECT_LE(low.x, -r - reach);
  EXPECT_LE(low.y, -reach);
  EXPECT_LE(low.z, -r - reach);
  EXPECT_GE(high.x, r + reach);
  EXPECT_GE(high.y, data.height + reach);
  EXPECT_GE(high.z, r + reach);
}

TEST(Sdf, LatticeOutsideItsBoxIsNeverMoreThanTheDistance) {
  const Vessel outline = ready_vessel(beaker3());
  const Lattice lattice = lattice_of(beaker3(), 32);
  const Vec3 low = lattice.origin, high = lattice_point(lattice, lattice.nx - 1, lattice.ny - 1, lattice.nz - 1);
  Random random(10);
  int compared = 0;
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p{random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.6), random.uniform(-0.4, 0.4)};
    const Vec3 clamped = glm::clamp(p, low, high);
    if (p == clamped) continue;
    ++compared;
    const double sdf = core_f64::lattice_distance(lattice, p);
    ASSERT_NEAR(sdf, std::hypot(core_f64::lattice_distance(lattice, clamped), glm::distance(p, clamped)), 1e-15);  // rounding
    // the two ways meet at a right angle or more, so the hypotenuse lies between the true distance and 2^(-1/2) of it;
    // interpolation is off by spacing^2 / 8 times the curvature of the distance, at most 1 / (2 spacing) two cells off: a 16th of a
    // cell
    const double exact = core_f64::signed_distance(outline, p);
    ASSERT_LE(sdf, exact + lattice.spacing / 16) << p.x << " " << p.y << " " << p.z;
    ASSERT_GE(sdf, std::sqrt(0.5) * exact - lattice.spacing / 16) << p.x << " " << p.y << " " << p.z;
  }
  EXPECT_GT(compared, 10000);
}

TEST(Sdf, LatticeIsContinuousAtItsBox) {
  const Lattice lattice = lattice_of(vase(), 24);
  for (const Vec3 p : {lattice_point(lattice, 0, 3.3, 4.1), lattice_point(lattice, lattice.nx - 1, 3.3, 4.1),
                       lattice_point(lattice, 2.5, 0, 6.2), lattice_point(lattice, 2.5, lattice.ny - 1, 6.2),
                       lattice_point(lattice, 7.7, 3.3, 0), lattice_point(lattice, 7.7, 3.3, lattice.nz - 1),
                       lattice_point(lattice, 0, 0, 0), lattice_point(lattice, lattice.nx - 1, lattice.ny - 1, lattice.nz - 1)}) {
    const double here = core_f64::lattice_distance(lattice, p);
    for (int k = 0; k < 6; ++k) {
      Vec3 step{};
      step[k / 2] = k % 2 ? 1e-9 : -1e-9;
      ASSERT_NEAR(core_f64::lattice_distance(lattice, p + step), here, 1e-8);  // 1e-9 m away, by a slope of a few at most
    }
  }
}

TEST(Sdf, LatticeGradientIsItsDifferenceQuotient) {
  const Vessel vessel = lattice_vessel(vase(), 24);
  const Lattice& lattice = vessel.lattice;
  const double h = 1e-7;
  Random random(12);
  for (int n = 0; n < 2000; ++n) {
    // inside a cell; across its faces the slope jumps
    const auto coordinate = [&random](int count) { return std::floor(random.uniform(0, count - 1)) + random.uniform(0.01, 0.99); };
    const Vec3 p = lattice_point(lattice, coordinate(lattice.nx), coordinate(lattice.ny), coordinate(lattice.nz));
    Vec3 difference;
    for (int k = 0; k < 3; ++k) {
      Vec3 step{};
      step[k] = h;
      difference[k] = (core_f64::signed_distance(vessel, p + step) - core_f64::signed_distance(vessel, p - step)) / (2 * h);
    }
    if (glm::length(difference) < 0.1) continue;  // near where it vanishes its direction is undetermined
    int element = 0;
    const Vec3 g = core_f64::distance_gradient(vessel, p, element);
    EXPECT_EQ(element, -1);
    EXPECT_NEAR(glm::length(g), 1, 1e-12);
    // 1e-7: along an axis trilinear is linear, so only rounding, 1e-16 / h / 0.1
    ASSERT_LT(glm::distance(g, glm::normalize(difference)), 1e-7);
  }
}

TEST(Sdf, LatticeGradientOutsideItsBoxIsItsDifferenceQuotient) {
  const Lattice lattice = lattice_of(vase(), 24);
  const Vec3 low = lattice.origin, high = lattice_point(lattice, lattice.nx - 1, lattice.ny - 1, lattice.nz - 1);
  const double h = 1e-7;
  Random random(14);
  int compared = 0;
  for (int n = 0; n < 4000; ++n) {
    const Vec3 p{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.5), random.uniform(-0.3, 0.3)};
    const Vec3 inner = glm::clamp(p, low, high), steps = (inner - lattice.origin) / lattice.spacing;
    bool near_a_face = p == inner;
    for (int k = 0; k < 3; ++k) {
      const double to_face =
          p[k] == inner[k] ? std::abs(steps[k] - std::round(steps[k])) * lattice.spacing : std::abs(p[k] - inner[k]);
      near_a_face = near_a_face || to_face < 2 * h;  // across it the slope jumps
    }
    if (near_a_face) continue;
    ++compared;
    Vec3 difference;
    for (int k = 0; k < 3; ++k) {
      Vec3 step{};
      step[k] = h;
      difference[k] = (core_f64::lattice_distance(lattice, p + step) - core_f64::lattice_distance(lattice, p - step)) / (2 * h);
    }
    // 1e-6: rounding, 1e-16 / h, and the third derivative, h^2 / d^2 for d over some mm
    ASSERT_LT(glm::distance(core_f64::lattice_gradient(lattice, p), glm::normalize(difference)), 1e-6);
  }
  EXPECT_GT(compared, 2000);
}

TEST(Sdf, LatticeGradientOutsideItsBoxIsUnitAndPointsAway) {
  const Lattice lattice = lattice_of(beaker1(), 24);
  for (const Vec3 p : {Vec3{0.5, 0.05, 0}, Vec3{0, 0.05, -0.5}, Vec3{0, 1, 0}, Vec3{0.3, -0.4, 0.2}}) {
    const Vec3 g = core_f64::lattice_gradient(lattice, p);
    EXPECT_NEAR(glm::length(g), 1, 1e-12);
    EXPECT_GT(glm::dot(g, glm::normalize(p - Vec3{0, 0.055, 0})), 0.5);
  }
}

TEST(Sdf, LatticeGradientIsXWhereItVanishes) {
  const std::vector<std::uint32_t> quarters(8, std::bit_cast<std::uint32_t>(0.25f));
  const Lattice lattice{{0, 0, 0}, 1, 2, 2, 2, false, std::make_shared<const std::vector<std::uint32_t>>(quarters)};
  EXPECT_EQ(core_f64::lattice_gradient(lattice, {0.5, 0.5, 0.5}), (Vec3{1, 0, 0}));
  EXPECT_EQ(core_f64::lattice_distance(lattice, {0.5, 0.5, 0.5}), 0.25);
}

TEST(Sdf, LatticeErrorFallsWithTheSquareOfItsSpacing) {
  // on the cone and the neck, further from creases than the coarsest cell's diagonal
  const Vessel outline = ready_vessel(beaker3());
  std::vector<Vec3> points;
  Random random(13);
  while (points.size() < 4000) {
    const Vec3 p = around({random.uniform(5e-3, 45e-3), random.uniform(15e-3, 90e-3)}, random.uniform(-PI, PI));
    if (std::abs(core_f64::signed_distance(outline, p)) < 5e-3) points.push_back(p);
  }
  std::vector<double> worst, spacing;
  for (const int samples : {30, 60, 120}) {
    const Lattice lattice = lattice_of(beaker3(), samples);
    double largest = 0;
    for (const Vec3& p : points)
      largest = std::max(largest, std::abs(core_f64::lattice_distance(lattice, p) - core_f64::signed_distance(outline, p)));
    worst.push_back(largest);
    spacing.push_back(lattice.spacing);
  }
  for (std::size_t i = 1; i < worst.size(); ++i) {
    const double order = std::log(worst[i - 1] / worst[i]) / std::log(spacing[i - 1] / spacing[i]);
    EXPECT_NEAR(order, 2, 0.3) << worst[i - 1] << " m, " << worst[i]
                               << " m";  // the worst place in a cell differs from lattice to lattice
  }
}

}  // namespace
}  // namespace wholehand
