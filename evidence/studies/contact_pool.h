// SPDX-License-Identifier: MIT
// Grasps of many people by vessel: their statistics, and samples of the paper's size.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "evidence/studies/contact_plan.h"
#include "evidence/studies/contact_tally.h"
#include "evidence/studies/row.h"

namespace wholehand {

// People from whom samples are drawn: the first ones of a larger population, to bound the memory.
constexpr std::uint64_t MOST_POOLED = 20'000;

// How many people's grasps are kept: all, but at most MOST_POOLED, and fewer if each makes many (in all poses together).
std::uint64_t pooled_people(std::uint64_t people, std::uint64_t grasps_of_person);
// A note if that is less than MOST_POOLED and not all of the people; else "".
std::string pool_note(std::uint64_t people, std::uint64_t grasps_of_person);

using Grasps = std::span<const ContactGrasp>;  // of one person in one pose, in the order of the plan

// A tally for each vessel.
class VesselTallies {
 public:
  // `vessels` and the plan must outlive it.
  explicit VesselTallies(const std::vector<StudyVessel>& vessels)
      : vessels_(vessels), tallies_(vessels.size()), counts_(vessels.size() + 1) {}
  explicit VesselTallies(const ContactPlan& plan) : VesselTallies(plan.vessels()) {}

  void add(std::size_t vessel, const ContactGrasp& grasp) { tallies_[vessel].add(grasp); }
  // Also counts the person.
  void add(Grasps grasps);
  // The values of contact_statistics(): vessel after vessel, then all of the paper's together. In the latter, a vessel's weight is the number of
  // grasps that a sample makes until enough of them hold, so that all grasps of a sample have equal weight.
  std::vector<double> values() const;
  // The people and grasps behind each of them.
  std::vector<StudyCount> counts() const;

 private:
  double made_in_sample(std::size_t vessel) const;

  const std::vector<StudyVessel>& vessels_;
  std::vector<ContactTally> tallies_;
  std::vector<std::array<StudyCount, CONTACTS_OVER>> counts_;  // of each vessel, then of all of the paper's
};

// The grasps of the first people, in each pose.
class ContactPool {
 public:
  // `vessels`, at least one, and the plan must outlive it. They divide the grasps of a person in a pose, in their order.
  ContactPool(const std::vector<StudyVessel>& vessels, std::uint64_t people);
  ContactPool(const ContactPlan& plan, std::uint64_t people) : ContactPool(plan.vessels(), people) {}

  // A person's grasps: those in the first of STUDY_POSES, then those in the next. Keeps only the first people.
  void add(const std::vector<ContactGrasp>& of_person);
  std::uint64_t people() const { return grasps_.size() / (slots_ * STUDY_POSES.size()); }

  // The grasps of a sample of the paper's size in a pose, vessel by vessel in order: those of PAPER_PEOPLE people (draw_people), in random order, until
  // as many hold as the vessel's sample has. If fewer hold, all grasps of these people. The pool has at least PAPER_PEOPLE people.
  std::vector<std::vector<const ContactGrasp*>> draw(std::size_t pose, std::uint64_t seed) const;

  // The values of VesselTallies for such a sample. All are NaN if the pool has fewer than PAPER_PEOPLE people.
  std::vector<double> sample(std::size_t pose, std::uint64_t seed) const;

 private:
  Grasps of(std::uint64_t person, std::size_t pose) const;

  const std::vector<StudyVessel>& vessels_;
  std::size_t slots_;  // grasps of a person in a pose
  std::uint64_t most_;
  std::vector<ContactGrasp> grasps_;
};

}  // namespace wholehand
