// SPDX-License-Identifier: MIT
// sanitizers: address
// (Embree starts workers that the thread sanitizer cannot see into, and then reports what they were given.)
// Lattices of distances to meshes: what lies in them, how far they err, and when they are refused.
#include "core/meshes/lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "base/text/error.h"
#include "core/load.h"
#include "core/meshes/distance.h"
#include "core/sdf.h"
#include "core/vectors.h"
#include "tests/support/meshes.h"
#include "tests/support/sanitized.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

constexpr double PLACE_ROUNDING = 1e-15;  // m: double precision of some 10 cm

TEST(MeshLattice, SamplesAreDistancesWhereTheyShouldBe) {
  const CheckedMesh mesh = check_mesh(placed_mesh(torus(0.05, 0.02, 60, 30), {0.3, 0, 0}, {0.01, 0.02, 0.03}), "torus");
  const MeshDistance distance(mesh);
  for (const bool halves : {false, true}) {
    LatticeSpec spec;
    spec.spacing = 5e-3;
    spec.margin = 8e-3;
    spec.bits = halves ? 16 : 32;
    const PreparedLattice lattice = lattice_of_mesh(distance, mesh, spec).lattice;
    EXPECT_EQ(lattice.spacing, 5e-3);
    EXPECT_EQ(lattice.halves, halves);
    const core_f64::Lattice loaded = core_f64::load_lattice(lattice);
    const std::array<int, 3> counts{lattice.nx, lattice.ny, lattice.nz};
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(lattice.origin[k], mesh.facts.low[k] - 8e-3 - 2 * 5e-3, PLACE_ROUNDING);
      EXPECT_GE(lattice.origin[k] + (counts[k] - 1) * 5e-3, mesh.facts.high[k] + 8e-3 + 2 * 5e-3 - PLACE_ROUNDING);
    }
    for (int k = 0; k < lattice.nz; ++k)
      for (int j = 0; j < lattice.ny; ++j)
        for (int i = 0; i < lattice.nx; ++i) {
          const Triple p{lattice.origin[0] + 5e-3 * i, lattice.origin[1] + 5e-3 * j, lattice.origin[2] + 5e-3 * k};
          // single precision of 0.1 m, or 11 bits of it
          ASSERT_NEAR(core_f64::lattice_sample(loaded, i, j, k), distance.signed_distance(p), halves ? 4e-5 : 1e-8);
        }
  }
}

TEST(MeshLattice, AnOpenMeshKeepsItsSides) {
  const CheckedMesh mesh = check_mesh(open_hemisphere(0.05, 4), "bowl");
  const MeshDistance distance(mesh);
  LatticeSpec spec;
  spec.spacing = 6e-3;
  const core_f64::Lattice lattice = core_f64::load_lattice(lattice_of_mesh(distance, mesh, spec).lattice);
  EXPECT_NEAR(core_f64::lattice_distance(lattice, {0, 0.03, 0}), -0.02, 1e-3);
  EXPECT_NEAR(core_f64::lattice_distance(lattice, {0, 0.055, 0}), 0.005, 1e-3);
}

// The side of most samples is that of the one before; here each is asked for.
TEST(MeshLattice, SamplesOfOpenMeshesAreThoseTakenOneByOne) {
  TriangleMesh sieve = icosphere(0.04, 4);
  for (std::size_t i = 0; i < sieve.triangles.size(); i += 100)
    sieve.triangles.erase(sieve.triangles.begin() + static_cast<std::ptrdiff_t>(i));
  for (const TriangleMesh& open : {open_hemisphere(0.05, 4), wavy_bowl(0.05, 3, 0.02), sieve}) {
    const CheckedMesh mesh = check_mesh(open, "bowl");
    const MeshDistance distance(mesh);
    ASSERT_EQ(distance.sign(), MeshSign::winding);
    LatticeSpec spec;
    spec.spacing = 3e-3;
    spec.margin = 20e-3;
    const PreparedLattice lattice = lattice_of_mesh(distance, mesh, spec).lattice;
    const core_f64::Lattice loaded = core_f64::load_lattice(lattice);
    int differences = 0;
    for (int k = 0; k < lattice.nz; ++k)
      for (int j = 0; j < lattice.ny; ++j)
        for (int i = 0; i < lattice.nx; ++i) {
          const Triple p{lattice.origin[0] + 3e-3 * i, lattice.origin[1] + 3e-3 * j, lattice.origin[2] + 3e-3 * k};
          differences += core_f64::lattice_sample(loaded, i, j, k) != static_cast<float>(distance.signed_distance(p));
        }
    EXPECT_EQ(differences, 0);
  }
}

