// SPDX-License-Identifier: MIT
// The statistics of sessions on grasps whose numbers are computed by hand.
// sanitizers: thread
#include "evidence/studies/session_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "base/numbers/random_bits.h"
#include "base/statistics/moments.h"
#include "base/text/error.h"
#include "device/recordings/grasp_collector.h"
#include "evidence/studies/paper_sample.h"
#include "tests/support/recorded_session.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

// The places are not the numbers of the paper's vessels: place 0 is only carried.
const SessionVessels SESSION_VESSELS{{1, "first"}, {2, "second"}, {3, "third"}};

SessionSampling sampling_of(int resamples, int threads = 1) {
  SessionSampling sampling;
  sampling.resamples = resamples;
  sampling.threads = threads;
  return sampling;
}

// Tilted by 60 degrees and maintained.
device::GraspReport tilted_grasp(int vessel, double increase, double change, device::GripCourse course = device::GripCourse::less) {
  device::GraspReport grasp;
  grasp.vessel = vessel;
  grasp.largest_tilt = radians(60);
  grasp.normal_increase = increase;
  grasp.grip_change = change;
  grasp.course = course;
  grasp.after_at_first = 4;
  return grasp;
}

const StudyRow& session_row(const std::vector<StudyRow>& rows, const std::string& vessel, const std::string& statistic) {
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [&](const StudyRow& row) { return row.vessel == vessel && row.statistic == statistic; });
  if (found == rows.end()) throw std::runtime_error("no row " + vessel + " " + statistic);
  return *found;
}

double session_value(const std::vector<StudyRow>& rows, const std::string& vessel, const std::string& statistic) {
  return session_row(rows, vessel, statistic).value;
}

// Increases of 1, 2, 3, then 4, 5, 6, then 7, 8, 9 N; the grip's changes go against them, with them, and nowhere.
std::vector<SessionSubject> nine_grasps() {
  std::vector<SessionSubject> subjects(3);
  const double changes[3][3] = {{3, 2, 1}, {-1, 0, 1}, {1, 1, 1}};
  for (int v = 0; v < 3; ++v)
    for (int k = 0; k < 3; ++k) {
      device::GraspReport grasp = tilted_grasp(v + 1, 3 * v + k + 1, changes[v][k]);
      grasp.response_time = 0.1 + 0.01 * k;
      grasp.tightened = 3 + v;
      grasp.before.mean = 2 + 2 * k;
      grasp.during.mean = 5;
      grasp.after.mean = 4 + k;
      grasp.tilt_time = 2 + k;
      grasp.duration = {1, 2, 3.0 + k};
      subjects[static_cast<std::size_t>(k)].grasps.push_back(grasp);
    }
  return subjects;
}

