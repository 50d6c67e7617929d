// SPDX-License-Identifier: MIT
// What a scene leaves out changes nothing else: without strengths, and without spheres between the joints, every other number is the same
// to the bit. tests/core/table_test.cpp says so of the table.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <set>

#include "core/fields.h"
#include "core/gather.h"
#include "tests/support/hard_scene.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

struct Difference {
  std::set<int> fields;      // whose numbers are not the same to the bit
  std::set<int> terms;       // planes of FIELD_TERMS among them
  std::uint32_t status = 0;  // bits
  int feasible = 0;          // grips that were compared
};

// Compares the fields that both scenes have, over grips of every kind.
Difference difference_of(const Scene& scene_a, const Scene& scene_b) {
  const FieldSet fields_a = all_fields(scene_a), fields_b = all_fields(scene_b);
  Difference found;
  for (std::size_t v = 0; v < scene_a.vessels.size(); ++v) {
    const auto grips = grips_with_hopeless_ones(scene_a.vessels[v], v, 40);
    const GatheredPlanes a = gather(*make_core_evaluator(scene_a), fields_a, v, grips);
    const GatheredPlanes b = gather(*make_core_evaluator(scene_b), fields_b, v, grips);
    for (std::size_t i = 0; i < grips.size(); ++i) {
      found.feasible += (a.uint(FIELD_STATUS, i) & STATUS_REASON_MASK) == REASON_NONE;
      found.status |= a.uint(FIELD_STATUS, i) ^ b.uint(FIELD_STATUS, i);
      for (int field = 0; field < FIELDS; ++field) {
        if (!fields_a.has(field) || !fields_b.has(field) || field == FIELD_STATUS) continue;
        for (int p = 0; p < field_planes(field, scene_a); ++p) {
          const bool is_same = field >= REAL_FIELDS ? a.uint(field, i) == b.uint(field, i)
                                                    : std::bit_cast<std::uint64_t>(a.real(fields_a.plane[field] + p, i)) ==
                                                          std::bit_cast<std::uint64_t>(b.real(fields_b.plane[field] + p, i));
          if (is_same) continue;
          found.fields.insert(field);
          if (field == FIELD_TERMS) found.terms.insert(p);
        }
      }
    }
  }
  return found;
}

constexpr int DEPTH_TERM = 2, HOLD_TERM = 5;  // planes of FIELD_TERMS

// With strengths the force of a hold is that of tips that share it, a safe tilt is one that the whole hand holds, and the term of holding is
// the effort's; some grips are not held. Nothing about the hand on the vessel changes.
TEST(KeptBits, StrengthsChangeOnlyWhatIsOfHolding) {
  for (const Pose pose : {Pose::articulated, Pose::paper}) {
    Scene without = hard_scene();
    without.pose = pose;
    Scene with = without;
    with.strength = StrengthData{};
    const Difference found = difference_of(without, with);
    EXPECT_EQ(found.fields, (std::set<int>{FIELD_LARGEST_HOLD, FIELD_SAFE_TILT, FIELD_SCORE, FIELD_TERMS, FIELD_HOLD_FORCE}));
    EXPECT_EQ(found.terms, std::set<int>{HOLD_TERM});
    EXPECT_EQ(found.status, std::uint32_t(STATUS_NOT_HELD));
    EXPECT_GT(found.feasible, 80);
  }
}

// Where no finger stops at a sphere, as in the paper's pose and the rigged one, spheres count in depths alone.
TEST(KeptBits, SpheresChangeOnlyDepths) {
  for (const Pose pose : {Pose::paper, Pose::rigged}) {
    Scene without = hard_scene();
    without.pose = pose;
    Scene with = without;
    with.hand.between = 2;
    const Difference found = difference_of(without, with);
    EXPECT_EQ(found.fields, (std::set<int>{FIELD_PHALANX_DEPTH, FIELD_PALM_DEPTH, FIELD_SCORE, FIELD_TERMS}));
    EXPECT_EQ(found.terms, std::set<int>{DEPTH_TERM});
    EXPECT_EQ(found.status & ~std::uint32_t(STATUS_PLAUSIBLE | STATUS_SELF_OVERLAP | STATUS_CONTACT_UNDECIDED), 0u);
    EXPECT_GT(found.feasible, 80);
  }
}

}  // namespace
}  // namespace wholehand
