// SPDX-License-Identifier: MIT
#include "sweeps/grips/mesh.h"

#include <algorithm>
#include <cmath>

#include "core/liquid.h"
#include "core/load.h"
#include "core/mesh_body.h"
#include "sweeps/grips/mesh_surface.h"

namespace wholehand::sweeps {
namespace {

using Point2 = std::array<double, 2>;  // (r, y), m

constexpr double SAME_HEIGHT = 1e-12;  // m: pieces of an outline that are lower hold nothing
constexpr double ON_AXIS = 1e-12;      // m
constexpr double SAME_POINT = 1e-9;    // m: where elements meet they do so to rounding
constexpr double UPRIGHT = 1e-12;      // sine of a tilt

// A triangle between vertices; none if two corners coincide, as in rings that have shrunk to a point.
void add_triangle(SurfaceMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const auto& p = mesh.positions;
  if (p[a] == p[b] || p[b] == p[c] || p[c] == p[a]) return;
  mesh.triangles.insert(mesh.triangles.end(), {a, b, c});
}

std::uint32_t add_vertex(SurfaceMesh& mesh, const Triple& position, const Triple& normal) {
  mesh.positions.push_back(position);
  mesh.normals.push_back(normal);
  return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

// Unit normal to the right of a -> b, which on an outline that runs anticlockwise in (r, y) is outward.
Point2 normal_at(const PreparedElement& element, const Point2& p) {
  if (element.side == 0) {
    const double dr = element.b[0] - element.a[0], dy = element.b[1] - element.a[1], length = std::hypot(dr, dy);
    return {dy / length, -dr / length};
  }
  const double sense = (element.b[1] > element.a[1] ? 1 : -1) * element.side / element.radius;
  return {sense * (p[0] - element.center[0]), sense * (p[1] - element.center[1])};
}

// Points along an element: the ends of a line, an arc in equal angles of at most 2 pi / segments.
std::vector<Point2> element_points(const PreparedElement& element, int segments) {
  if (element.side == 0) return {element.a, element.b};
  const auto angle = [&](const Point2& p) { return std::atan2(p[1] - element.center[1], p[0] - element.center[0]); };
  const double from = angle(element.a), sweep = std::remainder(angle(element.b) - from, 2 * PI);
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(sweep) * segments / (2 * PI) - 1e-9)));
  std::vector<Point2> points{element.a};
  for (int k = 1; k < steps; ++k) {
    const double at = from + sweep * k / steps;
    points.push_back({element.center[0] + element.radius * std::cos(at), element.center[1] + element.radius * std::sin(at)});
  }
  points.push_back(element.b);
  return points;
}

// ---- liquid ----

// A circle of the cavity's wall: its wet part reaches from -angle to +angle about the direction of the tilt.
struct Ring {
  double radius = 0, height = 0, angle = 0;  // m, m, rad in [0, pi]
};

// What a stretch of the wall between two breaks is under the level plane.
enum class Wetness { dry, partly, full };

// Rings along a stretch of the wall with the wall's outward normal (r, y) at each.
struct Stretch {
  Wetness wetness = Wetness::dry;
  std::vector<Ring> rings;
  std::vector<Point2> normals;
};

// The level plane u . p = level with u = cosine y - sine n.
struct LevelPlane {
  double level = 0, sine = 0, cosine = 1;

  // Where the plane cuts the slice at a height: the part x >= chord along n is wet. Upright the whole slice or nothing is.
  double chord(double height) const {
    const double above = cosine * height - level;
    if (sine > UPRIGHT) return above / sine;
    return above > 0 ? HUGE_VAL : -HUGE_VAL;
  }
  double angle(double radius, double height) const {
    const double cut = chord(height);
    if (cut >= radius) return 0;
    return cut <= -radius ? PI : std::acos(cut / radius);
  }
};

