// SPDX-License-Identifier: MIT
#include "viewer/ghost.h"

#include "core/vectors.h"
#include "grips/hand_nodes.h"

namespace wholehand {

std::optional<GhostHand> ghost_of(const Scene& scene, const Advice& advice, const VesselPoses& poses) {
  if (advice.vessel < 0 || !advice.best || !advice.is_better) return std::nullopt;
  const VesselPose& pose = poses[static_cast<std::size_t>(advice.vessel)];
  const glm::dmat3 turn = to_mat3(pose.rotation);
  const auto out = [&](const HandNode& node) {
    return GhostNode{to_triple(to_vec3(pose.place) + turn * to_vec3(node.position)),
                     to_quaternion(to_quat(turn) * to_quat(node.rotation))};
  };
  const HandNodes nodes = hand_nodes(scene.hand, advice.best->grip, advice.posed);
  GhostHand ghost{out(nodes.wrist), {}};
  for (std::size_t j = 0; j < ghost.joints.size(); ++j) ghost.joints[j] = out(nodes.joints[j]);
  return ghost;
}

}  // namespace wholehand
