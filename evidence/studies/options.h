// SPDX-License-Identifier: MIT
// Options of a study, besides its scene.
#pragma once

#include <cstdint>
#include <string>

namespace wholehand {

// How many people each experiment has by default.
struct StudyPeople {
  std::uint64_t contacts = 10'000, forces = 1000, sessions = 500;
  std::uint64_t advice = 0;  // ours, not the paper's: only on request
};
constexpr std::uint64_t ADVICE_PEOPLE = 200, QUICK_ADVICE_PEOPLE = 10;  // where it is
constexpr StudyPeople QUICK_PEOPLE{500, 20, 20};
constexpr int STUDY_RESAMPLES = 1000, QUICK_RESAMPLES = 200;

struct StudyOptions {
  std::string folder;  // for all files
  StudyPeople people;  // 0: this experiment is left out
  std::uint64_t seed = 1;
  int resamples = STUDY_RESAMPLES;  // for the intervals
  int threads = 0;                  // 0: all
  bool resumes = false;             // continues the folder's journal
};

}  // namespace wholehand
