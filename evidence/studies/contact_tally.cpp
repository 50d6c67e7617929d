// SPDX-License-Identifier: MIT
#include "evidence/studies/contact_tally.h"
#include "core/joints.h"

#include <fmt/format.h>

#include <bit>
#include <limits>

namespace wholehand {
namespace {

// m: distances that differ by less do not vary. Each has the error of the search for its contact: the tolerance, 1e-9 m, and up to some ten times
// that if a fingertip meets the vessel at a flat angle. Hands scatter a thousand times more.
constexpr double LEAST_DISTANCE = 1e-7;
constexpr double ABSENT = std::numeric_limits<double>::quiet_NaN();

double r_of(const Correlation& correlation) { return correlation.r.value_or(ABSENT); }

double share(double yes, double all) { return all > 0 ? yes / all : ABSENT; }

std::vector<ContactStatistic> all_statistics() {
  std::vector<ContactStatistic> all{
      {"held_share", "", ContactsOver::made}, {"plausible_share", ""}, {"mean_fingers", ""}, {"mean_points", ""}};
  for (const char* name : {"pearson_fingers_height", "pearson_fingers_distance", "pearson_points_height", "pearson_points_distance",
                           "projected_share"})
    all.push_back({name, ""});
  for (const char* name : {"projected_tip_share", "projected_finger_share", "projected_inner_share"})
    all.push_back({name, "", ContactsOver::projected});
  for (const char* name : {"grasps_projected_tip_share", "grasps_projected_finger_share", "grasps_projected_inner_share"})
    all.push_back({name, ""});
  for (const char* name : {"touch_share", "point_biserial_height", "point_biserial_distance"})
    for (int joint = 0; joint < JOINT_COUNT; ++joint) all.push_back({name, joint_key(joint)});
  return all;
}

}  // namespace

bool is_counted(const ContactGrasp& grasp, ContactsOver over) {
  if (over == ContactsOver::made) return true;
  return grasp.is_held && (over == ContactsOver::held || (grasp.tip_mask | grasp.finger_mask | grasp.inner_mask) != 0);
}

const std::vector<ContactStatistic>& contact_statistics() {
  static const std::vector<ContactStatistic> all = all_statistics();
  return all;
}

ContactTally::ContactTally() {
  fingers_[distance] = points_[distance] = RunningCorrelation(LEAST_DISTANCE);
  for (auto& point : touches_) point[distance] = RunningCorrelation(LEAST_DISTANCE);
}

void ContactTally::add(const ContactGrasp& grasp) {
  counts_[made] += 1;
  if (!grasp.is_held) return;
  const int fingers = std::popcount(grasp.used_mask), points = std::popcount(grasp.touch_mask);
  counts_[holding] += 1;
  counts_[plausible] += grasp.is_plausible ? 1 : 0;
  counts_[fingers_used] += fingers;
  counts_[points_touching] += points;
  const std::array<double, measures> x{grasp.height, grasp.distance};
  for (std::size_t m = 0; m < measures; ++m) {
    fingers_[m].add(x[m], fingers);
    points_[m].add(x[m], points);
  }
  for (int joint = 0; joint < JOINT_COUNT; ++joint) {
    const double touches = grasp.touch_mask >> joint & 1;
    counts_[touching + joint] += touches;
    for (std::size_t m = 0; m < measures; ++m) touches_[joint][m].add(x[m], touches);
  }
  const std::array<std::uint32_t, roles> masks{grasp.tip_mask, grasp.finger_mask, grasp.inner_mask};
  for (std::size_t role = 0; role < roles; ++role) {
    const int of_role = std::popcount(masks[role]);
    counts_[projected_to + role] += of_role;
    counts_[projected] += of_role;
    counts_[with_role + role] += of_role > 0 ? 1 : 0;
  }
  counts_[with_projected] += (grasp.tip_mask | grasp.finger_mask | grasp.inner_mask) != 0 ? 1 : 0;
}

void ContactTally::add(const ContactTally& other, double weight) {
  for (std::size_t k = 0; k < all_counts; ++k) counts_[k] += weight * other.counts_[k];
  for (std::size_t m = 0; m < measures; ++m) {
    fingers_[m].add(other.fingers_[m], weight);
    points_[m].add(other.points_[m], weight);
    for (int joint = 0; joint < JOINT_COUNT; ++joint) touches_[joint][m].add(other.touches_[joint][m], weight);
  }
}

// In the order of all_statistics.
std::vector<double> ContactTally::values() const {
  const auto of_held = [this](std::size_t count) { return share(counts_[count], counts_[holding]); };
  std::vector<double> all{share(counts_[holding], counts_[made]), of_held(plausible), of_held(fingers_used),
                          of_held(points_touching)};
  for (const auto& counts : {fingers_, points_})
    for (const RunningCorrelation& correlation : counts) all.push_back(r_of(correlation.pearson()));
  all.push_back(of_held(with_projected));
  for (std::size_t role = 0; role < roles; ++role) all.push_back(share(counts_[projected_to + role], counts_[projected]));
  for (std::size_t role = 0; role < roles; ++role) all.push_back(of_held(with_role + role));
  for (std::size_t joint = 0; joint < JOINT_COUNT; ++joint) all.push_back(of_held(touching + joint));
  for (std::size_t m = 0; m < measures; ++m)
    for (const auto& point : touches_) all.push_back(r_of(point[m].point_biserial()));
  return all;
}

}  // namespace wholehand
