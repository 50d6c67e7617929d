// SPDX-License-Identifier: MIT
// What is asked of a study beside its scene.
#pragma once

#include <cstdint>
#include <string>

namespace wholehand {

constexpr std::uint64_t STUDY_PEOPLE = 10'000, QUICK_PEOPLE = 500;
constexpr int STUDY_RESAMPLES = 1000, QUICK_RESAMPLES = 200;

struct StudyOptions {
  std::string folder;  // for all files
  std::uint64_t people = STUDY_PEOPLE;
  std::uint64_t seed = 1;
  int resamples = STUDY_RESAMPLES;  // for the intervals
  int threads = 0;                  // 0: all
};

}  // namespace wholehand