// One stretch of a piece of the wall. Heights follow a cosine map, because the angle varies as a square root where the plane leaves the wall; there
// are enough to keep the angle's steps at 2 pi / segments. A full stretch needs them only along an arc.
Stretch make_stretch(const PreparedElement& piece, double low, double high, const LevelPlane& plane, int segments) {
  const core_f64::Element element = core_f64::load_element(piece);
  const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
  const double cut = plane.chord(middle), radius = core_f64::element_radius(element, middle);
  Stretch stretch;
  stretch.wetness = cut >= radius ? Wetness::dry : cut <= -radius ? Wetness::full : Wetness::partly;
  const bool is_ruled = stretch.wetness == Wetness::dry || (stretch.wetness == Wetness::full && piece.side == 0);
  const int steps = is_ruled ? 1 : std::max(2, segments / 2);
  for (int k = 0; k <= steps; ++k) {
    const double y = k == 0 ? low : k == steps ? high : middle - half * std::cos(PI * k / steps);
    const double r = y == piece.a[1] ? piece.a[0] : y == piece.b[1] ? piece.b[0] : core_f64::element_radius(element, y);
    const double angle = stretch.wetness == Wetness::dry ? 0 : stretch.wetness == Wetness::full ? PI : plane.angle(r, y);
    stretch.rings.push_back({r, y, angle});
    stretch.normals.push_back(normal_at(piece, {r, y}));
  }
  return stretch;
}

// The level ledge between two radii at one height, cut where the chord's end passes along it.
Stretch make_ledge(const Ring& from, const Ring& to, const LevelPlane& plane) {
  Stretch ledge;
  ledge.wetness = Wetness::partly;
  ledge.rings = {from, to};
  const double reach = std::abs(plane.chord(from.height));
  if (reach > std::min(from.radius, to.radius) && reach < std::max(from.radius, to.radius)) {
    ledge.rings.insert(ledge.rings.begin() + 1, {reach, from.height, plane.chord(from.height) > 0 ? 0 : PI});
  }
  ledge.normals.assign(ledge.rings.size(), {0, to.radius > from.radius ? -1.0 : 1.0});
  return ledge;
}

// Makes two consecutive stretches share their ring. If one of them is full or dry the angle is known without rounding.
void share_ring(Stretch& before, Stretch& after) {
  Ring ring = before.rings.back();
  const auto any = [&](Wetness wetness) { return before.wetness == wetness || after.wetness == wetness; };
  if (any(Wetness::dry)) ring.angle = 0;
  if (any(Wetness::full)) ring.angle = PI;
  before.rings.back() = after.rings.front() = ring;
}

// All stretches from the floor to the mouth, ledges between them where the radius jumps.
std::vector<Stretch> wall_stretches(const std::vector<PreparedElement>& cavity, const LevelPlane& plane, int segments) {
  std::vector<Stretch> stretches;
  const auto append = [&](Stretch next) {
    if (!stretches.empty()) {
      Stretch& before = stretches.back();
      if (std::abs(before.rings.back().radius - next.rings.front().radius) <= SAME_POINT) {
        share_ring(before, next);
      } else if ((before.wetness == Wetness::full) == (next.wetness == Wetness::full) || plane.sine > UPRIGHT) {
        stretches.push_back(make_ledge(before.rings.back(), next.rings.front(), plane));
      }  // else the vessel is upright and filled up to the ledge
    }
    stretches.push_back(std::move(next));
  };
  for (const PreparedElement& piece : cavity) {
    if (piece.b[1] - piece.a[1] < SAME_HEIGHT) continue;
    const core_f64::Element element = core_f64::load_element(piece);
    std::vector<double> breaks{piece.a[1], piece.b[1]};
    for (const double sigma : {1.0, -1.0}) {
      const core_f64::Vec2 crossings = core_f64::plane_crossings(element, plane.level, plane.sine, plane.cosine, sigma);
      breaks.insert(breaks.end(), {crossings.x, crossings.y});
    }
    std::sort(breaks.begin(), breaks.end());
    double low = breaks.front();
    for (const double high : breaks) {
      if (high - low < SAME_HEIGHT) continue;
      append(make_stretch(piece, low, high, plane, segments));
      low = high;
    }
  }
  return stretches;
}

