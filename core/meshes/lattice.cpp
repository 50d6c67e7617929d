// SPDX-License-Identifier: MIT
#include "core/meshes/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <random>

#include "base/numbers/half.h"
#include "base/numbers/parallel.h"
#include "base/numbers/random_bits.h"
#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/lattice.h"
#include "core/load.h"
#include "core/meshes/distance.h"
#include "core/meshes/sampling.h"
#include "core/sdf.h"
#include "core/vectors.h"
#include "shaders/layout.h"

namespace wholehand {
namespace {

constexpr double BESIDE = 1e-6;               // of a triangle's size: how far off a side of it is probed
constexpr double COARSEST_CELLS = 24;         // along the longest side: where the search for a spacing starts
constexpr double SPACING_STEP = 1.25;         // from one try to the next
constexpr double FEWEST_SAMPLES = 6 * 6 * 6;  // with which lay_lattice lays any
constexpr double SAME_SPACING = 1e-4;         // relative: finer is not sought
constexpr double FAR_FOR_HALVES = 32;         // m: half of what they hold, as a lattice reaches beyond its mesh

// Random points of the surface with uniform density; the same ones each time. Where bodies overlap, interior points are left out: nobody touches
// them, and the distance is not 0 there.
std::vector<Triple> surface_points(const MeshDistance& distance, const TriangleMesh& mesh, int count) {
  const auto corner = [&](std::size_t triangle, int k) { return to_vec3(mesh.vertices[mesh.triangles[triangle][k]]); };
  std::vector<double> area_up_to;
  double area = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    area += glm::length(glm::cross(corner(i, 1) - corner(i, 0), corner(i, 2) - corner(i, 0)));
    area_up_to.push_back(area);
  }
  std::mt19937_64 random(5);
  const auto uniform = [&] { return unit_interval(random()); };
  std::vector<Triple> points;
  for (int n = 0; n < count; ++n) {
    const auto found = std::upper_bound(area_up_to.begin(), area_up_to.end() - 1, uniform() * area);
    const auto i = static_cast<std::size_t>(found - area_up_to.begin());
    const double root = std::sqrt(uniform()), share = uniform();
    const glm::dvec3 p = (1 - root) * corner(i, 0) + root * (1 - share) * corner(i, 1) + root * share * corner(i, 2);
    const glm::dvec3 normal = glm::cross(corner(i, 1) - corner(i, 0), corner(i, 2) - corner(i, 0));
    const double edge = std::sqrt(glm::length(normal));
    const glm::dvec3 aside = edge > 0 ? BESIDE * edge * glm::normalize(normal) : glm::dvec3(0);
    const glm::dvec3 front = p + aside, back = p - aside;
    const bool is_buried = distance.is_inside(to_triple(front)) && distance.is_inside(to_triple(back));
    if (!is_buried) points.push_back(to_triple(p));
  }
  return points;
}

double samples_of(const PreparedLattice& lattice) { return static_cast<double>(lattice.nx) * lattice.ny * lattice.nz; }

bool stores_halves(const PreparedLattice& lattice, const MeshFacts& facts, const LatticeSpec& spec) {
  if (spec.bits) return *spec.bits == 16;
  double squared = 0;
  for (int k = 0; k < 3; ++k) squared += std::pow(facts.high[k] - facts.low[k] + 2 * spec.margin, 2);
  return 4 * samples_of(lattice) > static_cast<double>(spec.most_bytes) / 2 && std::sqrt(squared) < FAR_FOR_HALVES;
}

// A sample as the kernels will read it.
double stored_value(double value, bool halves) {
  const auto single = static_cast<float>(value);
  return halves ? half_value(half_of(single)) * HALF_UNIT : single;
}

// Where the samples of a lattice lie, and in how many bits; none are taken yet.
PreparedLattice lay_lattice(const MeshFacts& facts, const LatticeSpec& spec, double spacing) {
  PreparedLattice lattice;
  lattice.spacing = spacing;
  std::array<int, 3> counts{};
  for (int k = 0; k < 3; ++k) {
    const double length = facts.high[k] - facts.low[k] + 2 * spec.margin;
    counts[k] = static_cast<int>(std::min(std::ceil(length / spacing) + 5, 1e9));
    lattice.origin[k] = facts.low[k] - spec.margin - 2 * spacing;
  }
  lattice.nx = counts[0];
  lattice.ny = counts[1];
  lattice.nz = counts[2];
  lattice.halves = stores_halves(lattice, facts, spec);
  return lattice;
}

bool lattice_fits(const PreparedLattice& lattice, const LatticeSpec& spec) {
  const double words = lattice.halves ? std::ceil(samples_of(lattice) / 2) : samples_of(lattice);
  return samples_of(lattice) <= spec.most_samples && 4 * words <= static_cast<double>(spec.most_bytes);
}

// The finest lattice that fits, between one that does and a smaller spacing that does not.
PreparedLattice finest_lattice(const MeshFacts& facts, const LatticeSpec& spec, PreparedLattice fits, double too_fine) {
  while (fits.spacing - too_fine > SAME_SPACING * fits.spacing) {
    const PreparedLattice between = lay_lattice(facts, spec, 0.5 * (fits.spacing + too_fine));
    if (lattice_fits(between, spec)) {
      fits = between;
    } else {
      too_fine = between.spacing;
    }
  }
  return fits;
}

// The trilinear value at p of samples that are taken now.
double value_without_samples(const MeshDistance& distance, const PreparedLattice& lattice, const Triple& p) {
  std::array<int, 3> cell{};
  Triple at{};
  for (int k = 0; k < 3; ++k) {
    const double steps = (p[k] - lattice.origin[k]) / lattice.spacing;
    cell[k] = static_cast<int>(std::floor(steps));
    at[k] = steps - cell[k];
  }
  double value = 0;
  for (int n = 0; n < 8; ++n) {
    const int x = n & 1, y = n >> 1 & 1, z = n >> 2;
    const double weight = (x != 0 ? at[0] : 1 - at[0]) * (y != 0 ? at[1] : 1 - at[1]) * (z != 0 ? at[2] : 1 - at[2]);
    const double sample = distance.signed_distance(lattice_place(lattice, cell[0] + x, cell[1] + y, cell[2] + z));
    value += weight * stored_value(sample, lattice.halves);
  }
  return value;
}

// Whether the error is larger than `tolerance` at any of the points; skips the others then.
bool any_error_above(const std::vector<Triple>& points, int threads, double tolerance,
                     const std::function<double(const Triple&)>& value_at) {
  std::atomic<bool> found{false};
  constexpr std::size_t CHUNK = 16;
  const std::size_t count = points.size();
  in_parallel((count + CHUNK - 1) / CHUNK, threads, [&](std::size_t chunk) {
    for (std::size_t i = chunk * CHUNK; i < std::min(count, (chunk + 1) * CHUNK) && !found; ++i)
      if (std::abs(value_at(points[i])) > tolerance) found = true;
  });
  return found;
}

double largest_error(const std::vector<Triple>& points, int threads, const std::function<double(const Triple&)>& value_at) {
  std::vector<double> errors(points.size());
  constexpr std::size_t CHUNK = 64;
  const std::size_t count = points.size();
  in_parallel((count + CHUNK - 1) / CHUNK, threads, [&](std::size_t chunk) {
    for (std::size_t i = chunk * CHUNK; i < std::min(count, (chunk + 1) * CHUNK); ++i) errors[i] = std::abs(value_at(points[i]));
  });
  return count > 0 ? *std::max_element(errors.begin(), errors.end()) : 0;
}

// Where the search for a spacing starts: coarser than it would be where only that fits.
PreparedLattice coarsest_lattice(const MeshFacts& facts, const LatticeSpec& spec, bool& at_limit) {
  double spacing = 0;
  for (int k = 0; k < 3; ++k) spacing = std::max(spacing, (facts.high[k] - facts.low[k]) / COARSEST_CELLS);
  PreparedLattice lattice = lay_lattice(facts, spec, spacing);
  at_limit = !lattice_fits(lattice, spec);
  while (!lattice_fits(lattice, spec) && samples_of(lattice) > FEWEST_SAMPLES)
    lattice = lay_lattice(facts, spec, lattice.spacing * SPACING_STEP);
  if (!lattice_fits(lattice, spec)) throw usage_error(fmt::format("no lattice of distances fits {} bytes", spec.most_bytes));
  return lattice;
}

// Finer and finer until the error is small enough or no more samples fit.
PreparedLattice choose_lattice(const MeshDistance& distance, const MeshFacts& facts, const std::vector<Triple>& points,
                               const LatticeSpec& spec, const LatticeProgress& progress, bool& at_limit) {
  PreparedLattice lattice = coarsest_lattice(facts, spec, at_limit);
  const auto value_at = [&](const Triple& p) { return value_without_samples(distance, lattice, p); };
  const auto is_coarse = [&] {
    if (progress) progress(0);
    return any_error_above(points, spec.threads, spec.tolerance, value_at);
  };
  while (is_coarse()) {
    const PreparedLattice finer = lay_lattice(facts, spec, lattice.spacing / SPACING_STEP);
    if (!lattice_fits(finer, spec)) {
      at_limit = true;
      return finest_lattice(facts, spec, lattice, finer.spacing);
    }
    lattice = finer;
  }
  return lattice;
}

// Replaces a lattice by the finest one that is forecast to take no longer than `most_seconds`, but by none coarser than that with which
// the search for a spacing starts: this one may take longer.
void give_way(const MeshFacts& facts, const LatticeSpec& spec, double most_seconds, LatticePlan& plan) {
  bool at_limit = false;
  PreparedLattice quick = coarsest_lattice(facts, spec, at_limit);
  LatticeSpec limited = spec;
  limited.most_samples = samples_of(plan.lattice) * most_seconds / plan.seconds;
  if (lattice_fits(quick, limited)) quick = finest_lattice(facts, limited, quick, plan.lattice.spacing);
  if (!(quick.spacing > plan.lattice.spacing)) return;
  plan.finer = plan.lattice;
  plan.finer_seconds = plan.seconds;
  plan.seconds *= samples_of(quick) / samples_of(plan.lattice);
  plan.lattice = quick;
}

PreparedLattice given_lattice(const MeshFacts& facts, const LatticeSpec& spec) {
  const PreparedLattice lattice = lay_lattice(facts, spec, *spec.spacing);
  if (lattice_fits(lattice, spec)) return lattice;
  bool at_limit = false;
  const double least = finest_lattice(facts, spec, coarsest_lattice(facts, spec, at_limit), lattice.spacing).spacing;
  throw usage_error(fmt::format(
      "a lattice of {:.4g} mm has {} samples of {} bytes, and {} MB are free for them: the finest that fits has {:.4g} mm",
      1e3 * lattice.spacing, readable_count(samples_of(lattice)), lattice.halves ? 2 : 4, readable_number(spec.most_bytes >> 20),
      1e3 * least * (1 + 5 * SAME_SPACING)));
}

}  // namespace

