// SPDX-License-Identifier: MIT
#include "sweeps/grips/quality.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/mesh_body.h"
#include "core/outline_points.h"
#include "core/vectors.h"
#include "sweeps/grips/hull.h"

namespace wholehand::sweeps {
namespace {

using core_f64::ContactPoint;
using core_f64::Vec3;

constexpr double EPSILON_WIDTH = 0.01;      // of a bracket that is narrow enough, relative
constexpr double VOLUME_WIDTH = 0.1;        // the same
constexpr double SAME_WRENCH = 1e-3;        // nearer points do not both become corners
constexpr double FLAT = 1e-7;               // of the set's size: thinner counts as flat
constexpr int SEPARATING_STEPS = 10'000;    // at most
constexpr double SOME_LENGTH = 1e-12;       // square of a direction that is more than rounding
constexpr double FINE_STEP = radians(0.1);  // of points along an arc: 0.4 um off at 1 m

double dot_of(const Point6& a, const Point6& b) {
  double sum = 0;
  for (std::size_t k = 0; k < 6; ++k) sum += a[k] * b[k];
  return sum;
}

Point6 plus(const Point6& a, double share, const Point6& b) {
  Point6 sum{};
  for (std::size_t k = 0; k < 6; ++k) sum[k] = a[k] + share * b[k];
  return sum;
}

Vec3 head(const Point6& p) { return {p[0], p[1], p[2]}; }
Vec3 tail(const Point6& p) { return {p[3], p[4], p[5]}; }
Point6 six(const Vec3& a, const Vec3& b) { return {a.x, a.y, a.z, b.x, b.y, b.z}; }

// The farthest wrench of W along a direction.
struct Support {
  double value = 0;
  Point6 wrench{};
};

// W in units of the scale. Its support function is that of kernel 10 with one digit of strength 1.
class WrenchSet {
 public:
  WrenchSet(std::span<const ContactPoint> contacts, const ContactMaterial& material, const Vec3& center, double scale)
      : friction_(material.friction), torsion_(material.torsion / scale) {
    for (const ContactPoint& contact : contacts) contacts_.push_back({(contact.place - center) / scale, contact.normal, 0});
  }

  // The support of the contacts' wrenches at unit normal force, without 0.
  Support of_contacts(const Point6& direction) const {
    std::pair<double, const ContactPoint*> best{-HUGE_VAL, nullptr};
    for (const ContactPoint& contact : contacts_) best = std::max(best, {press(contact, direction, nullptr), &contact});
    Support most;
    if (best.second) most.value = press(*best.second, direction, &most.wrench);
    return most;
  }
  Support of(const Point6& direction) const {
    const Support most = of_contacts(direction);
    return most.value > 0 ? most : Support{};
  }

  // 0 and, of each contact's cone, six wrenches on its edge.
  std::vector<Point6> corners() const {
    std::vector<Point6> points{Point6{}};
    for (const ContactPoint& contact : contacts_) {
      const Vec3 n = contact.normal, off = std::abs(n.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
      const Vec3 first = glm::normalize(glm::cross(n, off));
      for (const double sense : {1.0, -1.0}) {
        for (const Vec3& across : {first, glm::cross(n, first)}) points.push_back(at(contact, n + sense * friction_ * across, 0));
        points.push_back(at(contact, n, sense * friction_ * torsion_));
      }
    }
    return points;
  }

 private:
  static Point6 at(const ContactPoint& contact, const Vec3& force, double torsion) {
    return six(force, glm::cross(contact.place, force) + torsion * contact.normal);
  }

  // See press of core/effort.h.
  double press(const ContactPoint& contact, const Point6& direction, Point6* wrench) const {
    const Vec3 n = contact.normal, turning = tail(direction), velocity = head(direction) + glm::cross(turning, contact.place);
    const double along = glm::dot(n, velocity), spin = torsion_ * glm::dot(turning, n);
    const Vec3 across = velocity - along * n;
    const double root = std::sqrt(glm::dot(across, across) + spin * spin);
    const double share = root > 0 ? friction_ / root : 0.0;
    if (wrench) *wrench = at(contact, n + share * across, share * torsion_ * spin);
    return along + friction_ * root;
  }

  double friction_, torsion_;
  std::vector<ContactPoint> contacts_;
};

// Whether W lacks one of the six dimensions, by its corners: projects the longest out of all others, six times.
bool is_flat(std::vector<Point6> points) {
  double size = 0;
  for (int dimension = 0; dimension < 6; ++dimension) {
    const Point6 longest = *std::max_element(points.begin(), points.end(),
                                             [](const Point6& a, const Point6& b) { return dot_of(a, a) < dot_of(b, b); });
    const double square = dot_of(longest, longest);
    if (dimension == 0) size = std::sqrt(square);
    if (!(std::sqrt(square) > FLAT * size)) return true;
    for (Point6& point : points) point = plus(point, -dot_of(point, longest) / square, longest);
  }
  return false;
}

// Whether a plane through 0 has all contacts' wrenches on one side: the perceptron, which finds one if there is one with some room.
bool is_one_sided(const WrenchSet& set, const Point6& inside) {
  Point6 direction = plus({}, -1, inside);
  for (int step = 0; step < SEPARATING_STEPS; ++step) {
    const Support most = set.of_contacts(direction);
    if (most.value <= 0 && dot_of(direction, direction) > SOME_LENGTH) return true;
    direction = plus(direction, -1, most.wrench);
  }
  return false;
}

// A face of the inscribed hull, with the point of W that is farthest beyond it.
struct Gap {
  double offset = 0;  // of the face from 0
  double beyond = 0;  // volume that W may have there, beyond the pyramid over the face
  Point6 farthest{};
};

// One round: brackets from an inscribed hull and the exact support function at the normals of its faces.
struct Round {
  WrenchQuality quality;
  std::vector<Gap> gaps;
};

// W contains the hull, and no ray from the apex through a face leaves W later than at the plane of W's support, (h - u.c) / (offset - u.c) times
// as far as the face.
Round measure(const WrenchSet& set, const Hull& hull, const Point6& apex) {
  Round round;
  double low = HUGE_VAL, high = HUGE_VAL, inner = HUGE_VAL, within = 0, most = 0;
  for (const HullFacet& facet : hull.facets) {
    const Support support = set.of(facet.normal);
    const double to_apex = dot_of(facet.normal, apex), depth = facet.offset - to_apex;
    const double outer = facet.volume * std::pow((support.value - to_apex) / depth, 6);
    low = std::min(low, facet.offset);
    high = std::min(high, support.value);
    inner = std::min(inner, depth);
    within += facet.volume;
    most += outer;
    round.gaps.push_back({facet.offset, outer - facet.volume, support.wrench});
  }
  round.quality.epsilon = {std::max(0.0, low - hull.moved), high};
  // a hull whose corners move by `moved` holds itself scaled by 1 - moved / inner
  round.quality.volume = {within * std::pow(std::max(0.0, 1 - hull.moved / inner), 6), most};
  return round;
}

bool is_narrow(const std::array<double, 2>& bracket, double width) { return bracket[1] - bracket[0] <= width * bracket[1]; }

// Adds at most `count` of the points that are farthest beyond faces: half for the faces nearest to 0, the rest where most volume is missing.
bool add_farthest(std::vector<Point6>& points, std::vector<Gap>& gaps, const WrenchQuality& known, std::size_t count) {
  const std::size_t before = points.size();
  const auto add = [&](const Gap& gap) {
    const auto is_near = [&](const Point6& point) {
      const Point6 way = plus(point, -1, gap.farthest);
      return dot_of(way, way) < SAME_WRENCH * SAME_WRENCH;
    };
    if (std::none_of(points.begin(), points.end(), is_near)) points.push_back(gap.farthest);
  };
  if (!is_narrow(known.epsilon, EPSILON_WIDTH)) {
    std::sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.offset < b.offset; });
    for (const Gap& gap : gaps) {
      if (points.size() - before >= count / 2 || gap.offset >= (1 - EPSILON_WIDTH) * known.epsilon[1]) break;
      add(gap);
    }
  }
  std::sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.beyond > b.beyond; });
  for (const Gap& gap : gaps) {
    if (points.size() - before >= count) break;
    add(gap);
  }
  return points.size() > before;
}

