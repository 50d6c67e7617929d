// SPDX-License-Identifier: MIT
// What the 24 joints are called.
#pragma once

#include <array>
#include <string>

#include "core/scene.h"

namespace wholehand {

struct JointNames {
  const char* paper;   // "thumb CMC", "index PIP", "little tip": for people, and with joint_key for files
  const char* webxr;   // "index-finger-phalanx-intermediate": by it hand rigs in glTF are matched
  const char* openxr;  // the enumerant "XR_HAND_JOINT_INDEX_INTERMEDIATE_EXT": for engines
};
extern const std::array<JointNames, JOINT_COUNT> JOINT_NAMES;

// The paper's name as one word: "index_pip".
std::string joint_key(int joint);

}  // namespace wholehand
