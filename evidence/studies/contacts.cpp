// SPDX-License-Identifier: MIT
#include "evidence/studies/contacts.h"

#include <algorithm>
#include <memory>
#include <span>
#include <string>

#include "base/numbers/parallel.h"
#include "base/numbers/random_bits.h"
#include "base/statistics/resample.h"
#include "base/system/progress.h"
#include "evidence/studies/contact_pool.h"
#include "evidence/studies/contact_sensitivity.h"
#include "evidence/studies/paper_sample.h"

namespace wholehand {
namespace {

constexpr std::uint64_t BLOCK = 16;                    // people that a thread takes at a time
constexpr std::uint64_t LARGEST_WINDOW = 1024;         // people whose grasps wait to be counted in order
constexpr std::uint64_t WINDOW_GRASPS = 1 << 18;       // of them together, where a person makes many
constexpr std::uint64_t SAMPLES = 0x636f6e7461637473;  // keeps the samples' draws from those of people

std::size_t grasps_of_person(const ContactPlan& plan) { return plan.grasps().size() * STUDY_POSES.size(); }

void add_rows(const ContactPlan& plan, std::size_t pose, const VesselTallies& tallies, const std::vector<Interval>& intervals,
              std::vector<StudyRow>& rows) {
  const std::vector<double> values = tallies.values();
  const std::vector<StudyCount> counts = tallies.counts();
  const auto& statistics = contact_statistics();
  std::vector<std::string> names;
  for (const StudyVessel& vessel : plan.vessels()) names.push_back(vessel.name);
  const auto of_paper = std::count_if(plan.vessels().begin(), plan.vessels().end(), [](const auto& v) { return v.is_of_paper; });
  if (of_paper > 1) names.emplace_back(ALL_VESSELS);
  for (std::size_t v = 0; v < names.size(); ++v)
    for (std::size_t k = 0; k < statistics.size(); ++k) {
      const std::size_t at = v * statistics.size() + k;
      rows.push_back({"contacts", STUDY_POSE_NAMES[pose], names[v], statistics[k].name, statistics[k].subject, values[at],
                      intervals[at], std::nullopt, counts[at]});
    }
}

}  // namespace

std::optional<ContactStudy> study_contacts(const ContactPlan& plan, const StudyOptions& options, const std::atomic<bool>& stop,
                                           const ContactTaker& take) {
  const std::size_t slots = plan.grasps().size();
  std::vector<VesselTallies> tallies(STUDY_POSES.size(), VesselTallies(plan));
  ContactPool pool(plan, options.people.contacts);
  ContactSensitivity sensitivity(plan);
  std::vector<std::vector<ContactGrasp>> window;
  Progress progress(options.people.contacts, 0, "people");
  const std::uint64_t at_once = std::clamp<std::uint64_t>(WINDOW_GRASPS / grasps_of_person(plan), 1, LARGEST_WINDOW);
  // people in windows: evaluated in any order, counted in theirs
  for (std::uint64_t done = 0; done < options.people.contacts; done += window.size()) {
    window.assign(std::min(at_once, options.people.contacts - done), {});
    in_parallel((window.size() + BLOCK - 1) / BLOCK, options.threads,
                [&](std::size_t block) {
                  const std::size_t last = std::min<std::size_t>((block + 1) * BLOCK, window.size());
                  for (std::size_t k = block * BLOCK; k < last && !stop; ++k) window[k] = plan.of_person(options.seed, done + k);
                },
                [&](std::size_t blocks) { progress.update("contacts", std::min(options.people.contacts, done + blocks * BLOCK)); });
    if (stop) return std::nullopt;
    for (std::size_t k = 0; k < window.size(); ++k) {
      const std::vector<ContactGrasp>& person = window[k];
      for (std::size_t pose = 0; pose < STUDY_POSES.size(); ++pose) tallies[pose].add(Grasps(person).subspan(pose * slots, slots));
      pool.add(person);
      sensitivity.add(options.seed, done + k, person);
      if (take) take(done + k, person);
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
    add_rows(plan, pose, tallies[pose], sample_intervals(samples), study.rows);
  }
  study.sensitivity = sensitivity.rows();
  return study;
}

}  // namespace wholehand
