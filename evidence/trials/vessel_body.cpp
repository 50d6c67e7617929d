// SPDX-License-Identifier: MIT
#include "evidence/trials/vessel_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/mesh_body.h"
#include "core/outline_points.h"
#include "core/prepare.h"
#include "core/vectors.h"
#include "evidence/trials/piece_file.h"

namespace wholehand {
namespace {

using Point2 = std::array<double, 2>;

constexpr int SLICES = 400;    // of a vessel's height, for inertias alone
constexpr double FLAT = 1e-7;  // m: a shorter edge has no direction

// Points of an outline, with arcs cut so finely that no cone is further from them than FORM_TOLERANCE.
std::vector<Point2> form_points(const std::vector<PreparedElement>& elements) {
  double widest = 0;
  for (const PreparedElement& element : elements)
    if (element.side != 0) widest = std::max(widest, element.radius);
  const double step = widest > FORM_TOLERANCE ? 2 * std::acos(1 - FORM_TOLERANCE / widest) : radians(10);
  std::vector<Point2> points;
  for (const Point2& p : outline_points(elements, elements.size(), step)) {
    const Point2 kept{std::max(0.0, p[0]), p[1]};
    if (points.empty() || std::hypot(kept[0] - points.back()[0], kept[1] - points.back()[1]) > FLAT) points.push_back(kept);
  }
  return points;
}

// Whether the outline turns to the left at b, or goes straight on: convex there.
bool is_convex_at(const Point2& a, const Point2& b, const Point2& c) {
  const double ux = b[0] - a[0], uy = b[1] - a[1], vx = c[0] - b[0], vy = c[1] - b[1];
  return ux * vy - uy * vx >= -1e-9 * std::hypot(ux, uy) * std::hypot(vx, vy);
}

// Whether everything between two levels is equally far from the axis: a cylinder, with or without its ends.
bool is_upright(const std::vector<Point2>& points, std::size_t from, std::size_t to, double radius) {
  for (std::size_t k = from; k <= to; ++k) {
    const bool is_end = points[k][0] < FLAT && (points[k][1] == points[from][1] || points[k][1] == points[to][1]);
    if (!is_end && std::abs(points[k][0] - radius) > FLAT) return false;
  }
  return true;
}

// Whether an arc about the axis that ends at a point of the outline may continue to its own top: it narrows from there on, and the part above is
// nowhere narrower than the arc's end before that.
bool holds_the_rest(const std::vector<Point2>& points, std::size_t end, double middle, double top) {
  if (points[end][1] < middle - FLAT) return false;
  for (std::size_t k = end + 1; k < points.size() && points[k - 1][1] < top; ++k)
    if (points[k][0] < points[end][0] - FLAT) return false;
  return points.back()[1] >= top - FLAT;
}

// The arc that is all of the outline between two points, from the axis on.
const PreparedElement* arc_between(const std::vector<PreparedElement>& elements, const Point2& from, const Point2& to) {
  const auto is_at = [](const Point2& a, const Point2& b) { return std::hypot(a[0] - b[0], a[1] - b[1]) < FLAT; };
  for (const PreparedElement& element : elements)
    if (element.side != 0 && std::abs(element.center[0]) < FLAT && from[0] < FLAT && is_at(element.a, from) && is_at(element.b, to))
      return &element;
  return nullptr;
}

void append_piece(const std::vector<PreparedElement>& elements, const std::vector<Point2>& points, std::size_t from, std::size_t to,
                  std::vector<ConvexPiece>& pieces) {
  if (points[to][1] - points[from][1] < FLAT) return;  // level: no room in it
  ConvexPiece piece;
  piece.low = points[from][1];
  piece.high = points[to][1];
  double widest = 0;
  for (std::size_t k = from; k <= to; ++k) widest = std::max(widest, points[k][0]);
  if (is_upright(points, from, to, widest)) {
    piece.shape = PieceShape::cylinder;
    piece.radius = widest;
  } else if (const PreparedElement* arc = arc_between(elements, points[from], points[to]);
             arc && holds_the_rest(points, to, arc->center[1], arc->center[1] + arc->radius)) {
    piece.shape = PieceShape::ball;
    piece.radius = arc->radius;
    piece.high = arc->center[1] + arc->radius;
  }
  const int sides = to - from < FEW_RINGS ? FORM_SIDES : ROUNDED_SIDES;
  for (std::size_t k = from; k <= to; ++k) {
    const auto [r, y] = points[k];
    if (r < FLAT) {
      piece.vertices.push_back({0, y, 0});
      continue;
    }
    for (int side = 0; side < sides; ++side) {
      const double angle = 2 * PI * side / sides;
      piece.vertices.push_back({r * std::cos(angle), y, r * std::sin(angle)});
    }
  }
  pieces.push_back(std::move(piece));
}

std::vector<ConvexPiece> revolved_pieces(const VesselData& vessel) {
  const std::vector<PreparedElement> elements = prepare_vessel(vessel, false).hull;
  const std::vector<Point2> points = form_points(elements);
  std::vector<ConvexPiece> pieces;
  std::size_t from = 0;
  for (std::size_t k = 1; k < points.size(); ++k) {
    if (points[k][1] < points[k - 1][1] - FLAT) {
      throw usage_error(
          fmt::format("vessel {}: its outline goes down again at a height of {:.1f} mm; trials know outer forms that rise",
                      vessel.name, 1e3 * points[k - 1][1]));
    }
    const bool is_last = k + 1 == points.size();
    if (!is_last && is_convex_at(points[k - 1], points[k], points[k + 1])) continue;
    append_piece(elements, points, from, k, pieces);
    from = k;
  }
  return pieces;
}

VesselForm mesh_form(const VesselData& vessel, const std::string& folder, std::size_t most_pieces) {
  if (!vessel.mesh->body) throw failure_error(fmt::format("vessel {}: its mesh has not been read", vessel.name));
  const MeshBody& body = *vessel.mesh->body;
  TriangleMesh triangles;
  triangles.vertices = body.vertices;
  triangles.triangles = body.triangles;
  const CheckedMesh checked = check_mesh(triangles, vessel.name);
  const MeshDistance distance(checked);
  const std::optional<std::string> file = piece_file_of(*vessel.mesh, folder);
  const ConvexCover cover =
      file ? read_pieces(vessel, *file, folder, checked, distance) : cover_by_pieces(checked, distance, most_pieces);
  if (cover.error > MOST_PIECE_ERROR) {
    const std::string other = std::filesystem::path(vessel.mesh->file).filename().replace_extension(".pieces.obj").string();
    throw usage_error(fmt::format(
        "vessel {}: its mesh is not convex, and {} convex pieces of it, the most there may be, still reach {:.2f} mm out "
        "of it; allowed: {:.2g} mm; put convex pieces of it, as CoACD writes them, beside it as {}",
        vessel.name, most_pieces, 1e3 * cover.error, 1e3 * MOST_PIECE_ERROR, other));
  }
  VesselForm form;
  form.error = cover.error;
  form.file = file.value_or("");
  for (const ConvexHull& hull : cover.pieces) form.pieces.push_back({PieceShape::hull, hull.vertices});
  return form;
}

// Radius of a polyline at a height, 0 where it has none. Its heights do not fall.
double radius_at(const std::vector<Point2>& points, double y) {
  for (std::size_t k = 1; k < points.size(); ++k) {
    const auto [r0, y0] = points[k - 1];
    const auto [r1, y1] = points[k];
    if (y >= y0 && y < y1) return r0 + (r1 - r0) * (y - y0) / (y1 - y0);
  }
  return 0;
}

// Slices of revolution, of density 1: their sums about the origin.
struct SliceSum {
  double volume = 0, first = 0, along = 0, across = 0;  // first moment of y; second moments about the axis, and across it

