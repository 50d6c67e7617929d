// SPDX-License-Identifier: MIT
// Lists chosen in passes with a small memory, against the definition with all grips at hand.
// sanitizers: thread
#include "sweeps/lists/list_chooser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <utility>

#include "tests/support/fake_backend.h"

namespace wholehand::sweeps {
namespace {

// The definition: all grips of a list in order, each compared with all taken before.
std::vector<Candidate> by_definition(const Plan& plan, std::size_t vessel, std::vector<Candidate> grips, std::size_t list,
                                     std::size_t best, double apart) {
  std::sort(grips.begin(), grips.end(), is_better);
  std::vector<Candidate> taken;
  for (const Candidate& grip : grips) {
    if (taken.size() == best) break;
    if (plan.hand_scale_of(grip.index) != list) continue;
    const auto hand = fake_hand(vessel, plan.grip(vessel, grip.index));
    const bool differs = std::all_of(taken.begin(), taken.end(), [&](const Candidate& other) {
      return are_different(hand, fake_hand(vessel, plan.grip(vessel, other.index)), apart);
    });
    if (differs) taken.push_back(grip);
  }
  return taken;
}

// Grips of the second vessel with few distinct scores; one in four is left out, as if it were implausible. Half of the draws have
// grips that the core finds infeasible, too.
std::vector<Candidate> drawn_grips(const Plan& plan, std::mt19937& random) {
  std::vector<Candidate> grips;
  const int scores = 1 + static_cast<int>(random() % 30);
  const bool all = random() % 2 == 0;
  for (std::uint64_t i = 0; i < plan.grips(); ++i)
    if (random() % 4 != 0 && (all || fake_hand(1, plan.grip(1, i))))
      grips.push_back({static_cast<double>(random() % static_cast<unsigned>(scores)) / scores, i});
  std::shuffle(grips.begin(), grips.end(), random);
  return grips;
}

void expect_equal(const std::vector<Candidate>& chosen, const std::vector<Candidate>& expected) {
  ASSERT_EQ(chosen.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_EQ(chosen[k].index, expected[k].index) << k;
    EXPECT_EQ(chosen[k].score, expected[k].score) << k;
  }
}

// Passes until the lists are complete, each in blocks of its own; `restarts`: every pass is made by a new chooser that goes on.
int passes(const Plan& plan, const Evaluator& core, const ListRequest& request, std::vector<Candidate> grips, bool restarts,
           std::mt19937& random, std::vector<ListProgress>& progress) {
  progress.clear();
  std::optional<ListChooser> chooser(std::in_place, plan, &core, 1, request);
  int count = 0;
  while (!chooser->is_complete()) {
    if (restarts && random() % 2 == 0) {  // what an interrupt leaves of a pass
      chooser->offer({grips.begin(), grips.begin() + static_cast<std::ptrdiff_t>(grips.size() / 2)});
      chooser.emplace(plan, &core, 1, request, progress);
    }
    std::shuffle(grips.begin(), grips.end(), random);
    for (std::size_t first = 0; first < grips.size();) {
      const std::size_t count_of = std::min<std::size_t>(grips.size() - first, 1 + random() % 200);
      const auto start = grips.begin() + static_cast<std::ptrdiff_t>(first);
      chooser->offer({start, start + static_cast<std::ptrdiff_t>(count_of)});
      first += count_of;
    }
    chooser->end_pass();
    progress = chooser->progress();
    ++count;
  }
  return count;
}

TEST(ListChooser, ListsAreThoseOfTheDefinition) {
  std::mt19937 random(3);
  int several = 0, not_full = 0;
  for (int round = 0; round < 60; ++round) {
    Scene scene = fake_scene();
    if (round % 3 == 1) scene.grips.hand_scale.values = {1.1, 0.9, 1};
    if (round % 2 == 1) {
      scene.grips.sampling = Sampling::sobol;
      scene.grips.count = 700;
    }
    const Plan plan(scene, false);
    const FakeEvaluator core(scene);
    const std::vector<Candidate> grips = drawn_grips(plan, random);
    const double apart = std::array<double, 4>{0.01, 0.3, 0.5, 2}[random() % 4];
    const std::size_t best = 1 + random() % 25;
    for (const std::size_t pool : {1, 2, 7, 60, 100000}) {
      std::vector<ListProgress> lists;
      const int count = passes(plan, core, {best, apart, pool, 1 + round % 2}, grips, round % 5 == 0, random, lists);
      EXPECT_LE(count, static_cast<int>(best)) << "each pass takes a grip at least";
      if (pool == 100000) {
        EXPECT_EQ(count, 1);
      }
      several += count > 2;
      ASSERT_EQ(lists.size(), plan.hand_scales());
      for (std::size_t list = 0; list < lists.size(); ++list) {
        const auto expected = by_definition(plan, 1, grips, list, best, apart);
        expect_equal(lists[list].chosen, expected);
        not_full += expected.size() < best;
      }
    }
  }
  EXPECT_GT(several, 50);
  EXPECT_GT(not_full, 50);
}

// What ranks do: each chooser sees some of the grips, one takes what all found open, and others may find the hands.
TEST(ListChooser, APassMayBeShared) {
  std::mt19937 random(8);
  int several = 0;
  for (int round = 0; round < 20; ++round) {
    Scene scene = fake_scene();
    if (round % 2 == 1) scene.grips.hand_scale.values = {1.1, 0.9, 1};
    const Plan plan(scene, false);
    const FakeEvaluator core(scene);
    const std::vector<Candidate> grips = drawn_grips(plan, random);
    const std::size_t best = 1 + random() % 15, ranks = 1 + random() % 5;
    const ListRequest request{best, 0.3, 1 + random() % 40, 1};
    ListChooser leader(plan, &core, 1, request);
    std::size_t asked = 0;
    int count = 0;
    for (; !leader.is_complete(); ++count) {
      for (std::size_t rank = 0; rank < ranks; ++rank) {
        ListChooser other(plan, &core, 1, request, leader.progress());
        std::vector<Candidate> part;
        for (std::size_t i = rank; i < grips.size(); i += ranks) part.push_back(grips[i]);
        other.offer(part);
        EXPECT_LE(other.open_grips().size(), request.pool * plan.hand_scales());
        leader.add_open(other.open_grips());
      }
      leader.end_pass([&](const std::vector<Candidate>& some) {
        asked += some.size();
        return leader.hands_of(some);
      });
    }
    EXPECT_GT(asked, 0u);
    several += count > 1;
    for (std::size_t list = 0; list < plan.hand_scales(); ++list)
      expect_equal(leader.progress()[list].chosen, by_definition(plan, 1, grips, list, best, 0.3));
  }
  EXPECT_GT(several, 5);
}

TEST(ListChooser, WithoutADistanceTheListHasTheBestGrips) {
  const Scene scene = fake_scene();
  const Plan plan(scene, false);
  std::mt19937 random(4);
  std::vector<Candidate> grips = drawn_grips(plan, random);
  ListChooser chooser(plan, nullptr, 0, {12, 0, usual_pool(plan, 12, 0), 1});
  chooser.offer(grips);
  chooser.end_pass();
  EXPECT_TRUE(chooser.is_complete());
  std::sort(grips.begin(), grips.end(), is_better);
  grips.resize(12);
  expect_equal(chooser.chosen(), grips);
}

TEST(ListChooser, NothingWantedAndNothingThereIsComplete) {
  const Scene scene = fake_scene();
  const Plan plan(scene, false);
  const FakeEvaluator core(scene);
  EXPECT_TRUE(ListChooser(plan, &core, 0, {0, 0.3, 5, 1}).is_complete());
  ListChooser chooser(plan, &core, 0, {4, 0.3, 5, 1});
  EXPECT_FALSE(chooser.is_complete());
  chooser.end_pass();
  EXPECT_TRUE(chooser.is_complete());
  EXPECT_TRUE(chooser.chosen().empty());
}

// The first pass poses only what it takes to fill the list, and a later one only what may get into its pool.
TEST(ListChooser, HandsArePosedOnlyWhereTheyDecide) {
  struct Counting : FakeEvaluator {
    using FakeEvaluator::FakeEvaluator;
    std::optional<PosedHand> posed(std::size_t vessel, const GripInput& grip) const override {
      ++count;
      return FakeEvaluator::posed(vessel, grip);
    }
    mutable int count = 0;
  };
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 20000;
  const Plan plan(scene, false);
  const Counting core(scene);
  std::mt19937 random(5);
  ListChooser chooser(plan, &core, 0, {3, 1e-9, 1000, 1});
  chooser.offer(drawn_grips(plan, random));
  EXPECT_EQ(core.count, 0);
  chooser.end_pass();
  EXPECT_TRUE(chooser.is_complete());
  EXPECT_LE(core.count, 256) << "one block";
}

}  // namespace
}  // namespace wholehand::sweeps
