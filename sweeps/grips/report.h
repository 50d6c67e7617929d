// SPDX-License-Identifier: MIT
// One grip with every intermediate value, for people and as JSON.
#pragma once

#include <string>

#include "sweeps/grips/holding.h"
#include "sweeps/grips/methods.h"
#include "sweeps/grips/quality.h"

namespace wholehand {

// What was asked and what came of it.
struct GripReport {
  std::string scene, vessel, device;
  GripInput grip;
  GripFindings answer;
  Triple pour{};  // horizontal direction towards which the vessel is tilted, unit, vessel frame; zero for a vertical line
  bool has_liquid = false;
  double capacity = 0;                     // m3: of the vessel, where fills are asked for as volumes; 0 where they are shares
  double length_error = 0;                 // m: to which lengths are known (of the lattice of a mesh); 0: they are exact
  bool has_tilts = false;                  // the scene's: without them there are no force and hold terms
  std::vector<double> score_fills;         // fills of the score's terms
  std::size_t score_tilts = 0;             // the scene's,
  std::vector<std::size_t> counted_tilts;  // how many of them count at each of those fills,
  std::vector<double> last_tilts;          // and the last that does, rad; empty without tilts
  std::vector<StateHold> holds;            // of answer.states; empty until add_holding
  std::optional<GripHold> hold;            // over the scene's states; nothing without tilts
  std::optional<GripQuality> quality;      // nothing until add_quality
  std::optional<double> held_share;        // of the deviations of [robust] those that hold, where they were judged
};

// Evaluates the grip.
GripReport make_grip_report(const Scene& scene, std::size_t vessel, const GripInput& grip, const StateAxes& axes,
                            const GripMethods& methods);

// Adds the efforts of the whole hand: over the scene's states from the grip's own evaluation, and state by state by the core in double,
// whatever device answered. Does nothing for an infeasible grip.
void add_holding(GripReport& report, const Scene& scene, std::size_t vessel);
// The same with an evaluator that was made for `scene` before: for many grips of it.
void add_holding(GripReport& report, const Scene& scene, std::size_t vessel, const Evaluator& evaluator);

// Measures of the grasp, by the core in double too; takes seconds. Does nothing for an infeasible grip.
void add_quality(GripReport& report, const Scene& scene, std::size_t vessel);

// One JSON object in one line, SI units, points in the vessel frame; docs/grip.md names the fields. What does not exist up to the
// reason of an infeasible grip is absent; an infinite hold force, the center of no liquid and the forces of a state that is left
// out are null. Doubles read back as they were.
std::string grip_json(const GripReport& report);

// The share of deviations that hold in whole percents, rounded down: "100" says that all do.
std::string held_percent(double share);

// Whether a grip with this worst effort and this least friction that holds it runs out of friction before it runs out of strength: the
// margin of friction is the smaller one, or no strength is enough.
bool friction_fails_first(const Scene& scene, double effort, double friction_needed);

// Whether the grip holds the vessel, with how much of the hand's strength, what fails first, and how sure that is: some sentences, each in a line.
// `scene` is that of the report.
std::string grip_verdict(const Scene& scene, const GripReport& report);

// The same as the JSON object as tables, in mm, degrees, mL and g.
std::string grip_table(const GripReport& report);

// Horizontal direction towards which a tilt turns the vessel's mouth: away from the palm at roll 0, or towards it where the scene's
// liquid is poured so. Zero where the thumb-index line is vertical.
Triple pour_direction(const Scene& scene, const GripInput& grip);

// The grip whose thumb-index line runs through two points of the vessel frame, m, with roll and hand scale as given. With
// d = unit(index - thumb): obliquity = asin(d.y), azimuth = atan2(-d.z, d.x); along d and the horizontal direction e = unit(d x y)
// the line's foot o = (0, height, 0) + offset e is where it passes the axis: offset = thumb . e, height = the line's y there.
// Throws Error (usage) where the points coincide or lie above one another.
GripInput grip_through(const Triple& thumb, const Triple& index, double roll, double hand_scale);

}  // namespace wholehand
