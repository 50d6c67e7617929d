// SPDX-License-Identifier: MIT
// One grip with every intermediate value, for people and as JSON.
#pragma once

#include <string>

#include "sweeps/grips/holding.h"
#include "sweeps/grips/methods.h"
#include "sweeps/grips/quality.h"

namespace wholehand::sweeps {

// The request and its results.
struct GripReport {
  std::string scene, vessel, device;
  GripInput grip;
  GripFindings answer;
  Triple pour{};  // horizontal direction towards which the vessel is tilted, unit, vessel frame; zero for a vertical line
  bool has_liquid = false;
  double capacity = 0;                     // m3: of the vessel, if fills are requested as volumes; 0 if they are shares
  double length_error = 0;                 // m: the error of lengths (from the lattice of a mesh); 0: they are exact
  bool has_tilts = false;                  // the scene's: without them there are no force and hold terms
  std::vector<double> score_fills;         // fills of the score's terms
  std::size_t score_tilts = 0;             // the scene's,
  std::vector<std::size_t> counted_tilts;  // how many of them count at each of those fills,
  std::vector<double> last_tilts;          // and the last counted one, rad; empty without tilts
  std::vector<StateHold> holds;            // of answer.states; empty until add_holding
  std::optional<GripHold> hold;            // over the scene's states; nothing without tilts
  std::optional<GripQuality> quality;      // nothing until add_quality
  std::optional<double> held_share;        // share of the [robust] deviations that hold, if they were judged
};

// Evaluates the grip.
GripReport make_grip_report(const Scene& scene, std::size_t vessel, const GripInput& grip, const StateAxes& axes,
                            const GripMethods& methods);

// Adds the efforts of the whole hand: over the scene's states from the grip's own evaluation, and state by state from the core in double, whichever
// device answered. Does nothing for an infeasible grip.
void add_holding(GripReport& report, const Scene& scene, std::size_t vessel);
// The same with an existing evaluator for `scene`, for many grips.
void add_holding(GripReport& report, const Scene& scene, std::size_t vessel, const Evaluator& evaluator);

// Adds measures of the grasp, and to each of `holds` the fingers' shares, also by the core in double; takes seconds. Does nothing for an infeasible
// grip.
void add_quality(GripReport& report, const Scene& scene, std::size_t vessel);

// One JSON object in one line, SI units, points in the vessel frame; docs/grip.md names the fields. Fields beyond the reason of an infeasible grip
// are absent; an infinite hold force, the center of no liquid and the forces of a state that is left out are null. Doubles read back unchanged.
std::string grip_json(const GripReport& report);

// The share of deviations that hold, in whole percent, rounded down: "100" means all.
std::string held_percent(double share);

// Whether a grip with this worst effort and this least friction runs out of friction before strength: the margin of friction is the smaller one, or
// no strength is enough.
bool friction_fails_first(const Scene& scene, double effort, double friction_needed);

// Whether the grip holds the vessel, with what share of the hand's strength, what fails first, and how certain that is: some sentences, one per line.
// `scene` is the report's.
std::string grip_verdict(const Scene& scene, const GripReport& report);

// The content of the JSON object as tables, in mm, degrees, mL and g.
std::string grip_table(const GripReport& report);

// Horizontal direction in which a tilt turns the vessel's mouth: away from the palm at roll 0, or towards it if the scene's liquid is poured so. Zero
// if the thumb-index line is vertical.
Triple pour_direction(const Scene& scene, const GripInput& grip);

// The grip whose thumb-index line runs through two points of the vessel frame, m, with the given roll and hand scale. With d = unit(index - thumb):
// obliquity = asin(d.y), azimuth = atan2(-d.z, d.x). The line passes the axis at o = (0, height, 0) + offset e, with the horizontal direction e =
// unit(d x y): offset = thumb . e, height = the line's y there. Throws Error (usage) if the points coincide or lie above one another.
GripInput grip_through(const Triple& thumb, const Triple& index, double roll, double hand_scale);

}  // namespace wholehand::sweeps