// Puts the liquid together from its rings, in the frame (n, y, n x y) of the tilt.
class LiquidBuilder {
 public:
  LiquidBuilder(const Triple& pour, const LevelPlane& plane, int segments)
      : pour_(pour), up_{-plane.sine * pour[0], plane.cosine, -plane.sine * pour[2]}, segments_(segments) {}

  void add(const Stretch& stretch) {
    std::vector<std::uint32_t> first;
    for (std::size_t i = 0; i < stretch.rings.size(); ++i) {
      first.push_back(static_cast<std::uint32_t>(mesh_.positions.size()));
      for (int k = 0; k <= segments_; ++k) {
        const auto [cosine, sine] = direction(stretch.rings[i], k);
        add_vertex(mesh_, point(stretch.rings[i], k),
                   turned(stretch.normals[i][0] * cosine, stretch.normals[i][1], stretch.normals[i][0] * sine));
      }
    }
    for (std::size_t i = 0; i + 1 < first.size(); ++i) {
      for (int k = 0; k < segments_; ++k) {
        const std::uint32_t a = first[i] + k, b = first[i + 1] + k;
        add_triangle(mesh_, a, b, a + 1);
        add_triangle(mesh_, b, b + 1, a + 1);
      }
      add_surface(stretch.rings[i], stretch.rings[i + 1]);
    }
  }

  // Closes the liquid with the disc, or the part of it, at a ring: seen from below (`heading` -1) or from above (+1).
  void add_disc(const Ring& ring, int heading) {
    const Triple normal{0, static_cast<double>(heading), 0};
    const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
    for (int k = 0; k <= segments_; ++k) add_vertex(mesh_, point(ring, k), normal);
    for (int k = 1; k < segments_; ++k) {
      if (heading > 0) {
        add_triangle(mesh_, first, first + k + 1, first + k);
      } else {
        add_triangle(mesh_, first, first + k, first + k + 1);
      }
    }
  }

  SurfaceMesh take() { return std::move(mesh_); }

 private:
  // The strip of the level surface between two rings' chords.
  void add_surface(const Ring& low, const Ring& high) {
    const std::uint32_t a = add_vertex(mesh_, point(low, 0), up_), d = add_vertex(mesh_, point(low, segments_), up_),
                        c = add_vertex(mesh_, point(high, segments_), up_), b = add_vertex(mesh_, point(high, 0), up_);
    add_triangle(mesh_, a, d, c);
    add_triangle(mesh_, a, c, b);
  }

  // Cosine and sine of the k-th point's angle; the two ends of a full circle are one point.
  std::array<double, 2> direction(const Ring& ring, int k) const {
    const double at = ring.angle * (2.0 * k / segments_ - 1);
    const bool is_seam = ring.angle >= PI && (k == 0 || k == segments_);
    return {is_seam ? -1 : std::cos(at), is_seam ? 0 : std::sin(at)};
  }
  Triple point(const Ring& ring, int k) const {
    const auto [cosine, sine] = direction(ring, k);
    return turned(ring.radius * cosine, ring.height, ring.radius * sine);
  }
  Triple turned(double along, double y, double aside) const {
    return {along * pour_[0] - aside * pour_[2], y, along * pour_[2] + aside * pour_[0]};  // n x y = (-n.z, 0, n.x)
  }

  Triple pour_, up_;
  int segments_;
  SurfaceMesh mesh_;
};

}  // namespace

SurfaceMesh revolved_mesh(const std::vector<PreparedElement>& outline, int segments) {
  SurfaceMesh mesh;
  std::vector<Point2> round;  // exact at the quarters, so that extents are
  for (int k = 0; k < segments; ++k) {
    const int quarter = 4 * k / segments;
    const double rest = 2 * PI * k / segments - quarter * PI / 2;
    const double c = std::cos(rest), s = std::sin(rest);
    round.push_back(quarter == 0 ? Point2{c, s} : quarter == 1 ? Point2{-s, c} : quarter == 2 ? Point2{-c, -s} : Point2{s, -c});
  }
  Point2 end{HUGE_VAL, HUGE_VAL};
  for (const PreparedElement& element : outline) {
    std::vector<Point2> points = element_points(element, segments);
    if (std::hypot(points[0][0] - end[0], points[0][1] - end[1]) < SAME_POINT) points[0] = end;
    end = points.back();
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Point2& p : points) {
      const double r = std::abs(p[0]) < ON_AXIS ? 0 : p[0];
      const Point2 normal = normal_at(element, p);
      for (const Point2& at : round)
        add_vertex(mesh, {r * at[0], p[1], r * at[1]}, {normal[0] * at[0], normal[1], normal[0] * at[1]});
    }
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const auto low = static_cast<std::uint32_t>(first + i * segments), high = low + static_cast<std::uint32_t>(segments);
      for (int k = 0; k < segments; ++k) {
        const int next = (k + 1) % segments;
        add_triangle(mesh, low + k, high + k, low + next);
        add_triangle(mesh, high + k, high + next, low + next);
      }
    }
  }
  return mesh;
}

