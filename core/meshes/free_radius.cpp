// SPDX-License-Identifier: MIT
#include "core/meshes/free_radius.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wholehand {
namespace {

constexpr double ON_SIDE = 1e-9;  // of a triangle's doubled area: a line through its edge meets it
constexpr double ON_RAY = 1e-9;   // of a step between azimuths: a ray through a segment's end meets it

struct LevelPoint {
  double x, z;
};

// Where the rays meet a segment.
void shorten_rays(const LevelPoint& p, const LevelPoint& q, FreeRadii& radii) {
  const double cross = p.x * q.z - p.z * q.x;
  const double step = 2 * PI / RAY_AZIMUTHS;
  const double from = std::atan2(p.z, p.x) / step, sweep = std::atan2(cross, p.x * q.x + p.z * q.z) / step;
  const double low = std::min(from, from + sweep) - ON_RAY, high = std::max(from, from + sweep) + ON_RAY;
  for (double k = std::ceil(low); k <= high; ++k) {
    const double ux = std::cos(step * k), uz = std::sin(step * k);
    const double along = ux * (q.z - p.z) - uz * (q.x - p.x);
    // a segment along the ray starts at its nearer end
    const double radius = std::abs(along) > 0 ? std::abs(cross / along) : std::min(std::hypot(p.x, p.z), std::hypot(q.x, q.z));
    double& least = radii[static_cast<std::size_t>((static_cast<int>(k) % RAY_AZIMUTHS + RAY_AZIMUTHS) % RAY_AZIMUTHS)];
    least = std::min(least, radius);
  }
}

// Calls `visit(height's number, one end, other end)` for each level cut of a triangle, with its ends relative to the axis.
template <class Visit>
void for_each_cut(const TriangleMesh& mesh, double x, double z, const std::vector<double>& heights, const Visit& visit) {
  for (const Corners& triangle : mesh.triangles) {
    const Triple *a = &mesh.vertices[triangle[0]], *b = &mesh.vertices[triangle[1]], *c = &mesh.vertices[triangle[2]];
    if ((*b)[1] < (*a)[1]) std::swap(a, b);
    if ((*c)[1] < (*a)[1]) std::swap(a, c);
    if ((*c)[1] < (*b)[1]) std::swap(b, c);
    const auto point_at = [&](const Triple& low, const Triple& high, double y) {
      const double t = high[1] > low[1] ? (y - low[1]) / (high[1] - low[1]) : 0;
      return LevelPoint{low[0] + t * (high[0] - low[0]) - x, low[2] + t * (high[2] - low[2]) - z};
    };
    auto height = std::lower_bound(heights.begin(), heights.end(), (*a)[1]);
    for (; height != heights.end() && *height <= (*c)[1]; ++height)
      visit(static_cast<std::size_t>(height - heights.begin()), point_at(*a, *c, *height),
            *height < (*b)[1] ? point_at(*a, *b, *height) : point_at(*b, *c, *height));
  }
}

}  // namespace

std::vector<FreeRadii> free_radii(const TriangleMesh& mesh, double x, double z, const std::vector<double>& heights) {
  std::vector<FreeRadii> radii(heights.size(), FreeRadii(RAY_AZIMUTHS, std::numeric_limits<double>::infinity()));
  for_each_cut(mesh, x, z, heights,
               [&](std::size_t height, const LevelPoint& p, const LevelPoint& q) { shorten_rays(p, q, radii[height]); });
  return radii;
}

std::vector<double> least_radii(const TriangleMesh& mesh, double x, double z, const std::vector<double>& heights) {
  std::vector<double> least(heights.size(), std::numeric_limits<double>::infinity());
  for_each_cut(mesh, x, z, heights, [&](std::size_t height, const LevelPoint& p, const LevelPoint& q) {
    const double dx = q.x - p.x, dz = q.z - p.z, squared = dx * dx + dz * dz;
    const double t = squared > 0 ? std::clamp(-(p.x * dx + p.z * dz) / squared, 0.0, 1.0) : 0;
    least[height] = std::min(least[height], std::hypot(p.x + t * dx, p.z + t * dz));
  });
  return least;
}

std::vector<double> heights_on_line(const TriangleMesh& mesh, double x, double z) {
  std::vector<double> heights;
  for (const Corners& triangle : mesh.triangles) {
    const Triple &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]], &c = mesh.vertices[triangle[2]];
    if (std::min({a[0], b[0], c[0]}) > x || std::max({a[0], b[0], c[0]}) < x) continue;
    const double area = (b[0] - a[0]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[0] - a[0]);
    if (area == 0) continue;
    const double of_b = ((x - a[0]) * (c[2] - a[2]) - (z - a[2]) * (c[0] - a[0])) / area,
                 of_c = ((b[0] - a[0]) * (z - a[2]) - (b[2] - a[2]) * (x - a[0])) / area, of_a = 1 - of_b - of_c;
    if (std::min({of_a, of_b, of_c}) >= -ON_SIDE) heights.push_back(of_a * a[1] + of_b * b[1] + of_c * c[1]);
  }
  std::sort(heights.begin(), heights.end());
  return heights;
}

}  // namespace wholehand