void narrow(std::array<double, 2>& bracket, const std::array<double, 2>& by) {
  bracket = {std::max(bracket[0], by[0]), std::min(bracket[1], by[1])};
}

// Bounds by the support along the axes alone.
WrenchQuality boxed(const WrenchSet& set) {
  WrenchQuality quality{{0, HUGE_VAL}, {0, 1}};
  for (std::size_t k = 0; k < 6; ++k) {
    Point6 up{}, down{};
    up[k] = 1;
    down[k] = -1;
    const double above = set.of(up).value, below = set.of(down).value;
    quality.epsilon[1] = std::min({quality.epsilon[1], above, below});
    quality.volume[1] *= above + below;
  }
  return quality;
}

double farthest_from(const VesselData& vessel, const Triple& center) {
  double farthest = 0;
  if (vessel.mesh) {
    for (const Triple& vertex : vessel.mesh->body->vertices) farthest = std::max(farthest, distance(vertex, center));
    return farthest;
  }
  const auto elements = monotone_elements(vessel.outline);
  const double off_axis = std::hypot(center[0], center[2]);
  for (const auto& [radius, y] : outline_points(elements, elements.size(), FINE_STEP))
    farthest = std::max(farthest, std::hypot(radius + off_axis, y - center[1]));
  return farthest;
}

}  // namespace

WrenchQuality wrench_quality(std::span<const ContactPoint> contacts, const ContactMaterial& material, const Vec3& center,
                             double scale, std::size_t most_facets) {
  const WrenchSet set(contacts, material, center, scale);
  std::vector<Point6> points = set.corners();
  if (is_flat(points)) return {};
  Point6 apex{};
  for (const Point6& point : points) apex = plus(apex, 1.0 / static_cast<double>(points.size()), point);
  WrenchQuality known = boxed(set);
  if (is_one_sided(set, apex)) known.epsilon = {};
  while (const auto hull = hull_of(points, apex)) {
    Round round = measure(set, *hull, apex);
    narrow(known.epsilon, round.quality.epsilon);
    narrow(known.volume, round.quality.volume);
    if (is_narrow(known.epsilon, EPSILON_WIDTH) && is_narrow(known.volume, VOLUME_WIDTH)) break;
    if (hull->facets.size() >= most_facets) break;
    if (!add_farthest(points, round.gaps, known, points.size())) break;
  }
  return known;
}

GripQuality grip_quality(const Scene& scene, const Evaluator& evaluator, std::size_t vessel, const GripResult& result,
                         std::size_t most_facets) {
  GripQuality quality;
  quality.center = evaluator.empty_center_of_mass(vessel);
  quality.scale = farthest_from(scene.vessels[vessel], quality.center);
  std::vector<ContactPoint> contacts;
  for (const GripContact& contact : evaluator.contacts(vessel, result))
    contacts.push_back({to_vec3<double>(contact.point), to_vec3<double>(contact.normal), contact.digit});
  quality.wrenches = wrench_quality(contacts, {scene.force.friction, scene.force.torsion}, to_vec3<double>(quality.center),
                                    quality.scale, most_facets);
  return quality;
}

}  // namespace wholehand::sweeps
