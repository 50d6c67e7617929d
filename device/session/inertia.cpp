// SPDX-License-Identifier: MIT
#include "device/session/inertia.h"

#include "core/load.h"
#include "core/mesh_body.h"
#include "core/mirror.h"
#include "core/vectors.h"

namespace wholehand::device {

using core_f64::Mat3;
using core_f64::Vec3;

namespace {

// A body of density 1: its volume, and about the origin the integrals of x_i and x_i x_j.
struct BodyMoments {
  double volume = 0;
  Vec3 first{};
  Mat3 second{0};

  void add(const BodyMoments& part, double sign) {
    volume += sign * part.volume;
    first += sign * part.first;
    second += sign * part.second;
  }
  // I = tr(C) - C with C the second moments about the center, for a body of that mass.
  Mat3 inertia(double mass) const {
    const Vec3 center = first / volume;
    const Mat3 about = mass / volume * (second - volume * glm::outerProduct(center, center));
    return Mat3(about[0][0] + about[1][1] + about[2][2]) - about;
  }
};

// Under an element of a half outline: discs of radius r have pi r^2 dy, and pi r^4 / 4 dy of each of x x and z z.
BodyMoments revolved(const core_f64::Quadrature& quadrature, const core_f64::Element& element) {
  BodyMoments sum;
  const double middle = 0.5 * (element.a.y + element.b.y), half = 0.5 * (element.b.y - element.a.y);
  for (int i = 0; half != 0 && i < quadrature.count; ++i) {
    const double y = middle - half * quadrature.cosine[i], r = core_f64::element_radius(element, y);
    const double area = PI * r * r * half * quadrature.weight[i];
    sum.volume += area;
    sum.first.y += area * y;
    sum.second[0][0] += 0.25 * area * r * r;
    sum.second[1][1] += area * y * y;
    sum.second[2][2] += 0.25 * area * r * r;
  }
  return sum;
}

// Tetrahedra from the origin to each triangle.
BodyMoments enclosed(const MeshBody& body, Handedness handedness) {
  BodyMoments sum;
  const double side = handedness == Handedness::left ? -1 : 1;  // a mirrored triangle faces the other way
  for (const auto& triangle : body.triangles) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = to_vec3(mirrored(body.vertices[triangle[k]], handedness));
    const double part = side * glm::dot(p[0], glm::cross(p[1], p[2])) / 6;
    const Vec3 corners = p[0] + p[1] + p[2];
    sum.volume += part;
    sum.first += part / 4 * corners;
    sum.second += part / 20 *
                  (glm::outerProduct(corners, corners) + glm::outerProduct(p[0], p[0]) + glm::outerProduct(p[1], p[1]) +
                   glm::outerProduct(p[2], p[2]));
  }
  return sum;
}

Mat3 solid_cylinder(double mass, double radius, double height) {
  const double across = mass * (3 * radius * radius + height * height) / 12;
  Mat3 inertia(across);
  inertia[1][1] = 0.5 * mass * radius * radius;
  return inertia;
}

}  // namespace

Mat3 wall_inertia(const PreparedVessel& prepared, const VesselData& data, const core_f64::Vessel& vessel,
                  const core_f64::Quadrature& quadrature, Handedness handedness) {
  const MeshBody* body = data.mesh ? data.mesh->body.get() : nullptr;
  BodyMoments wall;
  if (body && body->facts.has_sure_volume() && !body->has_lattice_volume) wall.add(enclosed(*body, handedness), 1);
  if (!body)
    for (const PreparedElement& element : prepared.hull) wall.add(revolved(quadrature, core_f64::load_element(element)), 1);
  if (!body || body->holds_cavity)
    for (const core_f64::Element& element : vessel.cavity) wall.add(revolved(quadrature, element), -1);
  if (!(wall.volume > 0)) return solid_cylinder(vessel.mass, prepared.largest_radius, data.height - data.base);
  return wall.inertia(vessel.mass);
}

}  // namespace wholehand::device