// Largest difference between the lattice and a closed form in a band of 5 mm on both sides of the surface.
double band_error(const TriangleMesh& triangles, double spacing, const std::function<double(const Triple&)>& exact) {
  const CheckedMesh mesh = check_mesh(triangles, "body");
  const MeshDistance distance(mesh);
  LatticeSpec spec;
  spec.spacing = spacing;
  spec.margin = 5e-3;
  const core_f64::Lattice lattice = core_f64::load_lattice(lattice_of_mesh(distance, mesh, spec).lattice);
  Random random(10);
  double largest = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double x = random.uniform(-0.08, 0.08), y = random.uniform(-0.08, 0.08);
    const Triple p{x, y, random.uniform(-0.08, 0.08)};
    if (std::abs(exact(p)) > 5e-3) continue;
    largest = std::max(largest, std::abs(core_f64::lattice_distance(lattice, {p[0], p[1], p[2]}) - exact(p)));
  }
  return largest;
}

// Trilinear interpolation errs by h^2 / 8 times the sum of the second derivatives along the axes, which for a distance is at most
// the sum of the curvatures' sizes of its level surface, here at the depth to which the cells' corners reach: 10 mm. Chords cut off
// a sagitta.
TEST(MeshLattice, ASphereAndATorusAtSecondOrder) {
  struct Body {
    TriangleMesh mesh;
    std::function<double(const Triple&)> exact;
    double curvature, sagitta;
  };
  const std::vector<Body> bodies{
      {icosphere(0.05, 6), [](const Triple& p) { return norm(p) - 0.05; }, 2 / 0.04, 0.05 * std::pow(1.4 / 64, 2) / 6},
      {torus(0.05, 0.02, 400, 200), [](const Triple& p) { return std::hypot(std::hypot(p[0], p[2]) - 0.05, p[1]) - 0.02; },
       1 / 0.01 + 1 / 0.02, 2 * (0.07 * std::pow(PI / 400, 2) / 2 + 0.02 * std::pow(PI / 200, 2) / 2)},
  };
  for (const Body& body : bodies) {
    const double coarse = band_error(body.mesh, 5e-3, body.exact);
    EXPECT_LT(coarse, 25e-6 / 8 * body.curvature + body.sagitta);
    if (IS_SANITIZED) continue;
    const double fine = band_error(body.mesh, 2.5e-3, body.exact);
    EXPECT_GT((coarse + body.sagitta) / (fine - body.sagitta), 3.5);
    EXPECT_LT((coarse - body.sagitta) / (fine + body.sagitta), 4.5);
  }
}

TEST(MeshLattice, FloatsUpToHalfOfTheMemoryThenHalvesThenNothing) {
  const CheckedMesh mesh = check_mesh(torus(0.05, 0.02, 40, 20), "torus");
  const MeshDistance distance(mesh);
  LatticeSpec spec;
  spec.spacing = 10e-3;
  for (const double margin : {0.0, 7e-3}) {  // an even and an odd number of samples
    spec.bits.reset();
    spec.most_bytes = 1u << 20;
    spec.margin = margin;
    const PreparedLattice roomy = lattice_of_mesh(distance, mesh, spec).lattice;
    const std::size_t samples = static_cast<std::size_t>(roomy.nx) * roomy.ny * roomy.nz, half_words = (samples + 1) / 2;
    EXPECT_EQ(samples % 2, margin > 0 ? 1u : 0u);
    EXPECT_FALSE(roomy.halves);
    const auto made = [&](std::size_t most_bytes) {
      spec.most_bytes = most_bytes;
      return lattice_of_mesh(distance, mesh, spec).lattice;
    };
    EXPECT_FALSE(made(8 * samples).halves);
    EXPECT_TRUE(made(8 * samples - 1).halves);
    EXPECT_EQ(made(8 * samples - 1).words->size(), half_words);
    EXPECT_TRUE(made(4 * half_words).halves);
    EXPECT_THROW(made(4 * half_words - 1), Error);
    spec.bits = 32;
    EXPECT_FALSE(made(4 * samples).halves);
    EXPECT_THROW(made(4 * samples - 1), Error);
    spec.bits = 16;
    EXPECT_TRUE(made(1u << 20).halves);
    EXPECT_TRUE(made(4 * half_words).halves);
    EXPECT_THROW(made(4 * half_words - 1), Error);
  }
}

