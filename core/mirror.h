// SPDX-License-Identifier: MIT
// Treats a left hand as a right hand in a mirrored scene.
#pragma once

#include "core/prepared.h"
#include "core/result.h"
#include "core/vectors.h"

namespace wholehand {

// A left hand is the right hand in the scene mirrored in x. Converts a grip to that mirrored scene, and a point back. A rotation R becomes M R M with
// M = diag(-1, 1, 1). Each conversion is its own inverse.
GripInput mirrored(const GripInput& grip, Handedness handedness);
Triple mirrored(const Triple& point, Handedness handedness);
glm::dvec3 mirrored(const glm::dvec3& point, Handedness handedness);
glm::dmat3 mirrored(const glm::dmat3& rotation, Handedness handedness);
PreparedLattice mirrored(const PreparedLattice& lattice, Handedness handedness);

// The way between a scene and the world of its right hand, in which kernels compute.
class Mirror {
 public:
  explicit Mirror(Handedness handedness) : handedness_(handedness) {}
  template <class T>
  T operator()(const T& same) const {
    return mirrored(same, handedness_);
  }
  template <class Real = double>
  glm::vec<3, Real> in(const Triple& point) const {
    return to_vec3<Real>(mirrored(point, handedness_));
  }
  glm::dmat3 in(const Rotation& rotation) const { return mirrored(to_mat3(rotation), handedness_); }
  template <class Real>
  Triple out(const glm::vec<3, Real>& point) const {
    return mirrored(to_triple(point), handedness_);
  }
  Rotation out(const glm::dmat3& rotation) const { return to_rotation(mirrored(rotation, handedness_)); }

 private:
  Handedness handedness_;
};

}  // namespace wholehand
