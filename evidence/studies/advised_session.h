// SPDX-License-Identifier: MIT
// Does advice help? A virtual person does the mixing task as planned, and again with the advised grips.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "core/scene.h"
#include "device/advice/advice_loop.h"
#include "device/session/session.h"
#include "device/session/vessel_tracker.h"

namespace wholehand {

// A larger effort counts as this one: beyond all of the strength twice the need is no other answer.
constexpr double LARGEST_COUNTED_EFFORT = 2;
constexpr double EFFORT_LOOKS = 20;  // Hz at which the effort of a held vessel is sampled

// One session.
struct AdvisedOutcome {
  double grasps = 0, lost = 0;
  double effort = 0;    // of each grasp the largest that it came to, their mean; NaN: no grasp
  double seconds = 0;   // until it was over
  double is_whole = 0;  // 1: it came to its end by itself

  double lost_share() const;  // of the grasps; NaN: none
};

// The same person with the same numbers of chance.
struct AdvisedPerson {
  AdvisedOutcome without, with;
};

// Follows the ticks of a session.
class EffortWatch {
 public:
  // `live` must outlive it.
  explicit EffortWatch(const LiveScene& live);
  void take(const Tick& tick);
  // Mean over the grasps of the largest effort of each, at most LARGEST_COUNTED_EFFORT; NaN: no grasp.
  double mean() const;

 private:
  const LiveScene& live_;
  VesselTracker tracker_;
  std::int64_t period_;  // ticks between two looks
  int grasps_ = 0;       // that the last tick had counted
  std::vector<double> largest_;
};

// Ends early where `stop` is set. The advice is by the core, in step with the session. Nothing of a person whose hand holds no
// vessel: no grasps. Throws Error (failure) where the advice ends or changes its device: the session would be one without advice.
AdvisedPerson advised_person(const Scene& scene, std::uint64_t seed, std::uint64_t person, const std::atomic<bool>& stop);
// With an adviser of one's own.
AdvisedPerson advised_person(const Scene& scene, std::uint64_t seed, std::uint64_t person, const std::atomic<bool>& stop,
                             const AdviceLoop::AdviserOpener& open);

// As numbers, to the bit, for a journal.
std::vector<double> to_numbers(const AdvisedPerson& person);
AdvisedPerson person_from_numbers(const std::vector<double>& numbers);

}  // namespace wholehand