TEST(SessionStatistics, MeansDeviationsAndCorrelations) {
  const auto rows = session_rows(nine_grasps(), SESSION_VESSELS, sampling_of(5));
  constexpr double ROUNDING = 1e-12;  // of sums of a few numbers near 1
  EXPECT_NEAR(session_value(rows, "first", "normal_increase_mean"), 2, ROUNDING);
  EXPECT_NEAR(session_value(rows, "second", "normal_increase_mean"), 5, ROUNDING);
  EXPECT_NEAR(session_value(rows, "third", "normal_increase_deviation"), 1, ROUNDING);
  EXPECT_NEAR(session_value(rows, "first", "correlation_increase_change"), -1, ROUNDING);
  EXPECT_NEAR(session_value(rows, "second", "correlation_increase_change"), 1, ROUNDING);
  EXPECT_TRUE(std::isnan(session_value(rows, "third", "correlation_increase_change"))) << "the change is one and the same";
  EXPECT_NEAR(session_value(rows, "first", "grip_before_mean"), 4, ROUNDING);
  EXPECT_NEAR(session_value(rows, "first", "grip_before_deviation"), 2, ROUNDING);
  EXPECT_NEAR(session_value(rows, "second", "grip_during_mean"), 5, ROUNDING);
  EXPECT_NEAR(session_value(rows, "second", "grip_after_mean"), 5, ROUNDING);
  EXPECT_NEAR(session_value(rows, "third", "response_time_mean"), 0.11, ROUNDING);
  EXPECT_NEAR(session_value(rows, "third", "grip_stopped_mean"), 5, ROUNDING);
  EXPECT_NEAR(session_value(rows, "all", "response_time_mean"), 0.11, ROUNDING);
  // 0.1, 0.11 and 0.12, three times each: squares of 6 x 0.01^2 over 8
  EXPECT_NEAR(session_value(rows, "all", "response_time_deviation"), std::sqrt(6e-4 / 8), ROUNDING);
  EXPECT_NEAR(session_value(rows, "all", "grip_stopped_mean"), 4, ROUNDING);
  EXPECT_NEAR(session_value(rows, "all", "tilt_time_mean"), 3, ROUNDING);
  EXPECT_NEAR(session_value(rows, "all", "maintained_time_mean"), 4, ROUNDING);
  // before: 2, 4, 6 with 3, 2, 1, then -1, 0, 1, then 1, 1, 1. Sum of products 0 of the first two together
  EXPECT_NEAR(session_value(rows, "all", "correlation_before_change"), 0, ROUNDING);
}

// Sums of squares: 54 between with 2 degrees of freedom, 6 within with 6. So F is 27, and P(F > 27) is (1 + 2 x 27 / 6)^-3.
TEST(SessionStatistics, AnalysisOfVariance) {
  auto subjects = nine_grasps();
  auto rows = session_rows(subjects, SESSION_VESSELS, sampling_of(5));
  EXPECT_NEAR(session_value(rows, "all", "anova_f"), 27, 1e-10);
  EXPECT_NEAR(session_value(rows, "all", "anova_p"), 1e-3, 1e-12);
  EXPECT_NEAR(session_value(rows, "all", "anova_share"), 0.9, 1e-12);
  EXPECT_EQ(session_value(rows, "all", "ordered_as_paper"), 1);
  // the third vessel becomes the least
  for (SessionSubject& subject : subjects) subject.grasps[2].normal_increase -= 8;
  rows = session_rows(subjects, SESSION_VESSELS, sampling_of(5));
  EXPECT_EQ(session_value(rows, "all", "ordered_as_paper"), 0);
  // without the third there is no order to compare
  for (SessionSubject& subject : subjects) subject.grasps.pop_back();
  rows = session_rows(subjects, SESSION_VESSELS, sampling_of(5));
  EXPECT_TRUE(std::isnan(session_value(rows, "all", "ordered_as_paper")));
}