// A half keeps 11 bits: of a sample at a corner of a cell that the surface passes, at most a cell's diagonal.
TEST(MeshLattice, HalvesCostTheirRoundingAndSaySo) {
  const CheckedMesh mesh = check_mesh(turned_mesh(beaker2(), 60, 3e-3), "flask");
  const MeshDistance distance(mesh);
  for (const double spacing : {3.5e-3, 5e-3}) {
    LatticeSpec spec;
    spec.spacing = spacing;
    spec.bits = 32;
    const double floats = lattice_of_mesh(distance, mesh, spec).error;
    spec.bits = 16;
    const double halves = lattice_of_mesh(distance, mesh, spec).error;
    EXPECT_NE(halves, floats);
    EXPECT_NEAR(halves, floats, std::sqrt(3.0) * spacing / 2048);
  }
}

TEST(MeshLattice, AChosenSpacingGoesOverToHalves) {
  const CheckedMesh mesh = check_mesh(turned_mesh(beaker1(), 60, 5e-3), "beaker");
  const MeshDistance distance(mesh);
  LatticeSpec spec;
  spec.tolerance = 2e-3;
  const MeshLattice floats = lattice_of_mesh(distance, mesh, spec);
  EXPECT_FALSE(floats.lattice.halves);
  spec.most_bytes = 8 * floats.lattice.words->size() - 4;
  const MeshLattice halves = lattice_of_mesh(distance, mesh, spec);
  EXPECT_TRUE(halves.lattice.halves);
  EXPECT_EQ(halves.lattice.spacing, floats.lattice.spacing);
  EXPECT_LE(halves.error, 2e-3);
}

TEST(MeshLattice, TheSpacingIsChosenByTheErrorAtTheSurface) {
  const CheckedMesh mesh = check_mesh(turned_mesh(beaker3(), 120, 2e-3), "flask");
  const MeshDistance distance(mesh);
  LatticeSpec spec;
  spec.tolerance = 1e-3;
  const MeshLattice chosen = lattice_of_mesh(distance, mesh, spec);
  EXPECT_LE(chosen.error, 1e-3);
  EXPECT_GT(chosen.error, 0.3e-3);  // not much finer than was asked for
  spec.spacing = 2 * chosen.lattice.spacing;
  EXPECT_GT(lattice_of_mesh(distance, mesh, spec).error, 1e-3);
}

TEST(MeshLattice, StaysWithinItsMemory) {
  const CheckedMesh mesh = check_mesh(turned_mesh(beaker1(), 60, 5e-3), "beaker");
  const MeshDistance distance(mesh);
  LatticeSpec spec;
  spec.tolerance = 1e-9;
  for (const std::size_t most : {2000u, 20'000u, 200'000u}) {
    spec.most_bytes = most;
    const MeshLattice finest = lattice_of_mesh(distance, mesh, spec);
    EXPECT_TRUE(finest.lattice.halves);
    EXPECT_LE(4 * finest.lattice.words->size(), most);
    EXPECT_GT(4 * finest.lattice.words->size(), most / 1.25) << most;  // the counts are whole numbers
    EXPECT_GT(finest.error, 1e-9);
  }
  spec.most_bytes = 100;
  EXPECT_THROW(lattice_of_mesh(distance, mesh, spec), Error);
}

TEST(MeshLattice, ARefusedSpacingNamesTheFinestThatFits) {
  const CheckedMesh mesh = check_mesh(torus(0.05, 0.02, 40, 20), "torus");
  const MeshDistance distance(mesh);
  LatticeSpec spec;
  spec.most_bytes = 1u << 20;
  spec.spacing = 1e-12;
  EXPECT_THROW(lattice_of_mesh(distance, mesh, spec), Error);
  spec.spacing = 0.5e-3;
  try {
    lattice_of_mesh(distance, mesh, spec);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    const std::string line = error.what(), words = "the finest that fits has ";
    EXPECT_NE(line.find("a lattice of 0.5 mm has 6,904,125 samples of 2 bytes, and 1 MB are free for them"), std::string::npos)
        << line;
    ASSERT_NE(line.find(words), std::string::npos) << line;
    spec.spacing = 1e-3 * std::stod(line.substr(line.find(words) + words.size()));
  }
  EXPECT_NO_THROW(lattice_of_mesh(distance, mesh, spec));
  *spec.spacing *= 0.99;
  EXPECT_THROW(lattice_of_mesh(distance, mesh, spec), Error);
}

