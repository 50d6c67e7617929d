// SPDX-License-Identifier: MIT
// Numbers and names of the 24 joints: the thumb's four from base to tip, then five of each other finger.
#pragma once

#include <array>
#include <string>

#include "core/scene.h"

namespace wholehand {

// The joints of a finger are finger_start(finger) + 0 .. finger_joints(finger) - 1.
constexpr int finger_start(int finger) { return finger == 0 ? 0 : 5 * finger - 1; }
constexpr int finger_joints(int finger) { return finger == 0 ? 4 : 5; }

// The bones beyond the palm: two of the thumb, then three of each finger. The digit that a phalanx belongs to, and the joint where it starts.
constexpr int phalanx_digit(int phalanx) { return (phalanx + 1) / 3; }
constexpr int phalanx_start(int phalanx) { return phalanx + 1 + 2 * phalanx_digit(phalanx); }
// The finger that a joint belongs to.
constexpr int finger_of(int joint) { return (joint + 1) / 5; }

struct JointNames {
  const char* paper;   // "thumb CMC", "index PIP", "little tip": for people, and with joint_key for files
  const char* webxr;   // "index-finger-phalanx-intermediate": the key that matches hand rigs in glTF
  const char* openxr;  // the enumerant "XR_HAND_JOINT_INDEX_INTERMEDIATE_EXT": for engines
};
extern const std::array<JointNames, JOINT_COUNT> JOINT_NAMES;

// The paper's name as one word: "index_pip".
std::string joint_key(int joint);

}  // namespace wholehand
