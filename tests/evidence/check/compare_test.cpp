// SPDX-License-Identifier: MIT
// What the comparison of two evaluations lets pass and what it must not: answers that were tampered with, one number at a time.
// sanitizers: none
#include "evidence/check/compare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "core/hand_size.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "sweeps/plan/plan.h"

namespace wholehand {
namespace {

// With the paper's hand, at heights at which none of its grips is near a margin.
Scene small_of_the_paper() {
  Scene scene = read_scene_file(find_scene("small"));
  scene.hand.fingers = paper_hand().fingers;
  scene.grips.height.values = {30e-3, 45e-3, 60e-3};
  return scene;
}

class Compare : public testing::Test {
 protected:
  Compare() : scene_(small_of_the_paper()) {
    scene_.strength.reset();
    scene_.force.max = scene_.force.base + 0.08 * scene_.force.range;  // reached at some of the tilts
    core_ = make_core_evaluator(scene_);
    const sweeps::Plan plan(scene_, true);
    for (std::uint64_t i = 0; i < plan.grips(); ++i) grips_.push_back(plan.grip(0, i));
    planes_ = gather(*core_, all_fields(scene_), 0, grips_);
  }

  // Grips outside after `change` was made to every feasible grip of one side, in a row that `name` is in; and over all rows.
  std::pair<std::uint64_t, std::uint64_t> outside(const std::string& name,
                                                  const std::function<void(GatheredPlanes&, std::size_t grip)>& change) const {
    GatheredPlanes other = planes_;
    for (std::size_t i = 0; i < grips_.size(); ++i)
      if (feasible(i)) change(other, i);
    Comparer comparer(scene_, *core_, allowance(Precision::single), Spreads::everywhere);
    comparer.add(0, grips_, other, planes_);
    expect_same_verdicts(comparer, other);
    std::uint64_t named = 0, all = 0;
    for (const Comparison& row : comparer.rows()) {
      all += row.outside;
      named += row.quantity == name ? row.outside : 0;
    }
    EXPECT_EQ(comparer.holds(), all == 0);
    return {named, all};
  }

  // Where the core's answers are moved for those grips alone that may need it, the same grips are outside, by the same differences.
  void expect_same_verdicts(const Comparer& everywhere, const GatheredPlanes& other) const {
    Comparer needed(scene_, *core_, allowance(Precision::single));
    needed.add(0, grips_, other, planes_);
    ASSERT_EQ(needed.rows().size(), everywhere.rows().size());
    for (std::size_t r = 0; r < needed.rows().size(); ++r) {
      const Comparison &found = needed.rows()[r], &wanted = everywhere.rows()[r];
      EXPECT_EQ(found.outside, wanted.outside) << wanted.quantity;
      EXPECT_EQ(found.compared, wanted.compared) << wanted.quantity;
      EXPECT_EQ(found.worst, wanted.worst) << wanted.quantity;
      EXPECT_EQ(std::max(1.0, found.worst_ratio), std::max(1.0, wanted.worst_ratio)) << wanted.quantity;
    }
    EXPECT_EQ(needed.grazing(), everywhere.grazing());
    EXPECT_EQ(needed.excluded(), everywhere.excluded());
    EXPECT_EQ(needed.holds(), everywhere.holds());
  }

  bool feasible(std::size_t i) const { return (planes_.uint(FIELD_STATUS, i) & STATUS_REASON_MASK) == REASON_NONE; }
  double& real(GatheredPlanes& planes, int field, int k, std::size_t i) const {
    return planes.reals[(planes.fields.plane[field] + k) * planes.count + i];
  }
  std::uint64_t feasible_grips() const {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < grips_.size(); ++i) count += feasible(i) ? 1 : 0;
    return count;
  }

