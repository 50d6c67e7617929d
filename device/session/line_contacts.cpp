// SPDX-License-Identifier: MIT
#include "device/session/line_contacts.h"

#include <cmath>

#include "core/contact.h"
#include "core/trig.h"

namespace wholehand::device {

using core_f64::Vec3;

namespace {

constexpr int MOST_ROOT_STEPS = 24;
constexpr double ON_SURFACE = 1e-8;      // m
constexpr double FARTHEST_ROOT = 20e-3;  // m: a contact that would have to go further has left the surface that it was on

}  // namespace

// Newton's iteration on the separation along the line, outward from the vessel.
std::optional<LineContacts> line_contacts(const core_f64::Vessel& vessel, Vec3 point, Vec3 direction,
                                          const std::array<double, 2>& near, const std::array<double, 2>& radii,
                                          double friction) noexcept {
  LineContacts contacts;
  contacts.is_antipodal = true;
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec3 outward = k == 0 ? -direction : direction;
    const double start = k == 0 ? -near[k] : near[k];
    double at = start, separation = core_f64::NO_DISTANCE;
    Vec3 normal{};
    int element = -1;
    for (int step = 0; step < MOST_ROOT_STEPS && std::abs(separation) > ON_SURFACE; ++step) {
      const Vec3 place = point + at * outward;
      separation = core_f64::separation_at(vessel, place, radii[k]);
      normal = core_f64::distance_gradient(vessel, place, element);
      const double slope = glm::dot(normal, outward);
      if (!(slope > GRAZING_COSINE)) return std::nullopt;
      if (std::abs(separation) > ON_SURFACE) at -= separation / slope;
      if (std::abs(at - start) > FARTHEST_ROOT) return std::nullopt;
    }
    if (std::abs(separation) > ON_SURFACE || (vessel.lid >= 0 && element == vessel.lid)) return std::nullopt;
    contacts.places[k] = point + at * outward;
    contacts.is_antipodal = contacts.is_antipodal && core_f64::angle_between(normal, outward) <= std::atan(friction);
  }
  if (!(glm::dot(contacts.places[1] - contacts.places[0], direction) > 0)) return std::nullopt;
  return contacts;
}

}  // namespace wholehand::device
