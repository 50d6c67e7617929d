// SPDX-License-Identifier: MIT
// [arm]: where the holder's shoulder is, how long the arm is, and how far wrist and forearm turn.
#include "core/reader/parts.h"

namespace wholehand {

void read_arm(const SceneTable& root, Handedness handedness, std::optional<ArmData>& arm) {
  const auto table =
      root.table("arm", {"shoulder_mm", "upper_arm_mm", "forearm_mm", "wrist_radius_mm", "elbow_radius_mm", "flexion_deg",
                         "extension_deg", "radial_deg", "ulnar_deg", "pronation_deg", "supination_deg"});
  if (!table) return;
  ArmData& data = arm.emplace();
  if (handedness == Handedness::left) data.shoulder[0] = -data.shoulder[0];
  table->read("shoulder_mm", ranges::PLACE, "[x, y, z]", data.shoulder);
  table->read("upper_arm_mm", ranges::ARM_LENGTH, data.upper_arm);
  table->read("forearm_mm", ranges::ARM_LENGTH, data.forearm);
  table->read("wrist_radius_mm", ranges::ARM_RADIUS, data.wrist_radius);
  table->read("elbow_radius_mm", ranges::ARM_RADIUS, data.elbow_radius);
  table->read("flexion_deg", ranges::RANGE_OF_MOTION, data.flexion);
  table->read("extension_deg", ranges::RANGE_OF_MOTION, data.extension);
  table->read("radial_deg", ranges::RANGE_OF_MOTION, data.radial);
  table->read("ulnar_deg", ranges::RANGE_OF_MOTION, data.ulnar);
  table->read("pronation_deg", ranges::RANGE_OF_MOTION, data.pronation);
  table->read("supination_deg", ranges::RANGE_OF_MOTION, data.supination);
}

}  // namespace wholehand
