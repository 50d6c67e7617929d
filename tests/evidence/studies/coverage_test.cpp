// SPDX-License-Identifier: MIT
// sanitizers: none (too slow)
// The intervals of a study hold what a repetition of the experiment gives, in 95 % of the repetitions. Populations, and then experiments, are drawn from
// the same made people, who differ as much as one person's grasps do; normal, skewed and discrete numbers are among theirs.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/numbers/normal.h"
#include "base/numbers/parallel.h"
#include "base/numbers/random_bits.h"
#include "base/statistics/moments.h"
#include "base/statistics/resample.h"
#include "core/joints.h"
#include "evidence/studies/contact_pool.h"
#include "evidence/studies/force_statistics.h"
#include "evidence/studies/options.h"
#include "evidence/studies/paper_sample.h"
#include "evidence/studies/session_statistics.h"

namespace wholehand {
namespace {

class Chance {
 public:
  explicit Chance(std::uint64_t seed) : state_(mixed_bits(seed)) {}
  double uniform() { return unit_interval(split_mix(state_)); }
  double normal() { return normal_quantile(uniform() + 0x1p-60); }
  double log_normal(double deviation) { return std::exp(deviation * normal()); }
  bool happens(double log_odds) { return uniform() < 1 / (1 + std::exp(-log_odds)); }
  template <class Thing>
  void shuffle(std::vector<Thing>& things) {
    for (std::size_t k = 0; k + 1 < things.size(); ++k) std::swap(things[k], things[k + draw_below(things.size() - k, state_)]);
  }

