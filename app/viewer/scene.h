// SPDX-License-Identifier: MIT
// The constant part of a viewed scene, as the JSON that the page takes; docs/view.md names the fields.
#pragma once

#include <string>
#include <vector>

#include "core/scene.h"

namespace wholehand {

enum class ViewMode { live, recording, grips };

// What the page shows besides the scene: the gripper or the evaluating backend, and mode-specific parts as JSON: the control's limits, the length of
// a recording, the grips.
struct ViewFacts {
  ViewMode mode = ViewMode::live;
  std::string title, device;
  std::string control_limits;        // empty: the page is not a gripper
  double duration = 0, rate = 0;     // s, Hz: of a recording
  double most_force = 0;             // largest force on the gripper's fingers, N; 0: there is no gripper
  std::string grips;                 // empty: none
  std::vector<double> fills, tilts;  // of grips: the request, of the capacity and rad
};

// One JSON object. Vessels in the scene's order, joints in the order of docs/method.md. Throws Error as prepare_vessel.
std::string view_scene_json(const Scene& scene, const ViewFacts& facts);

// The triangles of a mesh vessel for the page: two counts, positions, indices; little endian, vessel frame, m. Empty for an outline.
std::string mesh_bytes(const VesselData& vessel);

}  // namespace wholehand
