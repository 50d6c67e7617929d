// SPDX-License-Identifier: MIT
#include "evidence/studies/contact_sensitivity.h"

#include <bit>
#include <limits>

#include "core/people/person.h"
#include "evidence/studies/sensitivity.h"

namespace wholehand {
namespace {

std::vector<std::string> all_answer_names() {
  std::vector<std::string> names;
  for (const char* pose : STUDY_POSE_NAMES)
    for (const char* answer : {"held_share", "mean_fingers", "mean_points", "projected_share", "mean_distance"})
      names.push_back(std::string(pose) + "_" + answer);
  return names;
}

// The sums of a person's grasps in one pose.
struct PersonSums {
  double grasps = 0, held = 0, fingers = 0, points = 0, projected = 0, distance = 0;

  void add(const ContactGrasp& grasp) {
    grasps += 1;
    if (!grasp.is_held) return;
    held += 1;
    fingers += std::popcount(grasp.used_mask);
    points += std::popcount(grasp.touch_mask);
    projected += (grasp.tip_mask | grasp.finger_mask | grasp.inner_mask) != 0 ? 1 : 0;
    distance += grasp.distance;
  }
  // In the order of the names. What nothing was held for is absent.
  void append_to(std::vector<double>& answers) const {
    answers.push_back(grasps > 0 ? held / grasps : std::numeric_limits<double>::quiet_NaN());
    for (const double sum : {fingers, points, projected, distance})
      answers.push_back(held > 0 ? sum / held : std::numeric_limits<double>::quiet_NaN());
  }
};

}  // namespace

const std::vector<std::string>& contact_answer_names() {
  static const std::vector<std::string> names = all_answer_names();
  return names;
}

ContactSensitivity::ContactSensitivity(const ContactPlan& plan)
    : plan_(plan), indices_(person_input_names().size(), contact_answer_names().size()) {}

void ContactSensitivity::add(std::uint64_t seed, std::uint64_t number, std::span<const ContactGrasp> grasps) {
  const std::vector<PlannedGrasp>& planned = plan_.grasps();
  std::vector<double> answers;
  for (std::size_t pose = 0; pose < STUDY_POSES.size(); ++pose) {
    PersonSums sums;
    for (std::size_t g = 0; g < planned.size(); ++g)
      if (plan_.vessels()[planned[g].vessel].is_of_paper) sums.add(grasps[pose * planned.size() + g]);
    sums.append_to(answers);
  }
  indices_.add(person_inputs(draw_shares(seed, number)), answers);
}

std::vector<StudyRow> ContactSensitivity::rows() const {
  return sensitivity_rows("contacts", contact_answer_names(), person_input_names(), indices_);
}

}  // namespace wholehand
