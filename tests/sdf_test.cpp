// Kernel 2: the signed distance against brute force over sampled outlines, its gradient against differences, the lattice, and the
// inner offset that makes shells and cavities.
#include "core/sdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "core/error.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using core_f64::Element;
using core_f64::Vec2;
using core_f64::Vec3;
using core_f64::Vessel;

constexpr int OUTLINE_SAMPLES = 100000;
constexpr int FEWER_SAMPLES = 10000;  // where many distances are asked for: the search on the curve makes up for it

// One element of an outline as a curve over [0, 1], from the scene's own data.
struct Piece {
  bool is_arc = false;
  double ar = 0, ay = 0, br = 0, by = 0, cr = 0, cy = 0, radius = 0, from = 0, sweep = 0;

  Vec2 at(double t) const {
    if (!is_arc) return {ar + t * (br - ar), ay + t * (by - ay)};
    return {cr + radius * std::cos(from + t * sweep), cy + radius * std::sin(from + t * sweep)};
  }
  // Outward normal: to the right of the way, as the body lies to its left.
  Vec2 normal(double t) const {
    if (!is_arc) {
      const double l = std::hypot(br - ar, by - ay);
      return {(by - ay) / l, -(br - ar) / l};
    }
    const double sign = sweep > 0 ? 1 : -1;
    return {sign * std::cos(from + t * sweep), sign * std::sin(from + t * sweep)};
  }
  double length() const { return is_arc ? radius * std::abs(sweep) : std::hypot(br - ar, by - ay); }
};

std::vector<Piece> pieces_of(const VesselData& vessel) {
  std::vector<Piece> pieces;
  double r = 0, y = 0;
  for (const OutlineElement& element : vessel.outline) {
    Piece piece{element.is_arc, r, y, element.end[0], element.end[1], element.center[0], element.center[1], 0, 0, 0};
    if (piece.is_arc) {
      piece.radius = std::hypot(r - piece.cr, y - piece.cy);
      piece.from = std::atan2(y - piece.cy, r - piece.cr);
      piece.sweep = std::remainder(std::atan2(piece.by - piece.cy, piece.br - piece.cr) - piece.from, 2 * PI);
      const bool is_half = std::abs(std::abs(piece.sweep) - PI) < 1e-9;  // then the way further from the axis
      if (is_half && std::cos(piece.from + piece.sweep / 2) < 0) piece.sweep = -piece.sweep;
    }
    pieces.push_back(piece);
    r = element.end[0];
    y = element.end[1];
  }
  return pieces;
}

// The outline as points, and the smallest distance to it: by the nearest sample of each element, then by golden section on the
// curve around it, so that what is left is rounding.
class Sampled {
 public:
  explicit Sampled(std::vector<Piece> pieces, int samples = OUTLINE_SAMPLES) : pieces_(std::move(pieces)) {
    double total = 0;
    for (const Piece& piece : pieces_) total += piece.length();
    for (const Piece& piece : pieces_) {
      const int n = std::max(16, static_cast<int>(samples * piece.length() / total));
      std::vector<double> r, y;
      for (int i = 0; i <= n; ++i) {
        const Vec2 q = piece.at(static_cast<double>(i) / n);
        r.push_back(q.x);
        y.push_back(q.y);
      }
      spacing_ = std::max(spacing_, piece.length() / n);
      r_.push_back(r);
      y_.push_back(y);
    }
  }

  double spacing() const { return spacing_; }
  const std::vector<Piece>& pieces() const { return pieces_; }

  double distance(Vec2 q) const {
    std::vector<double> least(pieces_.size());
    std::vector<std::size_t> where(pieces_.size());
    double bound = 1e300;
    for (std::size_t e = 0; e < pieces_.size(); ++e) {
      double best = 1e300;
      for (std::size_t i = 0; i < r_[e].size(); ++i) {
        const double dr = r_[e][i] - q.x, dy = y_[e][i] - q.y;
        const double d = dr * dr + dy * dy;
        where[e] = d < best ? i : where[e];
        best = d < best ? d : best;
      }
      least[e] = std::sqrt(best);
      bound = std::min(bound, least[e]);
    }
    double result = bound;
    for (std::size_t e = 0; e < pieces_.size(); ++e) {
      if (least[e] > bound + spacing_) continue;
      const double n = static_cast<double>(r_[e].size() - 1), i = static_cast<double>(where[e]);
      double low = std::max(0.0, (i - 1) / n), high = std::min(1.0, (i + 1) / n);
      const double ratio = (std::sqrt(5.0) - 1) / 2;
      const auto far = [&](double t) { return glm::distance(pieces_[e].at(t), q); };
      for (int step = 0; step < 60; ++step) {
        const double left = high - ratio * (high - low), right = low + ratio * (high - low);
        (far(left) < far(right) ? high : low) = far(left) < far(right) ? right : left;
      }
      result = std::min({result, far(low), far(high)});
    }
    return result;
  }

  // Parity of the polygon of samples along a slanting ray, so that no level of the outline is special to it. The polygon is closed
  // on the far side of the axis. Wrong only nearer to an arc than the sagitta between two samples.
  bool inside(Vec2 q) const {
    const double c = std::cos(1.0), s = std::sin(1.0);
    const auto along = [&](double r, double y) { return (r - q.x) * c + (y - q.y) * s; };
    const auto across = [&](double r, double y) { return (y - q.y) * c - (r - q.x) * s; };
    bool odd = false;
    double last_r = -1, last_y = pieces_.front().ay;
    const auto edge = [&](double r, double y) {
      const double v0 = across(last_r, last_y), v1 = across(r, y);
      if ((v0 < 0) != (v1 < 0)) {
        const double u0 = along(last_r, last_y), u1 = along(r, y);
        if (u0 + (u1 - u0) * v0 / (v0 - v1) > 0) odd = !odd;
      }
      last_r = r;
      last_y = y;
    };
    for (std::size_t e = 0; e < pieces_.size(); ++e) {
      for (std::size_t i = 0; i < r_[e].size(); ++i) edge(r_[e][i], y_[e][i]);
    }
    edge(-1, pieces_.back().by);
    edge(-1, pieces_.front().ay);
    return odd;
  }

 private:
  std::vector<Piece> pieces_;
  std::vector<std::vector<double>> r_, y_;
  double spacing_ = 0;
};

// A line from a to b: where an arc has its center stands the outward normal.
Element line_element(Vec2 a, Vec2 b) { return {a, b, glm::normalize(Vec2{b.y - a.y, a.x - b.x})}; }

std::vector<VesselData> solids() { return {beaker1(), beaker2(), beaker3(), vase(), ledges()}; }

// Without its last element, the mouth.
std::vector<Piece> open_pieces(const VesselData& vessel) {
  std::vector<Piece> pieces = pieces_of(vessel);
  pieces.pop_back();
  return pieces;
}

Vec3 around(Vec2 q, double azimuth) { return {q.x * std::cos(azimuth), q.y, q.x * std::sin(azimuth)}; }

