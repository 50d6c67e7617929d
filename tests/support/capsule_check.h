// SPDX-License-Identifier: MIT
// The posed hand as 19 bones with skin, checked at many points of each: what a grip must not do, found without the kernels that
// decide it. A bone is the rounded cone through its two points: all spheres between the one at its start and the one at its end.
#pragma once

#include <array>
#include <cstddef>

#include "core/evaluator.h"

namespace wholehand {

constexpr int BONES = JOINT_COUNT - FINGER_COUNT;  // three of the thumb, four of each finger

// A bone of the posed hand. Vessel frame, m.
struct CheckedBone {
  int finger = 0, joint = 0;  // the finger, and the joint at the start of the bone
  bool is_metacarpal = false;
  Triple start{}, end{};
  double start_radius = 0, end_radius = 0;
  double depth = 0;   // how deep its skin lies in the vessel at most; negative: outside
  double lowest = 0;  // y of its lowest skin
  double length() const;
};

struct CapsuleCheck {
  std::array<CheckedBone, BONES> bones{};
  double deepest = 0;  // of all bones, m
  double lowest = 0;   // y of the lowest skin, m
  // The largest overlap of two bones of different fingers, metacarpals left out, m; negative: the least distance between them.
  double overlap = 0;
  std::array<int, 2> overlapping{};  // these two, of `bones`
};

// Checks a feasible grip of a vessel. Every value is found at some of a bone's points, so the true one is never below `depth` and
// `overlap` and never above `lowest`: what fails here fails.
CapsuleCheck check_capsules(const Scene& scene, const Evaluator& evaluator, std::size_t vessel, const GripInput& grip,
                            const GripResult& result);

}  // namespace wholehand
