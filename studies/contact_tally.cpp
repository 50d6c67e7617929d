// SPDX-License-Identifier: MIT
#include "studies/contact_tally.h"

#include <fmt/format.h>

#include <bit>
#include <limits>

#include "core/joints.h"

namespace wholehand {
namespace {

constexpr std::array<const char*, 5> FINGER_POINTS{"cmc", "mcp", "pip", "dip", "tip"};
constexpr std::array<const char*, 4> THUMB_POINTS{"cmc", "mcp", "ip", "tip"};
constexpr double ABSENT = std::numeric_limits<double>::quiet_NaN();

double r_of(const Correlation& correlation) { return correlation.r.value_or(ABSENT); }

double share(std::size_t yes, std::size_t all) { return all == 0 ? ABSENT : static_cast<double>(yes) / static_cast<double>(all); }

std::vector<ContactStatistic> all_statistics() {
  std::vector<ContactStatistic> all{{"held_share", ""}, {"plausible_share", ""}, {"mean_fingers", ""}, {"mean_points", ""}};
  for (const char* name : {"pearson_fingers_height", "pearson_fingers_distance", "pearson_points_height", "pearson_points_distance",
                           "projected_share", "projected_tip_share", "projected_finger_share", "projected_inner_share",
                           "grasps_projected_tip_share", "grasps_projected_finger_share", "grasps_projected_inner_share"})
    all.push_back({name, ""});
  for (const char* name : {"touch_share", "point_biserial_height", "point_biserial_distance"})
    for (int joint = 0; joint < JOINT_COUNT; ++joint) all.push_back({name, hand_point_name(joint)});
  return all;
}

}  // namespace

std::string hand_point_name(int joint) {
  const int digit = finger_of(joint), k = joint - finger_start(digit);
  return fmt::format("{}_{}", FINGER_NAMES[digit], digit == 0 ? THUMB_POINTS[k] : FINGER_POINTS[k]);
}

const std::vector<ContactStatistic>& contact_statistics() {
  static const std::vector<ContactStatistic> all = all_statistics();
  return all;
}

void ContactTally::add(const ContactGrasp& grasp) {
  ++grasps_;
  if (!grasp.is_held) return;
  ++held_;
  plausible_ += grasp.is_plausible ? 1 : 0;
  const std::array<double, measures> x{grasp.height, grasp.distance};
  for (std::size_t m = 0; m < measures; ++m) {
    fingers_[m].add(x[m], std::popcount(grasp.used_mask));
    points_[m].add(x[m], std::popcount(grasp.touch_mask));
    for (int joint = 0; joint < JOINT_COUNT; ++joint) touches_[joint][m].add(x[m], grasp.touch_mask >> joint & 1);
  }
  const std::array<std::uint32_t, roles> masks{grasp.tip_mask, grasp.finger_mask, grasp.inner_mask};
  bool has_projected = false;
  for (std::size_t role = 0; role < roles; ++role) {
    const auto points = static_cast<std::size_t>(std::popcount(masks[role]));
    points_by_role_[role] += points;
    projected_points_ += points;
    grasps_by_role_[role] += points > 0 ? 1 : 0;
    has_projected = has_projected || points > 0;
  }
  projected_grasps_ += has_projected ? 1 : 0;
}

// In the order of all_statistics.
std::vector<double> ContactTally::values() const {
  std::vector<double> all{share(held_, grasps_), share(plausible_, held_), fingers_[height].mean_y(), points_[height].mean_y()};
  for (const auto& counts : {fingers_, points_})
    for (const RunningCorrelation& correlation : counts) all.push_back(r_of(correlation.pearson()));
  all.push_back(share(projected_grasps_, held_));
  for (const std::size_t points : points_by_role_) all.push_back(share(points, projected_points_));
  for (const std::size_t grasps : grasps_by_role_) all.push_back(share(grasps, held_));
  for (const auto& point : touches_) all.push_back(point[height].mean_y());
  for (std::size_t m = 0; m < measures; ++m)
    for (const auto& point : touches_) all.push_back(r_of(point[m].point_biserial()));
  return all;
}

}  // namespace wholehand