  void add(double outer, double inner, double y, double thickness) {
    const double part = PI * (outer * outer - inner * inner) * thickness;
    const double spin = PI * (std::pow(outer, 4) - std::pow(inner, 4)) * thickness / 2;
    volume += part;
    first += part * y;
    along += spin;
    across += spin / 2 + part * (y * y + thickness * thickness / 12);
  }
  void subtract(const SliceSum& part) {
    volume -= part.volume;
    first -= part.first;
    along -= part.along;
    across -= part.across;
  }
  // As a body of a mass at a center.
  RigidLoad weighing(double mass, const Triple& center) const {
    if (!(volume > 0)) return {mass, center, {}};
    const double density = mass / volume, height = first / volume;
    const double round = density * along, level = density * (across - volume * height * height);
    return {mass, center, {level, 0, 0, 0, round, 0, 0, 0, level}};
  }
};

SliceSum revolved_sum(const std::vector<Point2>& points, double low, double high) {
  SliceSum sum;
  const double thickness = (high - low) / SLICES;
  for (int k = 0; k < SLICES; ++k) {
    const double y = low + (k + 0.5) * thickness;
    sum.add(radius_at(points, y), 0, y, thickness);
  }
  return sum;
}

// Moments of a body of density 1 about the origin.
struct Moments {
  double volume = 0;
  glm::dvec3 first{};
  glm::dmat3 second{0};  // of x_i x_j

