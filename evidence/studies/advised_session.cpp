// SPDX-License-Identifier: MIT
#include "evidence/studies/advised_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "base/text/error.h"
#include "core/people/participant.h"
#include "device/advice/stepped_advice.h"
#include "evidence/studies/simulated_session.h"

namespace wholehand {
namespace {

constexpr double NO_OUTCOME = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t STUDY_CLOUD = 256;  // grips of an update: people are many
constexpr int ADVICE_THREADS = 1;         // people are shared among the threads

constexpr std::array<double AdvisedOutcome::*, 5> OUTCOME_NUMBERS{
    &AdvisedOutcome::grasps, &AdvisedOutcome::lost, &AdvisedOutcome::effort, &AdvisedOutcome::seconds, &AdvisedOutcome::is_whole};

AdvisedOutcome play(const Scene& scene, const Participant& person, std::uint64_t tremor, const std::vector<device::SimJob>& jobs,
                    device::SteppedAdvice* advice, const std::atomic<bool>& stop) {
  EffortWatch efforts(scene.live.rate);
  device::Tick last;
  SimulatedSession asked{scene, person, tremor, jobs};
  asked.shown = advice;
  const bool is_whole = run_simulated(
      asked,
      [&](const device::Tick& tick, const device::Session& session) {
        if (advice) advice->look(tick, session.poses());
        efforts.take(tick, session);
        last = tick;
        return true;
      },
      stop);
  return {static_cast<double>(last.grasps), static_cast<double>(last.lost), efforts.mean(),
          static_cast<double>(last.number) / scene.live.rate, is_whole ? 1.0 : 0.0};
}

}  // namespace

double AdvisedOutcome::lost_share() const { return grasps > 0 ? lost / grasps : NO_OUTCOME; }

EffortWatch::EffortWatch(double rate) : period_(std::max<std::int64_t>(1, std::llround(rate / EFFORT_LOOKS))) {}

void EffortWatch::take(const device::Tick& tick, const device::Session& session) {
  if (!device::is_held(tick.state)) return;
  if (tick.grasps > grasps_) largest_.push_back(0);
  grasps_ = tick.grasps;
  if (tick.number % period_ != 0) return;
  const device::HandView hand = device::hand_view(session.live(), tick, session.poses());
  if (hand.hold) largest_.back() = std::max(largest_.back(), std::min(LARGEST_COUNTED_EFFORT, hand.hold->effort));
}

double EffortWatch::mean() const {
  if (largest_.empty()) return NO_OUTCOME;
  return std::accumulate(largest_.begin(), largest_.end(), 0.0) / static_cast<double>(largest_.size());
}

AdvisedPerson advised_person(const Scene& scene, std::uint64_t seed, std::uint64_t person, const std::atomic<bool>& stop) {
  return advised_person(scene, seed, person, stop,
                        [](const Scene& own) { return std::make_unique<device::Adviser>(own, "core", ADVICE_THREADS); });
}

AdvisedPerson advised_person(const Scene& scene, std::uint64_t seed, std::uint64_t person, const std::atomic<bool>& stop,
                             const device::AdviceLoop::AdviserOpener& open) {
  Scene own = scene;
  const Participant participant(scene.people, seed, person, Experiment::advice);
  own.hand = participant.hand(scene.hand);
  const std::vector<device::SimJob> jobs = jobs_of(own);
  AdvisedPerson outcome;
  outcome.without.effort = outcome.with.effort = NO_OUTCOME;
  if (jobs.empty()) return outcome;
  const std::uint64_t tremor = tremor_seed(scene, seed, person, 0);
  outcome.without = play(own, participant, tremor, jobs, nullptr, stop);
  device::SteppedAdvice::Options options;
  options.while_held = false;
  options.keeps_line = true;
  options.grips = STUDY_CLOUD;
  device::SteppedAdvice advice(own, open, options);
  outcome.with = play(own, participant, tremor, jobs, &advice, stop);
  if (const std::vector<std::string> warnings = advice.take_warnings(); !warnings.empty())
    throw failure_error(fmt::format("person {} has no session with advice: {}", person, warnings.front()));
  return outcome;
}

std::vector<double> to_numbers(const AdvisedPerson& person) {
  std::vector<double> numbers;
  for (const AdvisedOutcome* one : {&person.without, &person.with})
    for (const auto member : OUTCOME_NUMBERS) numbers.push_back(one->*member);
  return numbers;
}

AdvisedPerson person_from_numbers(const std::vector<double>& numbers) {
  AdvisedPerson person;
  if (numbers.size() != 2 * OUTCOME_NUMBERS.size()) return person;
  std::size_t at = 0;
  for (AdvisedOutcome* one : {&person.without, &person.with})
    for (const auto member : OUTCOME_NUMBERS) one->*member = numbers[at++];
  return person;
}

}  // namespace wholehand
