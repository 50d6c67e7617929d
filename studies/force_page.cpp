// SPDX-License-Identifier: MIT
#include "studies/force_page.h"

#include <fmt/format.h>

#include <utility>

#include "studies/force_trial.h"

namespace wholehand {

StudySection force_section(std::vector<StudyRow> rows) {
  StudySection section;
  section.id = "forces";
  section.title = "Forces";
  section.words = {
      fmt::format(
          "People grip one vessel, lift it, tilt it and hold it still, under each choice of F_base and F_range: \u201c0.8\u201d is "
          "F_base alone, \u201c0.8-3.8\u201d is F_base to F_base + F_range, in N. The intervals are those of {} people, as many as "
          "in the "
          "paper.",
          FORCE_PEOPLE),
      fmt::format(
          "A person has {} attempts. Who loses the grip in {} of them has lost it often, as the paper counts. A grip oscillates if "
          "its force passes its mean from side to side within a second at rest. The opening is how far the gripper opened beyond "
          "the grasp. The coefficients are those of a logistic regression, for each newton.",
          FORCE_ATTEMPTS, OFTEN)};
  section.rows = std::move(rows);
  return section;
}

}  // namespace wholehand
