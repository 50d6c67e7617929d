// SPDX-License-Identifier: MIT
// Spheres that are just contacts, or just none: rounding decides, the grip says so, and its report is one evaluation's.
// sanitizers: none
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/hand_size.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "evidence/check/compare.h"
#include "host/open_backend.h"
#include "sweeps/grips/report.h"
#include "sweeps/plan/plan.h"
#include "tests/support/meshes.h"

namespace wholehand {
namespace {

constexpr double LARGE = 0.005;  // of 1 / (1 + effort): more than an effort's own tolerance, and less than a contact's worth

// With the hand and the strengths for which the grips of these tests were found.
Scene former_scene() {
  Scene scene = read_scene_file(find_scene("three_beakers"));
  scene.hand = paper_hand();
  scene.strength->by_opening = false;
  scene.arm.reset();
  return scene;
}

Scene beaker_scene() {
  Scene scene = former_scene();
  scene.vessels.resize(1);
  return scene;
}

// A sphere on a bone of the index finger is a contact to 1e-7 m.
GripInput touching_grip() {
  GripInput grip;
  grip.height = 0.10170970911141486;
  grip.obliquity = -0.13093843058866886;
  grip.roll = -1.0220236059302552;
  return grip;
}

struct Undecided {
  std::string who;
  GatheredPlanes planes;
  double form(std::size_t i) const {
    return compared_form(FIELD_WORST_EFFORT, planes.real(planes.fields.plane[FIELD_WORST_EFFORT], i));
  }
  bool is_flagged(std::size_t i) const { return (planes.uint(FIELD_STATUS, i) & STATUS_CONTACT_UNDECIDED) != 0; }
  std::uint32_t outcome(std::size_t i) const { return planes.uint(FIELD_STATUS, i) & ~std::uint32_t(STATUS_CONTACT_UNDECIDED); }
};

std::vector<Undecided> evaluated(const Scene& scene, const std::vector<GripInput>& grips) {
  const FieldSet fields = make_field_set({FIELD_WORST_EFFORT, FIELD_STATUS, FIELD_TOUCH_MASK, FIELD_POSED}, scene);
  std::vector<Undecided> all;
  for (const std::string on : {"core", "vulkan"})
    for (const Precision precision : {Precision::full, Precision::single})
      all.push_back({on + (precision == Precision::full ? " double" : " float"),
                     gather(*open_backend(scene, fields, on, precision, 1), 0, grips)});
  return all;
}

// Heights from well below the rim to where bones of the hand lie on it, and obliquities nanometer by nanometer where a sphere of a hand that
// moves along the wall becomes a contact.
TEST(UndecidedContacts, AreFlaggedWhereverEffortsDiffer) {
  const Scene scene = beaker_scene();
  std::vector<GripInput> grips;
  for (int k = 0; k < 400; ++k) {
    GripInput grip = touching_grip();
    grip.height = 0.09 + 4.7e-5 * k;
    grip.obliquity = -0.1 - 1e-4 * k;
    grips.push_back(grip);
  }
  const std::size_t scanned = grips.size();
  for (int k = -60; k <= 60; ++k) {
    GripInput grip = touching_grip();
    grip.obliquity += 1e-7 * k;
    grips.push_back(grip);
  }
  const std::vector<Undecided> all = evaluated(scene, grips);
  std::size_t differing = 0, flagged = 0, contacts_change = 0;
  for (std::size_t i = 0; i < grips.size(); ++i) {
    flagged += i < scanned && all[0].is_flagged(i) ? 1 : 0;
    contacts_change += i > scanned && std::abs(all[0].form(i) - all[0].form(i - 1)) > LARGE ? 1 : 0;
    for (const Undecided& other : all) {
      if (other.outcome(i) == all[0].outcome(i) && !(std::abs(other.form(i) - all[0].form(i)) > LARGE)) continue;
      ++differing;
      EXPECT_TRUE(other.is_flagged(i) && all[0].is_flagged(i))
          << other.who << ", grip " << i << ": " << other.form(i) << ", " << all[0].form(i);
    }
  }
  EXPECT_GT(contacts_change, 0u) << "no sphere becomes a contact here";
  EXPECT_GT(differing, 0u) << "nothing is decided by rounding here";
  EXPECT_LT(50 * flagged, scanned);
}

// Fingers that pass the wall within a micrometer and go on in double rest on it in float.
TEST(UndecidedContacts, AreFlaggedWhereAFingerRestsByRounding) {
  Scene scene = former_scene();
  scene.vessels.erase(scene.vessels.begin(), scene.vessels.begin() + 2);  // beaker3
  GripInput grip;
  grip.height = 0.12084984338479117;
  grip.obliquity = radians(17.81638406682759);
  grip.roll = radians(-68.69069582317024);
  const std::vector<Undecided> all = evaluated(scene, {grip});
  std::size_t differing = 0;
  for (const Undecided& one : all) {
    EXPECT_TRUE(one.is_flagged(0)) << one.who;
    differing += one.planes.uint(FIELD_TOUCH_MASK, 0) != all[0].planes.uint(FIELD_TOUCH_MASK, 0) ? 1 : 0;
  }
  EXPECT_GT(differing, 0u);
}

// A mesh's lattice flags as few grips as the outline that it is made of: its fingers come to rest at the wall, and do not pass it.
TEST(UndecidedContacts, AreAsFewOnALatticeAsOnItsOutline) {
  Scene outline = beaker_scene();
  outline.strength.reset();
  Scene mesh = outline;
  mesh.vessels = {vessel_of_mesh("mesh", turned_mesh(outline.vessels[0], 96, 1e-3), 1e-3)};
  std::vector<GripInput> grips;
  for (int k = 0; k < 300; ++k) {
    GripInput grip = touching_grip();
    grip.height = 0.04 + 1.7e-4 * k;
    grip.azimuth = 0.021 * k;
    grip.roll = -1.5 + 0.0051 * k;
    grips.push_back(grip);
  }
  const auto flagged = [&](const Scene& scene) {
    const Undecided core{"core",
                         gather(*open_backend(scene, make_field_set({FIELD_STATUS}, scene), "core", Precision::full, 1), 0, grips)};
    const Undecided device{
        "vulkan", gather(*open_backend(scene, make_field_set({FIELD_STATUS}, scene), "vulkan", Precision::single, 1), 0, grips)};
    int both = 0, articulated = 0;
    for (std::size_t i = 0; i < grips.size(); ++i) {
      both += core.is_flagged(i) || device.is_flagged(i) ? 1 : 0;
      articulated += (core.outcome(i) & STATUS_REASON_MASK) == REASON_NONE ? 1 : 0;
    }
    EXPECT_GT(articulated, 200);
    return both;
  };
  EXPECT_LE(flagged(mesh), flagged(outline) + 9) << "3 % of the grips: facets and cells have edges where the outline has none";
}

// The efforts of a report are those that the score was made of, whatever answers.
TEST(UndecidedContacts, HaveOneEffortInOneReport) {
  const Scene scene = beaker_scene();
  for (const std::string on : {"core", "vulkan"})
    for (const Precision precision : {Precision::full, Precision::single}) {
      if (on == "vulkan" && precision == Precision::full) continue;  // pipelines of all fields take long to compile
      const sweeps::GripMethods methods = sweeps::open_grip_methods(scene, on, precision);
      sweeps::GripReport report = sweeps::make_grip_report(scene, 0, touching_grip(), {{1}, {radians(60)}}, methods);
      sweeps::add_holding(report, scene, 0);
      ASSERT_TRUE(report.hold) << report.device;
      EXPECT_NEAR(1 / (1 + report.hold->worst), report.answer.score.terms.hold, 1e-6) << report.device;
      const std::string table = sweeps::grip_table(report);
      EXPECT_NE(table.find("\n  undecided "), std::string::npos) << table;
      const bool is_core_double = on == "core" && precision == Precision::full;
      EXPECT_EQ(table.find("\n  from the core ") == std::string::npos, is_core_double) << table;
      EXPECT_NE(sweeps::grip_json(report).find("\"undecided\":true"), std::string::npos);
    }
}

}  // namespace
}  // namespace wholehand
