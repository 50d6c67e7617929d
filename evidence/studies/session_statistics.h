// SPDX-License-Identifier: MIT
// The paper's numbers about its mixing task (section V-B, Table 3, Figs 8 and 9), from the grasps of many people. Simulated and recorded people go
// through the same code. docs/study.md has each statistic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/scene.h"
#include "device/recordings/grasp_measure.h"
#include "evidence/studies/row.h"

namespace wholehand {

// Fewer people than this have no intervals.
constexpr std::size_t LEAST_SUBJECTS = 3;
// Fewer people do not show how much people differ: their intervals hold less than 93 % of repetitions (docs/study.md).
constexpr std::size_t ENOUGH_SUBJECTS = 50;
// A warning for the reader; empty from ENOUGH_SUBJECTS on, and where there are no intervals.
std::string few_people_note(std::size_t people);

// A vessel of the scene that stands for one of the paper's.
struct SessionVessel {
  std::size_t place = 0;  // in the scene, and GraspReport::vessel
  std::string name;
};
using SessionVessels = std::vector<SessionVessel>;  // for the paper's first, second and third: 1 to 3

// Throws Error (usage) if nothing is poured in the scene, or one of them is named ALL_VESSELS.
SessionVessels session_vessels(const Scene& scene);

struct SessionSubject {
  std::vector<device::GraspReport> grasps;  // all of one person's sessions
};

struct SessionSampling {
  std::uint64_t seed = 1;
  int resamples = 1000;  // for the intervals, at least 1
  int threads = 0;       // 0: all
  // The simulated user tilts as fast as the paper's people did, so the paper's tilt time is not compared.
  bool are_simulated = false;
};

// Rows of the experiment "sessions": for all vessels together, for each vessel, and inside_share. Grasps of other vessels do not count. `subjects`:
// at least one. The same bits for any number of threads.
std::vector<StudyRow> session_rows(std::span<const SessionSubject> subjects, const SessionVessels& vessels,
                                   const SessionSampling& sampling);

}  // namespace wholehand
