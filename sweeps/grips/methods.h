// SPDX-License-Identifier: MIT
// Where the answer to one grip comes from: the core, or a device's planes. The same questions to either.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/backend.h"
#include "core/evaluator.h"

namespace wholehand {

// One fill (fraction of the capacity; 0 where the scene has no liquid) and tilt (rad) of a grip, with what is asked of it.
struct GripState {
  double fill = 0, tilt = 0;
  LiquidResult liquid;
  StateResult state;
  bool counts = true;  // false: the scene leaves it out ([tilts] until_poured), and what depends on the grip's forces is NaN
};

// A grip over the scene's own fills and tilts. The effort is a share of the strength: up to 1 the hand holds.
struct GripHold {
  double worst = 0, worst_fill = 0, worst_tilt = 0;  // a state of the largest effort: fraction, rad
  double tips_worst = 0;
  double push = 0;  // N: upright and fullest, what may push at the center of mass along each of +-x, +-y, +-z beside the weight
  double friction_needed = 0;  // the least mu that holds all states; infinite: none up to 10
  int states = 0, skipped = 0, pivots = 0;
};

// All results for one grip. `states` and `score` are empty where the grip is not feasible.
struct GripFindings {
  GripResult result;
  std::vector<GripState> states;  // fill-major, in the order asked
  GripScore score;                // over the scene's own fills and tilts
  std::optional<GripHold> hold;   // of the same evaluation as the score; nothing where that is for the core in double to say
  bool is_core_double = true;     // what the core in double adds is then of the same evaluation too
};

// Fills and tilts of the states that are asked for. Without liquid the one fill is 0. A scene leaves out states of its own list of
// tilts; of another list all states count.
struct StateAxes {
  std::vector<double> fills{0.0};
  std::vector<double> tilts;  // rad; empty: no states
  double capacity = 0;        // m3: of the vessel, where the fills are asked for as volumes; 0 where they are shares
};

// Answers one grip of one vessel of the scene that it was made for.
struct GripMethods {
  std::string device;  // what answers, for people
  std::function<GripFindings(std::size_t vessel, const GripInput& grip, const StateAxes& axes)> answer;
};

// The scene's own fills of a vessel, and its tilts.
StateAxes scene_axes(const Scene& scene, std::size_t vessel);

// The core's kernels called directly. Shares the evaluator, which must have been made for `scene`.
GripMethods core_grip_methods(const Scene& scene, std::shared_ptr<const Evaluator> evaluator, const std::string& device);

// A backend's planes: one run over the grip with every field kept, and a second one where other states are asked for than the scene
// has. `open` gives a backend for a scene and its fields, as open_backend does.
using BackendOpener = std::function<std::unique_ptr<Backend>(const Scene&, const FieldSet&)>;
GripMethods backend_grip_methods(const Scene& scene, const BackendOpener& open);

// By the name that a user gives, as for open_backend: "core" is called directly, everything else through its planes.
GripMethods open_grip_methods(const Scene& scene, const std::string& on, Precision precision);

}  // namespace wholehand
