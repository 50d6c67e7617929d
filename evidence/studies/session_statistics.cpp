// SPDX-License-Identifier: MIT
#include "evidence/studies/session_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/numbers/parallel.h"
#include "base/numbers/random_bits.h"
#include "base/statistics/anova.h"
#include "base/statistics/correlation.h"
#include "base/statistics/resample.h"
#include "base/text/error.h"
#include "evidence/studies/grasp_numbers.h"
#include "evidence/studies/paper_sample.h"

namespace wholehand {
namespace {

using namespace of_grasp;

constexpr std::uint64_t SESSION_SAMPLES = 0x73657373696f6e73;  // keeps the samples' draws from those of people

using GraspList = std::vector<const device::GraspReport*>;
using GraspsByVessel = std::vector<GraspList>;  // in the order of the SessionVessels

// ---- statistics of grasps ----

enum class Summary { mean, deviation, correlation };

struct Measure {
  const char* name;
  Summary summary;
  Number number;
  Number with = nullptr;  // of a correlation
};

// With the paper's value; NaN: it is not known.
struct OfAll {
  Measure measure;
  double paper = NO_VALUE;
};
struct OfVessel {
  Measure measure;
  std::array<double, 3> paper{NO_VALUE, NO_VALUE, NO_VALUE};
};

const std::array<OfAll, 19> OF_ALL{{
    {{"response_time_mean", Summary::mean, response_time}, 0.106},
    {{"response_time_deviation", Summary::deviation, response_time}, 0.095},
    {{"grip_stopped_mean", Summary::mean, grip_stopped}, 3.76},
    {{"grip_stopped_deviation", Summary::deviation, grip_stopped}, 0.08},
    {{"grip_after_mean", Summary::mean, grip_after}, 4.87},
    {{"grip_after_deviation", Summary::deviation, grip_after}, 1.67},
    {{"tilt_time_mean", Summary::mean, tilt_time}, 3.647},
    {{"tilt_time_deviation", Summary::deviation, tilt_time}, 1.392},
    {{"maintained_time_mean", Summary::mean, maintained_time}, 4.12},
    {{"maintained_over_8N_share", Summary::mean, is_hard}, 2.0 / 61},
    {{"maintained_under_1N_share", Summary::mean, is_soft}, 3.0 / 61},
    {{"g1_share", Summary::mean, has_course<device::GripCourse::equal>}},
    {{"g2_share", Summary::mean, has_course<device::GripCourse::more>}},
    {{"g3_share", Summary::mean, has_course<device::GripCourse::less>}},
    {{"g4_share", Summary::mean, has_course<device::GripCourse::complex>}, 7.0 / 71},
    {{"rising_share", Summary::mean, is_rising}, 62.0 / 71},
    {{"falling_share", Summary::mean, is_falling}, 6.0 / 71},
    {{"lost_share", Summary::mean, is_lost}},
    {{"correlation_before_change", Summary::correlation, grip_before, grip_change}, -0.184},
}};

const std::array<OfVessel, 18> OF_VESSEL{{
    {{"normal_increase_mean", Summary::mean, normal_increase}, {0.56, 1.02, 2.33}},
    {{"normal_increase_deviation", Summary::deviation, normal_increase}, {0.29, 0.54, 0.34}},
    {{"correlation_increase_change", Summary::correlation, normal_increase, grip_change}, {-0.251, -0.223, 0.098}},
    {{"grip_before_mean", Summary::mean, grip_before}, {3.84, 3.38, 4.63}},
    {{"grip_before_deviation", Summary::deviation, grip_before}, {1.84, 1.33, 1.96}},
    {{"grip_during_mean", Summary::mean, grip_during}},
    {{"grip_after_mean", Summary::mean, grip_after}},
    {{"response_time_mean", Summary::mean, response_time}},
    {{"grip_stopped_mean", Summary::mean, grip_stopped}},
    {{"g1_share", Summary::mean, has_course<device::GripCourse::equal>}},
    {{"g2_share", Summary::mean, has_course<device::GripCourse::more>}},
    {{"g3_share", Summary::mean, has_course<device::GripCourse::less>}},
    {{"g4_share", Summary::mean, has_course<device::GripCourse::complex>}},
    {{"rising_share", Summary::mean, is_rising}},
    {{"lost_share", Summary::mean, is_lost}},
    {{"tilted_share", Summary::mean, has_tilt}},
    {{"analyzed_share", Summary::mean, has_type}},
    {{"saturated_share", Summary::mean, is_saturated}},
}};

// Statistics that compare the normal increases of the vessels with each other.
struct BetweenVessels {
  const char* name;
  double paper = NO_VALUE;
};
const std::array<BetweenVessels, 4> BETWEEN{{{"anova_f"}, {"anova_p"}, {"anova_share"}, {"ordered_as_paper", 1}}};

bool counts(const Measure& measure, const device::GraspReport& grasp) {
  return std::isfinite(measure.number(grasp)) && (!measure.with || std::isfinite(measure.with(grasp)));
}

double value_of(const Measure& measure, const GraspList& grasps) {
  if (measure.summary != Summary::correlation) {
    device::MeanSum sum;
    for (const device::GraspReport* grasp : grasps) sum.add(measure.number(*grasp));
    const device::MeanDeviation result = sum.result();
    return measure.summary == Summary::mean ? result.mean : result.deviation;
  }
  std::vector<double> x, y;
  for (const device::GraspReport* grasp : grasps) {
    if (!counts(measure, *grasp)) continue;
    x.push_back(measure.number(*grasp));
    y.push_back(measure.with(*grasp));
  }
  return pearson(x, y).r.value_or(NO_VALUE);
}

// In the order of BETWEEN.
std::array<double, BETWEEN.size()> between_vessels(const GraspsByVessel& grasps) {
  std::vector<std::vector<double>> groups(grasps.size());
  std::vector<double> means;
  for (std::size_t v = 0; v < grasps.size(); ++v) {
    device::MeanSum sum;
    for (const device::GraspReport* grasp : grasps[v]) {
      const double increase = normal_increase(*grasp);
      if (std::isfinite(increase)) groups[v].push_back(increase);
      sum.add(increase);
    }
    means.push_back(sum.result().mean);
  }
  const std::optional<Anova> anova = one_way_anova(groups);
  // NaN is never below
  const bool has_all = means.size() == PAPER_GRASPS.size() && std::isfinite(means[0] + means[1] + means[2]);
  const double is_ordered = counted_if(has_all, has_all && means[0] < means[1] && means[1] < means[2]);
  return {anova ? anova->f : NO_VALUE, anova ? anova->p : NO_VALUE, anova ? anova->share : NO_VALUE, is_ordered};
}

// All values, in the order of the rows; used for the population and every sample of it.
std::vector<double> values_of(const GraspsByVessel& grasps) {
  GraspList all;
  for (const GraspList& of_vessel : grasps) all.insert(all.end(), of_vessel.begin(), of_vessel.end());
  std::vector<double> values;
  for (const OfAll& statistic : OF_ALL) values.push_back(value_of(statistic.measure, all));
  for (const double value : between_vessels(grasps)) values.push_back(value);
  for (const GraspList& of_vessel : grasps)
    for (const OfVessel& statistic : OF_VESSEL) values.push_back(value_of(statistic.measure, of_vessel));
  return values;
}

// How many of one person's grasps count for each statistic, in the order of values_of.
std::vector<std::uint64_t> counts_of(const GraspsByVessel& grasps) {
  std::vector<std::uint64_t> counted;
  const auto count = [](const Measure& measure, const GraspList& list) {
    return static_cast<std::uint64_t>(
        std::count_if(list.begin(), list.end(), [&](const device::GraspReport* grasp) { return counts(measure, *grasp); }));
  };
  GraspList all;
  for (const GraspList& of_vessel : grasps) all.insert(all.end(), of_vessel.begin(), of_vessel.end());
  for (const OfAll& statistic : OF_ALL) counted.push_back(count(statistic.measure, all));
  counted.insert(counted.end(), BETWEEN.size(), count({"", Summary::mean, normal_increase}, all));
  for (const GraspList& of_vessel : grasps)
    for (const OfVessel& statistic : OF_VESSEL) counted.push_back(count(statistic.measure, of_vessel));
  return counted;
}

// ---- the population and its samples ----

class GraspPool {
 public:
  GraspPool(std::span<const SessionSubject> subjects, const SessionVessels& vessels) : vessels_(vessels.size()) {
    for (const SessionSubject& subject : subjects) {
      GraspsByVessel& grasps = subjects_.emplace_back(vessels_);
      for (const device::GraspReport& grasp : subject.grasps)
        for (std::size_t v = 0; v < vessels_; ++v)
          if (static_cast<std::size_t>(grasp.vessel) == vessels[v].place) grasps[v].push_back(&grasp);
    }
  }