  void subtract(const SliceSum& part) {
    volume -= part.volume;
    first.y -= part.first;
    // a body of revolution has along = 2 <x x>, across = <x x> + <y y>
    second[0][0] -= part.along / 2;
    second[1][1] -= part.across - part.along / 2;
    second[2][2] -= part.along / 2;
  }
  // As a body of a mass, whose own center comes to lie at `center`.
  RigidLoad weighing(double mass, const Triple& center) const {
    RigidLoad load{mass, center, {}};
    if (!(volume > 0)) return load;
    const glm::dvec3 middle = first / volume;
    const glm::dmat3 about = mass / volume * (second - volume * glm::outerProduct(middle, middle));
    const double trace = about[0][0] + about[1][1] + about[2][2];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) load.inertia[3 * i + j] = (i == j ? trace : 0) - about[i][j];
    return load;
  }
};

// The middle of the edges of only one triangle; for a closed mesh, whose volume does not depend on it, the origin.
glm::dvec3 middle_of_holes(const MeshBody& body) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const auto& triangle : body.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back({triangle[k], triangle[(k + 1) % 3]});
  std::sort(edges.begin(), edges.end());
  glm::dvec3 sum(0);
  int count = 0;
  for (const auto& [from, to] : edges) {
    if (std::binary_search(edges.begin(), edges.end(), std::array{to, from})) continue;
    sum += 0.5 * (to_vec3(body.vertices[from]) + to_vec3(body.vertices[to]));
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : sum;
}

// The sum of the tetrahedra from one place to all triangles: an open mesh's hole is closed by a cone to that place.
Moments mesh_moments(const MeshBody& body) {
  Moments whole;
  const glm::dvec3 o = middle_of_holes(body);
  for (const auto& triangle : body.triangles) {
    const auto a = to_vec3(body.vertices[triangle[0]]), b = to_vec3(body.vertices[triangle[1]]),
               c = to_vec3(body.vertices[triangle[2]]);
    const double part = glm::dot(a - o, glm::cross(b - o, c - o)) / 6;
    const glm::dvec3 sum = o + a + b + c;
    whole.volume += part;
    whole.first += part / 4 * sum;
    whole.second += part / 20 *
                    (glm::outerProduct(sum, sum) + glm::outerProduct(o, o) + glm::outerProduct(a, a) + glm::outerProduct(b, b) +
                     glm::outerProduct(c, c));
  }
  return whole;
}

}  // namespace

VesselForm vessel_form(const VesselData& vessel, const std::string& folder, std::size_t most_pieces) {
  if (vessel.surface == Surface::shell) {
    throw usage_error(
        fmt::format("vessel {}: its surface is a shell, into which fingers reach; trials have no model of a wall that is "
                    "touched from both sides: use surface = \"solid\"",
                    vessel.name));
  }
  if (vessel.mesh) return mesh_form(vessel, folder, most_pieces);
  return {revolved_pieces(vessel), 0, ""};
}

