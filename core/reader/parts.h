// SPDX-License-Identifier: MIT
// The parts of a scene file, one function per table. Each throws Error (usage) for what is not allowed there.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/reader/table.h"
#include "core/scene.h"

namespace wholehand {

// ---- hand.cpp ----
void read_hand(const SceneTable& root, HandData& hand);

// ---- vessel.cpp ----
void read_vessels(const SceneTable& root, Scene& scene);
// What other tables require of vessels: [liquid] a cavity, a vessel's own liquid a [liquid].
void check_vessels(const SceneTable& root, const Scene& scene);

// ---- shape.cpp, outline.cpp, cavity.cpp ----
struct Silhouette {
  std::vector<OutlineElement> elements;
  double largest_radius = 0;  // m
  double height = 0;          // of the mouth, m
};
Silhouette read_shape(const SceneTable& vessel, const std::string& shape);
Silhouette read_outline(const SceneTable& vessel);
// What the vessel holds: its wall and floor, or its inner outline, which lies within `silhouette`; for a mesh the inner outline alone, unchecked.
void read_cavity(const SceneTable& table, const Silhouette& silhouette, VesselData& vessel);

// ---- grips.cpp ----
// `turns`: some vessel is not a body of revolution, so the azimuth goes all round by default.
void read_grips(const SceneTable& root, bool turns, GripsData& grips);
// [liquid] has been read: `until_poured` needs it.
void read_tilts(const SceneTable& root, Scene& scene);
void read_liquid(const SceneTable& root, std::optional<LiquidData>& liquid);

// ---- fills.cpp ----
// What is in a vessel in the live task.
void read_own_liquid(const SceneTable& vessel_table, VesselData& vessel);
// Converts fills given in mL to fractions of each vessel's capacity. Vessels and [liquid] have been read and checked.
void set_vessel_fills(const SceneTable& root, Scene& scene);

// ---- force.cpp ----
void read_force(const SceneTable& root, ForceData& force);
// Without the table `strength` stays.
void read_strength(const SceneTable& root, std::optional<StrengthData>& strength);
// `has_tilts`: the force and hold terms count.
void read_score(const SceneTable& root, bool has_tilts, ScoreWeights& weights);
void read_output(const SceneTable& root, OutputData& output);

// ---- tabletop.cpp ----
// Call it after the vessels have been read: it refuses a clearance that reaches a vessel's mouth. Meshes are checked once they are
// loaded.
void read_tabletop(const SceneTable& root, const std::vector<VesselData>& vessels, std::optional<TableData>& tabletop);

// ---- arm.cpp ----
// Call it after [hand] has been read: by default the shoulder is on the hand's side.
void read_arm(const SceneTable& root, Handedness handedness, std::optional<ArmData>& arm);

// ---- robust.cpp ----
void read_robust(const SceneTable& root, std::optional<RobustData>& robust);

// ---- people.cpp ----
void read_people(const SceneTable& root, PeopleData& people);

// ---- session.cpp ----
void read_live(const SceneTable& root, bool has_efforts, LiveData& live);
void read_device(const SceneTable& root, DeviceData& device);
void read_task(const SceneTable& root, const std::vector<VesselData>& vessels, std::optional<TaskData>& task);

}  // namespace wholehand