TEST(SessionStatistics, SharesAreOfTheGraspsThatTheyAreSaidOf) {
  std::vector<SessionSubject> subjects(1);
  auto& grasps = subjects[0].grasps;
  grasps = {tilted_grasp(1, 1, 0.5), tilted_grasp(1, 1, -0.5), tilted_grasp(1, 1, 0, device::GripCourse::complex),
            tilted_grasp(1, 1, 2, device::GripCourse::more), tilted_grasp(1, 1, 1, device::GripCourse::equal)};
  grasps[0].after_at_first = 8.5;
  grasps[1].after_at_first = 0.5;
  grasps[2].after_at_first = 8;                   // not over 8
  grasps[3].after_at_first = 1;                   // nor under 1
  grasps[4].after_at_first = device::Tick::NONE;  // nothing is maintained
  // saturated: no type, and still maintained
  grasps.push_back(tilted_grasp(1, 9, 9, device::GripCourse::not_analyzed));
  // hardly tilted, and lost
  grasps.push_back(tilted_grasp(1, 9, 9, device::GripCourse::not_analyzed));
  grasps.back().largest_tilt = radians(29);
  grasps.back().after_at_first = 9;
  grasps.back().before.mean = 100;
  grasps.back().outcome = device::GraspOutcome::lost;
  // a grasp of a vessel that nobody pours from
  grasps.push_back(tilted_grasp(0, 50, 50, device::GripCourse::more));
  grasps.back().outcome = device::GraspOutcome::lost;
  const auto rows = session_rows(subjects, SESSION_VESSELS, sampling_of(5));
  for (const char* vessel : {"all", "first"}) {
    EXPECT_DOUBLE_EQ(session_value(rows, vessel, "g1_share"), 0.2) << vessel;
    EXPECT_DOUBLE_EQ(session_value(rows, vessel, "g2_share"), 0.2) << vessel;
    EXPECT_DOUBLE_EQ(session_value(rows, vessel, "g3_share"), 0.4) << vessel;
    EXPECT_DOUBLE_EQ(session_value(rows, vessel, "g4_share"), 0.2) << vessel;
    EXPECT_DOUBLE_EQ(session_value(rows, vessel, "rising_share"), 0.6) << vessel;
    EXPECT_DOUBLE_EQ(session_value(rows, vessel, "lost_share"), 1.0 / 7) << vessel;
  }
  EXPECT_DOUBLE_EQ(session_value(rows, "all", "falling_share"), 0.4) << "0 is no rise";
  EXPECT_DOUBLE_EQ(session_value(rows, "all", "maintained_over_8N_share"), 0.2);
  EXPECT_DOUBLE_EQ(session_value(rows, "all", "maintained_under_1N_share"), 0.2);
  EXPECT_DOUBLE_EQ(session_value(rows, "first", "normal_increase_mean"), 1);
  EXPECT_TRUE(std::isnan(session_value(rows, "first", "grip_before_mean"))) << "of a grasp that is hardly tilted";
  EXPECT_TRUE(std::isnan(session_value(rows, "second", "lost_share")));
}

// One person makes seven grasps of the vessel: five have a type, six are tilted, and five of these maintained. The other makes one without a tilt.
TEST(SessionStatistics, CountThePeopleAndGraspsBehindANumber) {
  std::vector<SessionSubject> subjects(2);
  for (const device::GripCourse course : {device::GripCourse::less, device::GripCourse::less, device::GripCourse::complex,
                                          device::GripCourse::more, device::GripCourse::equal, device::GripCourse::not_analyzed})
    subjects[0].grasps.push_back(tilted_grasp(1, 1, 0.5, course));
  subjects[0].grasps[4].after_at_first = device::Tick::NONE;
  subjects[0].grasps[0].before.mean = subjects[0].grasps[5].before.mean = 3;
  for (std::size_t person = 0; person < 2; ++person) {
    subjects[person].grasps.push_back(tilted_grasp(1, 9, 9, device::GripCourse::not_analyzed));
    subjects[person].grasps.back().largest_tilt = 0;
    subjects[person].grasps.back().response_time = 0.1;
  }
  subjects[1].grasps.push_back(tilted_grasp(0, 1, 1));  // nobody pours from this vessel
  const auto rows = session_rows(subjects, SESSION_VESSELS, sampling_of(5));
  const auto has_count = [&](const char* vessel, const char* statistic, std::uint64_t people, std::uint64_t grasps) {
    const StudyCount& count = session_row(rows, vessel, statistic).count;
    EXPECT_EQ(count.people, std::optional(people)) << vessel << ' ' << statistic;
    EXPECT_EQ(count.grasps, std::optional(grasps)) << vessel << ' ' << statistic;
  };
  for (const char* vessel : {"all", "first"}) {
    has_count(vessel, "lost_share", 2, 8);
    has_count(vessel, "response_time_mean", 2, 2);
    has_count(vessel, "g4_share", 1, 5);
  }
  has_count("all", "maintained_over_8N_share", 1, 5);
  has_count("all", "correlation_before_change", 1, 1);
  has_count("all", "anova_f", 1, 5);
  has_count("first", "analyzed_share", 1, 6);
  has_count("first", "grip_before_mean", 1, 2);
  has_count("second", "lost_share", 0, 0);
  EXPECT_FALSE(session_row(rows, "all", INSIDE_SHARE).count.people);
}

