// SPDX-License-Identifier: MIT
// The experiment of contacts on small populations.
// sanitizers: thread
#include "evidence/studies/contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "base/text/error.h"
#include "evidence/studies/contact_sensitivity.h"
#include "evidence/studies/sensitivity.h"
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

ContactStudy study_of(const Scene& scene, const StudyOptions& options) {
  const std::atomic<bool> stop = false;
  const auto study = study_contacts(ContactPlan(scene), options, stop);
  EXPECT_TRUE(study.has_value());
  return study.value_or(ContactStudy{});
}
std::vector<StudyRow> study_rows(const Scene& scene, const StudyOptions& options) { return study_of(scene, options).rows; }

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
  // every contact lies on its guidance point: what is left of the search for it is no distance to correlate with
  for (const StudyRow& row : many) {
    if (!row.statistic.ends_with("_distance")) continue;
    EXPECT_TRUE(std::isnan(row.value)) << row.pose << " " << row.vessel << " " << row.statistic << " " << row.subject;
  }
  // at one guidance point everybody does the same
  for (const StudyRow& row : many) {
    if (row.vessel != "cup" || (row.statistic != "held_share" && row.statistic != "touch_share") || std::isnan(row.value)) continue;
    EXPECT_TRUE(row.value == 0 || row.value == 1) << row.statistic << " " << row.subject << " " << row.value;
  }
}

TEST(StudyContacts, EveryVesselHasEveryStatistic) {
  const auto rows = study_rows(study_scene(), study_options(3));
  // three vessels and all of the paper's, in two poses; each input of each answer stands apart
  const std::size_t statistics = 2 * 4 * contact_statistics().size();
  ASSERT_EQ(rows.size(), statistics);
  EXPECT_GT(study_row(rows, "articulated", "beaker1", "held_share").value, 0);
  EXPECT_EQ(rows.front().pose, "paper");
  EXPECT_EQ(rows[statistics - 1].vessel, ALL_VESSELS);
  const auto sensitivity = study_of(study_scene(), study_options(3)).sensitivity;
  ASSERT_EQ(sensitivity.size(), contact_answer_names().size() * person_input_names().size());
  EXPECT_EQ(sensitivity.front().statistic, "first_order_of_paper_held_share");
  EXPECT_EQ(sensitivity.back().statistic, "first_order_of_articulated_mean_distance");
}

// All are those of the paper's sample: 22 grasps of the first vessel, 32 of the second, and none of the cup. All hold.
TEST(StudyContacts, AllAreThoseThatArePoured) {
  const auto rows = study_rows(study_scene(), study_options(50));
  const auto mean = [&](const char* vessel) { return study_row(rows, "articulated", vessel, "mean_fingers").value; };
  for (const char* vessel : {"beaker1", "beaker3"}) EXPECT_EQ(study_row(rows, "articulated", vessel, "held_share").value, 1);
  EXPECT_NEAR(mean("all"), (22 * mean("beaker1") + 32 * mean("beaker3")) / 54, 1e-12);
  EXPECT_GT(std::abs(mean("beaker1") - mean("beaker3")), 0.1) << "the weights must show";
}

// 17 people are needed for a sample of 17.
TEST(StudyContacts, FewPeopleHaveNoIntervals) {
  const auto few = study_rows(study_scene(), study_options(16)), enough = study_rows(study_scene(), study_options(17));
  for (const StudyRow& row : few) EXPECT_TRUE(std::isnan(row.interval.low) && std::isnan(row.interval.high)) << row.statistic;
  const StudyRow& row = study_row(enough, "articulated", "beaker1", "mean_fingers");
  EXPECT_LE(row.interval.low, row.value);
  EXPECT_GE(row.interval.high, row.value);
}