Vec2 point_in_box(const VesselData& vessel, Random& random) {
  const double wide = 1.5 * largest_radius(vessel), high = vessel.height;
  return {random.uniform(0, wide), random.uniform(-0.4 * high, 1.4 * high)};
}

// Points on which distances are compared: everywhere, the axis, on and beside the surface and its corners, level with the ends of
// elements, centres of arcs, far away.
std::vector<Vec2> queries(const VesselData& vessel, const std::vector<Piece>& pieces, int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) points.push_back(point_in_box(vessel, random));
  for (int i = 0; i < 20; ++i) points.push_back({0, random.uniform(-0.2, 1.2) * vessel.height});
  for (const Piece& piece : pieces) {
    for (const double t : {0.0, 0.1, 0.5, 1.0}) {
      for (const double off : {0.0, 1e-3, -1e-3, 1e-6, -1e-6, 1e-8, -1e-8}) {
        const Vec2 q = piece.at(t) + off * piece.normal(t);
        if (q.x >= 0) points.push_back(q);
      }
    }
    for (const double r : {0.0, 5e-3, 21e-3, 33e-3, 60e-3}) points.push_back({r, piece.by});  // level with an element's end
    if (piece.is_arc) points.push_back({piece.cr, piece.cy});
  }
  points.push_back({1, 0});
  points.push_back({3, -100});
  points.push_back({0, 100});
  return points;
}

void expect_brute_force(const VesselData& data, int count) {
  const Vessel vessel = ready_vessel(data);
  const Sampled brute(pieces_of(data));
  int signs = 0;
  for (const Vec2& q : queries(data, brute.pieces(), count, 1)) {
    const double expected = brute.distance(q);
    const double profile = core_f64::profile_distance(vessel, q);
    // 1e-12 m: rounding of coordinates up to 1 m and of the arcs' ends; far away, of the distance itself
    const double rounding = 1e-12 * std::max(1.0, expected);
    ASSERT_NEAR(std::abs(profile), expected, rounding) << data.name << " at " << q.x << ", " << q.y;
    // 1e-9 m: the sagitta between two samples 1e-5 m apart on an arc of 3 mm is 4e-9 m; samples are under 4e-6 m apart
    if (expected > 1e-9) {
      ++signs;
      ASSERT_EQ(profile < 0, brute.inside(q)) << data.name << " at " << q.x << ", " << q.y << ", distance " << expected;
    }
    for (const double azimuth : {0.0, 0.7, 2.5, -1.9}) {
      ASSERT_NEAR(core_f64::signed_distance(vessel, around(q, azimuth)), profile, rounding);
    }
  }
  ASSERT_LT(brute.spacing(), 1e-5);
  EXPECT_GT(signs, count);
}

TEST(Sdf, OfACylinderIsBruteForce) { expect_brute_force(beaker1(), 300); }
TEST(Sdf, OfAFlaskIsBruteForce) { expect_brute_force(beaker2(), 300); }
TEST(Sdf, OfAConeIsBruteForce) { expect_brute_force(beaker3(), 300); }
TEST(Sdf, OfConvexAndConcaveArcsIsBruteForce) { expect_brute_force(vase(), 500); }
TEST(Sdf, OfLedgesAndOverhangsIsBruteForce) { expect_brute_force(ledges(), 500); }

TEST(Sdf, InsideIsNegative) {
  for (const VesselData& data : solids()) {
    const Vessel vessel = ready_vessel(data);
    EXPECT_LT(core_f64::signed_distance(vessel, {0, data.height / 2, 0}), -1e-3) << data.name;
    EXPECT_GT(core_f64::signed_distance(vessel, {0, -1e-3, 0}), 1e-4);
    EXPECT_GT(core_f64::signed_distance(vessel, {0, data.height + 1e-3, 0}), 1e-4);
    EXPECT_GT(core_f64::signed_distance(vessel, {0.2, data.height / 2, 0.1}), 1e-2);
  }
}

TEST(Sdf, OfACylinderInClosedForm) {
  // 1e-16 m: one subtraction of numbers under 0.2 m, or one root
  const Vessel vessel = ready_vessel(beaker1());
  EXPECT_NEAR(core_f64::signed_distance(vessel, {0, 55e-3, 0}), -40e-3, 1e-16);
  EXPECT_NEAR(core_f64::signed_distance(vessel, {0, 3e-3, 0}), -3e-3, 1e-16);
  EXPECT_NEAR(core_f64::signed_distance(vessel, {0, 108e-3, 0}), -2e-3, 1e-16);
  EXPECT_NEAR(core_f64::signed_distance(vessel, {50e-3, 55e-3, 0}), 10e-3, 1e-16);
  EXPECT_NEAR(core_f64::signed_distance(vessel, {30e-3, 55e-3, 40e-3}), 10e-3, 1e-16);
  EXPECT_NEAR(core_f64::signed_distance(vessel, {0, -7e-3, 0}), 7e-3, 1e-16);
  EXPECT_NEAR(core_f64::signed_distance(vessel, {43e-3, 114e-3, 0}), 5e-3, 1e-16);    // off the rim: 3, 4, 5
  EXPECT_NEAR(core_f64::signed_distance(vessel, {0, -12e-3, -45e-3}), 13e-3, 1e-16);  // off the base's edge: 5, 12, 13
}

TEST(Sdf, OfASphereHasNoSeamAtItsPoles) {
  const double r = 42.5e-3;
  const Vessel vessel = ready_vessel(beaker2());
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    // below the centre the flask is its sphere
    const Vec3 direction = glm::normalize(Vec3{random.uniform(-1, 1), random.uniform(-1, 0), random.uniform(-1, 1)});
    const double far = random.uniform(10e-3, 80e-3);
    EXPECT_NEAR(core_f64::signed_distance(vessel, Vec3{0, r, 0} + far * direction), far - r, 1e-15);  // a root and a square more
  }
}

TEST(Sdf, IsNeverNaN) {
  for (VesselData data : {beaker1(), beaker2(), vase(), ledges(), shell_of(vase())}) {
    const Vessel vessel = ready_vessel(data);
    for (const double x : {0.0, 1e-300, -1e-20, 1e-9, 24e-3, 40e-3, 1.0, 1e6, -1e100}) {
      for (const double y : {0.0, -1e-300, 6e-3, 42.5e-3, 60e-3, data.height, -1e6, 1e100}) {
        for (const double z : {0.0, 1e-200, 1e100}) {
          int element = -2;
          const Vec3 g = core_f64::distance_gradient(vessel, {x, y, z}, element);
          EXPECT_FALSE(std::isnan(core_f64::signed_distance(vessel, {x, y, z}))) << x << " " << y << " " << z;
          EXPECT_NEAR(glm::length(g), 1, 1e-12) << data.name << " at " << x << " " << y << " " << z;  // rounding of a normalisation
          EXPECT_GE(element, 0);
          EXPECT_LT(element, static_cast<int>(vessel.outline.size()));
        }
      }
    }
  }
}

// ---- shells: the wall between the outline and its inner offset ----

