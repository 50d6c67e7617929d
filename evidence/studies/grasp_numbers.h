// SPDX-License-Identifier: MIT
// A grasp's contribution to the statistics of sessions: NaN if it does not count; a share is the mean of 0 and 1. docs/study.md says which grasps
// count for each number.
#pragma once

#include <cmath>
#include <limits>

#include "device/recordings/grasp_measure.h"

namespace wholehand {

constexpr double HARD_GRIP = 8, SOFT_GRIP = 1;  // N: the paper counts people who maintain with more or less than this

namespace of_grasp {

constexpr double NO_VALUE = std::numeric_limits<double>::quiet_NaN();

using Number = double (*)(const device::GraspReport&);

inline double counted_if(bool counts, double value) { return counts ? value : NO_VALUE; }
inline bool is_tilted(const device::GraspReport& grasp) { return grasp.largest_tilt >= device::LEAST_ANALYZED; }
inline bool is_analyzed(const device::GraspReport& grasp) { return grasp.course != device::GripCourse::not_analyzed; }
inline bool is_maintained(const device::GraspReport& grasp) { return is_tilted(grasp) && std::isfinite(grasp.after_at_first); }

inline double response_time(const device::GraspReport& grasp) { return grasp.response_time; }
inline double grip_stopped(const device::GraspReport& grasp) { return grasp.tightened; }
inline double is_lost(const device::GraspReport& grasp) { return grasp.outcome == device::GraspOutcome::lost ? 1 : 0; }
inline double tilt_time(const device::GraspReport& grasp) { return counted_if(is_tilted(grasp), grasp.tilt_time); }
inline double grip_before(const device::GraspReport& grasp) { return counted_if(is_tilted(grasp), grasp.before.mean); }
inline double grip_during(const device::GraspReport& grasp) { return counted_if(is_tilted(grasp), grasp.during.mean); }
inline double grip_after(const device::GraspReport& grasp) { return counted_if(is_tilted(grasp), grasp.after.mean); }
inline double maintained_time(const device::GraspReport& grasp) { return counted_if(is_maintained(grasp), grasp.duration[2]); }
inline double is_hard(const device::GraspReport& grasp) {
  return counted_if(is_maintained(grasp), grasp.after_at_first > HARD_GRIP);
}
inline double is_soft(const device::GraspReport& grasp) {
  return counted_if(is_maintained(grasp), grasp.after_at_first < SOFT_GRIP);
}
inline double normal_increase(const device::GraspReport& grasp) { return counted_if(is_analyzed(grasp), grasp.normal_increase); }
inline double grip_change(const device::GraspReport& grasp) { return counted_if(is_analyzed(grasp), grasp.grip_change); }
inline double has_tilt(const device::GraspReport& grasp) { return is_tilted(grasp) ? 1 : 0; }
inline double has_type(const device::GraspReport& grasp) { return counted_if(is_tilted(grasp), is_analyzed(grasp)); }
inline double is_saturated(const device::GraspReport& grasp) { return counted_if(is_tilted(grasp), grasp.saturated > 0); }
inline double is_rising(const device::GraspReport& grasp) { return counted_if(is_analyzed(grasp), grasp.grip_change > 0); }
inline double is_falling(const device::GraspReport& grasp) { return counted_if(is_analyzed(grasp), !(grasp.grip_change > 0)); }
template <device::GripCourse COURSE>
double has_course(const device::GraspReport& grasp) {
  return counted_if(is_analyzed(grasp), grasp.course == COURSE);
}

}  // namespace of_grasp
}  // namespace wholehand
