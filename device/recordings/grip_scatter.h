// SPDX-License-Identifier: MIT
// How much a person's grips scatter: the standard deviations that a scene's [robust] takes, from recorded grasps.
#pragma once

#include <array>
#include <cstddef>
#include <set>
#include <span>
#include <string>

#include "base/statistics/interval.h"
#include "core/reader/ranges.h"
#include "core/result.h"
#include "device/recordings/grasp_measure.h"

namespace wholehand::device {

// Fewer degrees of freedom give no table: the interval of five already reaches from 0.6 to 2.5 times the deviation.
constexpr std::size_t LEAST_FREEDOM = 5;

// A key of [robust] whose deviation grasps show.
struct ScatterKey {
  const char *name, *name_si;  // of the key; in JSON
  double GripInput::*number;
  bool turns;      // an angle without ends
  Quantity range;  // that the key takes
};
extern const std::array<ScatterKey, 5> SCATTER_KEYS;

// A standard deviation, SI, and its 95 % interval if the deviations are normal.
struct ScatterDeviation {
  double value = 0;
  Interval interval;
};

// A group is the grasps of one person, one vessel and one shown guidance point. Where a person grips on average, and a plan that differs between
// groups, are no scatter: deviations are from the mean of the group. A grasp that is alone in its group shows none, so it does not count.
class GripScatter {
 public:
  // Adds the grasps of one person.
  void add(std::span<const GraspReport> grasps);

  std::size_t grasps() const { return grasps_; }             // grasps that count
  std::size_t vessels() const { return vessels_.size(); }    // of the grasps that count
  std::size_t freedom() const { return grasps_ - groups_; }  // degrees of freedom
  bool is_enough() const { return freedom() >= LEAST_FREEDOM; }
  // In the order of SCATTER_KEYS; is_enough().
  std::array<ScatterDeviation, 5> deviations() const;
  // The [robust] table of a scene, with its comments; or one line, why there is none.
  std::string table() const;

 private:
  std::size_t grasps_ = 0, groups_ = 0, people_ = 0;
  std::set<int> vessels_;
  std::array<double, 5> squares_{};  // of the differences from the groups' means
};

}  // namespace wholehand::device