// The inner offset as points, without core/: the outline's samples moved inwards by the wall, and circles around its corners, where
// nothing of the outline is nearer than the wall.
std::vector<Vec2> inner_points(const VesselData& vessel, const Sampled& open) {
  std::vector<Vec2> points;
  const auto add = [&](Vec2 q) {
    if (q.x >= 0 && q.y <= vessel.height && open.distance(q) > vessel.wall - 1e-9) points.push_back(q);
  };
  for (const Piece& piece : open.pieces()) {
    const int n = std::max(4, static_cast<int>(piece.length() / 50e-6));
    for (int i = 0; i <= n; ++i) add(piece.at(static_cast<double>(i) / n) - vessel.wall * piece.normal(static_cast<double>(i) / n));
    for (int i = 0; i < 120; ++i) {
      const double angle = 2 * PI * i / 120;
      const Vec2 q = piece.at(1) + vessel.wall * Vec2{std::cos(angle), std::sin(angle)};
      if (open.pieces().back().by > q.y) add(q);
    }
  }
  return points;
}

TEST(Sdf, OfAShellIsTheWall) {
  for (const VesselData& solid : {beaker1(), beaker2(), beaker3(), vase()}) {
    const VesselData data = shell_of(solid);
    const Vessel vessel = ready_vessel(data);
    const PreparedVessel prepared = prepare_vessel(data, true);
    const Sampled hull(pieces_of(data), FEWER_SAMPLES), open(open_pieces(data), FEWER_SAMPLES);
    EXPECT_EQ(vessel.lid, -1);
    const double outer = data.outline[data.outline.size() - 2].end[0], inner = prepared.mouth_radius;
    Random random(5);
    int in_wall = 0, in_cavity = 0, outside = 0;
    std::vector<Vec2> points;
    for (int i = 0; i < 150; ++i) points.push_back(point_in_box(data, random));
    for (int i = 0; i < 300; ++i) {
      const Piece& piece = open.pieces()[static_cast<std::size_t>(random.uniform(0, static_cast<double>(open.pieces().size())))];
      const double t = random.uniform(0, 1);
      const Vec2 q = piece.at(t) - random.uniform(0, 2 * data.wall) * piece.normal(t);
      if (q.x > 0) points.push_back(q);
    }
    for (const Vec2& q : points) {
      const double sdf = core_f64::profile_distance(vessel, q);
      const double to_open = open.distance(q);
      // the rim: level with the mouth, from the inner wall to the outer one
      const double to_rim = std::hypot(std::max({inner - q.x, 0.0, q.x - outer}), q.y - data.height);
      const std::string where = data.name + " at " + std::to_string(q.x) + ", " + std::to_string(q.y);
      if (!hull.inside(q)) {  // none of these points is within a sample's sagitta of the hull by chance
        if (q.y > data.height && q.x < outer) {
          // over the mouth the nearest may be anywhere on the inner wall too: no further than the rim, and outside
          ASSERT_GT(sdf, 0) << where;
          ASSERT_LE(sdf, to_rim + 1e-9) << where;
        } else {
          ++outside;
          ASSERT_NEAR(sdf, std::min(to_open, to_rim), 1e-9) << where;  // 1e-9 m: the specification's for offsets
        }
      } else if (to_open > data.wall + 1e-9) {
        // in the cavity: from the nearest point of the outline, the last `to_open - wall` of the way is free
        ++in_cavity;
        ASSERT_NEAR(sdf, std::min(to_open - data.wall, to_rim), 1e-9) << where;
      } else if (to_open < data.wall - 1e-9) {
        ++in_wall;
        ASSERT_LT(sdf, 0) << where;
        // the inner wall is no nearer than wall - to_open, and just that far where it was not cut at a corner
        ASSERT_GE(-sdf, std::min({to_open, data.wall - to_open, to_rim}) - 1e-9) << where;
        ASSERT_LE(-sdf, std::min(to_open, to_rim) + 1e-9) << where;
      }
    }
    EXPECT_GT(in_wall, 100) << data.name;
    EXPECT_GT(in_cavity, 50) << data.name;
    EXPECT_GT(outside, 50) << data.name;
  }
}

TEST(Sdf, InsideTheWallOfAShellIsBruteForce) {
  for (const VesselData& solid : {beaker1(), beaker3(), vase()}) {
    const VesselData data = shell_of(solid);
    const Vessel vessel = ready_vessel(data);
    const Sampled open(open_pieces(data), FEWER_SAMPLES);
    const std::vector<Vec2> inner = inner_points(data, open);
    const double outer = data.outline[data.outline.size() - 2].end[0];
    Random random(6);
    int compared = 0;
    for (int i = 0; i < 300; ++i) {
      const Piece& piece = open.pieces()[static_cast<std::size_t>(random.uniform(0, static_cast<double>(open.pieces().size())))];
      const double t = random.uniform(0, 1);
      const Vec2 q = piece.at(t) - random.uniform(0.05, 0.95) * data.wall * piece.normal(t);
      if (q.x <= 0 || q.y > data.height - data.wall) continue;  // the rim has its own formula above
      double to_inner = 1e300;
      for (const Vec2& p : inner) to_inner = std::min(to_inner, glm::distance(p, q));
      const double to_outer = open.distance(q);
      const double expected = std::min({to_outer, to_inner, std::hypot(std::max(q.x - outer, 0.0), data.height - q.y)});
      // 1e-4 m: samples are 50 um apart, and the cut at a corner falls between two of them
      ASSERT_NEAR(-core_f64::profile_distance(vessel, q), expected, 1e-4) << data.name << " at " << q.x << ", " << q.y;
      ++compared;
    }
    EXPECT_GT(compared, 150);
  }
}

// ---- gradient ----

TEST(Sdf, GradientIsItsDifferenceQuotient) {
  // central differences over h = 1e-7 m: h^2 / (6 d^2) < 1e-8 at d > 0.5 mm from the surface, rounding 1e-17 / h = 1e-10
  const double h = 1e-7;
  for (const VesselData& data : {beaker1(), beaker2(), beaker3(), vase(), ledges(), shell_of(vase())}) {
    const Vessel vessel = ready_vessel(data);
    Random random(7);
    int compared = 0, creases = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec2 q = point_in_box(data, random);
      const Vec3 p = around(q, random.uniform(-PI, PI));
      if (std::abs(core_f64::signed_distance(vessel, p)) < 0.5e-3 || q.x < 0.5e-3) continue;
      const auto at = [&](Vec3 step) { return core_f64::signed_distance(vessel, p + h * step); };
      Vec3 forward, backward;
      for (int k = 0; k < 3; ++k) {
        Vec3 axis{};
        axis[k] = 1;
        forward[k] = (at(axis) - at({})) / h;
        backward[k] = (at({}) - at(-axis)) / h;
      }
      if (glm::distance(forward, backward) > 1e-2) {  // a medial surface passes between: no gradient there
        ++creases;
        continue;
      }
      int element = -1;
      ASSERT_LT(glm::distance(core_f64::distance_gradient(vessel, p, element), (forward + backward) / 2.0), 1e-7)
          << data.name << " at " << q.x << ", " << q.y;
      ++compared;
    }
    EXPECT_GT(compared, 3000) << data.name;
    EXPECT_LT(creases, 4) << data.name;  // at most 1 in 1,000
  }
}

