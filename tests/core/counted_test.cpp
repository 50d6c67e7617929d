// SPDX-License-Identifier: MIT
// The number that counts its operations: expressions with known counts, and a core that computes the same with it as with doubles.
// sanitizers: none
#include "tests/support/counted.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <thread>

#include "core/gather.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "core/wall_run.h"
#include "sweeps/plan/plan.h"
#include "tests/support/counted_core.h"

namespace wholehand {
namespace {

constexpr std::size_t GRIPS = 40;  // of each vessel

template <class Work>
OperationCounts counts_of(const Work& work) {
  const OperationCounts before = operations_so_far;
  work();
  return operations_so_far - before;
}

// additions, multiplications, divisions, roots, transcendentals, comparisons
using Counts = OperationCounts;

TEST(Counted, ExpressionsCountWhatTheySay) {
  Counted a = 3, b = 4, c = 5;
  EXPECT_EQ(counts_of([&] { c = a * b + c; }), (Counts{1, 1, 0, 0, 0, 0}));
  EXPECT_EQ(c.value, 17);
  EXPECT_EQ(counts_of([&] { c -= 2 * a / b - 1; }), (Counts{2, 1, 1, 0, 0, 0}));
  EXPECT_EQ(c.value, 16.5);
  EXPECT_EQ(counts_of([&] { c = std::sqrt(a) + std::sin(-std::abs(b)) + std::acos(Counted(0.5)); }), (Counts{2, 0, 0, 1, 2, 0}));
  EXPECT_EQ(c.value, std::sqrt(3.0) + std::sin(-4.0) + std::acos(0.5));
  EXPECT_EQ(counts_of([&] { c = std::max(a, b) + std::clamp(c, Counted(0), Counted(1)); }), (Counts{1, 0, 0, 0, 0, 3}));
  EXPECT_EQ(c.value, 5);
  bool holds = false;
  EXPECT_EQ(counts_of([&] { holds = a <= 3 && 4 > b; }), (Counts{0, 0, 0, 0, 0, 2}));
  EXPECT_FALSE(holds);
  EXPECT_EQ(counts_of([&] { holds = a == 3 && b != 3.5; }), (Counts{0, 0, 0, 0, 0, 2}));
  EXPECT_TRUE(holds);
}

TEST(Counted, ConstantsAndConversionsCountNothing) {
  constexpr Counted half = Counted(1) / Counted(2);
  EXPECT_EQ(counts_of([&] {
              const Counted copied = half;
              EXPECT_EQ(static_cast<int>(static_cast<float>(copied) * 4), 2);
              EXPECT_EQ((-copied).value, -0.5);
            }),
            Counts{});
}

TEST(Counted, VectorsCountTheirComponents) {
  using Vec3 = glm::vec<3, Counted>;
  const Vec3 a(1, 2, 3), b(4, 5, 6);
  Counted number;
  Vec3 vector;
  EXPECT_EQ(counts_of([&] { number = glm::dot(a, b); }), (Counts{2, 3, 0, 0, 0, 0}));
  EXPECT_EQ(number.value, 32);
  EXPECT_EQ(counts_of([&] { number = glm::length(a); }), (Counts{2, 3, 0, 1, 0, 0}));
  EXPECT_EQ(counts_of([&] { vector = glm::cross(a, b); }), (Counts{3, 6, 0, 0, 0, 0}));
  EXPECT_EQ(vector.y.value, 6);
  EXPECT_EQ(counts_of([&] { vector = a + Counted(2) * b; }), (Counts{3, 3, 0, 0, 0, 0}));
}

TEST(Counted, EachThreadCountsItsOwn) {
  const OperationCounts before = operations_so_far;
  OperationCounts there;
  std::thread([&] {
    const Counted product = Counted(2) * Counted(3);
    EXPECT_EQ(product.value, 6);
    there = operations_so_far;
  }).join();
  EXPECT_EQ(there, (Counts{0, 1, 0, 0, 0, 0}));
  EXPECT_EQ(operations_so_far, before);
}

std::vector<GripInput> some_grips(const Scene& scene, std::size_t vessel) {
  const sweeps::Plan plan(scene, true);
  std::vector<GripInput> grips;
  for (std::size_t i = 0; i < GRIPS; ++i) grips.push_back(plan.grip(vessel, i * plan.grips() / GRIPS));
  return grips;
}

// As bits, so that a NaN is what it was.
std::size_t differing(const std::vector<double>& a, const std::vector<double>& b) {
  std::size_t count = a.size() != b.size();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    count += std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i]);
  return count;
}

TEST(Counted, TheCoreComputesTheSameBits) {
  for (const std::string& name : shipped_scenes()) {
    const Scene scene = read_scene_file(find_scene(name));
    const auto core = make_core_evaluator(scene), counted = core_counted::make_evaluator(scene, {});
    const FieldSet fields = all_fields(scene);
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      const auto grips = some_grips(scene, v);
      const GatheredPlanes plain = gather(*core, fields, v, grips), with_counts = gather(*counted, fields, v, grips);
      EXPECT_EQ(differing(plain.reals, with_counts.reals), 0u) << name << ", " << scene.vessels[v].name;
      EXPECT_EQ(plain.uints, with_counts.uints) << name << ", " << scene.vessels[v].name;
    }
  }
}

// A sample of a bare wall: (reading - before) / T; -(K x + B v); the motion by 6 products and 4 sums, the press added to the force.
TEST(Counted, ASampleOfTheWallCountsItsFormula) {
  const WallCase wall{.wall_stiffness = 100, .is_bilateral = true, .place = 0.01};
  const auto energy = [&](int samples) { EXPECT_EQ(core_counted::late_energy(wall, samples, 0), 0); };
  const OperationCounts some = counts_of([&] { energy(10); }), more = counts_of([&] { energy(11); });
  const OperationCounts sample = more - some;
  EXPECT_EQ(sample.additions, 1u + 1u + 1u + 4u);
  EXPECT_EQ(sample.multiplications, 2u + 6u);
  EXPECT_EQ(sample.divisions, 1u);
  EXPECT_EQ(sample.roots + sample.transcendentals, 0u);
  EXPECT_EQ(core_counted::late_energy(wall, 100, 10), core_f64::late_energy(wall, 100, 10));
}

}  // namespace
}  // namespace wholehand