// The types as the paper describes them, from the ticks on.
TEST(SessionStatistics, TypesOfWholeSessions) {
  const auto normal = [](double x) { return x; };
  const std::function<double(double)> grips[] = {[](double x) { return 3 + x; }, [](double x) { return 3 + 2 * x; },
                                                 [](double x) { return 3 - 0.5 * x; },
                                                 [](double x) { return 3 + std::sin(1.75 * PI * x) + 0.8 * x; }};
  std::vector<SessionSubject> subjects;
  for (const auto& grip : grips) {
    device::GraspCollector collector(1000, 8);
    for (const device::Tick& tick : tilted_session(radians(60), grip, normal).recording.ticks) collector.add(tick);
    subjects.push_back({collector.finish()});
  }
  const auto rows = session_rows(subjects, {{0, "one"}}, sampling_of(5));
  for (const char* statistic : {"g1_share", "g2_share", "g3_share", "g4_share"})
    EXPECT_DOUBLE_EQ(session_value(rows, "one", statistic), 0.25) << statistic;
  EXPECT_DOUBLE_EQ(session_value(rows, "all", "rising_share"), 0.75);
  EXPECT_NEAR(session_value(rows, "one", "normal_increase_mean"), 1, 0.01);  // averaged over 0.1 s at both ends
  EXPECT_NEAR(session_value(rows, "one", "grip_before_mean"), 3, 1e-9);
  EXPECT_NEAR(session_value(rows, "all", "maintained_time_mean"), 1, 1e-9);
}

TEST(SessionStatistics, AllAlikeHaveIntervalsOfNoWidth) {
  std::vector<SessionSubject> subjects(20);
  for (SessionSubject& subject : subjects)
    for (int v = 1; v <= 3; ++v) {
      subject.grasps.push_back(tilted_grasp(v, 0.7 * v, 0.3));
      subject.grasps.back().response_time = 0.1;
      subject.grasps.back().before.mean = 3.3;
    }
  const auto rows = session_rows(subjects, SESSION_VESSELS, sampling_of(50));
  for (const StudyRow& row : rows) {
    if (std::isnan(row.value) || row.statistic == INSIDE_SHARE) continue;
    EXPECT_EQ(row.interval.low, row.interval.high) << row.vessel << " " << row.statistic;
  }
  EXPECT_EQ(session_row(rows, "second", "normal_increase_mean").interval.low, 1.4);
  EXPECT_EQ(session_row(rows, "second", "normal_increase_deviation").interval.low, 0);
  EXPECT_EQ(session_row(rows, "second", "normal_increase_mean").inside(), false);
}

// People who differ: the same draws for every number of threads.
std::vector<SessionSubject> uneven_people(std::size_t count) {
  std::uint64_t state = 7;
  std::vector<SessionSubject> subjects(count);
  for (SessionSubject& subject : subjects)
    for (int k = 0; k < 10; ++k) {
      const double increase = unit_interval(split_mix(state)), change = unit_interval(split_mix(state)) - 0.3;
      subject.grasps.push_back(tilted_grasp(1 + k % 3, increase, change));
      subject.grasps.back().before.mean = 3 + unit_interval(split_mix(state));
    }
  return subjects;
}