TEST(Sdf, GradientIsTheWayToTheNearestPoint) {
  // moving by the distance against the gradient ends on the surface, away from the medial axis as on it
  for (const VesselData& data : {beaker1(), beaker2(), beaker3(), vase(), ledges(), shell_of(beaker3())}) {
    const Vessel vessel = ready_vessel(data);
    Random random(8);
    for (int i = 0; i < 3000; ++i) {
      const Vec3 p = around(point_in_box(data, random), random.uniform(-PI, PI));
      int element = -1;
      const double sdf = core_f64::signed_distance(vessel, p);
      const Vec3 foot = p - sdf * core_f64::distance_gradient(vessel, p, element);
      ASSERT_NEAR(core_f64::signed_distance(vessel, foot), 0, 1e-15) << data.name;  // a normalisation and a product: a few 1e-17 m
    }
  }
}

TEST(Sdf, GradientOnTheSurfaceIsTheOutwardNormal) {
  for (const VesselData& data : solids()) {
    const Vessel vessel = ready_vessel(data);
    for (const Piece& piece : pieces_of(data)) {
      for (const double t : {0.05, 0.3, 0.5, 0.77, 0.98}) {
        // within 10 um of it the way to the nearest point has lost its digits: the element's own normal has not
        for (const double off : {0.0, 1e-17, -1e-17, 1e-14, -1e-14, 1e-11, -1e-11, 1e-8, -1e-8, 1e-6, -1e-6}) {
          const Vec2 normal = piece.normal(t);
          int element = -1;
          const Vec2 g = core_f64::profile_gradient(vessel, piece.at(t) + off * normal, element);
          // 1e-12: 1e-17 m of rounding over arcs of millimetres and elements of millimetres
          ASSERT_LT(glm::distance(g, normal), 1e-12) << data.name << ", off by " << off;
        }
      }
    }
  }
}

TEST(Sdf, GradientOfAShellPointsOutOfTheWallOnBothSides) {
  const Vessel vessel = ready_vessel(shell_of(beaker1()));  // wall from r = 38.5 to 40 mm
  int element = -1;
  for (const double y : {20e-3, 55e-3, 100e-3}) {
    EXPECT_LT(glm::distance(core_f64::distance_gradient(vessel, {40e-3, y, 0}, element), {1, 0, 0}), 1e-12);
    EXPECT_LT(glm::distance(core_f64::distance_gradient(vessel, {38.5e-3, y, 0}, element), {-1, 0, 0}), 1e-12);
    EXPECT_LT(glm::distance(core_f64::distance_gradient(vessel, {0, y, 39.9e-3}, element), {0, 0, 1}), 1e-12);
    EXPECT_LT(glm::distance(core_f64::distance_gradient(vessel, {0, y, -38.6e-3}, element), {0, 0, 1}), 1e-12);
    EXPECT_LT(glm::distance(core_f64::distance_gradient(vessel, {0, y, -30e-3}, element), {0, 0, 1}), 1e-12);
  }
  EXPECT_LT(glm::distance(core_f64::distance_gradient(vessel, {0, 1.5e-3, 0.1e-3}, element), {0, 1, 0}), 1e-12);  // inner floor
  EXPECT_LT(glm::distance(core_f64::distance_gradient(vessel, {0, 0, 0}, element), {0, -1, 0}), 1e-12);
}

TEST(Sdf, RadialDirectionOnTheAxisIsX) {
  for (const VesselData& data : {beaker1(), beaker2(), vase(), ledges(), shell_of(beaker1())}) {
    const Vessel vessel = ready_vessel(data);
    int radial = 0;
    for (int i = -20; i <= 120; ++i) {
      const double y = data.height * i / 100;
      int element = -1, same = -1;
      const Vec2 profile = core_f64::profile_gradient(vessel, {0, y}, element);
      const Vec3 g = core_f64::distance_gradient(vessel, {0, y, 0}, same);
      EXPECT_EQ(g, (Vec3{profile.x, profile.y, 0})) << data.name << " at height " << y;
      EXPECT_EQ(element, same);
      if (std::abs(g.x) > 0.5) ++radial;
    }
    EXPECT_GT(radial, 10) << data.name;  // somewhere the wall is nearest, and every direction as good
  }
}

TEST(Sdf, OfEquallyNearElementsTheFirstDecides) {
  // a cylinder of radius 2 and height 8 in whole numbers, so that ties are exact
  Vessel vessel;
  vessel.outline = {line_element({0, 0}, {2, 0}), line_element({2, 0}, {2, 8}), line_element({2, 8}, {0, 8})};
  int element = -1;
  EXPECT_EQ(core_f64::profile_gradient(vessel, {1, 1}, element), (Vec2{0, -1}));  // base and wall
  EXPECT_EQ(element, 0);
  EXPECT_EQ(core_f64::profile_gradient(vessel, {1, 7}, element), (Vec2{1, 0}));  // wall and mouth
  EXPECT_EQ(element, 1);
  EXPECT_EQ(core_f64::profile_gradient(vessel, {2, 0}, element), (Vec2{0, -1}));  // on their corner
  EXPECT_EQ(element, 0);
  core_f64::profile_gradient(vessel, {5, 12}, element);  // beyond the corner of wall and mouth
  EXPECT_EQ(element, 1);
  Vessel reordered = vessel;
  std::swap(reordered.outline[0], reordered.outline[1]);
  EXPECT_EQ(core_f64::profile_gradient(reordered, {1, 1}, element), (Vec2{1, 0}));
  EXPECT_EQ(element, 0);
}

// ---- crossings ----

TEST(Sdf, CrossingsAreHalfOpen) {
  const Element rising = line_element({1, 0}, {1, 2}), falling = line_element({1, 2}, {1, 0}),
                slanted = line_element({1, 0}, {3, 2}), level = line_element({1, 1}, {3, 1});
  for (const Element& element : {rising, falling, slanted}) {
    EXPECT_TRUE(core_f64::element_crosses(element, {0, 0}));  // counts for y in [min, max)
    EXPECT_TRUE(core_f64::element_crosses(element, {0, 1}));
    EXPECT_FALSE(core_f64::element_crosses(element, {0, 2}));
    EXPECT_FALSE(core_f64::element_crosses(element, {0, -1e-9}));
    EXPECT_FALSE(core_f64::element_crosses(element, {4, 1}));
  }
  EXPECT_TRUE(core_f64::element_crosses(slanted, {1.5, 1}));
  EXPECT_FALSE(core_f64::element_crosses(slanted, {2.5, 1}));
  for (const double r : {0.0, 1.0, 2.0, 5.0}) EXPECT_FALSE(core_f64::element_crosses(level, {r, 1}));
}

