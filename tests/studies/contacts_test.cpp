// SPDX-License-Identifier: MIT
// The experiment of contacts on small populations.
// sanitizers: address thread
#include "studies/contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/error.h"
#include "studies/contact_sensitivity.h"
#include "studies/sensitivity.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

// Two vessels of the paper's sample, and one that is only carried.
Scene study_scene() {
  Scene scene = scene_of({beaker1(), beaker3(), cylinder("cup", 70, 95, 2)});
  scene.vessels[0].guidance = {{65e-3, 0}, {45e-3, PI}};
  scene.vessels[0].liquid_name = "red";
  scene.vessels[1].guidance = {{120e-3, 0}};
  scene.vessels[1].liquid_name = "blue";
  scene.vessels[2].guidance = {{50e-3, 0}};
  scene.task.emplace();
  return scene;
}

StudyOptions study_options(std::uint64_t people, int threads = 1) {
  StudyOptions options;
  options.people.contacts = people;
  options.threads = threads;
  options.resamples = 20;
  return options;
}

std::vector<StudyRow> study_rows(const Scene& scene, const StudyOptions& options) {
  const std::atomic<bool> stop = false;
  const auto study = study_contacts(ContactPlan(scene), options, stop);
  EXPECT_TRUE(study.has_value());
  return study ? study->rows : std::vector<StudyRow>{};
}

std::uint64_t study_bits(double value) { return std::isnan(value) ? 0 : std::bit_cast<std::uint64_t>(value); }

bool same_study_bits(const std::vector<StudyRow>& a, const std::vector<StudyRow>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const StudyRow& x, const StudyRow& y) {
    return x.pose == y.pose && x.vessel == y.vessel && x.statistic == y.statistic && x.subject == y.subject &&
           study_bits(x.value) == study_bits(y.value) && study_bits(x.interval.low) == study_bits(y.interval.low) &&
           study_bits(x.interval.high) == study_bits(y.interval.high);
  });
}

const StudyRow& study_row(const std::vector<StudyRow>& rows, const std::string& pose, const std::string& vessel,
                          const std::string& statistic) {
  return *std::find_if(rows.begin(), rows.end(),
                       [&](const StudyRow& row) { return row.pose == pose && row.vessel == vessel && row.statistic == statistic; });
}

// 70 people: blocks of threads, and a last one that is not full.
TEST(StudyContacts, SameBitsForAnyThreads) {
  const Scene scene = study_scene();
  const auto one = study_rows(scene, study_options(70, 1));
  EXPECT_TRUE(same_study_bits(one, study_rows(scene, study_options(70, 2))));
  EXPECT_TRUE(same_study_bits(one, study_rows(scene, study_options(70, 5))));
  StudyOptions other = study_options(70, 1);
  other.seed = 2;
  EXPECT_FALSE(same_study_bits(one, study_rows(scene, other)));
}

TEST(StudyContacts, WithoutScatterAPopulationIsOnePerson) {
  Scene scene = study_scene();
  scene.people.scatter = 0;
  const auto one = study_rows(scene, study_options(1)), many = study_rows(scene, study_options(40));
  ASSERT_EQ(one.size(), many.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    // fewer than three grasps of one person have no correlation
    if (std::isnan(one[k].value)) continue;
    EXPECT_NEAR(one[k].value, many[k].value, 1e-12) << one[k].vessel << " " << one[k].statistic << " " << one[k].subject;
  }
  // at one guidance point everybody does the same
  for (const StudyRow& row : many) {
    if (row.vessel != "cup" || (row.statistic != "held_share" && row.statistic != "touch_share") || std::isnan(row.value)) continue;
    EXPECT_TRUE(row.value == 0 || row.value == 1) << row.statistic << " " << row.subject << " " << row.value;
  }
}

TEST(StudyContacts, EveryVesselHasEveryStatistic) {
  const auto rows = study_rows(study_scene(), study_options(3));
  // three vessels and all of the paper's, in two poses; then each input of each answer
  const std::size_t statistics = 2 * 4 * contact_statistics().size();
  ASSERT_EQ(rows.size(), statistics + contact_answer_names().size() * person_input_names().size());
  EXPECT_GT(study_row(rows, "articulated", "beaker1", "held_share").value, 0);
  EXPECT_EQ(rows.front().pose, "paper");
  EXPECT_EQ(rows[statistics - 1].vessel, ALL_VESSELS);
  EXPECT_EQ(rows[statistics].statistic, "first_order_of_paper_held_share");
  EXPECT_EQ(rows.back().statistic, "first_order_of_articulated_mean_distance");
}

// All are those of the paper's sample: the mean over the grasps of its two vessels, and not of the cup.
TEST(StudyContacts, AllAreThoseThatArePoured) {
  const auto rows = study_rows(study_scene(), study_options(50));
  const double one = study_row(rows, "articulated", "beaker1", "held_share").value,
               two = study_row(rows, "articulated", "beaker3", "held_share").value;
  const ContactPlan plan(study_scene());
  const auto count = [&](std::size_t v) { return static_cast<double>(plan.vessels()[v].last - plan.vessels()[v].first); };
  EXPECT_NEAR(study_row(rows, "articulated", "all", "held_share").value, (one * count(0) + two * count(1)) / (count(0) + count(1)),
              1e-12);
}