SurfaceMesh vessel_mesh(const VesselData& vessel, int segments) {
  if (vessel.mesh) {
    prepare_vessel(vessel, false);  // refuses a mesh that has not been read
    return mesh_surface(*vessel.mesh->body);
  }
  VesselData glass = vessel;
  if (vessel.wall > 0) glass.surface = Surface::shell;
  const PreparedVessel prepared = prepare_vessel(glass, vessel.wall > 0);
  return revolved_mesh(vessel.wall > 0 ? prepared.outline : prepared.hull, segments);
}

SurfaceMesh liquid_mesh(const VesselData& vessel, double volume, double tilt, const Triple& pour, int segments) {
  if (!(volume > 0) || !vessel.has_cavity()) return {};
  const PreparedVessel prepared = prepare_vessel(vessel, true);
  const core_f64::Quadrature quadrature = core_f64::load_quadrature(prepare_quadrature(QUADRATURE_POINTS));
  const core_f64::Vessel ready = core_f64::load_vessel(prepared, vessel, quadrature, false, Handedness::right);
  LevelPlane plane{0, std::sin(tilt), std::cos(tilt)};
  // `ready` has no capacity, so the level is solved to rounding
  plane.level = core_f64::liquid_at(ready, quadrature, volume, plane.sine, plane.cosine).level;
  const std::vector<Stretch> stretches = wall_stretches(prepared.cavity, plane, segments);
  LiquidBuilder builder(pour, plane, segments);
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    if (stretches[i].wetness == Wetness::dry) continue;
    const auto is_wet = [&](std::size_t k) { return k < stretches.size() && stretches[k].wetness != Wetness::dry; };
    builder.add(stretches[i]);
    if (!is_wet(i - 1)) builder.add_disc(stretches[i].rings.front(), -1);
    if (!is_wet(i + 1)) builder.add_disc(stretches[i].rings.back(), 1);
  }
  return builder.take();
}

SurfaceMesh ball_mesh(int segments) {
  PreparedElement half;
  half.a = {0, -1};
  half.b = {0, 1};
  half.radius = 1;
  half.side = 1;
  return revolved_mesh({half}, segments);
}

// With y along the bone: two arcs and the line that touches both, at the angle whose sine is (near - far) / length.
SurfaceMesh capsule_mesh(double length, double near, double far, int segments) {
  PreparedElement start, side, end;
  start.radius = near;
  start.side = 1;
  start.a = {0, -near};
  start.b = {0, near};
  end.center = {0, length};
  end.radius = far;
  end.side = 1;
  end.a = {0, length - far};
  end.b = {0, length + far};
  std::vector<PreparedElement> outline{near >= far ? start : end};  // where one ball holds the other
  if (length > std::abs(near - far)) {
    const double sine = (near - far) / length, cosine = std::sqrt((1 - sine) * (1 + sine));
    start.b = side.a = {near * cosine, near * sine};
    end.a = side.b = {far * cosine, length + far * sine};
    outline = {start, side, end};
  }
  SurfaceMesh mesh = revolved_mesh(outline, segments);
  for (std::vector<Triple>* vectors : {&mesh.positions, &mesh.normals}) {
    for (Triple& v : *vectors) v = {v[0], v[2], -v[1]};
  }
  return mesh;
}

}  // namespace wholehand::sweeps
