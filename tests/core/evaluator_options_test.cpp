// SPDX-License-Identifier: MIT
// What the evaluator's options cost: each approximation converges as its theory says, the named values change nothing.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "core/evaluator.h"
#include "evidence/check/compare.h"
#include "evidence/check/convergence.h"
#include "tests/support/long_double.h"
#include "tests/support/sampled_outline.h"
#include "tests/support/whole_parity.h"

namespace wholehand {
namespace {

bool same_bits(const GatheredPlanes& a, const GatheredPlanes& b) {
  const auto same = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y) || (std::isnan(x) && std::isnan(y));
  };
  return a.reals.size() == b.reals.size() && std::equal(a.reals.begin(), a.reals.end(), b.reals.begin(), same) &&
         a.uints == b.uints;
}

EvaluatorOptions named_values(Precision precision) {
  EvaluatorOptions options;
  options.stop_tolerance = precision == Precision::single ? STOP_TOLERANCE_F32 : STOP_TOLERANCE_F64;
  options.trace_steps = TRACE_STEPS;
  options.advance_steps = ADVANCE_STEPS;
  return options;
}

TEST(EvaluatorOptions, NamedValuesGiveTheSameBits) {
  for (const Pose pose : {Pose::articulated, Pose::paper}) {
    const Scene scene = wet_scene({vase()}, pose);
    const FieldSet fields = all_fields(scene);
    const auto grips = grips_of(scene, 0, 150);
    EXPECT_TRUE(same_bits(gather(*make_core_evaluator(scene), fields, 0, grips),
                          gather(*make_core_evaluator(scene, named_values(Precision::full)), fields, 0, grips)));
    EXPECT_TRUE(same_bits(gather(*make_core_float_evaluator(scene), fields, 0, grips),
                          gather(*make_core_float_evaluator(scene, named_values(Precision::single)), fields, 0, grips)));
  }
}

TEST(EvaluatorOptions, NamedValuesGiveTheSameBitsOnADevice) {
  const Scene scene = wet_scene({vase()}, Pose::articulated);
  const FieldSet fields = all_fields(scene);
  const auto grips = grips_of(scene, 0, 150);
  host::GripBackendOptions options;
  options.evaluator = named_values(Precision::single);
  const auto named = backend_of(scene, fields, Precision::single, options), as_is = backend_of(scene, fields, Precision::single);
  if (!as_is->info().is_cpu) GTEST_SKIP() << "two pipelines may round apart";
  EXPECT_TRUE(same_bits(gather(*as_is, 0, grips), gather(*named, 0, grips)));
}

// The device takes each limit: what it gives differs from the default's and is what the core gives with that limit.
TEST(EvaluatorOptions, DeviceTakesThemAsTheCoreDoes) {
  const Scene scene = scene_of({beaker2()}, Pose::articulated);
  const FieldSet fields = all_fields(scene);
  const auto grips = grips_of(scene, 0, 200);
  const GatheredPlanes default_way = gather(*backend_of(scene, fields, Precision::single), 0, grips);
  std::vector<EvaluatorOptions> ways(4);
  ways[0].stop_tolerance = 1e-3;
  ways[1].trace_steps = 4;
  ways[2].advance_steps = 5;
  ways[3].gap_table = 9;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    host::GripBackendOptions options;
    options.evaluator = ways[k];
    const GatheredPlanes device = gather(*backend_of(scene, fields, Precision::single, options), 0, grips),
                         core = gather(*make_core_float_evaluator(scene, ways[k]), fields, 0, grips);
    EXPECT_FALSE(same_bits(device, default_way)) << k;
    int differ = 0;
    for (std::size_t i = 0; i < grips.size(); ++i) {
      if (device.uint(FIELD_STATUS, i) != core.uint(FIELD_STATUS, i)) {
        ++differ;
        continue;
      }
      const double closures[] = {device.real(fields.plane[FIELD_CLOSURE], i), core.real(fields.plane[FIELD_CLOSURE], i)};
      // roundings of a gap of 0.1 m, by a slope of 10 closures a meter or so; within a loose tolerance a step may end either side
      if (!std::isnan(closures[0])) differ += std::abs(closures[0] - closures[1]) > 1e-5 ? 1 : 0;
    }
    EXPECT_LE(differ, static_cast<int>(grips.size()) / 50) << k;
  }
}

