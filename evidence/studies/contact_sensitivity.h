// SPDX-License-Identifier: MIT
// Which traits of a person decide how their hand touches.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/statistics/given_data_indices.h"
#include "evidence/studies/contact_plan.h"
#include "evidence/studies/contact_tally.h"
#include "evidence/studies/row.h"

namespace wholehand {

// The outputs of a person: pose by pose, means over the person's own grasps of the paper's vessels.
const std::vector<std::string>& contact_answer_names();

// Sums over people, added one by one.
class ContactSensitivity {
 public:
  // `plan` must outlive it.
  explicit ContactSensitivity(const ContactPlan& plan);

  // Adds a person and that person's grasps: those of the plan in the first of STUDY_POSES, then in the next.
  void add(std::uint64_t seed, std::uint64_t number, std::span<const ContactGrasp> grasps);

  std::vector<StudyRow> rows() const;

 private:
  const ContactPlan& plan_;
  GivenDataIndices indices_;
};

}  // namespace wholehand
