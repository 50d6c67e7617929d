// SPDX-License-Identifier: MIT
// Statistics of many grasps about how the hand touches: of a population, or of a sample from it. docs/study.md has each of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/scene.h"
#include "statistics/running_correlation.h"

namespace wholehand {

// One grasp, as it is counted.
struct ContactGrasp {
  double height = 0;                                            // of the thumb-index line, vessel frame, m
  double distance = 0;                                          // from the guidance point, m
  std::uint32_t touch_mask = 0;                                 // bit j: point j touches
  std::uint32_t tip_mask = 0, finger_mask = 0, inner_mask = 0;  // projected points, by role
  std::uint32_t used_mask = 0;                                  // bit f: finger f is used
  bool is_held = false;                                         // the grip is feasible; else all above has no meaning
  bool is_plausible = false;                                    // and no part of the hand is deep in the vessel
};

// "thumb_mcp", "index_dip".
std::string hand_point_name(int joint);

// What is said of grasps, in one order for all tallies. `subject`: the point of the hand, or empty.
struct ContactStatistic {
  std::string name, subject;
};
const std::vector<ContactStatistic>& contact_statistics();

// Keeps sums alone. The same grasps in the same order give the same bits.
class ContactTally {
 public:
  void add(const ContactGrasp& grasp);
  std::size_t grasps() const { return grasps_; }
  std::size_t held() const { return held_; }
  // One value for each of contact_statistics(); NaN: there is none.
  std::vector<double> values() const;

 private:
  enum { height, distance, measures };  // that correlations are with
  enum { tip, finger, inner, roles };

  std::size_t grasps_ = 0, held_ = 0, plausible_ = 0;
  std::array<RunningCorrelation, measures> fingers_, points_;
  std::array<std::array<RunningCorrelation, measures>, JOINT_COUNT> touches_;
  std::size_t projected_grasps_ = 0, projected_points_ = 0;
  std::array<std::size_t, roles> grasps_by_role_{}, points_by_role_{};
};

}  // namespace wholehand