 private:
  std::uint64_t state_;
};

// How often the values of experiments were in the intervals of populations, by statistic.
struct Hits {
  std::size_t inside = 0, of = 0;
  double share() const { return static_cast<double>(inside) / static_cast<double>(of); }
};
using Coverage = std::map<std::string, Hits>;

void count_hit(Coverage& coverage, const std::string& name, const Interval& interval, double value) {
  if (std::isnan(interval.low) || std::isnan(value)) return;
  Hits& hits = coverage[name];
  ++hits.of;
  constexpr double ROUNDING = 1e-9;  // of a share, which sums up in any order
  hits.inside += interval.low - ROUNDING <= value && value <= interval.high + ROUNDING ? 1 : 0;
}

// Counts of people or grasps, whose intervals hold whole counts and so more than 95 %.
bool is_discrete(const std::string& name) {
  const auto has = [&name](const char* part) { return name.find(part) != std::string::npos; };
  // of the projected points, of which a grasp has any number
  if (has(" projected_tip") || has(" projected_finger") || has(" projected_inner") || has("anova_share")) return false;
  return has("_share") || has("ordered_as_paper") || has("base_ahead");
}

// In `populations` each of `experiments`; `count_in(k)` counts those of population k.
template <class CountIn>
Coverage coverage_of(std::size_t populations, CountIn count_in) {
  std::vector<Coverage> each(populations);
  in_parallel(populations, 0, [&](std::size_t k) { each[k] = count_in(k); });
  Coverage all;
  for (const Coverage& one : each)
    for (const auto& [name, hits] : one) {
      all[name].inside += hits.inside;
      all[name].of += hits.of;
    }
  return all;
}

// The shares of a kind of statistics.
std::vector<double> shares_of(const Coverage& coverage, bool discrete) {
  std::vector<double> shares;
  for (const auto& [name, hits] : coverage)
    if (is_discrete(name) == discrete) shares.push_back(hits.share());
  return shares;
}

// Each statistic has at least 2,000 experiments, a binomial error of 0.5 %, in 30 or more populations. Whole counts hold more than 95 %.
void expect_covered(const Coverage& coverage) {
  for (const auto& [name, hits] : coverage) {
    EXPECT_GT(hits.share(), 0.93) << name << ", " << hits.of << " experiments";
    if (!is_discrete(name)) {
      EXPECT_LT(hits.share(), 0.97) << name << ", " << hits.of << " experiments";
    }
    EXPECT_GE(hits.of, 2000u) << name;
  }
  for (const bool discrete : {false, true}) {
    const std::vector<double> shares = shares_of(coverage, discrete);
    const auto [least, most] = std::minmax_element(shares.begin(), shares.end());
    // the figures of docs/study.md
    testing::Test::RecordProperty(discrete ? "discrete" : "continuous",
                                  fmt::format("{:.1f} ({:.1f} to {:.1f})", 100 * mean_of(shares), 100 * *least, 100 * *most));
    EXPECT_GT(mean_of(shares), discrete ? 0.95 : 0.94);
    EXPECT_LT(mean_of(shares), discrete ? 1 : 0.96);
  }
}

// ---- sessions ----

const SessionVessels COVERED_VESSELS{{0, "one"}, {1, "two"}, {2, "three"}};

// Two sessions of one person.
SessionSubject session_person(Chance& chance) {
  SessionSubject subject;
  const double person = chance.normal(), habit = chance.log_normal(0.4), tends = chance.normal();
  for (int grasp = 0; grasp < 6; ++grasp) {
    device::GraspReport& one = subject.grasps.emplace_back();
    one.vessel = grasp % 3;
    one.response_time = 0.2 * habit * chance.log_normal(0.4);
    one.tightened = 4 + person + chance.normal();
    one.largest_tilt = chance.happens(2.5) ? radians(60) : radians(10);
    one.before.mean = 3 * habit * chance.log_normal(0.3);
    one.during.mean = one.before.mean + 0.5 * chance.normal();
    one.after.mean = one.before.mean + person;
    one.after_at_first = std::abs(one.after.mean);
    one.tilt_time = 3 + chance.uniform();
    one.duration = {1, 3, 4 * chance.log_normal(0.3)};
    one.normal_increase = (1 + one.vessel) * 0.7 + 0.3 * person + 0.3 * chance.normal();
    one.grip_change = 0.5 * one.normal_increase - 0.2 * one.before.mean + chance.normal();
    const double course = chance.uniform() + 0.2 * tends;
    one.course = one.largest_tilt < device::LEAST_ANALYZED || chance.happens(-3) ? device::GripCourse::not_analyzed
                 : course < 0.2                                                  ? device::GripCourse::equal
                 : course < 0.4                                                  ? device::GripCourse::more
                 : course < 0.7                                                  ? device::GripCourse::less
                                                                                 : device::GripCourse::complex;
    one.saturated = chance.happens(-2 + tends) ? 1 : 0;
    one.outcome = chance.happens(-2 + tends) ? device::GraspOutcome::lost : device::GraspOutcome::let_go;
  }
  return subject;
}

std::vector<SessionSubject> session_people(std::size_t count, Chance& chance) {
  std::vector<SessionSubject> people(count);
  for (SessionSubject& person : people) person = session_person(chance);
  return people;
}

// 17 people, and of their grasps 22, 32 and 18 by chance.
std::vector<SessionSubject> session_experiment(Chance& chance) {
  std::vector<device::GraspReport> all;
  for (const SessionSubject& person : session_people(PAPER_PEOPLE, chance))
    all.insert(all.end(), person.grasps.begin(), person.grasps.end());
  chance.shuffle(all);
  std::array<std::size_t, 3> left = PAPER_GRASPS;
  std::erase_if(all, [&left](const device::GraspReport& grasp) {
    std::size_t& of_vessel = left[static_cast<std::size_t>(grasp.vessel)];
    return of_vessel == 0 || of_vessel-- == 0;
  });
  return {{all}};
}

Coverage session_coverage(std::size_t people, int resamples, std::size_t populations, int experiments) {
  return coverage_of(populations, [&](std::size_t population) {
    Chance chance(population + 1);
    const std::vector<SessionSubject> subjects = session_people(people, chance);
    const std::vector<StudyRow> rows = session_rows(subjects, COVERED_VESSELS, {population, resamples, 1, true});
    Coverage coverage;
    for (int k = 0; k < experiments; ++k) {
      const std::vector<StudyRow> repeated = session_rows(session_experiment(chance), COVERED_VESSELS, {1, 1, 1, true});
      for (std::size_t row = 0; row < rows.size(); ++row)
        count_hit(coverage, rows[row].vessel + " " + rows[row].statistic, rows[row].interval, repeated[row].value);
    }
    return coverage;
  });
}

TEST(StudyCoverage, OfSessionsIs95Percent) { expect_covered(session_coverage(StudyPeople{}.sessions, STUDY_RESAMPLES, 100, 40)); }

// The figures of docs/study.md, for these seeds: few people do not show how much people differ.
TEST(StudyCoverage, OfFewPeopleIsLess) {
  const std::map<std::size_t, double> measured{{3, 0.62}, {10, 0.85}, {20, 0.90}, {50, 0.93}, {170, 0.94}};
  for (const auto& [people, share] : measured)
    EXPECT_NEAR(mean_of(shares_of(session_coverage(people, QUICK_RESAMPLES, 200, 20), false)), share, 0.01) << people;
}

// ---- forces ----

ForcesOfPerson force_person(Chance& chance) {
  ForcesOfPerson forces;
  const double person = chance.normal();
  const bool fits = chance.happens(3);
  for (std::size_t choice = 0; choice < FORCE_CHOICES; ++choice) {
    ForceOutcome& one = forces[choice];
    const ForceChoice& force = PAPER_CHOICES[choice];
    one.has_gripped = fits;
    one.losses = chance.happens(person + 2 * force.base - 4 + 0.3 * force.range) ? 3 : 0;
    one.oscillates = chance.happens(-2);
    one.has_succeeded = true;
    one.opening = 1e-3 * (0.5 + force.base) * std::exp(0.3 * person) * chance.log_normal(0.5);
  }
  return forces;
}

std::vector<ForcesOfPerson> force_people(std::size_t count, Chance& chance) {
  std::vector<ForcesOfPerson> people(count);
  for (ForcesOfPerson& person : people) person = force_person(chance);
  return people;
}

Coverage force_coverage(std::size_t people, int resamples, std::size_t populations, int experiments) {
  return coverage_of(populations, [&](std::size_t population) {
    Chance chance(population + 1);
    const std::vector<StudyRow> rows = force_rows(force_people(people, chance), "cup", population, resamples, 1);
    Coverage coverage;
    for (int k = 0; k < experiments; ++k) {
      const std::vector<StudyRow> repeated = force_rows(force_people(FORCE_PEOPLE, chance), "cup", 1, 1, 1);
      for (std::size_t row = 0; row < rows.size(); ++row)
        count_hit(coverage, rows[row].subject + " " + rows[row].statistic, rows[row].interval, repeated[row].value);
    }
    return coverage;
  });
}

TEST(StudyCoverage, OfForcesIs95Percent) { expect_covered(force_coverage(StudyPeople{}.forces, STUDY_RESAMPLES, 40, 60)); }

// ---- contacts ----

const std::vector<StudyVessel>& contact_vessels() {
  static const std::vector<StudyVessel> vessels{
      {0, "one", 22, true, 0, 2}, {1, "two", 32, true, 2, 4}, {2, "three", 18, true, 4, 6}, {3, "cup", 24, false, 6, 8}};
  return vessels;
}

std::vector<ContactGrasp> contact_person(Chance& chance) {
  std::vector<ContactGrasp> grasps;
  const double person = chance.normal(), size = chance.normal();
  for (int slot = 0; slot < 8; ++slot) {
    ContactGrasp& grasp = grasps.emplace_back();
    grasp.is_held = chance.happens(2.5 + person);
    grasp.is_plausible = chance.happens(1);
    const double off = person + chance.normal();
    grasp.height = 0.05 + 7e-3 * off;
    grasp.distance = 0.02 * std::abs(off) * chance.log_normal(0.3);
    for (int joint = 0; joint < JOINT_COUNT; ++joint)
      if (joint == THUMB_TIP || joint == INDEX_TIP || chance.happens(size + 0.5 * off + 0.1 * (joint % 7)))
        grasp.touch_mask |= 1u << joint;
    for (int finger = 0; finger < FINGER_COUNT; ++finger)
      if (finger < 2 || chance.happens(size + finger - 2)) grasp.used_mask |= 1u << finger;
    for (std::uint32_t* mask : {&grasp.tip_mask, &grasp.finger_mask, &grasp.inner_mask})
      for (int joint = 11; joint < 20; ++joint)
        if (chance.happens(person - 1)) *mask |= 1u << joint;
  }
  return grasps;
}

Coverage contact_coverage(std::size_t people, int resamples, std::size_t populations, int experiments) {
  return coverage_of(populations, [&](std::size_t population) {
    Chance chance(population + 1);
    ContactPool pool(contact_vessels(), people);
    for (std::size_t k = 0; k < people; ++k) {
      std::vector<ContactGrasp> grasps = contact_person(chance);
      grasps.insert(grasps.end(), grasps.begin(), grasps.begin() + 8);  // alike in both poses
      pool.add(grasps);
    }
    std::vector<std::vector<double>> samples(static_cast<std::size_t>(resamples));
    for (std::size_t k = 0; k < samples.size(); ++k) samples[k] = pool.sample(0, mixed_bits(population * 10000 + k));
    const std::vector<Interval> intervals = sample_intervals(samples);
    Coverage coverage;
    for (int k = 0; k < experiments; ++k) {
      std::vector<std::vector<ContactGrasp>> by_vessel(contact_vessels().size());
      for (std::size_t person = 0; person < PAPER_PEOPLE; ++person) {
        const std::vector<ContactGrasp> grasps = contact_person(chance);
        for (std::size_t v = 0; v < by_vessel.size(); ++v)
          for (std::size_t slot = contact_vessels()[v].first; slot < contact_vessels()[v].last; ++slot)
            by_vessel[v].push_back(grasps[slot]);
      }
      VesselTallies tallies(contact_vessels());
      for (std::size_t v = 0; v < by_vessel.size(); ++v) {
        chance.shuffle(by_vessel[v]);
        std::size_t held = 0;
        for (const ContactGrasp& grasp : by_vessel[v]) {
          if (held == contact_vessels()[v].sample) break;
          tallies.add(v, grasp);
          held += grasp.is_held ? 1 : 0;
        }
      }
      const std::vector<double> values = tallies.values();
      const auto& statistics = contact_statistics();
      for (std::size_t at = 0; at < values.size(); ++at) {
        const ContactStatistic& statistic = statistics[at % statistics.size()];
        count_hit(coverage, fmt::format("{} {} {}", at / statistics.size(), statistic.name, statistic.subject), intervals[at],
                  values[at]);
      }
    }
    return coverage;
  });
}

TEST(StudyCoverage, OfContactsIs95Percent) { expect_covered(contact_coverage(StudyPeople{}.contacts, STUDY_RESAMPLES, 30, 100)); }

TEST(StudyCoverage, OfQuickContactsIs95Percent) {
  expect_covered(contact_coverage(QUICK_PEOPLE.contacts, QUICK_RESAMPLES, 100, 40));
}

}  // namespace
}  // namespace wholehand