std::optional<PreparedLattice> lattice_at(const MeshFacts& facts, const LatticeSpec& spec, double spacing) {
  const PreparedLattice lattice = lay_lattice(facts, spec, spacing);
  return lattice_fits(lattice, spec) ? std::optional(lattice) : std::nullopt;
}

MeshLattice lattice_of_mesh(const MeshDistance& distance, const CheckedMesh& mesh, const LatticeSpec& spec,
                            const LatticeProgress& progress, const LatticeForecast& forecast) {
  const std::vector<Triple> points = surface_points(distance, mesh.mesh, SURFACE_SAMPLES);
  MeshLattice made;
  made.lattice =
      spec.spacing ? given_lattice(mesh.facts, spec) : choose_lattice(distance, mesh.facts, points, spec, progress, made.at_limit);
  std::optional<LatticeSampler> sampler;
  sampler.emplace(distance, made.lattice, spec.threads);
  const bool is_limited = !spec.spacing && forecast.most_seconds < std::numeric_limits<double>::infinity();
  if (forecast.say || is_limited) {
    LatticePlan plan{made.lattice, sampler->forecast(forecast.clock), {}, 0};
    if (is_limited && plan.seconds > forecast.most_seconds) give_way(mesh.facts, spec, forecast.most_seconds, plan);
    if (plan.finer) {
      made.lattice = plan.lattice;
      made.at_limit = true;
      sampler.emplace(distance, made.lattice, spec.threads);
    }
    if (forecast.say) forecast.say(plan);
  }
  made.lattice.words = std::make_shared<const std::vector<std::uint32_t>>(sampler->take_all(progress));
  const core_f64::Lattice lattice = core_f64::load_lattice(made.lattice);
  made.error = largest_error(points, spec.threads, [&](const Triple& p) {
    return core_f64::lattice_distance(lattice, {p[0], p[1], p[2]});
  });
  if (progress) progress(1);
  return made;
}

