// SPDX-License-Identifier: MIT
// Tests whether advice helps: a virtual person does the mixing task as planned, and again with the advised grips.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "core/scene.h"
#include "device/advice/advice_loop.h"
#include "device/session/session.h"

namespace wholehand {

// A larger effort counts as this one: beyond twice the strength, more makes no difference.
constexpr double LARGEST_COUNTED_EFFORT = 2;
constexpr double EFFORT_LOOKS = 20;  // Hz at which the effort of a held vessel is sampled

// One session.
struct AdvisedOutcome {
  double grasps = 0, lost = 0;
  double effort = 0;    // the largest of each grasp, averaged; NaN: no grasp
  double seconds = 0;   // until it was over
  double is_whole = 0;  // 1: it ended by itself

  double lost_share() const;  // of the grasps; NaN: none
};

// The same person with the same random numbers.
struct AdvisedPerson {
  AdvisedOutcome without, with;
};

// Follows the ticks of a session.
class EffortWatch {
 public:
  explicit EffortWatch(double rate);  // of the session, Hz
  void take(const device::Tick& tick, const device::Session& session);
  // Mean over the grasps of the largest effort of each, at most LARGEST_COUNTED_EFFORT; NaN: no grasp.
  double mean() const;

 private:
  std::int64_t period_;  // ticks between two looks
  int grasps_ = 0;       // counted by the last tick
  std::vector<double> largest_;
};

// Ends early if `stop` is set. The core advises in step with the session. Makes no grasps for a person whose hand holds no vessel. Throws Error
// (failure) if the advice ends or changes its device, because the session would then be one without advice.
AdvisedPerson advised_person(const Scene& scene, std::uint64_t seed, std::uint64_t person, const std::atomic<bool>& stop);
// With a custom adviser.
AdvisedPerson advised_person(const Scene& scene, std::uint64_t seed, std::uint64_t person, const std::atomic<bool>& stop,
                             const device::AdviceLoop::AdviserOpener& open);

// As numbers, to the bit, for a journal.
std::vector<double> to_numbers(const AdvisedPerson& person);
AdvisedPerson person_from_numbers(const std::vector<double>& numbers);

}  // namespace wholehand
