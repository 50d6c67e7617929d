// SPDX-License-Identifier: MIT
// Statistics of many grasps about how the hand touches, for a population or a sample from it. docs/study.md has each of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/statistics/running_correlation.h"
#include "core/scene.h"

namespace wholehand {

// One grasp, as counted.
struct ContactGrasp {
  double height = 0;                                            // of the thumb-index line, vessel frame, m
  double distance = 0;                                          // from the guidance point, m
  std::uint32_t touch_mask = 0;                                 // bit j: point j touches
  std::uint32_t tip_mask = 0, finger_mask = 0, inner_mask = 0;  // projected points, by role
  std::uint32_t used_mask = 0;                                  // bit f: finger f is used
  bool is_held = false;                                         // the grip is feasible; else the members above have no meaning
  bool is_plausible = false;                                    // and no part of the hand is deep in the vessel
};

// The grasps that a statistic is taken over: all, those that hold, or those of them with a projected point.
enum class ContactsOver : std::size_t { made, held, projected };
constexpr std::size_t CONTACTS_OVER = 3;
bool is_counted(const ContactGrasp& grasp, ContactsOver over);

// A statistic of grasps, in one order for all tallies. `subject`: the point of the hand, or empty.
struct ContactStatistic {
  std::string name, subject;
  ContactsOver over = ContactsOver::held;
};
const std::vector<ContactStatistic>& contact_statistics();

// Keeps only sums. The same grasps in the same order give the same bits.
class ContactTally {
 public:
  ContactTally();
  void add(const ContactGrasp& grasp);
  // Adds all grasps of another tally, each as if made `weight` (above 0) times.
  void add(const ContactTally& other, double weight);
  double grasps() const { return counts_[made]; }
  double held() const { return counts_[holding]; }
  // One value for each of contact_statistics(); NaN: there is none.
  std::vector<double> values() const;

 private:
  enum { height, distance, measures };  // that correlations are with
  enum { tip, finger, inner, roles };
  // Counts. All except `made` only cover the grasps that hold.
  enum {
    made,
    holding,
    plausible,
    fingers_used,
    points_touching,
    touching,                                 // by point
    with_projected = touching + JOINT_COUNT,  // grasps with projected points
    with_role,                                // by role
    projected = with_role + roles,            // points
    projected_to,                             // by role
    all_counts = projected_to + roles
  };

  std::array<double, all_counts> counts_{};  // whole numbers without weights, exact up to 2^53
  std::array<RunningCorrelation, measures> fingers_, points_;
  std::array<std::array<RunningCorrelation, measures>, JOINT_COUNT> touches_;
};

}  // namespace wholehand
