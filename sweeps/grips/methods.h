// SPDX-License-Identifier: MIT
// Evaluates one grip by the core or from a device's planes, with the same interface.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/backend.h"
#include "core/evaluator.h"

namespace wholehand::sweeps {

// One fill (fraction of the capacity; 0 if the scene has no liquid) and tilt (rad) of a grip, with its results.
struct GripState {
  double fill = 0, tilt = 0;
  LiquidResult liquid;
  StateResult state;
  bool counts = true;  // false: the scene leaves it out ([tilts] until_poured), and results that depend on forces are NaN
};

// A grip over the scene's own fills and tilts. The effort is a share of the strength: up to 1 the hand holds.
struct GripHold {
  double worst = 0, worst_fill = 0, worst_tilt = 0;  // a state of the largest effort: fraction, rad
  double tips_worst = 0;
  double push = 0;  // N: upright and fullest, the largest push beside the weight at the center of mass along +-x, +-y and +-z
  double friction_needed = 0;  // the least mu that holds all states; infinite: none up to 10
  int states = 0, skipped = 0, pivots = 0;
};

// All results for one grip. `states` and `score` are empty if the grip is not feasible.
struct GripFindings {
  GripResult result;
  std::vector<GripState> states;  // fill-major, in the requested order
  GripScore score;                // over the scene's own fills and tilts
  std::optional<GripHold> hold;   // from the same evaluation as the score; nothing if only the core in double provides it
  bool is_core_double = true;     // the core in double's additions are then from the same evaluation too
};

// Fills and tilts of the requested states. Without liquid the one fill is 0. A scene leaves out states only of its own list of tilts; in any other
// list all states count.
struct StateAxes {
  std::vector<double> fills{0.0};
  std::vector<double> tilts;  // rad; empty: no states
  double capacity = 0;        // m3: of the vessel, if fills are requested as volumes; 0 if they are shares
};

// Answers one grip of one vessel of the scene that it was made for.
struct GripMethods {
  std::string device;  // what answers, for people
  std::function<GripFindings(std::size_t vessel, const GripInput& grip, const StateAxes& axes)> answer;
};

// The scene's own fills of a vessel, and its tilts.
StateAxes scene_axes(const Scene& scene, std::size_t vessel);

// Calls the core's kernels directly. Shares the evaluator, which must have been made for `scene`.
GripMethods core_grip_methods(const Scene& scene, std::shared_ptr<const Evaluator> evaluator, const std::string& device);

// Uses a backend's planes: one run over the grip with every field kept, and a second one if the requested states are not the scene's. `open` gives a
// backend for a scene and its fields, as open_backend does.
using BackendOpener = std::function<std::unique_ptr<Backend>(const Scene&, const FieldSet&)>;
GripMethods backend_grip_methods(const Scene& scene, const BackendOpener& open);

// Chooses by the user's name, as for open_backend: "core" is called directly, everything else through its planes.
GripMethods open_grip_methods(const Scene& scene, const std::string& on, Precision precision);

}  // namespace wholehand::sweeps