// A hand touches by its size and by where it is put: nothing of the forces has a part in it.
TEST(StudyContacts, SensitivityIsOfWhatGraspingAsksFor) {
  const auto rows = study_rows(study_scene(), study_options(400, 2));
  const auto row = [&](const std::string& answer, const std::string& input) {
    return *std::find_if(rows.begin(), rows.end(),
                         [&](const StudyRow& one) { return one.statistic == FIRST_ORDER_OF + answer && one.subject == input; });
  };
  const StudyRow height = row("articulated_mean_distance", "height_mm");
  EXPECT_GT(height.interval.low, 0);
  EXPECT_EQ(height.vessel, ALL_VESSELS);
  EXPECT_EQ(height.pose, "");
  EXPECT_EQ(height.experiment, "contacts");
  const StudyRow patience = row("articulated_mean_distance", "patience_s");
  EXPECT_LT(patience.value, 0.5 * height.value);
  // fewer people have no indices
  const auto few = study_rows(study_scene(), study_options(3));
  EXPECT_TRUE(std::isnan(few.back().value));
  EXPECT_TRUE(strongest_inputs(few).front().inputs.empty());
}

TEST(StudyContacts, PlansThePapersSample) {
  const Scene scene = study_scene();
  const ContactPlan plan(scene);
  ASSERT_EQ(plan.vessels().size(), 3u);
  EXPECT_EQ(plan.vessels()[0].sample, 22u);
  EXPECT_EQ(plan.vessels()[1].sample, 32u);
  EXPECT_TRUE(plan.vessels()[1].is_of_paper);
  EXPECT_EQ(plan.vessels()[2].sample, 24u);
  EXPECT_FALSE(plan.vessels()[2].is_of_paper);
  // 17 people have 34 grasps at two points; at one point they need two each for 32
  EXPECT_EQ(plan.vessels()[0].last - plan.vessels()[0].first, 2u);
  EXPECT_EQ(plan.vessels()[1].last - plan.vessels()[1].first, 2u);
  // the palm is away from the user on either side
  for (const PlannedGrasp& grasp : plan.grasps()) EXPECT_NEAR(std::cos(grasp.grip.azimuth), 1, 1e-12);
  EXPECT_NEAR(plan.grasps()[1].place[0], -40e-3, 1e-6);  // on the far side of the cylinder, where the thumb is
}

// What a grasp is evaluated in lacks liquid, walls, tilts and efforts: the hand touches as in the whole scene.
TEST(StudyContacts, WhatIsLeftOutChangesNothing) {
  Scene scene = study_scene();
  scene.liquid.emplace();
  scene.liquid->fills = {0, 0.5};
  scene.strength.emplace();
  scene.tilts = {0, 0.5, 1};
  scene.table.emplace();
  scene.pose = Pose::articulated;
  const ContactPlan plan(scene);
  for (std::uint64_t number = 0; number < 20; ++number) {
    const std::vector<ContactGrasp> grasps = plan.of_person(1, number);
    Scene own = scene;
    const Person person = draw_person(scene.people, 1, number);
    own.hand = hand_of(scene.hand, person);
    own.table.reset();  // a session does not look at it
    const auto core = make_core_evaluator(own);
    for (std::size_t g = 0; g < plan.grasps().size(); ++g) {
      const PlannedGrasp& planned = plan.grasps()[g];
      const Traits traits = draw_grasp(scene.people, person, 1, number, 0, planned.number);
      GripInput grip = planned.grip;
      grip.height += of(traits, Trait::height);
      grip.azimuth += of(traits, Trait::azimuth);
      grip.obliquity += of(traits, Trait::obliquity);
      grip.roll += of(traits, Trait::roll);
      GripResult result;
      core->grip(plan.vessels()[planned.vessel].place, grip, result);
      const ContactGrasp& grasp = grasps[plan.grasps().size() + g];
      EXPECT_EQ(grasp.is_held, result.reason == Reason::none);
      EXPECT_EQ(grasp.is_plausible, result.plausible);
      EXPECT_EQ(grasp.touch_mask, result.touch_mask);
      EXPECT_EQ(grasp.tip_mask, result.tip_mask);
      EXPECT_EQ(grasp.used_mask, result.used_mask);
      EXPECT_EQ(grasp.height, grip.height);
    }
  }
}

TEST(StudyContacts, StopsWhereItIsAsked) {
  const Scene scene = study_scene();
  const std::atomic<bool> stop = true;
  EXPECT_FALSE(study_contacts(ContactPlan(scene), study_options(5), stop).has_value());
}

// Its rows could not be told from those of all vessels together.
TEST(StudyContacts, AVesselMayNotBeNamedAll) {
  Scene scene = study_scene();
  scene.vessels[2].name = "all";
  try {
    ContactPlan plan(scene);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_STREQ(error.what(), "the scene: a vessel has the name 'all', as the rows of all vessels together; give it another");
  }
}

TEST(StudyContacts, WithoutGuidancePointsThereIsNothingToGrasp) {
  try {
    ContactPlan plan(scene_of({beaker1()}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_STREQ(error.what(), "the scene: no vessel has guidance points, at which people grasp; add guidance_mm to a vessel");
  }
}

}  // namespace
}  // namespace wholehand