// ---- orders ----

struct Sweep {
  std::vector<double> steps, errors;
  double order() const { return fitted_order(steps, errors); }
};

// Largest error of the distance at the points, by the lattice's spacing.
Sweep lattice_errors(const VesselData& data, const std::vector<Vec3>& points, const std::vector<int>& resolutions) {
  const core_f64::Vessel outline = ready_vessel(data);
  Sweep sweep;
  for (const int samples : resolutions) {
    const core_f64::Lattice lattice = lattice_of(data, samples);
    double worst = 0;
    for (const Vec3& p : points)
      worst = std::max(worst, std::abs(core_f64::lattice_distance(lattice, p) - core_f64::signed_distance(outline, p)));
    sweep.steps.push_back(lattice.spacing);
    sweep.errors.push_back(worst);
  }
  return sweep;
}

// Trilinear interpolation is off by h^2 / 8 times the second derivatives where there are any.
TEST(Convergence, LatticeIsOfSecondOrderAwayFromCreases) {
  Random random(71);
  std::vector<Vec3> points;
  while (points.size() <
         20000) {  // beside the straight wall, within the finest lattice; further than a cell from base, lid and axis
    points.push_back(around({random.uniform(25e-3, 41e-3), random.uniform(35e-3, 75e-3)}, random.uniform(-PI, PI)));
  }
  const Sweep sweep = lattice_errors(beaker1(), points, {40, 57, 80, 113});
  EXPECT_NEAR(sweep.order(), 2, 0.1) << sweep.errors.front() << " to " << sweep.errors.back() << " m";
  for (std::size_t k = 0; k < sweep.errors.size(); ++k)
    EXPECT_LT(sweep.errors[k], 1.05 * sweep.steps[k] * sweep.steps[k] / 8 / 25e-3);  // curvature 1 / r, at most
}

// Inside a corner the nearest face changes, and the slope with it: a kink that no lattice holds, off by up to a share of h.
TEST(Convergence, LatticeIsOfFirstOrderAtCreases) {
  Random random(72);
  std::vector<Vec3> points;
  while (points.size() < 20000) {
    const double in = random.uniform(5e-3, 20e-3);
    points.push_back(around({40e-3 - in, in}, random.uniform(-PI, PI)));
  }
  const Sweep sweep = lattice_errors(beaker1(), points, {40, 57, 80, 113});
  EXPECT_NEAR(sweep.order(), 1, 0.15) << sweep.errors.front() << " to " << sweep.errors.back() << " m";
  for (std::size_t k = 0; k < sweep.errors.size(); ++k) EXPECT_LT(sweep.errors[k], sweep.steps[k]);
}

// The outline's own distance is a formula: the wider arithmetic finds nothing in it but rounding.
TEST(Convergence, OutlineIsExactToRounding) {
  const Scene scene = scene_of({beaker1(), beaker2(), beaker3(), vase(), shell_of(beaker2())});
  const auto narrow = make_core_float_evaluator(scene), core = make_core_evaluator(scene);
  const auto wide = core_ld::make_evaluator(scene, {});
  Random random(73);
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    for (int n = 0; n < 5000; ++n) {
      const double x = static_cast<float>(random.uniform(-0.2, 0.2)), y = static_cast<float>(random.uniform(-0.1, 0.3)),
                   z = static_cast<float>(random.uniform(-0.2, 0.2));
      const Triple p{x, y, z};
      const double size = 0.4;  // m: coordinates and their differences
      ASSERT_NEAR(core->distance(v, p), wide->distance(v, p), 8 * 0x1p-52 * size) << v;
      ASSERT_NEAR(narrow->distance(v, p), core->distance(v, p), 8 * 0x1p-23 * size) << v;
    }
  }
}

// Largest difference of a field between feasible grips that do not graze.
double worst_difference(const GatheredPlanes& a, const GatheredPlanes& b, int field) {
  double worst = 0;
  for (std::size_t i = 0; i < a.count; ++i) {
    const std::uint32_t status = a.uint(FIELD_STATUS, i) | b.uint(FIELD_STATUS, i);
    if ((status & (STATUS_REASON_MASK | STATUS_GRAZING)) != 0) continue;
    worst = std::max(worst, std::abs(a.real(a.fields.plane[field], i) - b.real(b.fields.plane[field], i)));
  }
  return worst;
}

