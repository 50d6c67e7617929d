// SPDX-License-Identifier: MIT
#include "sweeps/grips/hull.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include "sweeps/grips/qhull_run.h"

namespace wholehand::sweeps {
namespace {

constexpr int HULL_DIMENSION = 6;

// The determinant by elimination with row pivots, times 1 / 6!: the volume of a simplex with these edges.
double simplex_volume(std::array<Point6, 6> edges) {
  double volume = 1.0 / 720;
  for (std::size_t c = 0; c < 6; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < 6; ++r)
      if (std::abs(edges[r][c]) > std::abs(edges[pivot][c])) pivot = r;
    std::swap(edges[c], edges[pivot]);
    volume *= std::abs(edges[c][c]);
    if (!(volume > 0)) return 0;
    for (std::size_t r = c + 1; r < 6; ++r) {
      const double share = edges[r][c] / edges[c][c];
      for (std::size_t k = c; k < 6; ++k) edges[r][k] -= share * edges[c][k];
    }
  }
  return volume;
}

HullFacet read_facet(const facetT& facet, const Point6& apex) {
  HullFacet read;
  std::copy_n(facet.normal, HULL_DIMENSION, read.normal.begin());
  read.offset = -facet.offset;
  std::array<Point6, 6> edges{};
  std::size_t count = 0;
  vertexT *vertex = nullptr, **vertexp = nullptr;  // the names that Qhull's macro wants
  FOREACHvertex_(facet.vertices) {
    for (std::size_t k = 0; count < 6 && k < 6; ++k) edges[count][k] = vertex->point[k] - apex[k];
    ++count;
  }
  read.volume = simplex_volume(edges);
  return read;
}

}  // namespace

// Option QJ moves each coordinate randomly (the same at each call) until no two faces are coplanar. Here it is faster than merging such faces, and
// does not fail on the many coinciding points of a regular grip.
std::optional<Hull> hull_of(std::vector<Point6> points, const Point6& apex) {
  if (points.size() <= HULL_DIMENSION) return std::nullopt;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> nowhere(std::fopen("/dev/null", "w"), &std::fclose);
  if (!nowhere) return std::nullopt;  // Qhull would print to stderr
  QhullRun run;
  qhT* qh = run.get();
  char command[] = "qhull QJ";
  const int failed = qh_new_qhull(qh, HULL_DIMENSION, static_cast<int>(points.size()), points.front().data(), False, command,
                                  nullptr, nowhere.get());
  if (failed != 0) return std::nullopt;
  Hull hull;
  hull.moved = std::sqrt(static_cast<double>(HULL_DIMENSION)) * std::max(0.0, qh->JOGGLEmax);
  facetT* facet = nullptr;
  FORALLfacets { hull.facets.push_back(read_facet(*facet, apex)); }
  return hull;
}

}  // namespace wholehand::sweeps