// A sample stands for a cell about it, of which a wall at the distance d across leaves 1/2 - d / spacing. Along any line across two walls
// that are a cell apart or more those shares add up to the way between them; of walls that are nearer they add up to more, by up to a
// quarter of a cell. A sample half a cell from a wall has a neighbor across it; one that has none is at a wall within another body.
EnclosedVolume enclosed_volume(const PreparedLattice& lattice, double area) {
  const core_f64::Lattice loaded = core_f64::load_lattice(lattice);
  const auto is_inside = [&](int i, int j, int k) {
    const bool is_there = i >= 0 && j >= 0 && k >= 0 && i < lattice.nx && j < lattice.ny && k < lattice.nz;
    return is_there && std::signbit(core_f64::lattice_sample(loaded, i, j, k));  // -0 on a wall within
  };
  const auto is_deep = [&](int i, int j, int k) {
    return is_inside(i, j, k) && is_inside(i - 1, j, k) && is_inside(i + 1, j, k) && is_inside(i, j - 1, k) &&
           is_inside(i, j + 1, k) && is_inside(i, j, k - 1) && is_inside(i, j, k + 1);
  };
  EnclosedVolume enclosed;
  double sum = 0;
  Triple moment{};
  for (int k = 0; k < lattice.nz; ++k)
    for (int j = 0; j < lattice.ny; ++j)
      for (int i = 0; i < lattice.nx; ++i) {
        double share = std::clamp(0.5 - core_f64::lattice_sample(loaded, i, j, k) / lattice.spacing, 0.0, 1.0);
        if (share == 0) continue;
        if (share > 0.5) enclosed.is_empty = false;
        if (share < 1 && is_deep(i, j, k)) share = 1;
        sum += share;
        const Triple place = lattice_place(lattice, i, j, k);
        for (int axis = 0; axis < 3; ++axis) moment[axis] += share * place[axis];
      }
  enclosed.volume = sum * std::pow(lattice.spacing, 3);
  enclosed.doubt = area * lattice.spacing / 8;  // a quarter of a cell for two walls
  for (int axis = 0; axis < 3; ++axis) enclosed.center[axis] = sum > 0 ? moment[axis] / sum : 0;
  return enclosed;
}

}  // namespace wholehand