std::vector<ConvexPiece> convex_pieces(const VesselData& vessel) { return vessel_form(vessel, "").pieces; }

std::string form_text(const VesselForm& form) {
  return fmt::format("{}, which leave the mesh by at most {:.2f} mm{}", counted(form.pieces.size(), "convex piece"),
                     1e3 * form.error, form.file.empty() ? "" : ", from " + form.file);
}

RigidLoad joined(const RigidLoad& a, const RigidLoad& b) {
  RigidLoad whole;
  whole.mass = a.mass + b.mass;
  if (!(whole.mass > 0)) return a;
  whole.center = point_between(a.center, b.center, b.mass / whole.mass);
  for (const RigidLoad* part : {&a, &b}) {
    const auto arm = to_vec3(part->center) - to_vec3(whole.center);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        whole.inertia[3 * i + j] += part->inertia[3 * i + j] + part->mass * ((i == j ? glm::dot(arm, arm) : 0) - arm[i] * arm[j]);
  }
  return whole;
}

RigidLoad load_between(const RigidLoad& a, const RigidLoad& b, double share) {
  RigidLoad load{a.mass + share * (b.mass - a.mass), point_between(a.center, b.center, share), {}};
  for (std::size_t k = 0; k < 9; ++k) load.inertia[k] = a.inertia[k] + share * (b.inertia[k] - a.inertia[k]);
  return load;
}

VesselLoad::VesselLoad(const Scene& scene, const Evaluator& evaluator, std::size_t vessel, const Triple& pour)
    : scene_(scene), evaluator_(evaluator), vessel_(vessel), pour_(pour) {
  const VesselData& data = scene.vessels[vessel];
  prepared_ = prepare_vessel(data, data.has_cavity());
  hull_ = form_points(prepared_.hull);
  cavity_ = form_points(prepared_.cavity);
  glass_ = glass();
}

RigidLoad VesselLoad::glass() const {
  const VesselData& data = scene_.vessels[vessel_];
  const VesselConstants constants = evaluator_.constants(vessel_);
  if (data.mesh) {
    Moments whole = mesh_moments(*data.mesh->body);
    if (data.mesh->body->holds_cavity) whole.subtract(revolved_sum(cavity_, prepared_.floor_height, prepared_.mouth_height));
    return whole.weighing(constants.mass, constants.center_of_mass);
  }
  SliceSum sum = revolved_sum(hull_, 0, hull_.back()[1]);
  sum.subtract(revolved_sum(cavity_, prepared_.floor_height, prepared_.mouth_height));
  return sum.weighing(constants.mass, constants.center_of_mass);
}

RigidLoad VesselLoad::liquid(const LiquidResult& liquid) const {
  const Triple center{liquid.lean * pour_[0], liquid.height, liquid.lean * pour_[2]};
  SliceSum sum;
  const double floor = prepared_.floor_height, thickness = (prepared_.mouth_height - floor) / SLICES;
  for (int k = 0; k < SLICES && sum.volume < liquid.volume; ++k) {
    const double radius = radius_at(cavity_, floor + (k + 0.5) * thickness), slice = PI * radius * radius * thickness;
    if (!(slice > 0)) continue;
    const double part = thickness * std::min(1.0, (liquid.volume - sum.volume) / slice);  // the uppermost is not full
    sum.add(radius, 0, floor + k * thickness + part / 2, part);
  }
  return sum.weighing(liquid.mass, center);
}

RigidLoad VesselLoad::at(double fill, double tilt, double mass) const {
  RigidLoad load = glass_;
  if (scene_.liquid && fill > 0) {
    const LiquidResult held = evaluator_.liquid(vessel_, fill, tilt);
    if (held.mass > 0) load = joined(load, liquid(held));
  }
  if (!std::isnan(mass)) {
    const double factor = load.mass > 0 ? mass / load.mass : 0;
    for (double& entry : load.inertia) entry *= factor;
    load.mass = mass;
  }
  return load;
}

}  // namespace wholehand
