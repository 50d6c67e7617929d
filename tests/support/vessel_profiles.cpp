// SPDX-License-Identifier: MIT
#include "tests/support/vessel_profiles.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/scene.h"
#include "core/vectors.h"
#include "tests/support/meshes.h"

namespace wholehand {
namespace {

constexpr double MM = 1e-3;
constexpr double FULL_TURN = 2 * PI;
constexpr double ON_AXIS = 1e-12;      // m
constexpr int HANDLE_ACROSS = 32;      // corners of the bar's section
constexpr int HANDLE_BEND_STEPS = 48;  // of the half circle

std::uint32_t add_vertex(TriangleMesh& mesh, const Triple& place) {
  mesh.vertices.push_back(place);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

// A row of a surface: one ring, or one point on the axis, which all columns share.
std::vector<std::uint32_t> add_ring(TriangleMesh& mesh, const std::array<double, 2>& point, int sides, const RingShape& shape) {
  const auto& [r, y] = point;
  if (r < ON_AXIS) return std::vector<std::uint32_t>(sides, add_vertex(mesh, shape(0, y, 0)));
  std::vector<std::uint32_t> row;
  for (int j = 0; j < sides; ++j) row.push_back(add_vertex(mesh, shape(r, y, FULL_TURN * j / sides)));
  return row;
}

// Rows upward, columns to the left as seen from outside: add_fields makes triangles that face inward.
TriangleMesh of_rows(TriangleMesh mesh, const std::vector<std::vector<std::uint32_t>>& rows) {
  add_fields(mesh, rows);
  for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
  return mesh;
}

}  // namespace

TurnedProfile& TurnedProfile::line(double r, double y) {
  elements_.push_back({.end = {r, y}});
  return *this;
}

TurnedProfile& TurnedProfile::arc(double r, double y, double center_r, double center_y) {
  const auto [from_r, from_y] = end();
  const double radius = std::hypot(from_r - center_r, from_y - center_y);
  if (std::abs(radius - std::hypot(r - center_r, y - center_y)) > 1e-9 * radius)
    throw std::logic_error("an arc's ends are not equally far");
  const double start = std::atan2(from_y - center_y, from_r - center_r);
  const double sweep = std::remainder(std::atan2(y - center_y, r - center_r) - start, FULL_TURN);
  elements_.push_back({{r, y}, {center_r, center_y}, radius, start, sweep});
  return *this;
}

TurnedProfile& TurnedProfile::cap(double r, double y) {
  const auto [from_r, from_y] = end();
  return arc(r, y, 0, (r * r + y * y - from_r * from_r - from_y * from_y) / (2 * (y - from_y)));
}

double TurnedProfile::volume() const {
  double sum = 0;
  std::array<double, 2> at = from_;
  for (const Element& e : elements_) {
    if (e.radius == 0) {
      sum += (e.end[1] - at[1]) * (at[0] * at[0] + at[0] * e.end[0] + e.end[0] * e.end[0]) / 3;
    } else {
      // r = c + R cos a and dy = R cos a da: r^2 dy = R (c^2 cos a + 2 c R cos^2 a + R^2 cos^3 a) da
      const auto antiderivative = [&](double angle) {
        const double c = e.center[0], s = std::sin(angle);
        return e.radius * (c * c * s + c * e.radius * (angle + s * std::cos(angle)) + e.radius * e.radius * (s - s * s * s / 3));
      };
      sum += antiderivative(e.start + e.sweep) - antiderivative(e.start);
    }
    at = e.end;
  }
  return PI * sum * MM * MM * MM;
}

ProfilePoints TurnedProfile::points() const {
  ProfilePoints points{{from_[0] * MM, from_[1] * MM}};
  for (const Element& e : elements_) {
    int steps = 1;
    // a chord over the angle 2 h is R (1 - cos h) from its arc
    if (e.radius > 0)
      steps = std::max(2, static_cast<int>(std::ceil(std::abs(e.sweep) / (2 * std::acos(1 - PROFILE_SAGITTA / (e.radius * MM))))));
    for (int i = 1; i < steps; ++i) {
      const double angle = e.start + e.sweep * i / steps;
      points.push_back({(e.center[0] + e.radius * std::cos(angle)) * MM, (e.center[1] + e.radius * std::sin(angle)) * MM});
    }
    points.push_back({e.end[0] * MM, e.end[1] * MM});
  }
  return points;
}

double outer_side(double center_r, double center_y, double radius, double y) {
  return center_r + std::sqrt(radius * radius - (y - center_y) * (y - center_y));
}

double inner_side(double center_r, double center_y, double radius, double y) {
  return center_r - std::sqrt(radius * radius - (y - center_y) * (y - center_y));
}

double frustums(const ProfilePoints& points) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto& [r, y] = points[i];
    const auto& [next_r, next_y] = points[i + 1];
    sum += (next_y - y) * (r * r + r * next_r + next_r * next_r) / 3;
  }
  return PI * sum;
}

