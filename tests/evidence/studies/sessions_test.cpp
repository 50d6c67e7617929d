// SPDX-License-Identifier: MIT
// Sessions of virtual people.
#include "evidence/studies/sessions.h"

#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "base/statistics/distributions.h"
#include "base/text/error.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "device/loop/gripper.h"
#include "device/recordings/grasp_collector.h"
#include "device/recordings/grip_scatter.h"
#include "device/recordings/session_report.h"
#include "device/session/session.h"
#include "evidence/studies/journal.h"
#include "evidence/studies/people_loop.h"
#include "evidence/studies/simulated_session.h"
#include "tests/support/files.h"

namespace wholehand {
namespace {

const std::atomic<bool> GOES_ON{false};

// One beaker of the shipped scene, so that a session is short.
Scene one_beaker(std::size_t vessel = 1) {
  Scene scene = read_scene_file(find_scene("mixing_board"));
  scene.vessels = {VesselData(scene.vessels[vessel])};
  std::erase_if(scene.task->amounts, [&](const auto& amount) { return amount.first != scene.vessels[0].liquid_name; });
  return scene;
}

bool same(const std::vector<device::GraspReport>& a, const std::vector<device::GraspReport>& b) {
  const std::vector<double> x = to_numbers({a, 0}), y = to_numbers({b, 0});
  if (x.size() != y.size()) return false;
  for (std::size_t k = 0; k < x.size(); ++k)
    if (x[k] != y[k] && !(std::isnan(x[k]) && std::isnan(y[k]))) return false;
  return true;
}

// What is measured is what `wholehand session` says of a recording of the same ticks.
TEST(Sessions, AreMeasuredAsRecordingsAre) {
  Scene scene = one_beaker();
  const Participant person(scene.people, 1, 5, Experiment::sessions);
  scene.hand = person.hand(scene.hand);
  device::Recording recording;
  device::GraspCollector collector(scene.live.rate, scene.force.max);
  run_simulated(
      {scene, person, tremor_seed(scene, 1, 5, 0), jobs_of(scene)},
      [&](const device::Tick& tick, const device::Session&) {
        recording.ticks.push_back(tick);
        collector.add(tick);
        return true;
      },
      GOES_ON);
  recording.info.rate = scene.live.rate;
  recording.info.force_max = scene.force.max;
  recording.info.vessels = {{scene.vessels[0].name, "red", 2}};
  const std::vector<device::GraspReport> first = collector.finish(), all = sessions_of_person(one_beaker(), 1, 5, GOES_ON).grasps;
  EXPECT_TRUE(same(device::report_session(recording).grasps, first));
  ASSERT_GT(all.size(), first.size()) << "there is a second session";
  EXPECT_TRUE(same({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(first.size())}, first));
  EXPECT_FALSE(same({all.begin() + static_cast<std::ptrdiff_t>(first.size()), all.end()}, first)) << "with grasps of its own";
  ASSERT_FALSE(first.empty());
  EXPECT_GT(first[0].largest_tilt, device::LEAST_ANALYZED);
  EXPECT_GT(first[0].normal_increase, 0);
}

// A virtual person's grips scatter as `[people]` says of one person's grasps, and the person's habits are no scatter. The deviations of 39 degrees
// of freedom lie within 99.9 % of the chi-square distribution.
TEST(Sessions, GripsScatterAsThePersonsGraspsDo) {
  Scene scene = one_beaker();
  scene.task.reset();
  const Participant person(scene.people, 1, 5, Experiment::sessions);
  scene.hand = person.hand(scene.hand);
  const std::vector<device::SimJob> jobs(40, jobs_of(scene).at(0));
  device::GraspCollector collector(scene.live.rate, scene.force.max);
  EXPECT_TRUE(run_simulated(
      {scene, person, 1, jobs, 2000.0},
      [&](const device::Tick& tick, const device::Session&) {
        collector.add(tick);
        return true;
      },
      GOES_ON));
  device::GripScatter scatter;
  scatter.add(collector.finish());
  ASSERT_EQ(scatter.freedom(), 39u);
  const auto found = scatter.deviations();
  const auto expect_scatter = [&](std::size_t k, Trait trait) {
    const double expected = scene.people.traits[static_cast<std::size_t>(trait)].grasp, ratio = found[k].value / expected;
    EXPECT_GT(39 * ratio * ratio, chi_square_quantile(0.0005, 39)) << device::SCATTER_KEYS[k].name;
    EXPECT_LT(39 * ratio * ratio, chi_square_quantile(0.9995, 39)) << device::SCATTER_KEYS[k].name;
  };
  expect_scatter(0, Trait::height);
  expect_scatter(2, Trait::obliquity);
  expect_scatter(3, Trait::roll);
  expect_scatter(4, Trait::azimuth);
  EXPECT_LT(found[1].value, 0.5e-3) << "virtual people aim at the axis, and their arms tremble by some 0.15 mm";
}

TEST(Sessions, WithoutScatterEverybodyIsOnePerson) {
  Scene scene = one_beaker();
  scene.people.scatter = 0;
  EXPECT_TRUE(same(sessions_of_person(scene, 1, 0, GOES_ON).grasps, sessions_of_person(scene, 1, 99, GOES_ON).grasps));
  scene.people.scatter = 1;
  EXPECT_FALSE(same(sessions_of_person(scene, 1, 0, GOES_ON).grasps, sessions_of_person(scene, 1, 99, GOES_ON).grasps));
}

// A grip rises by more than the load if gain and margin ask for more. Without scatter and control error the grip over the tilt
// changes by gain / (1 - margin) - 1 of the rise of the normal force.
TEST(Sessions, TheGripRisesByGainAndMargin) {
  for (const double gain : {0.6, 0.9, 1.4}) {
    Scene scene = one_beaker();
    scene.people.scatter = 0;
    for (Spread& spread : scene.people.traits) spread.person = spread.grasp = 0;
    scene.people.traits[static_cast<std::size_t>(Trait::gain)].mean = gain;
    scene.people.traits[static_cast<std::size_t>(Trait::grip_error)].mean = 1e-6;
    scene.people.traits[static_cast<std::size_t>(Trait::grip_tremor)].mean = 1e-6;
    const double margin = scene.people.traits[static_cast<std::size_t>(Trait::margin)].mean;
    const std::vector<device::GraspReport> grasps = sessions_of_person(scene, 1, 0, GOES_ON).grasps;
    ASSERT_EQ(grasps.size(), 2u);
    const double wanted = (gain / (1 - margin) - 1) * grasps[0].normal_increase;
    // the liquid's weight does not change the load, since it is the expected weight; the response comes late
    EXPECT_NEAR(grasps[0].grip_change, wanted, 0.03 + 0.1 * std::abs(wanted)) << gain;
  }
}

// On a vessel whose normal force rises by 2 to 3 N: who makes less than 1 - margin of the rise falls behind it, and who makes more is ahead.
TEST(Sessions, WhoMakesMoreOfTheRiseIsAheadOfTheLoad) {
  const auto change = [](double gain) {
    Scene scene = one_beaker(3);
    scene.people.scatter = 0;
    scene.people.traits[static_cast<std::size_t>(Trait::gain)].mean = gain;
    const std::vector<device::GraspReport> grasps = sessions_of_person(scene, 1, 0, GOES_ON).grasps;
    EXPECT_FALSE(grasps.empty());
    EXPECT_GT(grasps[0].normal_increase, 2);
    return grasps[0].grip_change;
  };
  EXPECT_LT(change(0.5), -0.5);
  EXPECT_GT(change(0.9), 0.2);
  EXPECT_GT(change(1.2), change(0.9) + 0.5);
}

// Whatever [people] allows: the session ends, and what goes to the gripper and comes from it are numbers within the gripper's limits.
TEST(Sessions, PeopleAtTheEndsOfTheirRangesComeToAnEnd) {
  for (const TraitFacts& fact : trait_facts()) {
    const auto k = static_cast<std::size_t>(&fact - trait_facts().data());
    for (const double value : {fact.low, fact.high}) {
      Scene scene = one_beaker();
      scene.people.traits[k].mean = value;
      const Participant person(scene.people, 1, 0, Experiment::sessions);
      scene.hand = person.hand(scene.hand);
      double last = 0;
      run_simulated(
          {scene, person, 1, jobs_of(scene)},
          [&](const device::Tick& tick, const device::Session&) {
            EXPECT_TRUE(std::isfinite(tick.device.gap + tick.device.position[0] + tick.device.position[1] +
                                      tick.device.position[2] + tick.written.grip))
                << fact.key << ' ' << value << ' ' << tick.number;
            EXPECT_LE(std::abs(tick.written.grip), device::PAPER_GRIP) << fact.key << ' ' << value << ' ' << tick.number;
            last = static_cast<double>(tick.number) / scene.live.rate;
            return !testing::Test::HasFailure();
          },
          GOES_ON);
      EXPECT_LT(last, LONGEST_SESSION) << fact.key << ' ' << value;
    }
  }
}

TEST(Sessions, GraspsSurviveAsNumbers) {
  const std::vector<device::GraspReport> grasps = sessions_of_person(one_beaker(), 1, 3, GOES_ON).grasps;
  ASSERT_FALSE(grasps.empty());
  const PersonSessions whole = sessions_from_numbers(to_numbers({grasps, 1}));
  const std::vector<device::GraspReport>& again = whole.grasps;
  EXPECT_EQ(whole.broken, 1);
  EXPECT_TRUE(same(again, grasps));
  ASSERT_EQ(again.size(), grasps.size());
  EXPECT_EQ(again[0].vessel, grasps[0].vessel);
  EXPECT_EQ(again[0].course, grasps[0].course);
  EXPECT_EQ(again[0].before.count, grasps[0].before.count);
  EXPECT_EQ(again[0].spilled, grasps[0].spilled);
  EXPECT_EQ(again[0].after_at_first, grasps[0].after_at_first);
  // a member that to_numbers leaves out would be lost: 16 numbers, 5 of slips, 3 durations, 3 means of 3 numbers, and 3 names
  EXPECT_EQ(to_numbers({grasps, 0}).size(), 1 + 36 * grasps.size());
  // with the names, each padded to a number; grip and shown point are of recordings alone
  EXPECT_EQ(sizeof(device::GraspReport), 16 * 8 + 5 * 8 + 3 * 8 + 9 * 8 + 8 + 8u + sizeof(std::optional<GripInput>) + 8);
}

TEST(StudyJournal, GoesOnAndRefusesAnother) {
  const TemporaryFolder folder;
  const std::string path = folder / "study.journal";
  const StudyIdentity own{{"scene", "a"}, {"seed", "1"}};
  const std::vector<double> numbers{1.5, -0.0, NAN, INFINITY, 1e-310};
  StudyJournal(path, own, false).add("sessions", 7, numbers);
  {
    StudyJournal journal(path, own, true);
    const std::vector<double>* found = journal.find("sessions", 7);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->size(), numbers.size());
    for (std::size_t k = 0; k < numbers.size(); ++k)
      EXPECT_EQ(std::bit_cast<std::uint64_t>((*found)[k]), std::bit_cast<std::uint64_t>(numbers[k]));
    EXPECT_FALSE(journal.find("forces", 7));
    EXPECT_FALSE(journal.find("sessions", 8));
  }
  try {
    StudyJournal(path, {{"scene", "b"}, {"seed", "1"}}, true);
    ADD_FAILURE() << "it went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("another scene"), std::string::npos) << error.what();
  }
  EXPECT_EQ(StudyJournal(path, own, false).done(), 0u) << "without --resume it begins again";
}

// A run that was killed leaves a line without its end. That person is done again, and what is added then is whole.
TEST(StudyJournal, ALineThatIsCutIsDoneAgain) {
  const TemporaryFolder folder;
  const std::string path = folder / "study.journal";
  const StudyIdentity own{{"seed", "1"}};
  {
    StudyJournal journal(path, own, false);
    journal.add("forces", 0, std::vector<double>{1});
    journal.add("forces", 1, std::vector<double>{2});
  }
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 5);
  {
    StudyJournal journal(path, own, true);
    EXPECT_EQ(journal.done(), 1u);
    EXPECT_EQ(journal.damaged(), 1u);
    journal.add("forces", 1, std::vector<double>{3});
  }
  StudyJournal journal(path, own, true);
  ASSERT_TRUE(journal.find("forces", 1));
  EXPECT_EQ((*journal.find("forces", 1))[0], 3);
  EXPECT_TRUE(journal.find("forces", 0));
}

