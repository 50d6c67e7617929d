// SPDX-License-Identifier: MIT
#include "tests/support/capsule_check.h"

#include <algorithm>
#include <cmath>

#include "core/joints.h"
#include "tests/support/special_values.h"

namespace wholehand {
namespace {

constexpr int BONE_STEPS = 64;  // of a bone of 68 mm at most: 1.1 mm

struct SkinSphere {
  Triple center{};
  double radius = 0;
};

SkinSphere sphere_along(const CheckedBone& bone, int step) {
  const double share = static_cast<double>(step) / BONE_STEPS;
  SkinSphere sphere;
  for (std::size_t k = 0; k < 3; ++k) sphere.center[k] = (1 - share) * bone.start[k] + share * bone.end[k];
  sphere.radius = (1 - share) * bone.start_radius + share * bone.end_radius;
  return sphere;
}

double distance_between(const Triple& a, const Triple& b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return std::sqrt(x * x + y * y + z * z);
}

// Upper bound on the overlap of two bones: neither has skin further from its middle than half its length and its larger radius.
double most_overlap(const CheckedBone& a, const CheckedBone& b) {
  double reach = 0;
  for (const CheckedBone* bone : {&a, &b}) reach += bone->length() / 2 + std::max(bone->start_radius, bone->end_radius);
  return reach - distance_between(sphere_along(a, BONE_STEPS / 2).center, sphere_along(b, BONE_STEPS / 2).center);
}

double overlap_of(const CheckedBone& a, const CheckedBone& b) {
  double largest = -INFINITE;
  for (int i = 0; i <= BONE_STEPS; ++i) {
    const SkinSphere one = sphere_along(a, i);
    for (int k = 0; k <= BONE_STEPS; ++k) {
      const SkinSphere other = sphere_along(b, k);
      largest = std::max(largest, one.radius + other.radius - distance_between(one.center, other.center));
    }
  }
  return largest;
}

std::array<CheckedBone, BONES> bones_of(const Scene& scene, const GripInput& grip, const GripResult& result) {
  const double scale = scene.hand.scale * grip.hand_scale;
  std::array<CheckedBone, BONES> bones{};
  std::size_t next = 0;
  for (int finger = 0; finger < FINGER_COUNT; ++finger) {
    const auto& radii = scene.hand.fingers[static_cast<std::size_t>(finger)].radii;
    for (int k = 0; k + 1 < finger_joints(finger); ++k) {
      const auto at = static_cast<std::size_t>(k), joint = static_cast<std::size_t>(finger_start(finger) + k);
      CheckedBone& bone = bones[next++];
      bone.finger = finger;
      bone.joint = static_cast<int>(joint);
      bone.is_metacarpal = k == 0;
      bone.start = result.posed[joint];
      bone.end = result.posed[joint + 1];
      bone.start_radius = scale * radii[at];
      bone.end_radius = scale * radii[at + 1];
    }
  }
  return bones;
}

}  // namespace

double CheckedBone::length() const { return distance_between(start, end); }

CapsuleCheck check_capsules(const Scene& scene, const Evaluator& evaluator, std::size_t vessel, const GripInput& grip,
                            const GripResult& result) {
  CapsuleCheck check{.bones = bones_of(scene, grip, result), .deepest = -INFINITE, .lowest = INFINITE, .overlap = -INFINITE};
  for (CheckedBone& bone : check.bones) {
    bone.depth = -INFINITE;
    bone.lowest = INFINITE;
    for (int step = 0; step <= BONE_STEPS; ++step) {
      const SkinSphere sphere = sphere_along(bone, step);
      bone.depth = std::max(bone.depth, sphere.radius - evaluator.distance(vessel, sphere.center));
      bone.lowest = std::min(bone.lowest, sphere.center[1] - sphere.radius);
    }
    check.deepest = std::max(check.deepest, bone.depth);
    check.lowest = std::min(check.lowest, bone.lowest);
  }
  for (std::size_t a = 0; a < BONES; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const CheckedBone &one = check.bones[a], &other = check.bones[b];
      if (one.finger == other.finger || one.is_metacarpal || other.is_metacarpal) continue;
      if (most_overlap(one, other) <= check.overlap) continue;
      const double overlap = overlap_of(one, other);
      if (overlap <= check.overlap) continue;
      check.overlap = overlap;
      check.overlapping = {static_cast<int>(b), static_cast<int>(a)};
    }
  }
  return check;
}

}  // namespace wholehand