TEST(SessionStatistics, SameBitsForAnyThreads) {
  const auto bits = [](double value) { return std::isnan(value) ? 0 : std::bit_cast<std::uint64_t>(value); };
  const auto subjects = uneven_people(30);
  const auto one = session_rows(subjects, SESSION_VESSELS, sampling_of(40, 1)),
             three = session_rows(subjects, SESSION_VESSELS, sampling_of(40, 3));
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].statistic, three[k].statistic);
    EXPECT_EQ(bits(one[k].value), bits(three[k].value)) << one[k].statistic;
    EXPECT_EQ(bits(one[k].interval.low), bits(three[k].interval.low)) << one[k].statistic;
    EXPECT_EQ(bits(one[k].interval.high), bits(three[k].interval.high)) << one[k].statistic;
  }
  SessionSampling other = sampling_of(40);
  other.seed = 2;
  EXPECT_NE(session_row(session_rows(subjects, SESSION_VESSELS, other), "first", "normal_increase_mean").interval.low,
            session_row(one, "first", "normal_increase_mean").interval.low);
}

// The interval's ends are samples, and so shares of 22 grasps.
TEST(SessionStatistics, SamplesHaveThePapersSize) {
  std::vector<SessionSubject> subjects(12);
  for (std::size_t k = 0; k < subjects.size(); ++k) {
    subjects[k].grasps.assign(10, tilted_grasp(1, 1, 1));
    for (device::GraspReport& grasp : subjects[k].grasps)
      grasp.outcome = k % 2 == 0 ? device::GraspOutcome::lost : device::GraspOutcome::let_go;
  }
  const auto rows = session_rows(subjects, SESSION_VESSELS, sampling_of(41));
  const StudyRow& row = session_row(rows, "first", "lost_share");
  EXPECT_DOUBLE_EQ(row.value, 0.5);
  EXPECT_LT(row.interval.low, 0.5);
  EXPECT_GT(row.interval.high, 0.5);
  for (const double end : {row.interval.low, row.interval.high})
    EXPECT_NEAR(22 * end, std::round(22 * end), 1e-9) << "rounding of a mean of 22 numbers";
}

TEST(SessionStatistics, TwoPeopleHaveNoIntervals) {
  for (const StudyRow& row : session_rows(uneven_people(2), SESSION_VESSELS, sampling_of(10)))
    EXPECT_TRUE(std::isnan(row.interval.low) && std::isnan(row.interval.high)) << row.statistic;
  EXPECT_FALSE(std::isnan(
      session_row(session_rows(uneven_people(3), SESSION_VESSELS, sampling_of(10)), "all", "rising_share").interval.low));
}

TEST(SessionStatistics, PapersValues) {
  SessionSampling sampling = sampling_of(5);
  const auto real = session_rows(nine_grasps(), SESSION_VESSELS, sampling);
  EXPECT_EQ(session_row(real, "all", "tilt_time_mean").paper, 3.647);
  EXPECT_EQ(session_row(real, "all", "tilt_time_deviation").paper, 1.392);
  EXPECT_EQ(session_row(real, "third", "normal_increase_mean").paper, 2.33);
  EXPECT_EQ(session_row(real, "first", "correlation_increase_change").paper, -0.251);
  EXPECT_EQ(session_row(real, "all", "rising_share").paper, 62.0 / 71);
  EXPECT_FALSE(session_row(real, "all", "lost_share").paper.has_value());
  EXPECT_EQ(session_row(real, "all", "response_time_mean").experiment, "sessions");
  // the simulated user's tilting is the paper's: nothing to compare with
  sampling.are_simulated = true;
  const auto simulated = session_rows(nine_grasps(), SESSION_VESSELS, sampling);
  EXPECT_FALSE(session_row(simulated, "all", "tilt_time_mean").paper.has_value());
  EXPECT_FALSE(session_row(simulated, "all", "tilt_time_deviation").paper.has_value());
  EXPECT_EQ(session_row(simulated, "all", "response_time_mean").paper, 0.106);
}

