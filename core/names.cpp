// SPDX-License-Identifier: MIT
#include "core/joints.h"
#include "core/result.h"
#include "core/scene.h"

namespace wholehand {

const std::array<const char*, FINGER_COUNT> FINGER_NAMES{"thumb", "index", "middle", "ring", "little"};
const std::array<const char*, 7> REASON_NAMES{"", "degenerate", "not_converged", "misses", "too_wide", "too_narrow", "on_mouth"};

const std::array<JointNames, JOINT_COUNT> JOINT_NAMES{{
    {"thumb CMC", "thumb-metacarpal", "XR_HAND_JOINT_THUMB_METACARPAL_EXT"},
    {"thumb MCP", "thumb-phalanx-proximal", "XR_HAND_JOINT_THUMB_PROXIMAL_EXT"},
    {"thumb IP", "thumb-phalanx-distal", "XR_HAND_JOINT_THUMB_DISTAL_EXT"},
    {"thumb tip", "thumb-tip", "XR_HAND_JOINT_THUMB_TIP_EXT"},
    {"index CMC", "index-finger-metacarpal", "XR_HAND_JOINT_INDEX_METACARPAL_EXT"},
    {"index MCP", "index-finger-phalanx-proximal", "XR_HAND_JOINT_INDEX_PROXIMAL_EXT"},
    {"index PIP", "index-finger-phalanx-intermediate", "XR_HAND_JOINT_INDEX_INTERMEDIATE_EXT"},
    {"index DIP", "index-finger-phalanx-distal", "XR_HAND_JOINT_INDEX_DISTAL_EXT"},
    {"index tip", "index-finger-tip", "XR_HAND_JOINT_INDEX_TIP_EXT"},
    {"middle CMC", "middle-finger-metacarpal", "XR_HAND_JOINT_MIDDLE_METACARPAL_EXT"},
    {"middle MCP", "middle-finger-phalanx-proximal", "XR_HAND_JOINT_MIDDLE_PROXIMAL_EXT"},
    {"middle PIP", "middle-finger-phalanx-intermediate", "XR_HAND_JOINT_MIDDLE_INTERMEDIATE_EXT"},
    {"middle DIP", "middle-finger-phalanx-distal", "XR_HAND_JOINT_MIDDLE_DISTAL_EXT"},
    {"middle tip", "middle-finger-tip", "XR_HAND_JOINT_MIDDLE_TIP_EXT"},
    {"ring CMC", "ring-finger-metacarpal", "XR_HAND_JOINT_RING_METACARPAL_EXT"},
    {"ring MCP", "ring-finger-phalanx-proximal", "XR_HAND_JOINT_RING_PROXIMAL_EXT"},
    {"ring PIP", "ring-finger-phalanx-intermediate", "XR_HAND_JOINT_RING_INTERMEDIATE_EXT"},
    {"ring DIP", "ring-finger-phalanx-distal", "XR_HAND_JOINT_RING_DISTAL_EXT"},
    {"ring tip", "ring-finger-tip", "XR_HAND_JOINT_RING_TIP_EXT"},
    {"little CMC", "pinky-finger-metacarpal", "XR_HAND_JOINT_LITTLE_METACARPAL_EXT"},
    {"little MCP", "pinky-finger-phalanx-proximal", "XR_HAND_JOINT_LITTLE_PROXIMAL_EXT"},
    {"little PIP", "pinky-finger-phalanx-intermediate", "XR_HAND_JOINT_LITTLE_INTERMEDIATE_EXT"},
    {"little DIP", "pinky-finger-phalanx-distal", "XR_HAND_JOINT_LITTLE_DISTAL_EXT"},
    {"little tip", "pinky-finger-tip", "XR_HAND_JOINT_LITTLE_TIP_EXT"},
}};

std::string joint_key(int joint) {
  std::string key = JOINT_NAMES[static_cast<std::size_t>(joint)].paper;
  for (char& c : key) c = c == ' ' ? '_' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return key;
}

}  // namespace wholehand