  Scene scene_;
  std::shared_ptr<const Evaluator> core_;
  std::vector<GripInput> grips_;
  GatheredPlanes planes_;
};

TEST_F(Compare, HoldsForTheSameAnswers) {
  EXPECT_GT(feasible_grips(), 20u);
  EXPECT_EQ(outside("", [](GatheredPlanes&, std::size_t) {}).second, 0u);
}

TEST_F(Compare, FindsALengthThatIsOffByMicrometers) {
  const auto [gaps, all] = outside("gap", [&](GatheredPlanes& planes, std::size_t i) { real(planes, FIELD_GAP, 0, i) += 100e-6; });
  EXPECT_EQ(gaps, feasible_grips());
  EXPECT_EQ(all, gaps);
}

// Float is done with a corner at 1e-6 m, where double may spend its steps on the way to 1e-9.
TEST_F(Compare, SpentStepsAreAnOutcomeOnlyAtOneStopTolerance) {
  GatheredPlanes other = planes_;
  for (std::size_t i = 0; i < grips_.size(); ++i) {
    if (feasible(i))
      other.uints[other.fields.plane[FIELD_STATUS] * other.count + i] ^= STATUS_PROXY_UNSETTLED | 4u << STATUS_UNSETTLED_SHIFT;
  }
  const auto outside_of = [&](Allowance allowed) {
    Comparer comparer(scene_, *core_, allowed);
    comparer.add(0, grips_, other, planes_);
    std::uint64_t all = 0;
    for (const Comparison& row : comparer.rows()) all += row.outside;
    return all;
  };
  EXPECT_EQ(outside_of(allowance(Precision::single)), feasible_grips());
  EXPECT_EQ(outside_of(float_against_double()), 0u);
}

TEST_F(Compare, FindsANumberThatIsNotThere) {
  const auto nan = [&](GatheredPlanes& planes, std::size_t i) {
    real(planes, FIELD_CLOSURE, 0, i) = std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_EQ(outside("closure", nan).first, feasible_grips());
  const auto infinite = [&](GatheredPlanes& planes, std::size_t i) {
    double& hold = real(planes, FIELD_LARGEST_HOLD, 0, i);
    hold = std::isinf(hold) ? 1 : std::numeric_limits<double>::infinity();
  };
  EXPECT_EQ(outside("largest hold", infinite).first, feasible_grips());
}

// The fullest vessel's torque is largest at one tilt: at any other the force is smaller by far more than rounding.
TEST_F(Compare, FindsAPeakToldAtTheWrongTilt) {
  const auto [peaks, all] = outside(
      "force short of peak", [&](GatheredPlanes& planes, std::size_t i) { real(planes, FIELD_PEAK_TILT, 1, i) = scene_.tilts[0]; });
  EXPECT_EQ(peaks, feasible_grips());
  EXPECT_EQ(all, peaks);
}

TEST_F(Compare, FindsASafeTiltThatIsTooSmall) {
  std::uint64_t changed = 0;
  const auto [wrong, all] = outside("force beyond safe", [&](GatheredPlanes& planes, std::size_t i) {
    double& safe = real(planes, FIELD_SAFE_TILT, 0, i);
    if (std::isnan(safe)) return;  // no tilt is
    ++changed;
    safe = std::numeric_limits<double>::quiet_NaN();
  });
  EXPECT_GT(changed, 0u);
  EXPECT_EQ(wrong, changed);
  EXPECT_EQ(all, wrong);
}

TEST_F(Compare, FindsASafeTiltThatIsTooLarge) {
  std::uint64_t changed = 0;
  const auto [wrong, all] = outside("force beyond safe", [&](GatheredPlanes& planes, std::size_t i) {
    double& safe = real(planes, FIELD_SAFE_TILT, 1, i);
    if (safe == scene_.tilts.back()) return;  // every tilt is
    ++changed;
    safe = scene_.tilts.back();
  });
  EXPECT_GT(changed, 0u);
  EXPECT_EQ(wrong, changed);
  EXPECT_EQ(all, wrong);
}

TEST_F(Compare, FindsAnOutcomeThatNoMoveExplains) {
  const auto [outcomes, all] = outside("discrete outcomes", [&](GatheredPlanes& planes, std::size_t i) {
    planes.uints[planes.fields.plane[FIELD_TOUCH_MASK] * planes.count + i] ^= 1;  // the thumb's base, which is far from the glass
  });
  EXPECT_EQ(outcomes, feasible_grips());
  EXPECT_EQ(all, outcomes);
}

TEST_F(Compare, FindsATiltThatIsNotListed) {
  const auto between = [&](int field) {
    return [&, field](GatheredPlanes& planes, std::size_t i) {
      double& tilt = real(planes, field, 1, i);
      tilt = (std::isnan(tilt) ? 0 : tilt) + 0.3 * (scene_.tilts[1] - scene_.tilts[0]);
    };
  };
  EXPECT_EQ(outside("force short of peak", between(FIELD_PEAK_TILT)).first, feasible_grips());
  EXPECT_EQ(outside("force beyond safe", between(FIELD_SAFE_TILT)).first, feasible_grips());
  const auto none = [&](GatheredPlanes& planes, std::size_t i) {
    real(planes, FIELD_PEAK_TILT, 0, i) = std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_EQ(outside("force short of peak", none).first, feasible_grips());
}

// A side that calls a sharp grip grazing does not get it left out.
TEST_F(Compare, FindsGrazingThatIsNone) {
  std::uint64_t sharp = 0;
  for (std::size_t i = 0; i < grips_.size(); ++i)
    sharp += feasible(i) && (planes_.uint(FIELD_STATUS, i) & STATUS_GRAZING) == 0 ? 1 : 0;
  const auto [outcomes, all] = outside("discrete outcomes", [&](GatheredPlanes& planes, std::size_t i) {
    planes.uints[planes.fields.plane[FIELD_STATUS] * planes.count + i] |= STATUS_GRAZING;
  });
  EXPECT_GT(sharp, 20u);
  EXPECT_EQ(outcomes, sharp);
  EXPECT_EQ(all, outcomes);
}

// A grip at which a point is just as far as the contact tolerance, again and again: its outcome is anybody's guess, the others' is
// not.
TEST_F(Compare, LetsFewOutcomesDifferWithinTheMargin) {
  std::size_t at = 0;
  int joint = 0;
  const auto separation = [&] { return real(planes_, FIELD_SEPARATION, joint, at); };
  while (!(feasible(at) && separation() > 1e-3 && separation() < 9e-3)) {
    joint = (joint + 1) % JOINT_COUNT;
    at += joint == 0 ? 1 : 0;
  }
  Scene scene = scene_;
  scene.hand.contact_tolerance = separation();
  const auto core = make_core_evaluator(scene);
  const auto holds_with = [&](std::size_t doubtful, std::size_t all = 400) {
    std::vector<GripInput> grips(doubtful, grips_[at]);
    for (std::size_t i = 0; grips.size() < all; ++i)
      if (i % grips_.size() != at) grips.push_back(grips_[i % grips_.size()]);
    const GatheredPlanes sure = gather(*core, all_fields(scene), 0, grips);
    GatheredPlanes other = sure;
    for (std::size_t i = 0; i < doubtful; ++i) other.uints[other.fields.plane[FIELD_TOUCH_MASK] * other.count + i] ^= 1u << joint;
    Comparer comparer(scene, *core, allowance(Precision::single));
    comparer.add(0, grips, other, sure);
    EXPECT_EQ(comparer.excluded(), doubtful);
    EXPECT_EQ(comparer.allowed(), allowed_flips(comparer.grips() - comparer.grazing()));
    return comparer.holds();
  };
  EXPECT_TRUE(holds_with(1)) << "of 400: not 1 in 1,000, and yet nothing";
  EXPECT_TRUE(holds_with(allowed_flips(400)));
  EXPECT_FALSE(holds_with(allowed_flips(400) + 1));
  EXPECT_FALSE(holds_with(1, 1)) << "nothing is left to compare";
}

// In a scene with strengths: what is wrong with an effort, a push, a friction or a safe tilt, and nothing for what the search may leave.
class CompareEfforts : public Compare {
 protected:
  CompareEfforts() {
    scene_ = small_of_the_paper();
    scene_.strength = StrengthData{};
    scene_.strength->by_opening = false;
    for (double& digit : scene_.strength->digits) digit *= 0.1;  // some states are not held
    scene_.hand.depth_limit = 20e-3;
    scene_.force.max = 1e3;
    core_ = make_core_evaluator(scene_);
    planes_ = gather(*core_, compared_fields(scene_), 0, grips_);
  }
  bool plausible(std::size_t i) const { return (planes_.uint(FIELD_STATUS, i) & STATUS_PLAUSIBLE) != 0; }
  // Plausible grips whose number is finite and above 0.
  std::uint64_t with_number(int field) const {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < grips_.size(); ++i) {
      const double value = planes_.real(planes_.fields.plane[field], i);
      count += std::isfinite(value) && value > 0 ? 1 : 0;
    }
    return count;
  }
};

TEST_F(CompareEfforts, HoldForTheSameAnswers) {
  EXPECT_GT(with_number(FIELD_WORST_EFFORT), 20u);
  EXPECT_EQ(outside("", [](GatheredPlanes&, std::size_t) {}).second, 0u);
}

// Efforts of single states and the core's hold forces are not asked of a device.
TEST_F(CompareEfforts, AskForNoEffortOfAState) {
  const FieldSet fields = compared_fields(scene_);
  for (const int field : {FIELD_EFFORT, FIELD_EFFORT_LOW, FIELD_TIPS_EFFORT, FIELD_HOLD_FORCE, FIELD_LARGEST_HOLD})
    EXPECT_FALSE(fields.has(field)) << field_row(field).variable;
  for (const int field : {FIELD_WORST_EFFORT, FIELD_TIPS_WORST_EFFORT, FIELD_PUSH, FIELD_FRICTION_NEEDED, FIELD_SAFE_TILT})
    EXPECT_TRUE(fields.has(field)) << field_row(field).variable;
}

// Five percent are found wherever the grip's own answer does not move as much; a tenth of a percent nowhere.
TEST_F(CompareEfforts, FindANumberThatIsOffByPercents) {
  for (const auto& row : {std::pair<const char*, int>{"1/(1+worst effort)", FIELD_WORST_EFFORT},
                          {"1/(1+tips' effort)", FIELD_TIPS_WORST_EFFORT},
                          {"push", FIELD_PUSH},
                          {"1/(1+friction)", FIELD_FRICTION_NEEDED}}) {
    const auto& name = row.first;
    const int field = row.second;
    const auto scaled = [&](double factor) {
      return [this, field, factor](GatheredPlanes& planes, std::size_t i) { real(planes, field, 0, i) *= factor; };
    };
    const std::uint64_t numbers = with_number(field);
    EXPECT_GT(numbers, 10u) << name;
    const auto [wrong, all] = outside(name, scaled(1.05));
    EXPECT_GE(10 * wrong, 9 * numbers) << name;
    EXPECT_EQ(all, wrong) << name;
    EXPECT_EQ(outside(name, scaled(1.001)).second, 0u) << name;
  }
}

TEST_F(CompareEfforts, FindAnInfiniteEffortThatIsNone) {
  const auto [wrong, all] = outside("1/(1+worst effort)", [&](GatheredPlanes& planes, std::size_t i) {
    double& effort = real(planes, FIELD_WORST_EFFORT, 0, i);
    if (std::isfinite(effort)) effort = std::numeric_limits<double>::infinity();
  });
  EXPECT_GE(10 * wrong, 9 * with_number(FIELD_WORST_EFFORT));
  EXPECT_EQ(all, wrong);
}

TEST_F(CompareEfforts, FindAGripThatIsWronglyCalledHeldOrNot) {
  std::uint64_t changed = 0;
  const auto [wrong, all] = outside("discrete outcomes", [&](GatheredPlanes& planes, std::size_t i) {
    if (!plausible(i)) return;
    planes.uints[planes.fields.plane[FIELD_STATUS] * planes.count + i] ^= STATUS_NOT_HELD;
    ++changed;
  });
  EXPECT_GT(changed, 20u);
  EXPECT_GE(10 * wrong, 9 * changed) << "but those that are as near to 1 as both sides may be off";
  EXPECT_EQ(all, wrong);
}

// A grip that takes nearly all of the strength: two efforts that agree may lie on both sides of the gate.
TEST_F(CompareEfforts, LetAGripDifferThatIsNearTheGate) {
  std::size_t at = 0;
  const auto worst = [&](const GatheredPlanes& planes) { return planes.real(planes.fields.plane[FIELD_WORST_EFFORT], at); };
  while (!(plausible(at) && std::isfinite(worst(planes_)) && worst(planes_) > 0)) ++at;
  for (double& digit : scene_.strength->digits) digit *= worst(planes_) / 1.0003;
  core_ = make_core_evaluator(scene_);
  planes_ = gather(*core_, compared_fields(scene_), 0, grips_);
  ASSERT_NEAR(worst(planes_), 1.0003, 1e-3);
  const auto flipped = [&](double effort) {
    GatheredPlanes other = planes_;
    other.uints[other.fields.plane[FIELD_STATUS] * other.count + at] ^= STATUS_NOT_HELD;
    real(other, FIELD_WORST_EFFORT, 0, at) = effort;
    Comparer comparer(scene_, *core_, allowance(Precision::single));
    comparer.add(0, grips_, other, planes_);
    return std::pair(comparer.excluded(), comparer.holds());
  };
  EXPECT_EQ(flipped(2 - worst(planes_)), std::pair(std::uint64_t{1}, true));
}

// A state that takes less is as wrong as one that is not listed.
TEST_F(CompareEfforts, FindAWorstStateThatIsNone) {
  const GatheredPlanes of_states = gather(*core_, make_field_set({FIELD_EFFORT, FIELD_STATUS}, scene_), 0, grips_);
  const std::vector<double>& fills = vessel_fills(scene_, scene_.vessels[0]);
  std::uint64_t changed = 0;
  const auto [wrong, all] = outside("effort short of worst", [&](GatheredPlanes& planes, std::size_t i) {
    double& fill = real(planes, FIELD_WORST_EFFORT_FILL, 0, i);
    double& tilt = real(planes, FIELD_WORST_EFFORT_TILT, 0, i);
    if (!plausible(i)) return;
    for (std::size_t s = 0; s < fills.size() * scene_.tilts.size(); ++s) {
      const double effort = of_states.real(of_states.fields.plane[FIELD_EFFORT] + static_cast<int>(s), i);
      if (effort > 0.7 * planes.real(planes.fields.plane[FIELD_WORST_EFFORT], i)) continue;
      fill = fills[s / scene_.tilts.size()];
      tilt = scene_.tilts[s % scene_.tilts.size()];
      ++changed;
      return;
    }
  });
  EXPECT_GT(changed, 10u);
  EXPECT_GE(10 * wrong, 9 * changed);
  EXPECT_EQ(all, wrong);
  const auto unlisted = [&](GatheredPlanes& planes, std::size_t i) {
    if (plausible(i)) real(planes, FIELD_WORST_EFFORT_TILT, 0, i) += 1e-3;
  };
  EXPECT_EQ(outside("effort short of worst", unlisted).first, with_number(FIELD_WORST_EFFORT_TILT));
}

// The tilt before the reported one is as wrong as the one after, where the effort between them is not 1.
TEST_F(CompareEfforts, FindASafeTiltThatIsAnother) {
  std::uint64_t changed = 0;
  const auto [wrong, all] = outside("force beyond safe", [&](GatheredPlanes& planes, std::size_t i) {
    double& safe = real(planes, FIELD_SAFE_TILT, 0, i);
    if (!plausible(i) || std::isnan(safe) || safe == scene_.tilts.front()) return;
    const auto listed = std::find(scene_.tilts.begin(), scene_.tilts.end(), safe);
    safe = *(listed - 1);
    ++changed;
  });
  EXPECT_GT(changed, 10u);
  EXPECT_GE(10 * wrong, 9 * changed);
  EXPECT_EQ(all, wrong);
}

// At 180 degrees the sine is a rounding, and with it the torque: as far as the weight at its lever goes, and no further.
TEST(CompareTorque, UpsideDownIsComparedByTheWeightAtItsLever) {
  Scene scene = read_scene_file(find_scene("small"));
  scene.tilts = {PI};
  scene.liquid.reset();  // which has a tolerance of its own
  const auto core = make_core_evaluator(scene), single = make_core_float_evaluator(scene);
  const sweeps::Plan plan(scene, true);
  std::vector<GripInput> grips;
  for (std::uint64_t i = 0; i < plan.grips(); ++i) grips.push_back(plan.grip(0, i));
  const FieldSet fields = all_fields(scene);
  const GatheredPlanes full = gather(*core, fields, 0, grips);
  const auto outside_of = [&](const GatheredPlanes& other) {
    Comparer comparer(scene, *core, float_against_double());
    comparer.add(0, grips, other, full);
    std::uint64_t outside = 0;
    for (const Comparison& row : comparer.rows()) outside += row.quantity == "torque" ? row.outside : 0;
    return outside;
  };
  EXPECT_EQ(outside_of(gather(*single, fields, 0, grips)), 0u);
  GatheredPlanes wrong = full;
  for (std::size_t i = 0; i < grips.size(); ++i) wrong.reals[fields.plane[FIELD_TORQUE] * grips.size() + i] += 1e-4;  // N m
  EXPECT_GT(outside_of(wrong), 20u);
}

// A line beside the axis that the thin index tip only just meets, where the thick thumb still closes from well around the wall.
TEST_F(Compare, DoesNotHoldWhereNothingIsCompared) {
  Scene scene = scene_;
  scene.hand.fingers[1].radii[4] = 0.1e-3;
  const auto core = make_core_evaluator(scene);
  const FieldSet fields = all_fields(scene);
  std::vector<GripInput> scan;
  for (double offset = 5e-3; offset < 60e-3; offset += 1e-6) {
    GripInput beside = grips_[0];
    beside.obliquity = 0;
    beside.offset = offset;
    scan.push_back(beside);
  }
  const GatheredPlanes found = gather(*core, fields, 0, scan);
  std::vector<GripInput> grazing;
  for (std::size_t i = 0; i < scan.size(); ++i)
    if ((found.uint(FIELD_STATUS, i) & STATUS_GRAZING) != 0) grazing.push_back(scan[i]);
  ASSERT_FALSE(grazing.empty());
  const GatheredPlanes answers = gather(*core, fields, 0, grazing);
  Comparer comparer(scene, *core, allowance(Precision::single));
  comparer.add(0, grazing, answers, answers);
  EXPECT_EQ(comparer.grazing(), grazing.size());
  EXPECT_FALSE(comparer.holds());
}

}  // namespace
}  // namespace wholehand