  GraspsByVessel all() const {
    GraspsByVessel grasps(vessels_);
    for (std::size_t subject = 0; subject < subjects_.size(); ++subject) add(subject, grasps);
    return grasps;
  }

  // Adds each person's counts to the rows, which are in the order of values_of.
  void count(std::vector<StudyRow>& rows) const {
    for (const GraspsByVessel& grasps : subjects_) {
      const std::vector<std::uint64_t> counted = counts_of(grasps);
      for (std::size_t k = 0; k < counted.size(); ++k) rows[k].count.add_person(counted[k]);
    }
  }

  // Draws 17 people. Each vessel has as many of their grasps as in the paper; all where there are fewer.
  GraspsByVessel sample(std::uint64_t seed) const {
    std::uint64_t state = seed;
    GraspsByVessel grasps(vessels_);
    for (const std::size_t subject : draw_people(PAPER_PEOPLE, subjects_.size(), state)) add(subject, grasps);
    for (std::size_t v = 0; v < vessels_; ++v) {
      GraspList& open = grasps[v];
      if (open.size() <= PAPER_GRASPS[v]) continue;
      for (std::size_t k = 0; k < PAPER_GRASPS[v]; ++k) std::swap(open[k], open[k + draw_below(open.size() - k, state)]);
      open.resize(PAPER_GRASPS[v]);
    }
    return grasps;
  }

