// SPDX-License-Identifier: MIT
// One person who acts with their hand, grasp after grasp.
#pragma once

#include <cstdint>

#include "core/people/person.h"
#include "core/people_data.h"
#include "core/scene.h"

namespace wholehand {

// Names the draws of a person's grasps; each experiment has its own.
enum class Experiment : std::uint64_t { contacts = 0, live = 1, sessions = 2, forces = 3, advice = 4 };

class Participant {
 public:
  // The person in the middle of every trait, with the scene's own hand. All grasps are alike.
  explicit Participant(const PeopleData& people);
  // Person `number` of a population. `first`: number of the first grasp, so that a second session draws other grasps.
  Participant(const PeopleData& people, std::uint64_t seed, std::uint64_t number, Experiment experiment, std::uint64_t first = 0);

  const Person& person() const { return person_; }
  // The person's hand if the scene's is `plain`; for the median person it is `plain` itself.
  HandData hand(const HandData& plain) const;
  // The person's traits in grasp `k` of this experiment, counted from 0. Neither allocates nor throws.
  Traits grasp(std::uint64_t k) const noexcept;

 private:
  PeopleData people_;
  Person person_;
  bool is_median_ = true;
  std::uint64_t seed_ = 0, number_ = 0, experiment_ = 0, first_ = 0;
};

}  // namespace wholehand