TEST(Sdf, CrossingsOfArcsAreHalfOpen) {
  // quarter circles of radius 5 about (6, 0): 3, 4, 5 gives exact points
  const Element right{{11, 0}, {6, 5}, {6, 0}, 5, 1}, left{{6, 5}, {1, 0}, {6, 0}, 5, -1};
  EXPECT_TRUE(core_f64::element_crosses(right, {0, 0}));
  EXPECT_FALSE(core_f64::element_crosses(right, {0, 5}));
  EXPECT_TRUE(core_f64::element_crosses(right, {9.9, 3}));  // crossing at r = 10
  EXPECT_FALSE(core_f64::element_crosses(right, {10.1, 3}));
  EXPECT_TRUE(core_f64::element_crosses(left, {1.9, 3}));  // crossing at r = 2
  EXPECT_FALSE(core_f64::element_crosses(left, {2.1, 3}));
  EXPECT_FALSE(core_f64::element_crosses(left, {0, -1}));
}

TEST(Sdf, SignDoesNotFlipLevelWithTheEndOfAnElement) {
  for (const VesselData& data : {beaker1(), beaker2(), beaker3(), vase(), ledges(), shell_of(vase())}) {
    const Vessel vessel = ready_vessel(data);
    int compared = 0;
    for (const Element& element : vessel.outline) {
      for (const double level : {element.a.y, element.b.y}) {
        for (int i = 0; i <= 120; ++i) {
          const double r = i * 0.5e-3 + 0.1e-3;
          const double sdf = core_f64::profile_distance(vessel, {r, level});
          if (std::abs(sdf) < 1e-6) continue;  // on a level element
          // within the distance to the surface nothing can change its sign
          for (const double off : {-0.9 * std::abs(sdf), -1e-9, 1e-9, 0.9 * std::abs(sdf)}) {
            const double beside = core_f64::profile_distance(vessel, {r, level + off});
            ASSERT_GT(sdf * beside, 0) << data.name << " at " << r << ", " << level;
            ++compared;
          }
        }
      }
    }
    EXPECT_GT(compared, 900);
  }
}

// ---- elements ----

TEST(Sdf, DistanceToALine) {
  // 1e-15: rounding of numbers under 100
  const Element line = line_element({1, 1}, {5, 4});
  EXPECT_NEAR(core_f64::element_distance_squared(line, {3, 2.5}), 0, 1e-15);
  EXPECT_NEAR(core_f64::element_distance_squared(line, {3 - 3, 2.5 + 4}), 25, 1e-13);  // beside it
  EXPECT_NEAR(core_f64::element_distance_squared(line, {3 + 1.5, 2.5 - 2}), 6.25, 1e-14);
  EXPECT_NEAR(core_f64::element_distance_squared(line, {0, 0}), 2, 1e-15);   // before its start
  EXPECT_NEAR(core_f64::element_distance_squared(line, {8, 8}), 25, 1e-13);  // beyond its end
}

TEST(Sdf, DistanceToAnArc) {
  const Element right{{11, 0}, {6, 5}, {6, 0}, 5, 1};
  EXPECT_NEAR(core_f64::element_distance_squared(right, {9, 4}), 0, 1e-13);    // on it: 3, 4, 5; the root of 25 and back
  EXPECT_NEAR(core_f64::element_distance_squared(right, {12, 8}), 25, 1e-13);  // twice as far from the centre
  EXPECT_NEAR(core_f64::element_distance_squared(right, {6, 0}), 25, 1e-13);   // its centre
  EXPECT_NEAR(core_f64::element_distance_squared(right, {7.5, 2}), 6.25, 1e-13);
  EXPECT_NEAR(core_f64::element_distance_squared(right, {11, -3}), 9, 1e-13);  // nearest its start
  EXPECT_NEAR(core_f64::element_distance_squared(right, {2, 5}), 16, 1e-13);   // nearest its end, not the circle's other side
  EXPECT_NEAR(core_f64::element_distance_squared(right, {2, -3}), 80, 1e-12);  // opposite: its nearer end, (6, 5)
}

TEST(Sdf, ArcsAreSplitAtThePolesOfTheirCircles) {
  const auto elements = monotone_elements(ledges().outline);
  EXPECT_EQ(elements.size(), 14u);  // twelve, and the trough and the bump in two each
  for (const VesselData& data : solids()) {
    const auto parts = monotone_elements(data.outline);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const PreparedElement& part = parts[i];
      if (i > 0) {
        EXPECT_EQ(part.a, parts[i - 1].b) << data.name;
      }
      EXPECT_NE(part.a, part.b) << data.name;  // nothing of no length where an arc starts or ends at a pole
      if (part.side == 0) continue;
      // both ends on its half of the circle, so y is monotone between them
      EXPECT_GE(part.side * (part.a[0] - part.center[0]), -1e-15) << data.name;
      EXPECT_GE(part.side * (part.b[0] - part.center[0]), -1e-15) << data.name;
      for (const auto& end : {part.a, part.b}) {
        EXPECT_NEAR(std::hypot(end[0] - part.center[0], end[1] - part.center[1]), part.radius,
                    1e-15);  // rounding of coordinates under 0.2 m
      }
    }
    EXPECT_EQ(parts.front().a, (std::array<double, 2>{0, 0}));
    EXPECT_EQ(parts.back().b, (std::array<double, 2>{0, data.height}));
  }
}

TEST(Sdf, BoundingSphereHoldsTheVessel) {
  for (const VesselData& data : {beaker1(), beaker2(), beaker3(), vase(), ledges(), shell_of(vase())}) {
    const Vessel vessel = ready_vessel(data);
    for (const Piece& piece : pieces_of(data)) {
      for (int i = 0; i <= 100; ++i) {
        const Vec2 q = piece.at(i / 100.0);
        EXPECT_LE(std::hypot(q.x, q.y - vessel.bound_height), vessel.bound_radius + 1e-15) << data.name;  // rounding
      }
    }
    EXPECT_LT(vessel.bound_radius, 2 * std::hypot(largest_radius(data), data.height));  // and not much more
  }
}

Vessel grid_vessel(const Vessel& outline, int samples) {
  Vessel vessel = outline;
  vessel.grid = core_f64::sample_grid(outline, samples);
  vessel.is_grid = true;
  return vessel;
}

// ---- what surrounds a point: how far it may go without passing a surface ----

// A point of an outline's element swept round the axis.
Vec3 swept(const Element& element, double t, double azimuth) {
  Vec2 q{element.a.x + t * (element.b.x - element.a.x), element.a.y + t * (element.b.y - element.a.y)};
  if (element.side != 0) {
    const double chord = q.y - element.center.y;
    q.x = element.center.x + element.side * std::sqrt(std::max(0.0, element.radius * element.radius - chord * chord));
  }
  return around(q, azimuth);
}

TEST(Sdf, SupportIsTheDistanceAndItsGradient) {
  for (const VesselData& data : {beaker1(), vase(), ledges(), shell_of(vase())}) {
    const Vessel vessel = ready_vessel(data), grid = grid_vessel(vessel, 16);
    Random random(14);
    for (int n = 0; n < 1000; ++n) {
      const Vec3 p = around(point_in_box(data, random), random.uniform(-PI, PI));
      for (const Vessel* each : {&vessel, &grid}) {
        const core_f64::Support support = core_f64::support_at(*each, p);
        int element = -2;
        EXPECT_EQ(support.distance, core_f64::signed_distance(*each, p));
        EXPECT_EQ(support.normal, core_f64::distance_gradient(*each, p, element));
        EXPECT_EQ(support.element, element);
      }
      EXPECT_FALSE(core_f64::support_at(grid, p).planar);
    }
  }
}

