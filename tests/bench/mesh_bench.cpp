// SPDX-License-Identifier: MIT
// Distances to a mesh of 100,000 triangles: how long its lattice takes, and how the rate and the answers of single distances
// compare with CGAL's (Debian's libcgal-dev, 215 MB with the Boost headers it needs, and therefore in no list of packages:
// installed by hand before configuring, or this comparison is left out).
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "core/meshes/distance.h"
#include "core/meshes/lattice.h"
#include "tests/bench/bench.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"
#ifdef WHOLEHAND_CGAL
#include "tests/bench/cgal_distance.h"
#endif

namespace wholehand::bench {
namespace {

constexpr int LATTICE_SAMPLES = 128 * 128 * 128;
constexpr int QUERIES = 20000;
constexpr double NEAR = 2e-3;  // m from the surface

// The round-bottom flask: small triangles on its sphere, long ones on its neck.
const CheckedMesh& flask() {
  static const CheckedMesh mesh = check_mesh(turned_mesh(beaker2(), 216, 0.5e-3), "the benchmark's flask");
  return mesh;
}

// The widest spacing with at least `samples` samples.
MeshLattice lattice_of(const MeshDistance& distance, int samples) {
  const double margin = lattice_margin(three_beakers());
  LatticeSpec spec;
  spec.margin = margin;
  const MeshFacts& facts = flask().facts;
  const auto count = [&](double spacing) {
    double all = 1;
    for (int k = 0; k < 3; ++k) all *= std::ceil((facts.high[k] - facts.low[k] + 2 * margin) / spacing) + 5;
    return all;
  };
  double low = 1e-4, high = 1e-2;
  while (high - low > 1e-9) (count((low + high) / 2) >= samples ? low : high) = (low + high) / 2;
  spec.spacing = low;
  return lattice_of_mesh(distance, flask(), spec);
}

// As many samples as 128 in each direction have, on all threads, Embree's tree included; a sweep pays this once a mesh.
void mesh_lattice(benchmark::State& state) {
  flask();
  MeshLattice made;
  for (auto _ : state) {
    const MeshDistance distance(flask());
    made = lattice_of(distance, LATTICE_SAMPLES);
    benchmark::DoNotOptimize(made.lattice.words);
  }
  const double samples = static_cast<double>(made.lattice.nx) * made.lattice.ny * made.lattice.nz;
  state.SetItemsProcessed(static_cast<std::int64_t>(samples) * state.iterations());
  state.counters["triangles"] = static_cast<double>(flask().facts.triangles);
  state.counters["spacing_mm"] = 1e3 * made.lattice.spacing;
  state.counters["error_mm"] = 1e3 * made.error;
}

// Uniform in the bounding box and half its size around, or in a shell about the surface.
std::vector<Triple> query_points(const MeshDistance& distance, bool near) {
  const MeshFacts& facts = flask().facts;
  Random random(near ? 1 : 2);
  std::vector<Triple> points;
  while (points.size() < QUERIES) {
    Triple p{};
    for (int k = 0; k < 3; ++k) {
      const double room = near ? NEAR : 0.5 * (facts.high[k] - facts.low[k]);
      p[k] = random.uniform(facts.low[k] - room, facts.high[k] + room);
    }
    std::uint32_t nearest = 0;
    if ((distance.distance(p, nearest) < NEAR) == near) points.push_back(p);
  }
  return points;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Signed distances on one thread. With CGAL in turns with its own, and what the answers differ by.
void mesh_queries(benchmark::State& state, bool near) {
  const MeshDistance distance(flask());
  const std::vector<Triple> points = query_points(distance, near);
  std::vector<double> ours(points.size()), theirs(points.size());
#ifdef WHOLEHAND_CGAL
  const CgalDistance cgal(flask().mesh);
#endif
  double our_seconds = 0;
  [[maybe_unused]] double their_seconds = 0;  // with CGAL
  for (auto _ : state) {
    auto start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < points.size(); ++i) ours[i] = distance.signed_distance(points[i]);
    const double seconds = seconds_since(start);
    our_seconds += seconds;
    state.SetIterationTime(seconds);
#ifdef WHOLEHAND_CGAL
    start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double away = cgal.distance(points[i]);
      theirs[i] = cgal.is_inside(points[i]) ? -away : away;
    }
    their_seconds += seconds_since(start);
#endif
  }
  const double queries = static_cast<double>(state.iterations()) * QUERIES;
  state.SetItemsProcessed(static_cast<std::int64_t>(queries));
#ifdef WHOLEHAND_CGAL
  double largest = 0, sum = 0;
  int signs = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double difference = std::abs(std::abs(ours[i]) - std::abs(theirs[i]));
    largest = std::max(largest, difference);
    sum += difference;
    signs += std::signbit(ours[i]) != std::signbit(theirs[i]) ? 1 : 0;
  }
  state.counters["cgal_per_s"] = queries / their_seconds;
  state.counters["ratio"] = their_seconds / our_seconds;
  state.SetLabel("over CGAL");
  state.counters["largest_m"] = largest;
  state.counters["mean_m"] = sum / QUERIES;
  state.counters["signs"] = signs;
#endif
}

}  // namespace

void add_mesh_benchmarks() {
  benchmark::RegisterBenchmark("mesh_lattice", mesh_lattice)->UseRealTime()->Unit(benchmark::kSecond);
  for (const bool near : {true, false})
    benchmark::RegisterBenchmark(near ? "mesh_near" : "mesh_far", [near](benchmark::State& state) { mesh_queries(state, near); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
}

}  // namespace wholehand::bench
