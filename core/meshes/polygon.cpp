// SPDX-License-Identifier: MIT
#include "core/meshes/polygon.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace wholehand {
namespace {

// Twice the area of a triangle, positive if it turns counter-clockwise.
double twice_area(const PolygonCorner& a, const PolygonCorner& b, const PolygonCorner& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Whether a ray from p to the right meets the edge, and where. An edge has its lower end and lacks its upper one, so that a ray through a corner
// meets one edge of two that go on up or down.
bool meets_ray(const PolygonCorner& a, const PolygonCorner& b, const PolygonCorner& p, double& x) {
  if ((a.y > p.y) == (b.y > p.y)) return false;
  x = a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
  return x >= p.x;
}

bool is_in_triangle(const PolygonCorner& p, const PolygonCorner& a, const PolygonCorner& b, const PolygonCorner& c) {
  const double ab = twice_area(a, b, p), bc = twice_area(b, c, p), ca = twice_area(c, a, p);
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

// A polygon as a ring of corners, from which one ear after the other is cut. An ear is a corner whose triangle with its neighbors lies within.
class EarCutter {
 public:
  explicit EarCutter(const PolygonLoop& outer) : start_(add_ring(outer)) {}

  // Joins a loop within the polygon with the ring: a bridge leads from its rightmost corner to a corner that sees it, and back.
  void join(const PolygonLoop& loop) {
    const std::size_t seen = corner_that_sees(rightmost(loop));
    std::size_t inner = add_ring(loop);
    for (std::size_t i = inner; i < ring_.size(); ++i)
      if (ring_[i].at.x > ring_[inner].at.x) inner = i;
    const std::size_t before = ring_[inner].previous, after = ring_[seen].next, inner_copy = ring_.size(),
                      seen_copy = inner_copy + 1;
    ring_.push_back({ring_[inner].at, before, seen_copy, false});
    ring_.push_back({ring_[seen].at, inner_copy, after, false});
    ring_[before].next = inner_copy;
    ring_[after].previous = seen_copy;
    ring_[seen].next = inner;
    ring_[inner].previous = seen;
    left_ += 2;
  }

  std::vector<Corners> cut() {
    std::vector<Corners> triangles;
    triangles.reserve(left_ - 2);
    find_ears();
    int searches = MOST_SEARCHES;
    for (std::size_t at = start_; left_ > 3; --left_) {
      at = next_ear(at);
      if (!ring_[at].is_ear && searches-- > 0) {
        find_ears();
        at = next_ear(at);
      }
      // where loops cross there may be no ear: then any corner is cut
      const std::size_t before = ring_[at].previous, after = ring_[at].next;
      triangles.push_back(triangle_at(at));
      ring_[before].next = after;
      ring_[after].previous = before;
      ring_[before].is_ear = is_ear(before);
      ring_[after].is_ear = is_ear(after);
      start_ = before;
      at = ring_[after].next;  // the ear beside the last one would be a sliver
    }
    triangles.push_back(triangle_at(start_));
    return triangles;
  }

  static const PolygonCorner& rightmost(const PolygonLoop& loop) {
    return *std::max_element(loop.begin(), loop.end(), [](const PolygonCorner& a, const PolygonCorner& b) { return a.x < b.x; });
  }

 private:
  // Cutting an ear changes whether its neighbors are ears. In theory no other corner becomes one; with rounding some do.
  static constexpr int MOST_SEARCHES = 16;

  struct RingCorner {
    PolygonCorner at;
    std::size_t previous, next;
    bool is_ear;
  };

  std::size_t add_ring(const PolygonLoop& loop) {
    const std::size_t first = ring_.size();
    for (std::size_t i = 0; i < loop.size(); ++i)
      ring_.push_back({loop[i], first + (i + loop.size() - 1) % loop.size(), first + (i + 1) % loop.size(), false});
    left_ += loop.size();
    return first;
  }

  // Whether the way from a corner to p begins within the polygon.
  bool sees_inward(std::size_t corner, const PolygonCorner& p) const {
    const PolygonCorner &at = ring_[corner].at, &before = ring_[ring_[corner].previous].at, &after = ring_[ring_[corner].next].at;
    if (twice_area(before, at, after) > 0) return twice_area(at, after, p) >= 0 && twice_area(at, p, before) >= 0;
    return !(twice_area(at, before, p) > 0 && twice_area(at, p, after) > 0);
  }

  // A corner of the ring that nothing hides from p: the right end of the edge that p sees to its right, or, if corners lie in the triangle before it,
  // the one of these in the flattest direction.
  std::size_t corner_that_sees(const PolygonCorner& p) const {
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t found = start_;
    std::size_t at = start_;
    do {
      const std::size_t next = ring_[at].next;
      double x = 0;
      // of the two sides of a bridge, p sees the one that goes up
      const bool goes_up = ring_[next].at.y > ring_[at].at.y;
      if (goes_up && meets_ray(ring_[at].at, ring_[next].at, p, x) && x < nearest) {
        nearest = x;
        found = ring_[at].at.x > ring_[next].at.x ? at : next;
      }
      at = next;
    } while (at != start_);
    const PolygonCorner met{nearest, p.y, 0}, end = ring_[found].at;
    double flattest = steepness(p, end), closest = end.x;
    at = start_;
    do {
      const PolygonCorner& corner = ring_[at].at;
      const double steep = steepness(p, corner);
      const bool is_better = steep < flattest || (steep == flattest && corner.x < closest);
      if (is_better && corner.x >= p.x && is_in_triangle(corner, p, met, end) && sees_inward(at, p)) {
        flattest = steep;
        closest = corner.x;
        found = at;
      }
      at = ring_[at].next;
    } while (at != start_);
    return found;
  }

  static double steepness(const PolygonCorner& from, const PolygonCorner& to) {
    return to.y == from.y ? 0 : std::abs(to.y - from.y) / (to.x - from.x);
  }

  Corners triangle_at(std::size_t corner) const {
    return {ring_[ring_[corner].previous].at.vertex, ring_[corner].at.vertex, ring_[ring_[corner].next].at.vertex};
  }

  bool is_ear(std::size_t corner) const {
    const std::size_t before = ring_[corner].previous, after = ring_[corner].next;
    const PolygonCorner &a = ring_[before].at, &b = ring_[corner].at, &c = ring_[after].at;
    if (!(twice_area(a, b, c) > 0)) return false;
    const auto [low, high] = std::minmax({a.x, b.x, c.x});
    for (std::size_t i = ring_[after].next; i != before; i = ring_[i].next) {
      const PolygonCorner& p = ring_[i].at;
      if (p.x < low || p.x > high || p.vertex == a.vertex || p.vertex == b.vertex || p.vertex == c.vertex) continue;
      if (is_in_triangle(p, a, b, c)) return false;
    }
    return true;
  }

  void find_ears() {
    std::size_t at = start_;
    do {
      ring_[at].is_ear = is_ear(at);
      at = ring_[at].next;
    } while (at != start_);
  }

  // The first ear from there on; the same corner if there is none.
  std::size_t next_ear(std::size_t from) const {
    std::size_t at = from;
    while (!ring_[at].is_ear) {
      at = ring_[at].next;
      if (at == from) break;
    }
    return at;
  }

  std::vector<RingCorner> ring_;
  std::size_t left_ = 0;  // corners of the ring
  std::size_t start_;     // one of them
};

}  // namespace

bool is_within(const PolygonLoop& loop, const PolygonCorner& p) {
  bool is_inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    double x = 0;
    if (meets_ray(loop[i], loop[(i + 1) % loop.size()], p, x)) is_inside = !is_inside;
  }
  return is_inside;
}

std::vector<Corners> cut_polygon(const PolygonLoop& outer, std::vector<PolygonLoop> inner) {
  // from right to left, so that no bridge meets a loop that is not joined yet
  std::sort(inner.begin(), inner.end(),
            [](const PolygonLoop& a, const PolygonLoop& b) { return EarCutter::rightmost(a).x > EarCutter::rightmost(b).x; });
  EarCutter cutter(outer);
  for (const PolygonLoop& loop : inner) cutter.join(loop);
  return cutter.cut();
}

}  // namespace wholehand