// A trace ends where the separation is below the tolerance, so the gap is off by as much over the cosine of the angle of incidence.
TEST(Convergence, GapIsProportionalToTheStopTolerance) {
  const Scene scene = scene_of({beaker2()}, Pose::rigged);
  const FieldSet fields = all_fields(scene);
  const auto grips = sample_grips(scene.vessels[0], 4000, 74);
  EvaluatorOptions tight;
  tight.stop_tolerance = 1e-13;
  const GatheredPlanes truth = gather(*make_core_evaluator(scene, tight), fields, 0, grips);
  Sweep sweep;
  for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
    EvaluatorOptions options;
    options.stop_tolerance = tolerance;
    sweep.steps.push_back(tolerance);
    sweep.errors.push_back(worst_difference(gather(*make_core_evaluator(scene, options), fields, 0, grips), truth, FIELD_GAP));
    EXPECT_LT(sweep.errors.back(), 2 * tolerance / GRAZING_COSINE);
  }
  EXPECT_NEAR(sweep.order(), 1, 0.1) << sweep.errors.front() << " to " << sweep.errors.back() << " m";
}

// Linear interpolation of a smooth inverse.
TEST(Convergence, GapTableIsOfSecondOrder) {
  const Scene scene = scene_of({beaker2()}, Pose::rigged);
  const FieldSet fields = all_fields(scene);
  const auto grips = sample_grips(scene.vessels[0], 4000, 75);
  const GatheredPlanes truth = gather(*make_core_evaluator(scene), fields, 0, grips);
  Sweep sweep;
  for (const int entries : {33, 65, 129, 257, 513, 1025}) {
    EvaluatorOptions options;
    options.gap_table = entries;
    sweep.steps.push_back(1.0 / (entries - 1));
    sweep.errors.push_back(worst_difference(gather(*make_core_evaluator(scene, options), fields, 0, grips), truth, FIELD_CLOSURE));
  }
  EXPECT_NEAR(sweep.order(), 2, 0.1) << sweep.errors.front() << " to " << sweep.errors.back();
}

// On each piece the cosine map leaves a smooth integrand: the error falls faster than any fixed power until rounding ends it. Of
// what that promises the eighth power is asked for, between 4 points and 16.
TEST(Convergence, LiquidFallsFasterThanTheEighthPowerOfItsPoints) {
  for (const VesselData& data : {beaker1(), beaker2(), beaker3()}) {
    const Scene scene = wet_scene({data}, Pose::rigged);
    const auto truth = core_ld::make_evaluator(scene, {.quadrature_points = 64});
    Sweep sweep;
    for (const int points : {4, 8, 16, 32, 64}) {
      const auto core = make_core_evaluator(scene, {.quadrature_points = points});
      double worst = std::abs(core->capacity(0) - truth->capacity(0));
      for (int degree = 5; degree < 180; degree += 5)  // what the lip holds back: a volume under a given plane
        worst = std::max(worst, std::abs(core->liquid(0, 1, radians(degree)).volume - truth->liquid(0, 1, radians(degree)).volume));
      sweep.steps.push_back(1.0 / points);
      sweep.errors.push_back(worst / truth->capacity(0));
    }
    const auto& e = sweep.errors;
    EXPECT_LT(e[4], 1e-10) << data.name;
    EXPECT_GT(std::log2(e[0] / std::max(e[2], 1e-11)) / 2, 8)
        << data.name << ": " << e[0] << " " << e[1] << " " << e[2] << " " << e[3];
  }
}

TEST(Convergence, FittedOrderIsTheSlope) {
  EXPECT_NEAR(fitted_order({1, 0.5, 0.25, 0.125}, {3, 0.75, 0.1875, 0.046875}), 2, 1e-12);
  EXPECT_TRUE(std::isnan(fitted_order({1, 0.5}, {0, 0.1})));  // one point has no slope
  EXPECT_NEAR(fitted_order({1, 0.5, 0.25}, {4, 0, 1}), 1, 1e-12);
}

}  // namespace
}  // namespace wholehand