TEST(Sdf, SupportingPlaneHasTheNearestElementBeyondIt) {
  for (const VesselData& data : {beaker1(), beaker2(), beaker3(), vase(), ledges(), shell_of(beaker1()), shell_of(vase())}) {
    const Vessel vessel = ready_vessel(data);
    Random random(15);
    int planar = 0, outside = 0;
    std::vector<Vec3> points;
    for (int n = 0; n < 1500; ++n) points.push_back(around(point_in_box(data, random), random.uniform(-PI, PI)));
    for (const Vec2& q : queries(data, pieces_of(data), 0, 16)) points.push_back(around(q, random.uniform(-PI, PI)));
    for (const Vec3& p : points) {
      if (std::abs(p.x) > 0.5 || std::abs(p.y) > 0.5) continue;
      const core_f64::Support support = core_f64::support_at(vessel, p);
      outside += support.distance > 0;
      planar += support.planar;
      if (!support.planar || support.distance < 1e-12) continue;  // on the surface there is no step to bound
      ASSERT_GE(support.distance, 0);
      const auto nearest = static_cast<std::size_t>(support.element);
      for (std::size_t e = 0; e < vessel.outline.size(); ++e) {
        const Element& element = vessel.outline[e];
        for (int i = 0; i <= 8; ++i) {
          for (int k = 0; k < 12; ++k) {
            const Vec3 x = swept(element, i / 8.0, std::atan2(p.z, p.x) + k * PI / 6);
            // 1e-15 m: rounding
            const bool beyond = glm::dot(x - p, support.normal) <= -support.distance + 1e-15;
            const bool away = glm::distance(x, p) >= support.other - 1e-15;
            if (e == nearest) {
              ASSERT_TRUE(beyond) << data.name << ", element " << e << " at " << p.x << ", " << p.y << ", " << p.z;
            } else {
              ASSERT_TRUE(away || beyond) << data.name << ", element " << e << " at " << p.x << ", " << p.y << ", " << p.z;
            }
          }
        }
      }
    }
    EXPECT_GT(planar, outside / 4) << data.name;
  }
}

TEST(Sdf, SupportKnowsOfAnElementThatIsAsNear) {
  // in the corner of a level ledge and a wall, in whole numbers: one away from both, and their shared end is further
  Vessel vessel;
  vessel.outline = {line_element({0, 0}, {3, 0}), line_element({3, 0}, {3, 2}), line_element({3, 2}, {1, 2}),
                    line_element({1, 2}, {1, 8}), line_element({1, 8}, {0, 8})};
  const core_f64::Support support = core_f64::support_at(vessel, {2, 3, 0});
  EXPECT_EQ(support.element, 2);
  EXPECT_EQ(support.distance, 1);
  EXPECT_EQ(support.other, 1);
  EXPECT_LE(core_f64::safe_step(support, 1, {-1, 0, 0}, 1, 0), 1);  // along the ledge it would never meet the ledge
  // off the ledge's outer edge the edge stands for both that meet there, and the wall is the next
  const core_f64::Support edge = core_f64::support_at(vessel, {6, 6, 0});
  EXPECT_EQ(edge.element, 1);
  EXPECT_TRUE(edge.planar);
  EXPECT_EQ(edge.distance, 5);
  EXPECT_EQ(edge.other, 5);
}

TEST(Sdf, SafeStepPassesNoSurface) {
  // points on straight lines and on circles: nowhere along a step does the separation change its sign
  for (const VesselData& data : {beaker1(), beaker2(), beaker3(), vase(), ledges(), shell_of(beaker1()), shell_of(vase())}) {
    const Vessel vessel = ready_vessel(data);
    Random random(17);
    int steps = 0, longer = 0;
    for (int n = 0; n < 4000; ++n) {
      const Vec3 p = around(point_in_box(data, random), random.uniform(-PI, PI));
      const core_f64::Support support = core_f64::support_at(vessel, p);
      const double radius = n % 4 == 0 ? 0 : std::min(8e-3, support.distance * random.uniform(0, 1));
      const double separation = support.distance - radius;
      if (separation <= 1e-9) continue;
      Vec3 velocity = glm::normalize(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
      if (n % 3 == 0) velocity = glm::normalize(velocity - 2.0 * support.normal);  // towards the wall
      // a circle of radius 60 mm by angle, or a line by length
      const bool turns = n % 2;
      const double reach = 60e-3, speed = turns ? reach : 1, acceleration = turns ? reach : 0;
      const Vec3 inwards = glm::normalize(glm::cross(velocity, Vec3{0.3, -0.5, 0.8}));
      const Vec3 center = p + reach * inwards;
      const auto at = [&](double s) {
        return turns ? center - reach * std::cos(s) * inwards + reach * std::sin(s) * velocity : p + s * velocity;
      };
      const double step = core_f64::safe_step(support, separation, speed * velocity, speed, acceleration);
      ASSERT_GE(step, separation / speed * (1 - 1e-12));
      ++steps;
      longer += step > 1.01 * separation / speed;
      const double end = std::min(step, turns ? PI : 1.0);
      for (int i = 1; i <= 50; ++i) {
        // 1e-12 m: rounding of a root over the step, where it ends on the surface
        ASSERT_GE(core_f64::signed_distance(vessel, at(end * i / 50)) - radius, -1e-12)
            << data.name << " from " << p.x << ", " << p.y << ", " << p.z;
      }
    }
    EXPECT_GT(steps, 1000) << data.name;
    EXPECT_GT(longer, steps / 10) << data.name;  // it does gain something over separation / speed
  }
}

TEST(Sdf, SafeStepOfAPointAtRestIsUnbounded) {
  core_f64::Support support;
  support.distance = 1e-3;
  EXPECT_GT(core_f64::safe_step(support, 1e-3, {}, 0, 0), 1e6);
}

// ---- lattice ----

Vec3 lattice_point(const core_f64::Grid& grid, double i, double j, double k) { return grid.origin + grid.spacing * Vec3{i, j, k}; }

TEST(Sdf, GridHoldsTheDistanceAtItsSamples) {
  const Vessel outline = ready_vessel(vase()), vessel = grid_vessel(outline, 24);
  const core_f64::Grid& grid = vessel.grid;
  ASSERT_EQ(grid.samples.size(), static_cast<std::size_t>(grid.nx * grid.ny * grid.nz));
  for (int k = 0; k < grid.nz; ++k) {
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        const Vec3 p = lattice_point(grid, i, j, k);
        // 1e-15 m: the place of a sample is rounded to 1e-17 m, its cell coordinates to 1e-15
        ASSERT_NEAR(core_f64::signed_distance(vessel, p), core_f64::signed_distance(outline, p), 1e-15)
            << i << " " << j << " " << k;
      }
    }
  }
}

