// SPDX-License-Identifier: MIT
#include "evidence/studies/contact_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/error.h"
#include "core/people/participant.h"
#include "core/planes.h"
#include "core/prepare.h"
#include "device/simulated/sim_user.h"
#include "evidence/report/guidance_statistics.h"

namespace wholehand {

const std::array<const char*, STUDY_POSES.size()> STUDY_POSE_NAMES{"paper", "articulated"};

namespace {

constexpr std::uint64_t MOST_POINTS = 1000;  // of a vessel, in the number of a grasp (core/reader/ranges.h)
constexpr std::uint64_t MOST_REPEATS = 32;   // likewise
constexpr std::size_t FURTHER_SAMPLE = 24;   // grasps of a vessel beside the paper's: the mean of its three
const std::vector<int> KEPT{FIELD_STATUS,   FIELD_GAP,         FIELD_MIDPOINT,   FIELD_TOUCH_MASK,
                            FIELD_TIP_MASK, FIELD_FINGER_MASK, FIELD_INNER_MASK, FIELD_USED_MASK};

std::vector<StudyVessel> study_vessels(const Scene& scene) {
  const std::vector<std::size_t> of_paper = paper_vessels(scene, SampleVessels::with_guidance);
  std::vector<StudyVessel> vessels;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    if (scene.vessels[v].guidance.empty()) continue;
    StudyVessel vessel{v, scene.vessels[v].name, FURTHER_SAMPLE};
    const auto found = std::find(of_paper.begin(), of_paper.end(), v);
    if (found != of_paper.end()) {
      vessel.sample = PAPER_GRASPS[static_cast<std::size_t>(found - of_paper.begin())];
      vessel.is_of_paper = true;
    }
    vessels.push_back(vessel);
  }
  return vessels;
}

// Without everything that touching does not depend on: mass and load, efforts, tilts, and the table. Mass and its center are given, so that only a
// shell needs its wall, which fingers may touch from within.
Scene bare_scene(const Scene& scene, const std::vector<StudyVessel>& vessels, Pose pose) {
  Scene bare = scene;
  bare.text.clear();
  bare.pose = pose;
  bare.vessels.clear();
  for (const StudyVessel& vessel : vessels) {
    VesselData data = scene.vessels[vessel.place];
    if (data.surface != Surface::shell) {
      data.inner.clear();
      data.wall = data.floor = 0;
    }
    data.fills.clear();
    data.mass = 1;
    data.center_of_mass = {0, 0.5 * (data.base + data.height), 0};
    bare.vessels.push_back(data);
  }
  bare.liquid.reset();
  bare.strength.reset();
  bare.robust.reset();
  bare.table.reset();  // as in a session
  bare.arm.reset();
  bare.task.reset();
  bare.tilts.clear();
  bare.until_poured.reset();
  return bare;
}

// As published, the points have no flesh.
HandData without_flesh(HandData hand) {
  for (FingerData& finger : hand.fingers) finger.radii.fill(0);
  return hand;
}

// Palm away from the user, as in a session: the index finger is on the point's side, or the thumb.
double planned_azimuth(const Scene& scene, const GuidancePoint& point) {
  const double home = scene.hand.handedness == Handedness::left ? PI : 0;
  constexpr double ROUNDING = 1e-9;
  return std::cos(point.azimuth - home) >= -ROUNDING ? point.azimuth : point.azimuth + PI;
}

// The planned grip with the person's habits and this grasp's scatter.
GripInput scattered(GripInput grip, const Traits& traits) {
  grip.height += traits[Trait::height];
  grip.azimuth += traits[Trait::azimuth];
  grip.obliquity += traits[Trait::obliquity];
  grip.roll += traits[Trait::roll];
  return grip;
}

}  // namespace

