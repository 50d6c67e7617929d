// SPDX-License-Identifier: MIT
#include "evidence/studies/force_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "base/numbers/parallel.h"
#include "base/numbers/random_bits.h"
#include "base/statistics/logistic.h"
#include "base/statistics/resample.h"
#include "evidence/studies/paper_sample.h"

namespace wholehand {
namespace {

constexpr double NO_SHARE = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t FORCE_SAMPLES = 0x666f72636573;  // keeps the samples' draws from those of people

// An event whose share of trials is counted.
struct ForceEvent {
  std::string name;  // "lost", "opening_over_1mm"
  std::function<bool(const ForceOutcome&)> happens;
};

std::vector<ForceEvent> all_force_events() {
  std::vector<ForceEvent> all{{"lost", [](const ForceOutcome& one) { return one.is_lost(); }},
                              {"oscillated", [](const ForceOutcome& one) { return one.oscillates && !one.is_lost(); }},
                              {"held", [](const ForceOutcome& one) { return one.is_held(); }}};
  for (const double opening : OPENINGS)
    all.push_back(
        {fmt::format("opening_over_{:g}mm", opening * 1e3), [opening](const ForceOutcome& one) { return one.opening > opening; }});
  return all;
}

// Made once: samples ask for them a thousand times.
const std::vector<ForceEvent>& force_events() {
  static const std::vector<ForceEvent> events = all_force_events();
  return events;
}

using Members = std::span<const std::size_t>;  // people of a sample

double share_of(std::span<const ForcesOfPerson> people, Members members, std::size_t choice, const ForceEvent& event) {
  std::size_t yes = 0, of = 0;
  for (const std::size_t member : members) {
    const ForceOutcome& one = people[member][choice];
    if (!one.has_gripped) continue;
    ++of;
    yes += event.happens(one) ? 1 : 0;
  }
  return of > 0 ? static_cast<double>(yes) / static_cast<double>(of) : NO_SHARE;
}

double mean_opening(std::span<const ForcesOfPerson> people, Members members, std::size_t choice) {
  double sum = 0;
  std::size_t of = 0;
  for (const std::size_t member : members) {
    if (!people[member][choice].has_gripped) continue;
    ++of;
    sum += people[member][choice].opening;
  }
  return of > 0 ? sum / static_cast<double>(of) : NO_SHARE;
}

double gripped_share(std::span<const ForcesOfPerson> people, Members members, std::size_t choice) {
  std::size_t gripped = 0;
  for (const std::size_t member : members) gripped += people[member][choice].has_gripped ? 1 : 0;
  return static_cast<double>(gripped) / static_cast<double>(members.size());
}

// How each newton of F_base and of F_range changes the odds of an event, and whether F_base comes first.
void add_coefficients(std::span<const ForcesOfPerson> people, Members members, const ForceEvent& event,
                      std::vector<double>& values) {
  std::vector<double> terms;
  std::vector<char> happens;
  for (const std::size_t member : members)
    for (std::size_t choice = 0; choice < FORCE_CHOICES; ++choice) {
      if (!people[member][choice].has_gripped) continue;
      terms.push_back(PAPER_CHOICES[choice].base);
      terms.push_back(PAPER_CHOICES[choice].range);
      happens.push_back(event.happens(people[member][choice]) ? 1 : 0);
    }
  const LogisticModel model = fit_logistic_model(terms, 2, happens);
  if (!model.is_fitted) {
    values.insert(values.end(), 3, NO_SHARE);
    return;
  }
  values.insert(values.end(), {model.coefficients[0], model.coefficients[1],
                               std::abs(model.coefficients[0]) > std::abs(model.coefficients[1]) ? 1.0 : 0.0});
}

bool has_coefficients(const ForceEvent& event) { return event.name != "oscillated" && event.name != "held"; }

// All of them, in the order of `names_of`.
std::vector<double> values_of(std::span<const ForcesOfPerson> people, Members members) {
  std::vector<double> values;
  for (std::size_t choice = 0; choice < FORCE_CHOICES; ++choice) {
    for (const ForceEvent& event : force_events()) values.push_back(share_of(people, members, choice, event));
    values.push_back(mean_opening(people, members, choice));
    values.push_back(gripped_share(people, members, choice));
  }
  for (const ForceEvent& event : force_events())
    if (has_coefficients(event)) add_coefficients(people, members, event, values);
  return values;
}

// Counts everybody, in the order of values_of; each trial is one grasp.
std::vector<StudyCount> counts_of(std::span<const ForcesOfPerson> people) {
  std::vector<StudyCount> counts;
  for (std::size_t choice = 0; choice < FORCE_CHOICES; ++choice) {
    StudyCount tried, gripped;
    for (const ForcesOfPerson& person : people) {
      tried.add_person(1);
      gripped.add_person(person[choice].has_gripped ? 1 : 0);
    }
    counts.insert(counts.end(), force_events().size() + 1, gripped);
    counts.push_back(tried);
  }
  StudyCount all;
  for (const ForcesOfPerson& person : people)
    all.add_person(static_cast<std::uint64_t>(
        std::count_if(person.begin(), person.end(), [](const ForceOutcome& one) { return one.has_gripped; })));
  for (const ForceEvent& event : force_events())
    if (has_coefficients(event)) counts.insert(counts.end(), 3, all);
  return counts;
}

struct ForceName {
  std::string statistic, subject;
  std::optional<double> paper;
};
std::vector<ForceName> force_names() {
  std::vector<ForceName> all;
  for (const ForceChoice& choice : PAPER_CHOICES) {
    const double lost = static_cast<double>(choice.paper_lost) / static_cast<double>(FORCE_PEOPLE);
    for (const ForceEvent& event : force_events())
      all.push_back({event.name + "_share", choice_name(choice), event.name == "lost" ? std::optional(lost) : std::nullopt});
    all.push_back({"largest_opening_mean", choice_name(choice), std::nullopt});
    all.push_back({"gripped_share", choice_name(choice), std::nullopt});
  }
  for (const ForceEvent& event : force_events()) {
    if (!has_coefficients(event)) continue;
    all.push_back({"coefficient_base", event.name, std::nullopt});
    all.push_back({"coefficient_range", event.name, std::nullopt});
    all.push_back({"base_ahead_of_range", event.name, event.name == "lost" ? std::optional(1.0) : std::nullopt});
  }
  return all;
}

}  // namespace

std::vector<StudyRow> force_rows(std::span<const ForcesOfPerson> people, const std::string& vessel, std::uint64_t seed,
                                 int resamples, int threads) {
  std::vector<std::size_t> everybody(people.size());
  std::iota(everybody.begin(), everybody.end(), std::size_t{0});
  const std::vector<double> values = values_of(people, everybody);
  std::vector<Interval> intervals(values.size());
  if (people.size() >= FORCE_PEOPLE) {
    std::vector<std::vector<double>> samples(static_cast<std::size_t>(resamples));
    in_parallel(samples.size(), threads, [&](std::size_t k) {
      std::uint64_t state = mixed_bits(mixed_bits(seed ^ FORCE_SAMPLES) + k);
      samples[k] = values_of(people, draw_people(FORCE_PEOPLE, people.size(), state));
    });
    intervals = sample_intervals(samples);
  }
  std::vector<StudyRow> rows;
  const std::vector<ForceName> all = force_names();
  const std::vector<StudyCount> counts = counts_of(people);
  for (std::size_t k = 0; k < all.size(); ++k)
    rows.push_back({"forces", "", vessel, all[k].statistic, all[k].subject, values[k],
                    std::isnan(values[k]) ? Interval{} : intervals[k], all[k].paper, counts[k]});
  return rows;
}

}  // namespace wholehand
