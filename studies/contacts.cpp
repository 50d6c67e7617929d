// SPDX-License-Identifier: MIT
#include "studies/contacts.h"

#include <algorithm>
#include <memory>
#include <span>

#include "core/parallel.h"
#include "core/random_bits.h"
#include "studies/contact_sensitivity.h"
#include "studies/paper_sample.h"
#include "system/progress.h"

namespace wholehand {
namespace {

constexpr std::uint64_t BLOCK = 16;                    // people that a thread takes at a time
constexpr std::uint64_t LARGEST_WINDOW = 1024;         // people whose grasps wait to be counted in order
constexpr std::uint64_t WINDOW_GRASPS = 1 << 18;       // of them together, where a person makes many
constexpr std::uint64_t POOL_GRASPS = 1 << 21;         // likewise in the pool
constexpr std::uint64_t SAMPLES = 0x636f6e7461637473;  // keeps the samples' draws from those of people

using Grasps = std::span<const ContactGrasp>;  // of one person in one pose

std::size_t grasps_of_person(const ContactPlan& plan) { return plan.grasps().size() * STUDY_POSES.size(); }

// A tally for each vessel, and one of all of the paper's.
class VesselTallies {
 public:
  explicit VesselTallies(const ContactPlan& plan) : plan_(plan), tallies_(plan.vessels().size() + 1) {}

  void add(std::size_t vessel, const ContactGrasp& grasp) {
    tallies_[vessel].add(grasp);
    if (plan_.vessels()[vessel].is_of_paper) tallies_.back().add(grasp);
  }
  void add(Grasps grasps) {
    for (std::size_t i = 0; i < grasps.size(); ++i) add(plan_.grasps()[i].vessel, grasps[i]);
  }
  // Vessel after vessel, then all: those of contact_statistics().
  std::vector<double> values() const {
    std::vector<double> all;
    for (const ContactTally& tally : tallies_) {
      const std::vector<double> values = tally.values();
      all.insert(all.end(), values.begin(), values.end());
    }
    return all;
  }

 private:
  const ContactPlan& plan_;
  std::vector<ContactTally> tallies_;
};

// The grasps of the first people, in each pose.
class Pool {
 public:
  Pool(const ContactPlan& plan, std::uint64_t people)
      : plan_(plan),
        people_(std::min({people, MOST_POOLED, std::max<std::uint64_t>(PAPER_PEOPLE, POOL_GRASPS / grasps_of_person(plan))})) {}

  void add(const std::vector<ContactGrasp>& of_person) {
    if (size() < people_) grasps_.insert(grasps_.end(), of_person.begin(), of_person.end());
  }

  // What a sample of the paper's size shows in a pose: people drawn with replacement, and of each vessel as many of their grasps as
  // the paper has, none twice. Grasps that are not held are made and counted, and another takes their place.
  std::vector<double> sample(std::size_t pose, std::uint64_t seed) const {
    VesselTallies tallies(plan_);
    std::uint64_t state = seed;
    std::vector<std::uint64_t> people(PAPER_PEOPLE);
    for (std::uint64_t& person : people) person = draw_below(size(), state);
    std::vector<const ContactGrasp*> open;
    for (std::size_t v = 0; v < plan_.vessels().size(); ++v) {
      const StudyVessel& vessel = plan_.vessels()[v];
      open.clear();
      for (const std::uint64_t person : people)
        for (std::size_t g = vessel.first; g < vessel.last; ++g) open.push_back(&of(person, pose)[g]);
      std::size_t held = 0;
      for (std::size_t k = 0; k < open.size() && held < vessel.sample; ++k) {
        std::swap(open[k], open[k + draw_below(open.size() - k, state)]);
        tallies.add(v, *open[k]);
        held += open[k]->is_held ? 1 : 0;
      }
    }
    return tallies.values();
  }

 private:
  std::uint64_t size() const { return grasps_.size() / grasps_of_person(plan_); }
  Grasps of(std::uint64_t person, std::size_t pose) const {
    return {&grasps_[person * grasps_of_person(plan_) + pose * plan_.grasps().size()], plan_.grasps().size()};
  }

  const ContactPlan& plan_;
  std::uint64_t people_;
  std::vector<ContactGrasp> grasps_;
};

void add_rows(const ContactPlan& plan, std::size_t pose, const std::vector<double>& values, const std::vector<Interval>& intervals,
              std::vector<StudyRow>& rows) {
  const auto& statistics = contact_statistics();
  std::vector<std::string> names;
  for (const StudyVessel& vessel : plan.vessels()) names.push_back(vessel.name);
  const auto of_paper = std::count_if(plan.vessels().begin(), plan.vessels().end(), [](const auto& v) { return v.is_of_paper; });
  if (of_paper > 1) names.emplace_back(ALL_VESSELS);
  for (std::size_t v = 0; v < names.size(); ++v)
    for (std::size_t k = 0; k < statistics.size(); ++k) {
      const std::size_t at = v * statistics.size() + k;
      rows.push_back({"contacts", STUDY_POSE_NAMES[pose], names[v], statistics[k].name, statistics[k].subject, values[at],
                      intervals[at], std::nullopt});
    }
}

}  // namespace

std::optional<ContactStudy> study_contacts(const ContactPlan& plan, const StudyOptions& options, const std::atomic<bool>& stop) {
  const std::size_t slots = plan.grasps().size();
  std::vector<VesselTallies> tallies(STUDY_POSES.size(), VesselTallies(plan));
  Pool pool(plan, options.people.contacts);
  ContactSensitivity sensitivity(plan);
  std::vector<std::vector<ContactGrasp>> window;
  Progress progress(options.people.contacts, 0);
  const std::uint64_t at_once = std::clamp<std::uint64_t>(WINDOW_GRASPS / grasps_of_person(plan), 1, LARGEST_WINDOW);
  // people in windows: evaluated in any order, counted in theirs
  for (std::uint64_t done = 0; done < options.people.contacts; done += window.size()) {
    window.assign(std::min(at_once, options.people.contacts - done), {});
    in_parallel((window.size() + BLOCK - 1) / BLOCK, options.threads,
                [&](std::size_t block) {
                  const std::size_t last = std::min<std::size_t>((block + 1) * BLOCK, window.size());
                  for (std::size_t k = block * BLOCK; k < last && !stop; ++k) window[k] = plan.of_person(options.seed, done + k);
                },
                [&](std::size_t blocks) { progress.update("people", std::min(options.people.contacts, done + blocks * BLOCK)); });
    if (stop) return std::nullopt;
    for (std::size_t k = 0; k < window.size(); ++k) {
      const std::vector<ContactGrasp>& person = window[k];
      for (std::size_t pose = 0; pose < STUDY_POSES.size(); ++pose) tallies[pose].add(Grasps(person).subspan(pose * slots, slots));
      pool.add(person);
      sensitivity.add(options.seed, done + k, person);
    }
  }
  progress.clear();
  ContactStudy study;
  study.grasps = options.people.contacts * slots;
  for (std::size_t pose = 0; pose < STUDY_POSES.size(); ++pose) {
    std::vector<std::vector<double>> samples(static_cast<std::size_t>(options.resamples));
    in_parallel(samples.size(), options.threads, [&](std::size_t k) {
      if (!stop) samples[k] = pool.sample(pose, mixed_bits(mixed_bits(options.seed ^ SAMPLES) + k));
    });
    if (stop) return std::nullopt;
    add_rows(plan, pose, tallies[pose].values(), intervals_of(samples), study.rows);
  }
  study.sensitivity = sensitivity.rows();
  return study;
}

}  // namespace wholehand
