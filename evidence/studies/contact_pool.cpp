// SPDX-License-Identifier: MIT
#include "evidence/studies/contact_pool.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "base/text/readable.h"
#include "evidence/studies/paper_sample.h"

namespace wholehand {
namespace {

constexpr std::uint64_t POOL_GRASPS = 1 << 21;  // kept at most, where this leaves enough people for a sample

}  // namespace

std::uint64_t pooled_people(std::uint64_t people, std::uint64_t grasps_of_person) {
  return std::min({people, MOST_POOLED, std::max<std::uint64_t>(PAPER_PEOPLE, POOL_GRASPS / grasps_of_person)});
}

std::string pool_note(std::uint64_t people, std::uint64_t grasps_of_person) {
  const std::uint64_t pooled = pooled_people(people, grasps_of_person);
  if (pooled >= std::min(people, MOST_POOLED)) return "";
  return fmt::format("the samples for the intervals are drawn from the first {} people: each makes {}, and no more fit in memory",
                     readable_number(pooled), counted(grasps_of_person, "grasp"));
}

void VesselTallies::add(Grasps grasps) {
  std::array<std::uint64_t, CONTACTS_OVER> of_paper{};
  for (std::size_t v = 0; v < vessels_.size(); ++v) {
    std::array<std::uint64_t, CONTACTS_OVER> of_vessel{};
    for (std::size_t k = vessels_[v].first; k < vessels_[v].last; ++k) {
      add(v, grasps[k]);
      for (std::size_t over = 0; over < CONTACTS_OVER; ++over) of_vessel[over] += is_counted(grasps[k], ContactsOver{over}) ? 1 : 0;
    }
    for (std::size_t over = 0; over < CONTACTS_OVER; ++over) {
      counts_[v][over].add_person(of_vessel[over]);
      of_paper[over] += vessels_[v].is_of_paper ? of_vessel[over] : 0;
    }
  }
  for (std::size_t over = 0; over < CONTACTS_OVER; ++over) counts_.back()[over].add_person(of_paper[over]);
}

std::vector<StudyCount> VesselTallies::counts() const {
  std::vector<StudyCount> all;
  for (const auto& of_vessel : counts_)
    for (const ContactStatistic& statistic : contact_statistics())
      all.push_back(of_vessel[static_cast<std::size_t>(statistic.over)]);
  return all;
}

double VesselTallies::made_in_sample(std::size_t vessel) const {
  const StudyVessel& v = vessels_[vessel];
  const ContactTally& tally = tallies_[vessel];
  const auto most = static_cast<double>(PAPER_PEOPLE * (v.last - v.first));
  return tally.held() > 0 ? std::min(most, static_cast<double>(v.sample) * tally.grasps() / tally.held()) : most;
}

std::vector<double> VesselTallies::values() const {
  std::vector<double> all;
  ContactTally together;
  const auto append = [&all](const std::vector<double>& values) { all.insert(all.end(), values.begin(), values.end()); };
  for (std::size_t v = 0; v < vessels_.size(); ++v) {
    append(tallies_[v].values());
    if (vessels_[v].is_of_paper && tallies_[v].grasps() > 0) together.add(tallies_[v], made_in_sample(v) / tallies_[v].grasps());
  }
  append(together.values());
  return all;
}

ContactPool::ContactPool(const std::vector<StudyVessel>& vessels, std::uint64_t people)
    : vessels_(vessels), slots_(vessels.back().last), most_(pooled_people(people, slots_ * STUDY_POSES.size())) {}

void ContactPool::add(const std::vector<ContactGrasp>& of_person) {
  if (people() < most_) grasps_.insert(grasps_.end(), of_person.begin(), of_person.end());
}

Grasps ContactPool::of(std::uint64_t person, std::size_t pose) const {
  return {&grasps_[(person * STUDY_POSES.size() + pose) * slots_], slots_};
}

std::vector<std::vector<const ContactGrasp*>> ContactPool::draw(std::size_t pose, std::uint64_t seed) const {
  std::uint64_t state = seed;
  const std::vector<std::size_t> people = draw_people(PAPER_PEOPLE, this->people(), state);
  std::vector<std::vector<const ContactGrasp*>> drawn;
  for (const StudyVessel& vessel : vessels_) {
    std::vector<const ContactGrasp*>& grasps = drawn.emplace_back();
    for (const std::uint64_t person : people)
      for (std::size_t k = vessel.first; k < vessel.last; ++k) grasps.push_back(&of(person, pose)[k]);
    std::size_t made = 0;
    for (std::size_t held = 0; made < grasps.size() && held < vessel.sample; ++made) {
      std::swap(grasps[made], grasps[made + draw_below(grasps.size() - made, state)]);
      held += grasps[made]->is_held ? 1 : 0;
    }
    grasps.resize(made);
  }
  return drawn;
}

std::vector<double> ContactPool::sample(std::size_t pose, std::uint64_t seed) const {
  if (people() < PAPER_PEOPLE)
    return std::vector<double>((vessels_.size() + 1) * contact_statistics().size(), std::numeric_limits<double>::quiet_NaN());
  VesselTallies tallies(vessels_);
  const std::vector<std::vector<const ContactGrasp*>> drawn = draw(pose, seed);
  for (std::size_t v = 0; v < drawn.size(); ++v)
    for (const ContactGrasp* grasp : drawn[v]) tallies.add(v, *grasp);
  return tallies.values();
}

}  // namespace wholehand
