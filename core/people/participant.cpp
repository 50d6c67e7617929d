// SPDX-License-Identifier: MIT
#include "core/people/participant.h"

namespace wholehand {

Participant::Participant(const PeopleData& people) : people_(people), person_(make_person(people, {})) {}

Participant::Participant(const PeopleData& people, std::uint64_t seed, std::uint64_t number, Experiment experiment,
                         std::uint64_t first)
    : people_(people),
      person_(draw_person(people, seed, number)),
      is_median_(false),
      seed_(seed),
      number_(number),
      experiment_(static_cast<std::uint64_t>(experiment)),
      first_(first) {}

HandData Participant::hand(const HandData& plain) const { return is_median_ ? plain : hand_of(plain, person_); }

Traits Participant::grasp(std::uint64_t k) const noexcept {
  return is_median_ ? person_.traits : draw_grasp(people_, person_, seed_, number_, experiment_, first_ + k);
}

}  // namespace wholehand