// 65504 / 1024 m is the largest half.
TEST(MeshLattice, DistancesBeyondHalvesAreKeptOrCut) {
  const CheckedMesh mesh = check_mesh(box_mesh({0, 0, 0}, {200, 200, 200}), "box");
  const MeshDistance distance(mesh);
  LatticeSpec spec;
  spec.spacing = 20;
  spec.most_bytes = 16'000;
  const auto middle = [&] {
    return core_f64::lattice_distance(core_f64::load_lattice(lattice_of_mesh(distance, mesh, spec).lattice), {100, 100, 100});
  };
  EXPECT_EQ(middle(), -100);
  spec.bits = 16;
  EXPECT_EQ(middle(), -65504.0 / 1024);
}

TEST(MeshLattice, IsTheSameOnAnyNumberOfThreads) {
  const CheckedMesh mesh = check_mesh(torus(0.05, 0.02, 40, 20), "torus");
  const MeshDistance distance(mesh);
  LatticeSpec spec;
  spec.spacing = 7.3e-3;
  spec.bits = 16;
  spec.threads = 1;
  const MeshLattice one = lattice_of_mesh(distance, mesh, spec);
  spec.threads = 5;
  const MeshLattice five = lattice_of_mesh(distance, mesh, spec);
  EXPECT_EQ(*one.lattice.words, *five.lattice.words);
  EXPECT_EQ(one.error, five.error);
}

TEST(MeshLattice, TellsHowFarItIs) {
  const CheckedMesh mesh = check_mesh(torus(0.05, 0.02, 40, 20), "torus");
  const MeshDistance distance(mesh);
  LatticeSpec spec;
  spec.tolerance = 1e-3;  // many rows
  const auto here = std::this_thread::get_id();
  for (const int threads : {1, 3}) {
    spec.threads = threads;
    std::vector<double> shares;
    lattice_of_mesh(distance, mesh, spec, [&](double share) {
      EXPECT_EQ(std::this_thread::get_id(), here);
      shares.push_back(share);
    });
    ASSERT_GT(shares.size(), threads == 1 ? 3u : 1u);  // on a busy machine the other threads may take every row
    EXPECT_EQ(shares.front(), 0);
    EXPECT_EQ(shares.back(), 1);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  }
  const auto give_up = [](double share) {
    if (share > 0) throw failure_error("enough");
  };
  EXPECT_THROW(lattice_of_mesh(distance, mesh, spec, give_up), Error);
}

TEST(MeshLattice, SurfacesWithinAnotherBodyAreNoError) {
  const CheckedMesh mesh = check_mesh(joined(icosphere(0.05, 5), icosphere(0.02, 4)), "ball in a ball");
  LatticeSpec spec;
  spec.spacing = 2e-3;
  // a cell across the outer sphere is off by spacing^2 / (8 x 50 mm) = 10 um, an edge of chords as much again; on the inner one,
  // where the sign does not change, by up to half a cell
  EXPECT_LT(lattice_of_mesh(MeshDistance(mesh), mesh, spec).error, 5e-5);
}

TEST(MeshLattice, OverlappingBodiesEncloseTheirUnion) {
  const auto enclosed = [](const TriangleMesh& triangles, double spacing) {
    const CheckedMesh mesh = check_mesh(triangles, "bodies");
    LatticeSpec spec;
    spec.spacing = spacing;
    return enclosed_volume(lattice_of_mesh(MeshDistance(mesh), mesh, spec).lattice, mesh.facts.area);
  };
  // 360 and 120 cm3 that share 80; a cell at each of the 1.5 m of edges is off by a part of its section: 1.5 m x 0.3 mm2 = 0.1 %
  const EnclosedVolume boxes =
      enclosed(joined(box_mesh({0, 0, 0}, {0.06, 0.1, 0.06}), box_mesh({0.01, 0.06, 0.005}, {0.05, 0.12, 0.055})), 1e-3);
  EXPECT_NEAR(boxes.volume, 400e-6, 1e-6);
  EXPECT_NEAR(boxes.center[0], 0.03, 1e-4);
  EXPECT_NEAR(boxes.center[1], (360 * 0.05 + 40 * 0.11) / 400, 1e-4);
  // one ball: the chords' error is the mesh's own; what is left falls with the square of the spacing
  const CheckedMesh ball = check_mesh(icosphere(0.03, 4), "ball");
  EXPECT_NEAR(enclosed(icosphere(0.03, 4), 1e-3).volume, ball.facts.volume, 1e-3 * ball.facts.volume);
}