 private:
  void add(std::size_t subject, GraspsByVessel& grasps) const {
    for (std::size_t v = 0; v < vessels_; ++v)
      grasps[v].insert(grasps[v].end(), subjects_[subject][v].begin(), subjects_[subject][v].end());
  }

  std::size_t vessels_;
  std::vector<GraspsByVessel> subjects_;
};

StudyRow row_of(const std::string& vessel, const std::string& statistic, double paper) {
  StudyRow row;
  row.experiment = "sessions";
  row.vessel = vessel;
  row.statistic = statistic;
  if (!std::isnan(paper)) row.paper = paper;
  return row;
}

// F and p of the population belong to many more grasps than a sample has.
bool is_of_a_number_of_grasps(const StudyRow& row) { return row.statistic == "anova_f" || row.statistic == "anova_p"; }

// Without values, in the order of values_of.
std::vector<StudyRow> empty_rows(const SessionVessels& vessels, bool are_simulated) {
  std::vector<StudyRow> rows;
  for (const OfAll& statistic : OF_ALL) {
    const bool is_given = are_simulated && statistic.measure.number == tilt_time;
    rows.push_back(row_of(ALL_VESSELS, statistic.measure.name, is_given ? NO_VALUE : statistic.paper));
  }
  for (const BetweenVessels& statistic : BETWEEN) rows.push_back(row_of(ALL_VESSELS, statistic.name, statistic.paper));
  for (std::size_t v = 0; v < vessels.size(); ++v)
    for (const OfVessel& statistic : OF_VESSEL) rows.push_back(row_of(vessels[v].name, statistic.measure.name, statistic.paper[v]));
  return rows;
}

}  // namespace

std::string few_people_note(std::size_t people) {
  return people < LEAST_SUBJECTS || people >= ENOUGH_SUBJECTS
             ? ""
             : fmt::format("The intervals of fewer than {} people are too narrow, and a value may be outside of its own.",
                           ENOUGH_SUBJECTS);
}

SessionVessels session_vessels(const Scene& scene) {
  SessionVessels vessels;
  for (const std::size_t place : paper_vessels(scene, SampleVessels::any)) {
    check_sample_name(scene, scene.vessels[place].name);
    vessels.push_back({place, scene.vessels[place].name});
  }
  if (vessels.empty())
    throw usage_error(fmt::format("{}: the scene has a task, and no vessel has a liquid; people pour from vessels with a liquid",
                                  scene.file.empty() ? "the scene" : scene.file));
  return vessels;
}

std::vector<StudyRow> session_rows(std::span<const SessionSubject> subjects, const SessionVessels& vessels,
                                   const SessionSampling& sampling) {
  const GraspPool pool(subjects, vessels);
  std::vector<StudyRow> rows = empty_rows(vessels, sampling.are_simulated);
  const std::vector<double> values = values_of(pool.all());
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k].value = values[k];
  pool.count(rows);
  if (subjects.size() >= LEAST_SUBJECTS) {
    std::vector<std::vector<double>> samples(static_cast<std::size_t>(sampling.resamples));
    in_parallel(samples.size(), sampling.threads, [&](std::size_t k) {
      samples[k] = values_of(pool.sample(mixed_bits(mixed_bits(sampling.seed ^ SESSION_SAMPLES) + k)));
    });
    const std::vector<Interval> intervals = sample_intervals(samples);
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (!std::isnan(rows[k].value) && !is_of_a_number_of_grasps(rows[k])) rows[k].interval = intervals[k];
  }
  StudyRow inside = row_of(ALL_VESSELS, INSIDE_SHARE, NO_VALUE);
  inside.value = inside_share(rows);
  rows.push_back(inside);
  return rows;
}

}  // namespace wholehand
