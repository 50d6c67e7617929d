// SPDX-License-Identifier: MIT
#include "evidence/studies/session_page.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "base/text/text.h"
#include "evidence/studies/paper_sample.h"

namespace wholehand {

StudySection session_section(const SessionVessels& vessels, std::vector<StudyRow> rows, bool are_simulated) {
  StudySection section;
  section.id = "sessions";
  section.title = "Sessions";
  std::vector<std::string> samples;
  for (std::size_t v = 0; v < vessels.size(); ++v)
    samples.push_back(fmt::format("{} stands for the paper's vessel {}: {}", vessels[v].name, v + 1, PAPER_GRASPS[v]));
  section.words = {
      fmt::format("People pour from the vessels, as in the paper's mixing task. The intervals are those of samples of the paper's "
                  "size, with {} people and at most so many grasps. {}.",
                  PAPER_PEOPLE, joined(samples, ", ")),
      "Forces before, during and after the tilt, the times of tilting and maintaining, and the forces at first are of the grasps "
      "that are tilted by 30 degrees or more. The increase of the normal force, the types, and whether the grip rises are of the "
      "grasps that have a type. All other numbers are of all grasps.",
      are_simulated ? "The people are virtual. They tilt as fast as the paper's people did, so the paper's tilt time is nothing to "
                      "compare with."
                    : "The people are those of the recordings, one person each."};
  section.rows = std::move(rows);
  return section;
}

}  // namespace wholehand