ContactPlan::ContactPlan(const Scene& scene) : scene_(scene), vessels_(study_vessels(scene)) {
  if (vessels_.empty())
    throw usage_error(fmt::format("{}: no vessel has guidance points, at which people grasp; add guidance_mm to a vessel",
                                  scene.file.empty() ? "the scene" : scene.file));
  for (const StudyVessel& vessel : vessels_) check_sample_name(scene, vessel.name);
  prepare_hand(scene.hand, 2);  // people's hands are made to close: silently repairs what other commands refuse
  for (std::size_t k = 0; k < STUDY_POSES.size(); ++k) bare_[k] = bare_scene(scene, vessels_, STUDY_POSES[k]);
  // the mean person plans
  Scene mean = scene;
  PeopleData alike = scene.people;
  alike.scatter = 0;
  mean.pose = Pose::articulated;
  mean.table.reset();
  mean.arm.reset();
  mean.hand = hand_of(scene.hand, make_person(alike, {}));
  const std::unique_ptr<Evaluator> core = make_core_evaluator(mean);
  for (StudyVessel& vessel : vessels_) plan_vessel(*core, vessel);
}

// Repeats each point as often as the paper's sample requires of its people.
void ContactPlan::plan_vessel(const Evaluator& core, StudyVessel& vessel) {
  const std::vector<GuidancePoint>& points = scene_.vessels[vessel.place].guidance;
  const std::size_t of_one_round = PAPER_PEOPLE * points.size(), repeats = (vessel.sample + of_one_round - 1) / of_one_round;
  vessel.first = grasps_.size();
  for (std::size_t point = 0; point < points.size(); ++point) {
    PlannedGrasp grasp;
    grasp.vessel = static_cast<std::size_t>(&vessel - vessels_.data());
    grasp.point = point;
    grasp.grip.height = points[point].height;
    grasp.grip.azimuth = planned_azimuth(scene_, points[point]);
    grasp.place = guidance_place(core, vessel.place, points[point]);
    // as the simulated user chooses
    if (const auto chosen = device::best_roll(core, vessel.place, grasp.grip)) {
      grasp.grip = chosen->grip;
    } else {
      unheld_.push_back(fmt::format("{} at {:g} mm", vessel.name, points[point].height * 1e3));
    }
    for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
      grasp.number = (vessel.place * MOST_POINTS + point) * MOST_REPEATS + repeat;
      grasps_.push_back(grasp);
    }
  }
  vessel.last = grasps_.size();
}

std::vector<ContactGrasp> ContactPlan::of_person(std::uint64_t seed, std::uint64_t number) const {
  const Participant person(scene_.people, seed, number, Experiment::contacts);
  const HandData hand = person.hand(scene_.hand);
  std::vector<GripInput> grips;
  for (const PlannedGrasp& grasp : grasps_) grips.push_back(scattered(grasp.grip, person.grasp(grasp.number)));
  std::vector<ContactGrasp> grasps;
  std::vector<double> reals;
  std::vector<std::uint32_t> uints;
  for (std::size_t k = 0; k < STUDY_POSES.size(); ++k) {
    Scene scene = bare_[k];
    scene.hand = STUDY_POSES[k] == Pose::paper ? without_flesh(hand) : hand;
    const std::unique_ptr<Evaluator> core = make_core_evaluator(scene);
    const FieldSet fields = make_field_set(KEPT, scene);
    for (std::size_t v = 0; v < vessels_.size(); ++v) {
      const std::size_t first = vessels_[v].first, count = vessels_[v].last - first;
      reals.resize(static_cast<std::size_t>(fields.real_planes) * count);
      uints.resize(static_cast<std::size_t>(fields.uint_planes) * count);
      core->planes(v, &grips[first], count, fields, count, reals.data(), uints.data());
      const PlaneChunk chunk{v, 0, count, count, nullptr, reals.data(), uints.data()};
      for (std::size_t i = 0; i < count; ++i) {
        const GripResult result = decode_grip(chunk, fields, i);
        ContactGrasp grasp;
        grasp.is_held = result.reason == Reason::none;
        grasp.is_plausible = grasp.is_held && result.plausible;
        grasp.height = grips[first + i].height;
        if (grasp.is_held)
          grasp.distance =
              guidance_distance(*core, scene, v, grips[first + i], result.midpoint, result.gap, {grasps_[first + i].place});
        grasp.touch_mask = result.touch_mask;
        grasp.tip_mask = result.tip_mask;
        grasp.finger_mask = result.finger_mask;
        grasp.inner_mask = result.inner_mask;
        grasp.used_mask = result.used_mask;
        grasps.push_back(grasp);
      }
    }
  }
  return grasps;
}

}  // namespace wholehand
