// SPDX-License-Identifier: MIT
// The experiment of contacts (the paper's section V-A): where the hands of a population touch, and what samples of the paper's size show.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "evidence/studies/contact_plan.h"
#include "evidence/studies/options.h"
#include "evidence/studies/row.h"

namespace wholehand {

struct ContactStudy {
  // Pose by pose; for each its vessels, and ALL_VESSELS if there are several.
  std::vector<StudyRow> rows;
  std::vector<StudyRow> sensitivity;  // without a pose
  std::uint64_t grasps = 0;           // made, each in every pose
};

// Takes the grasps of a person (ContactPlan::of_person).
using ContactTaker = std::function<void(std::uint64_t person, std::span<const ContactGrasp> grasps)>;

// The same bits for any number of threads. Absent: `stop` was set. Shows its progress. `take` gets one person after the other, in order.
std::optional<ContactStudy> study_contacts(const ContactPlan& plan, const StudyOptions& options, const std::atomic<bool>& stop,
                                           const ContactTaker& take = {});

}  // namespace wholehand