TEST(Sdf, GridIsTrilinearBetweenItsSamples) {
  const Vessel vessel = grid_vessel(ready_vessel(vase()), 24);
  const core_f64::Grid& grid = vessel.grid;
  Random random(9);
  for (int n = 0; n < 1000; ++n) {
    const int i = static_cast<int>(random.uniform(0, grid.nx - 1)), j = static_cast<int>(random.uniform(0, grid.ny - 1)),
              k = static_cast<int>(random.uniform(0, grid.nz - 1));
    const double u = random.uniform(0, 1), v = random.uniform(0, 1), w = random.uniform(0, 1);
    double expected = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const int di = corner & 1, dj = corner >> 1 & 1, dk = corner >> 2;
      const auto index = static_cast<std::size_t>(((k + dk) * grid.ny + j + dj) * grid.nx + i + di);
      expected += (di ? u : 1 - u) * (dj ? v : 1 - v) * (dk ? w : 1 - w) * grid.samples[index];
    }
    ASSERT_NEAR(core_f64::signed_distance(vessel, lattice_point(grid, i + u, j + v, k + w)), expected, 1e-15);  // as above
  }
}

TEST(Sdf, GridReachesTwoCellsBeyondTheVessel) {
  const VesselData data = beaker3();
  const core_f64::Grid grid = core_f64::sample_grid(ready_vessel(data), 24);
  const Vec3 low = grid.origin, high = lattice_point(grid, grid.nx - 1, grid.ny - 1, grid.nz - 1);
  const double r = largest_radius(data), reach = 2 * grid.spacing - 1e-12;
  EXPECT_LE(low.x, -r - reach);
  EXPECT_LE(low.y, -reach);
  EXPECT_LE(low.z, -r - reach);
  EXPECT_GE(high.x, r + reach);
  EXPECT_GE(high.y, data.height + reach);
  EXPECT_GE(high.z, r + reach);
}

TEST(Sdf, GridOutsideItsBoxIsTheClampedValueAndTheWayToTheBox) {
  const Vessel outline = ready_vessel(beaker3()), vessel = grid_vessel(outline, 32);
  const core_f64::Grid& grid = vessel.grid;
  const Vec3 low = grid.origin, high = lattice_point(grid, grid.nx - 1, grid.ny - 1, grid.nz - 1);
  Random random(10);
  int compared = 0;
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p{random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.6), random.uniform(-0.4, 0.4)};
    const Vec3 clamped = glm::clamp(p, low, high);
    if (p == clamped) continue;
    ++compared;
    const double sdf = core_f64::signed_distance(vessel, p);
    ASSERT_NEAR(sdf, core_f64::signed_distance(vessel, clamped) + glm::distance(p, clamped), 1e-15);  // rounding
    // the two ways meet at a right angle at most, so their sum lies between the true distance and 2^(1/2) of it; interpolation is
    // off by spacing^2 / 8 times the curvature of the distance, at most 1 / (2 spacing) two cells off: a 16th of a cell
    const double exact = core_f64::signed_distance(outline, p);
    ASSERT_GE(sdf, exact - grid.spacing / 16) << p.x << " " << p.y << " " << p.z;
    ASSERT_LE(sdf, std::sqrt(2.0) * exact + grid.spacing / 16) << p.x << " " << p.y << " " << p.z;
  }
  EXPECT_GT(compared, 10000);
}

TEST(Sdf, GridIsContinuousAtItsBox) {
  const Vessel vessel = grid_vessel(ready_vessel(vase()), 24);
  const core_f64::Grid& grid = vessel.grid;
  for (const Vec3 p :
       {lattice_point(grid, 0, 3.3, 4.1), lattice_point(grid, grid.nx - 1, 3.3, 4.1), lattice_point(grid, 2.5, 0, 6.2),
        lattice_point(grid, 2.5, grid.ny - 1, 6.2), lattice_point(grid, 7.7, 3.3, 0), lattice_point(grid, 7.7, 3.3, grid.nz - 1),
        lattice_point(grid, 0, 0, 0), lattice_point(grid, grid.nx - 1, grid.ny - 1, grid.nz - 1)}) {
    const double here = core_f64::signed_distance(vessel, p);
    for (int k = 0; k < 6; ++k) {
      Vec3 step{};
      step[k / 2] = k % 2 ? 1e-9 : -1e-9;
      ASSERT_NEAR(core_f64::signed_distance(vessel, p + step), here, 1e-8);  // 1e-9 m away, by a slope of a few at most
    }
  }
}