TEST(SessionStatistics, ShareThatIsInside) {
  std::vector<StudyRow> rows(5);
  for (StudyRow& row : rows) row.interval = {1, 2};
  rows[0].paper = 1;
  rows[1].paper = 1.5;
  rows[2].paper = 2.5;
  rows[3].paper = 1.5;
  rows[3].interval = {};  // nothing to compare with
  EXPECT_EQ(count_inside(rows).inside, 2u);
  EXPECT_EQ(count_inside(rows).of, 3u);
  EXPECT_DOUBLE_EQ(inside_share(rows), 2.0 / 3);
  EXPECT_TRUE(std::isnan(inside_share({})));
  const auto all = session_rows(uneven_people(5), SESSION_VESSELS, sampling_of(20));
  EXPECT_EQ(all.back().statistic, INSIDE_SHARE);
  EXPECT_DOUBLE_EQ(all.back().value, inside_share(std::span(all).first(all.size() - 1)));
}

TEST(PaperSample, VesselsOfAScene) {
  using Places = std::vector<std::size_t>;
  Scene scene = scene_of({beaker1(), beaker1(), beaker3(), beaker1(), beaker3()});
  EXPECT_EQ(paper_vessels(scene, SampleVessels::any), (Places{0, 1, 2}));
  EXPECT_EQ(paper_vessels(scene, SampleVessels::with_guidance), Places{});
  for (const std::size_t v : {1, 3, 4}) scene.vessels[v].guidance = {{50e-3, 0}};
  EXPECT_EQ(paper_vessels(scene, SampleVessels::with_guidance), (Places{1, 3, 4}));
  // with a task, only what is poured
  scene.task.emplace();
  for (const std::size_t v : {2, 4}) scene.vessels[v].liquid_name = "red";
  EXPECT_EQ(paper_vessels(scene, SampleVessels::any), (Places{2, 4}));
  EXPECT_EQ(paper_vessels(scene, SampleVessels::with_guidance), Places{4});
  const SessionVessels vessels = session_vessels(scene);
  ASSERT_EQ(vessels.size(), 2u);
  EXPECT_EQ(vessels[1].place, 4u);
  EXPECT_EQ(vessels[1].name, scene.vessels[4].name);
  scene.vessels[4].name = ALL_VESSELS;
  EXPECT_THROW(session_vessels(scene), Error);
  for (VesselData& vessel : scene.vessels) vessel.liquid_name.clear();
  EXPECT_THROW(session_vessels(scene), Error);
}

// Two known people: in Polya's urn each number of draws of the first, 0 to 4 of 4, is equally likely. 10,000 samples have an error of 0.004.
TEST(PaperSample, WhoeverIsDrawnGoesBackTwice) {
  std::uint64_t state = 1;
  std::array<int, 5> times{};
  for (int k = 0; k < 10000; ++k) {
    const std::vector<std::size_t> people = draw_people(4, 2, state);
    ASSERT_EQ(people.size(), 4u);
    ++times[static_cast<std::size_t>(std::count(people.begin(), people.end(), 0u))];
  }
  for (const int one : times) EXPECT_NEAR(one / 1e4, 0.2, 0.02);
}

// The mean of 17 in repetitions of 40 known people, 0 to 39: what draw_people promises. A variance from 10,000 samples has an error of 1.4 %.
TEST(PaperSample, RepetitionsHaveTheKnownPeoplesOwnError) {
  std::uint64_t state = 2;
  constexpr double KNOWN = 40, COUNT = 17;
  std::vector<double> means;
  for (int k = 0; k < 10000; ++k) {
    double sum = 0;
    for (const std::size_t one : draw_people(17, 40, state)) sum += static_cast<double>(one);
    means.push_back(sum / COUNT);
  }
  const double variance = KNOWN * (KNOWN + 1) / 12;  // of 0 to 39 as a sample
  EXPECT_NEAR(std::pow(deviation_of(means), 2) / (variance * (1 / COUNT + 1 / KNOWN) * (KNOWN - 1) / (KNOWN + 1)), 1, 0.06);
  EXPECT_NEAR(mean_of(means), 19.5, 0.2);
}

}  // namespace
}  // namespace wholehand