double polygon_share(int sides) { return std::sin(FULL_TURN / sides) / (FULL_TURN / sides); }

ProfilePoints divided(const ProfilePoints& points, double step) {
  ProfilePoints finer{points.front()};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const std::array<double, 2> a = points[i - 1], b = points[i];
    const int steps = std::max(1, static_cast<int>(std::ceil(std::hypot(b[0] - a[0], b[1] - a[1]) / step - 1e-9)));
    for (int k = 1; k < steps; ++k) finer.push_back({a[0] + (b[0] - a[0]) * k / steps, a[1] + (b[1] - a[1]) * k / steps});
    finer.push_back(b);
  }
  return finer;
}

Triple round_ring(double r, double y, double angle) { return {r * std::sin(angle), y, r * std::cos(angle)}; }

Triple square_ring(double r, double y, double angle) {
  const double reach = std::max(std::abs(std::sin(angle)), std::abs(std::cos(angle)));
  return round_ring(r / reach, y, angle);
}

TriangleMesh swept_mesh(const ProfilePoints& points, int sides, const RingShape& shape) {
  TriangleMesh mesh;
  std::vector<std::vector<std::uint32_t>> rows;
  const bool is_loop = points.front() == points.back() && points.front()[0] > ON_AXIS;
  for (std::size_t i = 0; i + (is_loop ? 1 : 0) < points.size(); ++i) rows.push_back(add_ring(mesh, points[i], sides, shape));
  if (is_loop) rows.push_back(rows.front());
  return of_rows(std::move(mesh), rows);
}

TriangleMesh walled_mesh(const ProfilePoints& outer, const ProfilePoints& inner, int sides, const RingShape& outer_shape,
                         const RingShape& inner_shape) {
  TriangleMesh mesh;
  std::vector<std::vector<std::uint32_t>> rows;
  for (const auto& point : outer) rows.push_back(add_ring(mesh, point, sides, outer_shape));
  const bool has_sharp_rim = outer.back() == inner.back();  // or a rounded one: no flat ring between the two paths
  for (auto point = inner.rbegin() + (has_sharp_rim ? 1 : 0); point != inner.rend(); ++point)
    rows.push_back(add_ring(mesh, *point, sides, inner_shape));
  return of_rows(std::move(mesh), rows);
}

double Handle::volume_outside(double cylinder) const {
  // A straight part spans x from sqrt(cylinder^2 - z^2) to the bend. With z = bar sin t the integrand over the section is smooth and periodic:
  // the trapezoid rule converges faster than any power of the step.
  constexpr int STEPS = 64;
  double straight = 0;
  for (int i = 0; i < STEPS; ++i) {
    const double t = PI * i / STEPS, z = bar * std::sin(t);
    straight += 2 * bar * bar * std::cos(t) * std::cos(t) * (center_x - std::sqrt(cylinder * cylinder - z * z)) * PI / STEPS;
  }
  return 2 * straight + PI * bar * bar * PI * bend;
}

double Handle::mesh_volume() const {
  // a section of area A, swept in a chord over the angle d, fills A R sin d
  const double section = polygon_share(HANDLE_ACROSS) * PI * bar * bar, turn = PI / HANDLE_BEND_STEPS;
  return section * (2 * (center_x - end_x) + HANDLE_BEND_STEPS * bend * std::sin(turn));
}

TriangleMesh Handle::mesh() const {
  TriangleMesh mesh;
  std::vector<std::vector<std::uint32_t>> rows;
  const auto add_end = [&](double y) { rows.emplace_back(HANDLE_ACROSS, add_vertex(mesh, {end_x, y, 0})); };
  const auto add_section = [&](double x, double angle) {
    const double up = std::sin(angle), out = std::cos(angle);  // from the bend's center
    std::vector<std::uint32_t>& row = rows.emplace_back();
    for (int j = 0; j < HANDLE_ACROSS; ++j) {
      const double t = FULL_TURN * j / HANDLE_ACROSS, reach = bend + bar * std::cos(t);
      row.push_back(add_vertex(mesh, {x + reach * out, center_y + reach * up, bar * std::sin(t)}));
    }
  };
  add_end(center_y + bend);
  add_section(end_x, PI / 2);
  for (int i = 0; i <= HANDLE_BEND_STEPS; ++i) add_section(center_x, PI / 2 - PI * i / HANDLE_BEND_STEPS);
  add_section(end_x, -PI / 2);
  add_end(center_y - bend);
  return of_rows(std::move(mesh), rows);
}

}  // namespace wholehand