TEST(MeshLattice, TheForecastIsTheRateTimesTheWork) {
  EXPECT_EQ(forecast_seconds(10, 1000, 0.5), 50);
  EXPECT_EQ(forecast_seconds(1000, 1000, 7), 7);
  EXPECT_EQ(forecast_seconds(0, 1000, 0), 0);
  EXPECT_EQ(forecast_seconds(3, 3'000'000'000, 2), 2e9);
}

// By a clock that says how long the rows took: whatever the machine does meanwhile.
TEST(MeshLattice, RowsAreTimedBeforeTheSamplesAreTaken) {
  const CheckedMesh mesh = check_mesh(icosphere(0.05, 2), "ball");
  LatticeSpec spec;
  spec.spacing = 5e-3;
  spec.threads = 2;
  const MeshLattice plain = lattice_of_mesh(MeshDistance(mesh), mesh, spec);
  for (const double step : {4.0, 0.0}) {
    double now = 100, announced = -1;
    bool has_begun = false;
    LatticeForecast forecast;
    forecast.clock = [&] { return now += step; };
    forecast.say = [&](const LatticePlan& plan) {
      EXPECT_FALSE(has_begun);
      EXPECT_EQ(announced, -1) << "once";
      EXPECT_EQ(plan.lattice.ny, plain.lattice.ny);
      EXPECT_FALSE(plan.finer);
      announced = plan.seconds;
    };
    forecast.most_seconds = 1;  // which has no say where the spacing is given
    const MeshLattice made = lattice_of_mesh(
        MeshDistance(mesh), mesh, spec, [&](double share) { has_begun = share > 0; }, forecast);
    // two rows, one a thread, took 4 s by that clock
    EXPECT_EQ(announced, step / 2 * plain.lattice.ny * plain.lattice.nz);
    EXPECT_EQ(*made.lattice.words, *plain.lattice.words) << "timing changes no sample";
  }
}

double samples_in(const PreparedLattice& lattice) { return 1.0 * lattice.nx * lattice.ny * lattice.nz; }

// By the same clock.
TEST(MeshLattice, OneThatTakesTooLongGivesWay) {
  const CheckedMesh mesh = check_mesh(icosphere(0.05, 3), "ball");
  const MeshDistance distance(mesh);
  LatticeSpec spec;
  spec.tolerance = 0.1e-3;
  spec.threads = 2;
  const MeshLattice aimed_at = lattice_of_mesh(distance, mesh, spec);
  // two rows take 4 s
  const double whole = 2.0 * aimed_at.lattice.ny * aimed_at.lattice.nz;
  LatticePlan plan;
  const auto within = [&](double most_seconds) {
    LatticeForecast forecast;
    forecast.clock = [now = 0.0]() mutable { return now += 4; };
    forecast.say = [&](const LatticePlan& made) { plan = made; };
    forecast.most_seconds = most_seconds;
    return lattice_of_mesh(distance, mesh, spec, {}, forecast);
  };
  const MeshLattice same = within(whole);
  EXPECT_EQ(*same.lattice.words, *aimed_at.lattice.words);
  EXPECT_FALSE(plan.finer || same.at_limit);
  const MeshLattice quick = within(whole / 2);
  ASSERT_TRUE(plan.finer && quick.at_limit);
  EXPECT_EQ(plan.finer->spacing, aimed_at.lattice.spacing);
  EXPECT_EQ(plan.finer_seconds, whole);
  EXPECT_EQ(plan.lattice.spacing, quick.lattice.spacing);
  EXPECT_DOUBLE_EQ(plan.seconds, whole * samples_in(quick.lattice) / samples_in(aimed_at.lattice));
  EXPECT_LE(plan.seconds, whole / 2);
  // spacings are sought to 1e-4
  EXPECT_GT(samples_in(*lattice_at(mesh.facts, spec, quick.lattice.spacing * (1 - 1.01e-4))), samples_in(aimed_at.lattice) / 2);
  EXPECT_GT(quick.error, aimed_at.error);
  const MeshLattice coarsest = within(1e-3);
  EXPECT_DOUBLE_EQ(coarsest.lattice.spacing, 0.1 / 24) << "at least as many cells as the search starts with";
  spec.spacing = quick.lattice.spacing;
  const MeshLattice again = within(1e-3);
  EXPECT_EQ(*again.lattice.words, *quick.lattice.words) << "asked for by its spacing";
  EXPECT_FALSE(plan.finer);
}

}  // namespace
}  // namespace wholehand