// A byte that is not as it was written, in a line or in the head.
TEST(StudyJournal, WhatIsDamagedIsFound) {
  const TemporaryFolder folder;
  const std::string path = folder / "study.journal";
  const StudyIdentity own{{"seed", "1"}};
  {
    StudyJournal journal(path, own, false);
    for (std::uint64_t person = 0; person < 3; ++person)
      journal.add("forces", person, std::vector<double>{static_cast<double>(person)});
  }
  const std::string whole = file_text(path);
  std::string text = whole;
  text[text.rfind("\"person\":1") + 9] = '2';
  write_file(path, text);
  {
    const StudyJournal journal(path, own, true);
    EXPECT_EQ(journal.done(), 2u);
    EXPECT_EQ(journal.damaged(), 1u);
    EXPECT_FALSE(journal.find("forces", 1));
  }
  text = whole;
  text[text.find("seed") + 1] = 'x';
  write_file(path, text);
  EXPECT_THROW(StudyJournal(path, own, true), Error);
  write_file(path, "wholehand study journal 9\n" + whole.substr(whole.find('\n') + 1));
  EXPECT_THROW(StudyJournal(path, own, true), Error);
}

TEST(PeopleLoop, DoesWhatTheJournalLacksInTheirOrder) {
  const TemporaryFolder folder;
  StudyJournal(folder / "j", {}, false).add("x", 2, std::vector<double>{-1});
  StudyJournal journal(folder / "j", {}, true);
  std::atomic<int> calls{0};
  const auto all = of_people("x", 5, 3, journal, GOES_ON, [&calls](std::uint64_t person) {
    ++calls;
    return std::vector<double>{static_cast<double>(person)};
  });
  EXPECT_EQ(calls, 4);
  ASSERT_EQ(all.size(), 5u);
  EXPECT_EQ(all[2], (std::vector<double>{-1}));
  EXPECT_EQ(all[4], (std::vector<double>{4}));
  const std::atomic<bool> stop{true};
  of_people("y", 5, 2, journal, stop, [](std::uint64_t) -> std::vector<double> { throw std::logic_error("it is stopped"); });
}

}  // namespace
}  // namespace wholehand