// A hand touches by its size and by where it is put: nothing of the forces has a part in it.
TEST(StudyContacts, SensitivityIsOfWhatGraspingAsksFor) {
  const auto rows = study_of(study_scene(), study_options(400, 2)).sensitivity;
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
  const auto few = study_of(study_scene(), study_options(3)).sensitivity;
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

Triple beside_axis(double radius, const GuidancePoint& point) {
  return {radius * std::cos(point.azimuth), point.height, -radius * std::sin(point.azimuth)};
}

// Where the level line from outside to the axis first meets the vessel, to less than 1e-15 m: a step that is inside, and halving.
Triple point_on(const Evaluator& core, std::size_t vessel, const GuidancePoint& point) {
  double within = 0.2, outside = 0.2;
  while (core.distance(vessel, beside_axis(within, point)) > 0) outside = within, within -= 0.1e-3;
  for (int step = 0; step < 60; ++step) {
    const double middle = (within + outside) / 2;
    (core.distance(vessel, beside_axis(middle, point)) > 0 ? outside : within) = middle;
  }
  return beside_axis(outside, point);
}

// From the posed tips, each by its radius along the vessel's normal.
double nearer_contact(const Evaluator& core, const HandData& hand, std::size_t vessel, const GripResult& result,
                      const Triple& place) {
  const auto from = [&](int joint, double radius) {
    const Triple& tip = result.joints[joint];
    const Triple normal = core.gradient(vessel, tip);
    return std::hypot(tip[0] - radius * normal[0] - place[0], tip[1] - radius * normal[1] - place[1],
                      tip[2] - radius * normal[2] - place[2]);
  };
  return std::min(from(3, hand.fingers[0].radii[3]), from(8, hand.fingers[1].radii[4]));
}

// What a grasp is evaluated in lacks liquid, walls, tilts and efforts: the hand touches as in the whole scene. A shell keeps its
// wall.
TEST(StudyContacts, WhatIsLeftOutChangesNothing) {
  Scene scene = study_scene();
  scene.vessels.push_back(shell_of(beaker1()));
  scene.vessels.back().guidance = {{90e-3, 0}};
  scene.liquid.emplace();
  scene.liquid->fills = {0, 0.5};
  scene.strength.emplace();
  scene.tilts = {0, 0.5, 1};
  scene.table.emplace();
  const ContactPlan plan(scene);
  std::set<std::array<std::uint32_t, 3>> projected;
  for (std::uint64_t number = 0; number < 20; ++number) {
    const std::vector<ContactGrasp> grasps = plan.of_person(1, number);
    const Person person = draw_person(scene.people, 1, number);
    for (std::size_t pose = 0; pose < STUDY_POSES.size(); ++pose) {
      Scene own = scene;
      own.pose = STUDY_POSES[pose];
      own.hand = hand_of(scene.hand, person);
      if (own.pose == Pose::paper) {
        for (FingerData& finger : own.hand.fingers) finger.radii.fill(0);
      }
      own.table.reset();  // a session ignores it
      const auto core = make_core_evaluator(own);
      for (std::size_t g = 0; g < plan.grasps().size(); ++g) {
        const PlannedGrasp& planned = plan.grasps()[g];
        const std::size_t vessel = plan.vessels()[planned.vessel].place;
        const Traits traits = draw_grasp(scene.people, person, 1, number, 0, planned.number);
        GripInput grip = planned.grip;
        grip.height += traits[Trait::height];
        grip.azimuth += traits[Trait::azimuth];
        grip.obliquity += traits[Trait::obliquity];
        grip.roll += traits[Trait::roll];
        GripResult result;
        core->grip(vessel, grip, result);
        const ContactGrasp& grasp = grasps[pose * plan.grasps().size() + g];
        EXPECT_EQ(grasp.is_held, result.reason == Reason::none);
        EXPECT_EQ(grasp.is_plausible, result.plausible);
        EXPECT_EQ(grasp.touch_mask, result.touch_mask);
        EXPECT_EQ(grasp.tip_mask, result.tip_mask);
        EXPECT_EQ(grasp.finger_mask, result.finger_mask);
        EXPECT_EQ(grasp.inner_mask, result.inner_mask);
        EXPECT_EQ(grasp.used_mask, result.used_mask);
        EXPECT_EQ(grasp.height, grip.height);
        projected.insert({result.tip_mask, result.finger_mask, result.inner_mask});
        if (!grasp.is_held) continue;
        const Triple place = point_on(*core, vessel, scene.vessels[vessel].guidance[planned.point]);
        // the tips are where they should be to the tolerance of the gap's inverse, 1e-9 m
        EXPECT_NEAR(grasp.distance, nearer_contact(*core, own.hand, vessel, result, place), 1e-8);
      }
    }
  }
  EXPECT_GT(projected.size(), 3u) << "masks must differ";
}

// Other commands refuse this hand. People's hands are made to close, so without a check the study would take it.
TEST(StudyContacts, AHandThatDoesNotCloseIsRefused) {
  Scene scene = study_scene();
  scene.hand.pip.closed = radians(90);
  try {
    ContactPlan plan(scene);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("must fall strictly as the hand closes"), std::string::npos) << error.what();
  }
}

TEST(StudyContacts, StopsWhereItIsAsked) {
  const Scene scene = study_scene();
  const std::atomic<bool> stop = true;
  EXPECT_FALSE(study_contacts(ContactPlan(scene), study_options(5), stop).has_value());
}

// The rows of such a vessel would look like those of all vessels together.
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