TEST(Sdf, GridGradientIsItsDifferenceQuotient) {
  const Vessel vessel = grid_vessel(ready_vessel(vase()), 24);
  const core_f64::Grid& grid = vessel.grid;
  const double h = 1e-7;
  Random random(12);
  for (int n = 0; n < 2000; ++n) {
    // inside a cell; across its faces the slope jumps
    const auto coordinate = [&random](int count) { return std::floor(random.uniform(0, count - 1)) + random.uniform(0.01, 0.99); };
    const Vec3 p = lattice_point(grid, coordinate(grid.nx), coordinate(grid.ny), coordinate(grid.nz));
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

TEST(Sdf, GridGradientOutsideItsBoxIsUnitAndPointsAway) {
  const Vessel vessel = grid_vessel(ready_vessel(beaker1()), 24);
  for (const Vec3 p : {Vec3{0.5, 0.05, 0}, Vec3{0, 0.05, -0.5}, Vec3{0, 1, 0}, Vec3{0.3, -0.4, 0.2}}) {
    int element = 0;
    const Vec3 g = core_f64::distance_gradient(vessel, p, element);
    EXPECT_NEAR(glm::length(g), 1, 1e-12);
    EXPECT_GT(glm::dot(g, glm::normalize(p - Vec3{0, 0.055, 0})), 0.5);
  }
}

TEST(Sdf, GridGradientIsXWhereItVanishes) {
  Vessel vessel;
  vessel.is_grid = true;
  vessel.grid = {{0, 0, 0}, 1, 2, 2, 2, std::vector<double>(8, 0.25)};
  int element = 0;
  EXPECT_EQ(core_f64::distance_gradient(vessel, {0.5, 0.5, 0.5}, element), (Vec3{1, 0, 0}));
  EXPECT_EQ(core_f64::signed_distance(vessel, {0.5, 0.5, 0.5}), 0.25);
}

TEST(Sdf, GridErrorFallsWithTheSquareOfItsSpacing) {
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
    const Vessel vessel = grid_vessel(outline, samples);
    double largest = 0;
    for (const Vec3& p : points)
      largest = std::max(largest, std::abs(core_f64::signed_distance(vessel, p) - core_f64::signed_distance(outline, p)));
    worst.push_back(largest);
    spacing.push_back(vessel.grid.spacing);
  }
  for (std::size_t i = 1; i < worst.size(); ++i) {
    const double order = std::log(worst[i - 1] / worst[i]) / std::log(spacing[i - 1] / spacing[i]);
    EXPECT_NEAR(order, 2, 0.3) << worst[i - 1] << " m, " << worst[i]
                               << " m";  // the worst place in a cell differs from lattice to lattice
  }
}

// ---- inner offset ----

void expect_cavity_at_wall(const VesselData& data) {
  const PreparedVessel prepared = prepare_vessel(data, true);
  const Sampled open(open_pieces(data), FEWER_SAMPLES), hull(pieces_of(data), FEWER_SAMPLES);
  ASSERT_FALSE(prepared.cavity.empty()) << data.name;
  EXPECT_NEAR(prepared.cavity.front().a[1], prepared.floor_height, 1e-12);  // a level floor is no piece of r(y)
  EXPECT_NEAR(open.distance({0, prepared.floor_height}), data.wall, 1e-12) << data.name;
  EXPECT_NEAR(prepared.cavity.back().b[0], prepared.mouth_radius, 1e-12);
  EXPECT_NEAR(prepared.cavity.back().b[1], data.height, 1e-12);
  EXPECT_EQ(prepared.mouth_height, data.height);
  for (std::size_t i = 0; i < prepared.cavity.size(); ++i) {
    const PreparedElement& element = prepared.cavity[i];
    EXPECT_LE(element.a[1], element.b[1]) << data.name;  // y ascending
    if (i > 0) {
      // 1e-8 m: at an arc's pole r is the root of a rounding, (2 x 30 mm x 1e-17 m)^(1/2) and its few units
      EXPECT_NEAR(element.a[0], prepared.cavity[i - 1].b[0], 1e-8) << data.name << ", piece " << i;
      EXPECT_NEAR(element.a[1], prepared.cavity[i - 1].b[1], 1e-12) << data.name << ", piece " << i;
    }
    for (int n = 0; n <= 40; ++n) {
      const double t = n / 40.0;
      Vec2 q{element.a[0] + t * (element.b[0] - element.a[0]), element.a[1] + t * (element.b[1] - element.a[1])};
      if (element.side != 0) {
        const double chord = q.y - element.center[1];
        q.x = element.center[0] + element.side * std::sqrt(std::max(0.0, element.radius * element.radius - chord * chord));
      }
      // 1e-9 m: the specification's; at an arc's pole a rounding of y alone moves r by the root of it, but not the distance
      ASSERT_NEAR(open.distance(q), data.wall, 1e-9) << data.name << ", piece " << i << " at " << q.x << ", " << q.y;
      if (n > 0 && n < 40) {
        ASSERT_TRUE(q.x < 1e-6 || hull.inside({q.x, std::min(q.y, data.height - 1e-9)})) << data.name;
      }
    }
  }
}

TEST(Sdf, CavityIsAWallAwayFromTheOpenOutline) {
  for (const VesselData& data : {beaker1(), beaker2(), beaker3(), vase(), scaled(vase(), 2.7)}) expect_cavity_at_wall(data);
}

TEST(Sdf, CavityOfAThickWallStillIsAWallAway) {
  // the fillet of the foot (6 mm) and the bead (4 mm) are gone from the inside
  for (const double wall : {3e-3, 5e-3, 8e-3}) {
    VesselData data = vase();
    data.wall = wall;
    expect_cavity_at_wall(data);
  }
}

TEST(Sdf, CavityRadiusAgreesWithBisection) {
  for (const VesselData& data : {beaker2(), beaker3(), vase()}) {
    const PreparedVessel prepared = prepare_vessel(data, true);
    const Sampled open(open_pieces(data), FEWER_SAMPLES);
    for (const double fraction : {0.05, 0.31, 0.5, 0.64, 0.93, 1.0}) {
      const double y = prepared.floor_height + fraction * (data.height - prepared.floor_height);
      double cavity = -1;
      for (const PreparedElement& element : prepared.cavity) {
        if (y < element.a[1] || y > element.b[1] || element.a[1] == element.b[1]) continue;
        const double chord = y - element.center[1];
        cavity = element.side == 0
                     ? element.a[0] + (element.b[0] - element.a[0]) * (y - element.a[1]) / (element.b[1] - element.a[1])
                     : element.center[0] + element.side * std::sqrt(element.radius * element.radius - chord * chord);
      }
      double high = 0.1e-3;  // from the axis outwards to the first place that is nearer than the wall
      while (open.distance({high, y}) > data.wall) high += 0.1e-3;
      double low = high - 0.1e-3;
      for (int step = 0; step < 50; ++step) {
        const double middle = (low + high) / 2;
        (open.distance({middle, y}) > data.wall ? low : high) = middle;
      }
      EXPECT_NEAR(cavity, low, 1e-9) << data.name << " at " << y;
    }
  }
}

TEST(Sdf, CavityOfACylinderInClosedForm) {
  const PreparedVessel prepared = prepare_vessel(beaker1(), true);
  EXPECT_NEAR(prepared.floor_height, 1.5e-3, 1e-15);  // rounding
  EXPECT_NEAR(prepared.mouth_radius, 38.5e-3, 1e-15);
  EXPECT_EQ(prepared.mouth_height, 110e-3);
  EXPECT_EQ(prepared.lid, static_cast<int>(prepared.outline.size()) - 1);
}

std::string refusal(const VesselData& vessel) {
  try {
    prepare_vessel(vessel, true);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    return error.what();
  }
  return "";
}

TEST(Sdf, WallThickerThanTheRadiusIsRefused) {
  for (const double wall : {40e-3, 41e-3, 0.2}) {
    VesselData vessel = beaker1();
    vessel.wall = wall;
    EXPECT_NE(refusal(vessel).find("beaker1"), std::string::npos) << wall;
  }
  VesselData vessel = beaker1();
  vessel.wall = 39.9e-3;  // a bore is left
  EXPECT_EQ(refusal(vessel), "");
}

TEST(Sdf, WallThickerThanTheHeightIsRefused) {
  VesselData dish = cylinder("dish", 120, 20, 20);
  EXPECT_NE(refusal(dish).find("dish"), std::string::npos);
  dish.wall = 19e-3;
  EXPECT_EQ(refusal(dish), "");
}

TEST(Sdf, WallThatClosesTheNeckIsRefused) {
  for (VesselData vessel : {beaker2(), beaker3()}) {
    vessel.wall = 17.5e-3;  // the neck's radius is 17 mm, the body's 42.5
    EXPECT_NE(refusal(vessel).find(vessel.name), std::string::npos);
    vessel.wall = 16e-3;
    EXPECT_EQ(refusal(vessel), "") << vessel.name;
  }
}

TEST(Sdf, WallThatClosesTheWaistIsRefused) {
  VesselData vessel = vase();
  vessel.wall = 18.5e-3;  // 18 mm at the waist, between foot and belly
  EXPECT_NE(refusal(vessel).find("vase"), std::string::npos);
}

TEST(Sdf, CavityThatFoldsOverItselfIsRefused) {
  VesselData vessel = ledges();  // a trough in a level ledge: one height, three radii
  vessel.wall = 0.5e-3;
  EXPECT_NE(refusal(vessel).find("ledges"), std::string::npos);
}

TEST(Sdf, ShellWithoutACavityIsRefused) {
  VesselData vessel = shell_of(beaker1());
  vessel.wall = 50e-3;
  EXPECT_NE(refusal(vessel), "");
}

}  // namespace
}  // namespace wholehand
