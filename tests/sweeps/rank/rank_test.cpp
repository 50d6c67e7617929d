// SPDX-License-Identifier: MIT
// Grips ranked anew from a result: against every grip of the file gone through one by one.
// sanitizers: address
#include "sweeps/rank/rank.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>

#include "base/text/error.h"
#include "sweeps/lists/different_grips.h"
#include "sweeps/run/run.h"
#include "tests/support/result_reader.h"
#include "tests/support/scene_texts.h"
#include "tests/support/sweep_results.h"

namespace wholehand::sweeps {
namespace {

const std::array<const char*, 6> TERM_NAMES{"fingers", "contacts", "depth", "posture", "force", "hold"};

Ranking ranked(const SweptScene& swept, const RankRequest& request) {
  return rank_grips(*swept.result, swept.scene, *swept.plan, request, [&] { return make_core_evaluator(swept.scene); });
}

std::string rank_refusal(const SweptScene& swept, const RankRequest& request) {
  try {
    ranked(swept, request);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "accepted";
}

// The file's values of some variables, read apart from what is tested.
struct FileValues {
  explicit FileValues(const SweptScene& swept) : stored(swept.plan->stored_grips()), path(swept.path) {}
  double of(const std::string& name, std::size_t vessel, std::uint64_t grip) {
    auto& values = all[name];
    if (values.empty()) values = read_values(path, name);
    return values[vessel * stored + grip];
  }
  std::uint64_t stored;
  std::string path;
  std::map<std::string, std::vector<double>> all;
};

// The numbers of the grips of a list, the best first, by brute force.
std::vector<std::uint64_t> by_hand(const SweptScene& swept, std::size_t vessel, const std::array<double, 6>& weights,
                                   const std::function<bool(FileValues&, std::uint64_t)>& matches, std::size_t best) {
  FileValues file(swept);
  std::vector<std::pair<double, std::uint64_t>> grips;
  for (std::uint64_t grip = 0; grip < swept.plan->grips(); ++grip) {
    if (file.of("reason", vessel, grip) != 0 || file.of("plausible", vessel, grip) != 1 || !matches(file, grip)) continue;
    double score = 0;
    for (std::size_t k = 0; k < 6; ++k)
      if (weights[k] > 0) score += weights[k] * file.of(std::string("score_") + TERM_NAMES[k], vessel, grip);
    grips.push_back({-score, grip});
  }
  std::sort(grips.begin(), grips.end());
  std::vector<std::uint64_t> numbers;
  for (std::size_t k = 0; k < std::min(best, grips.size()); ++k) numbers.push_back(grips[k].second);
  return numbers;
}

std::vector<std::uint64_t> grip_indices(const std::vector<BestGrip>& grips) {
  std::vector<std::uint64_t> numbers;
  for (const BestGrip& grip : grips) numbers.push_back(grip.candidate.index);
  return numbers;
}

const auto ANY_GRIP = [](FileValues&, std::uint64_t) { return true; };

TEST(Rank, WithoutOptionsItIsTheSweepsOwnList) {
  for (const Precision precision : {Precision::single, Precision::full}) {
    const SweptScene swept(RESULT_SCENE, precision);
    const Ranking ranking = ranked(swept, {"", {}, 5});
    ASSERT_EQ(ranking.lists.size(), 2u);
    EXPECT_EQ(ranking.note, "");
    for (std::size_t v = 0; v < 2; ++v) {
      const auto own = swept.result->best(v);
      ASSERT_EQ(ranking.lists[v].size(), own.size());
      for (std::size_t k = 0; k < own.size(); ++k) {
        EXPECT_EQ(ranking.lists[v][k].candidate.index, own[k].index);
        EXPECT_EQ(ranking.lists[v][k].score, own[k].score) << "to the bit";
        EXPECT_EQ(ranking.lists[v][k].rank, k + 1);
      }
    }
  }
}

TEST(Rank, OtherWeightsGiveTheOrderOfTheirSums) {
  const SweptScene swept(RESULT_SCENE);
  for (const auto& [text, weights] :
       {std::pair<const char*, std::array<double, 6>>{"fingers=0,contacts=0,depth=0,posture=1,force=0,hold=0", {0, 0, 0, 1, 0, 0}},
        {"force=2", {0.02, 0.02, 0.69, 0.02, 2, 0.12}},
        {"hold=0,contacts=.7", {0.02, 0.7, 0.69, 0.02, 0.13, 0}}}) {
    const Ranking ranking = ranked(swept, {text, {}, 40});
    for (std::size_t v = 0; v < 2; ++v) EXPECT_EQ(grip_indices(ranking.lists[v]), by_hand(swept, v, weights, ANY_GRIP, 40)) << text;
  }
  EXPECT_NE(grip_indices(ranked(swept, {"force=2", {}, 40}).lists[0]), grip_indices(ranked(swept, {"", {}, 40}).lists[0]));
}

TEST(Rank, OnlyGripsThatMeetTheConditionAreListedAndCounted) {
  const SweptScene swept(RESULT_SCENE);
  const std::array<double, 6> own{0.02, 0.02, 0.69, 0.02, 0.13, 0.12};
  const auto expect_by_hand = [&](const std::string& where, const std::function<bool(FileValues&, std::uint64_t)>& matches) {
    const Ranking ranking = ranked(swept, {"", {where}, 1000});
    const auto expected = by_hand(swept, 1, own, matches, 1000);
    EXPECT_EQ(grip_indices(ranking.lists[1]), expected) << where;
    EXPECT_EQ(ranking.matching[1], expected.size()) << where;
    EXPECT_EQ(ranking.plausible[1], by_hand(swept, 1, own, ANY_GRIP, 1000).size());
    EXPECT_GT(expected.size(), 0u) << where;
    EXPECT_LT(expected.size(), ranking.plausible[1]) << where;
  };
  expect_by_hand("fingers_used >= 4 and palm_depth_mm < 2", [](FileValues& file, std::uint64_t grip) {
    return file.of("fingers_used", 1, grip) >= 4 && file.of("palm_depth", 1, grip) < 2e-3;
  });
  expect_by_hand("touch_mask & 12288", [](FileValues& file, std::uint64_t grip) {
    return (static_cast<int>(file.of("touch_mask", 1, grip)) & 12288) != 0;
  });
  const auto grip_at = [&](std::uint64_t grip) { return swept.plan->grip(1, grip); };
  expect_by_hand("roll_deg == -30 and not (height_mm < 60)", [&](FileValues&, std::uint64_t grip) {
    return std::abs(degrees(grip_at(grip).roll) + 30) < 1e-9 && grip_at(grip).height >= 0.06;
  });
  expect_by_hand("obliquity_deg > 0 or height_fraction < .5",
                 [&](FileValues&, std::uint64_t grip) { return grip_at(grip).obliquity > 0 || grip_at(grip).height < 0.5 * 0.14; });
}

TEST(Rank, OfSeveralValuesAConditionTakesTheLargestOrTheLeast) {
  const SweptScene swept(RESULT_SCENE);
  const std::uint64_t stored = swept.plan->stored_grips();
  const auto peaks = read_values(swept.path, "peak_feedback_force");  // vessel, fill, grip
  const auto safe = read_values(swept.path, "largest_safe_tilt");
  for (const auto& [where, is_largest] :
       {std::pair<const char*, bool>{"max(peak_feedback_force) < 1.5", true}, {"min(peak_feedback_force) < 1.5", false}}) {
    std::uint64_t count = 0;
    FileValues file(swept);
    for (std::uint64_t grip = 0; grip < swept.plan->grips(); ++grip) {
      const double a = peaks[grip], b = peaks[stored + grip];
      count += file.of("plausible", 0, grip) == 1 && (is_largest ? std::max(a, b) : std::min(a, b)) < 1.5;
    }
    EXPECT_EQ(ranked(swept, {"", {where}, 1}).matching[0], count) << where;
  }
  std::uint64_t count = 0;
  FileValues file(swept);
  for (std::uint64_t grip = 0; grip < swept.plan->grips(); ++grip)
    count += file.of("plausible", 0, grip) == 1 && safe[grip] >= 0 && safe[stored + grip] >= 0;  // NaN: none
  EXPECT_EQ(ranked(swept, {"", {"min(largest_safe_tilt) >= 0"}, 1}).matching[0], count);
}

TEST(Rank, RowsAreTheFilesNumbersOrTheCores) {
  const SweptScene whole(RESULT_SCENE), part(edited(RESULT_SCENE, "best = 5", "best = 5\nkeep = [\"score\", \"plausible\"]"));
  const Ranking from_file = ranked(whole, {"", {}, 5}), from_core = ranked(part, {"", {}, 5});
  EXPECT_EQ(from_file.note, "");
  EXPECT_NE(from_core.note.find("the core computed them"), std::string::npos);
  const ListOrigin origin{"a.nc", "s"};
  EXPECT_EQ(best_csv(whole.scene, *whole.plan, from_file.lists, origin), best_csv(part.scene, *part.plan, from_core.lists, origin))
      << "of a sweep by the core in double precision they are the same";
}

TEST(Rank, WhatTheFileLacksIsRefusedWithWhatToKeep) {
  const SweptScene part(edited(RESULT_SCENE, "best = 5", "best = 5\nkeep = [\"score\", \"plausible\", \"joints\"]"));
  EXPECT_NE(rank_refusal(part, {"force=1", {}, 5})
                .find("lacks score_fingers, score_contacts, score_depth, score_posture, score_force, score_hold, as keep of the "
                      "sweep does not name them"),
            std::string::npos)
      << rank_refusal(part, {"force=1", {}, 5});
  EXPECT_NE(
      rank_refusal(part, {"", {"gap_mm < 80"}, 5}).find("column 1: gap_mm is not in the file; add \"gap\" to [output] keep of"),
      std::string::npos);
  EXPECT_NE(rank_refusal(part, {"", {"max(joints) > 0"}, 5}).find("is a vector"), std::string::npos);
  const SweptScene none(edited(RESULT_SCENE, "best = 5", "best = 5\nkeep = [\"score\"]"));
  EXPECT_NE(rank_refusal(none, {"", {}, 5}).find("lacks plausible, as"), std::string::npos);
  const SweptScene still(edited(RESULT_SCENE, "[tilts]\ndeg = [0, 45, 90, 135]", ""));
  EXPECT_NE(rank_refusal(still, {"", {"max(peak_feedback_force) < 1"}, 5}).find("needs [tilts]"), std::string::npos);
  EXPECT_NE(rank_refusal(still, {"force=1", {}, 5}).find("force needs [tilts]"), std::string::npos);
  const SweptScene points(edited(RESULT_SCENE, "[tilts]", "[hand]\nbetween = 0\n\n[tilts]"));
  EXPECT_NE(rank_refusal(points, {"", {"self_depth_mm < 3"}, 5}).find("needs [hand] between above 0, which the scene of this file"),
            std::string::npos);
  EXPECT_NE(rank_refusal(SweptScene(RESULT_SCENE), {"", {"azimuth_deg > 0"}, 5}).find("one azimuth stands for all"),
            std::string::npos);
}

TEST(Rank, WeightsAreReadStrictly) {
  const Scene scene = SweptScene(RESULT_SCENE).scene;
  EXPECT_EQ(read_weights("", scene), (std::array<double, 6>{0.02, 0.02, 0.69, 0.02, 0.13, 0.12}));
  EXPECT_EQ(read_weights("hold=1e-1,fingers=.2", scene), (std::array<double, 6>{0.2, 0.02, 0.69, 0.02, 0.13, 0.1}));
  const std::pair<const char*, const char*> cases[] = {
      {"finger=1", "no term 'finger'; the nearest is 'fingers'"},
      {"force", "force=; allowed: a number, 0 to 1000"},
      {"force=-1", "force=-1; allowed"},
      {"force=1001", "force=1001; allowed"},
      {"force=nan", "force=nan; allowed"},
      {"force=1 ", "force=1 ; allowed"},
      {"force=1,force=1", "force is named twice"},
      {"force=1,", "ends with a comma"},
      {"fingers=0,contacts=0,depth=0,posture=0,force=0,hold=0", "no term has a weight above 0"},
  };
  for (const auto& [text, gist] : cases) {
    try {
      read_weights(text, scene);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(gist), std::string::npos) << text << ": " << error.what();
    }
  }
}

// ---- lists handed back ----

std::string written_list(const SweptScene& swept, const std::string& text) {
  const std::string path = swept.folder / "list.csv";
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

std::string csv_of(const SweptScene& swept, const Ranking& ranking) {
  return best_csv(swept.scene, *swept.plan, ranking.lists, list_origin("a/result.nc", swept.result->origin()));
}

TEST(GripListsTest, AListIsReadAsItWasWritten) {
  const SweptScene swept(RESULT_SCENE);
  const Ranking ranking = ranked(swept, {"force=1", {"fingers_used >= 3"}, 7});
  const GripLists lists = read_grip_lists(written_list(swept, csv_of(swept, ranking)), *swept.result, swept.scene, *swept.plan);
  ASSERT_EQ(lists.size(), 2u);
  for (std::size_t v = 0; v < 2; ++v) {
    ASSERT_EQ(lists[v].size(), ranking.lists[v].size());
    for (std::size_t k = 0; k < lists[v].size(); ++k) {
      EXPECT_EQ(lists[v][k].rank, k + 1);
      EXPECT_EQ(lists[v][k].candidate.index, ranking.lists[v][k].candidate.index);
      EXPECT_NEAR(lists[v][k].candidate.score, ranking.lists[v][k].score, 1e-8);
    }
  }
}

TEST(GripListsTest, RowsMayBeLeftOutAndSorted) {
  const SweptScene swept(RESULT_SCENE);
  const Ranking ranking = ranked(swept, {"", {}, 3});
  const std::string csv = csv_of(swept, ranking);
  std::vector<std::string> lines;
  for (std::size_t at = 0, end; (end = csv.find('\n', at)) != std::string::npos; at = end + 1)
    lines.push_back(csv.substr(at, end - at));
  const GripLists lists = read_grip_lists(written_list(swept, lines[0] + "\r\n" + lines[3] + "\r\n" + lines[1] + "\r\n"),
                                          *swept.result, swept.scene, *swept.plan);
  ASSERT_EQ(lists[0].size(), 2u);
  EXPECT_EQ(lists[0][0].rank, 1u);
  EXPECT_EQ(lists[0][1].rank, 3u);
  EXPECT_EQ(lists[0][1].candidate.index, ranking.lists[0][2].candidate.index);
  EXPECT_TRUE(lists[1].empty());
}

TEST(GripListsTest, OtherSweepsAndDamageAreRefusedWithTheirLine) {
  const SweptScene swept(RESULT_SCENE);
  const std::string csv = csv_of(swept, ranked(swept, {"", {}, 2})), id = sweep_id(swept.result->origin());
  const auto expect_refused = [&](const std::string& text, const std::string& gist) {
    const std::string path = written_list(swept, text);
    try {
      read_grip_lists(path, *swept.result, swept.scene, *swept.plan);
      ADD_FAILURE() << gist;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      EXPECT_EQ(std::string(error.what()).rfind(path, 0), 0u) << error.what();
      EXPECT_NE(std::string(error.what()).find(gist), std::string::npos) << error.what() << " lacks " << gist;
    }
  };
  expect_refused("", "is empty");
  expect_refused("a;b\n1;2\n", "it has no column vessel");
  expect_refused(edited(csv, id, "sweep-0"), ":2: the row is from another sweep (sweep-0)");
  expect_refused(edited(csv, "\ncup,2,", "\ncup,1,"), ":3: rank 1 appears twice");
  const std::size_t first = csv.find('\n') + 1, second = csv.find('\n', first) + 1;
  expect_refused(csv.substr(0, second) + edited(csv.substr(first, second - first), "cup,1,", "cup,2,"), " appears twice");
  expect_refused(edited(csv, "\ncup,2,", "\ncup,0,"), ":3: rank 0");
  expect_refused(edited(csv, "\ncup,2,", "\nmug,2,"), ":3: the sweep has no vessel 'mug'");
  expect_refused(edited(csv, ",result.nc," + id, "9999,result.nc," + id), ":2: grip '");
  expect_refused(edited(csv, "\ncup,2,", "\ncup,2,,"), ":3: the row has 44 cells and the header has 43");
}

TEST(GripListsTest, AnotherSceneDeviceOrPrecisionIsAnotherSweep) {
  Scene scene;
  scene.text = "scene";
  const SweepOrigin origin = origin_of(scene, "1", {"vulkan", "device", "driver", Precision::single, false});
  const std::string id = sweep_id(origin);
  EXPECT_EQ(id.size(), 22u);
  EXPECT_EQ(sweep_id(origin), id);
  SweepOrigin other = origin;
  other.scene += "#";
  EXPECT_NE(sweep_id(other), id);
  other = origin;
  other.device += "2";
  EXPECT_NE(sweep_id(other), id);
  other = origin;
  other.precision = Precision::full;
  EXPECT_NE(sweep_id(other), id);
  other = origin;
  other.wall_seconds = 7;
  EXPECT_EQ(sweep_id(other), id) << "the same sweep again";
  const auto core = [&](const char* threads) {
    return sweep_id(origin_of(scene, "1", {"core", threads, "g++", Precision::full, true}));
  };
  EXPECT_EQ(core("core, 2 threads"), core("core, 4 threads"));
}

// ---- several hands ----

TEST(Rank, EachHandScaleHasAListOfItsOwn) {
  for (const char* keep : {"best = 4", "best = 4\nkeep = [\"score\", \"plausible\"]"}) {
    const SweptScene swept(edited(edited(RESULT_SCENE, "best = 5", keep), "roll_deg", "hand_scale = [1.1, 0.9]\nroll_deg"));
    ASSERT_EQ(swept.plan->hand_scales(), 2u);
    const Ranking ranking = ranked(swept, {"", {}, 4});
    ASSERT_EQ(ranking.lists.size(), 4u);
    for (std::size_t list = 0; list < 4; ++list) {
      const auto own = swept.result->best(list / 2, list % 2);
      ASSERT_EQ(own.size(), 4u);
      ASSERT_EQ(ranking.lists[list].size(), 4u);
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(ranking.lists[list][k].grip.hand_scale, list % 2 == 0 ? 1.1 : 0.9);
        EXPECT_EQ(ranking.lists[list][k].candidate.index, own[k].index);
      }
    }
    EXPECT_EQ(list_name(swept.scene, *swept.plan, 3), "flask, hand scale 0.9");
    EXPECT_EQ(list_file_parts(swept.scene, *swept.plan)[1], "cup.hand0.9");
  }
}

// Grips of a list by the definition: each compared with all before, at the hands of the core's whole answers.
std::vector<std::uint64_t> different(const SweptScene& swept, std::size_t vessel, const std::vector<std::uint64_t>& in_order,
                                     std::size_t best, double apart) {
  const auto core = make_core_evaluator(swept.scene);
  std::vector<std::uint64_t> taken;
  std::vector<std::optional<PosedHand>> hands;
  for (const std::uint64_t grip : in_order) {
    if (taken.size() == best) break;
    GripResult whole;
    core->grip(vessel, swept.plan->grip(vessel, grip), whole);
    const std::optional<PosedHand> hand = whole.reason == Reason::none ? std::optional(whole.posed) : std::nullopt;
    if (!std::all_of(hands.begin(), hands.end(), [&](const auto& other) { return are_different(hand, other, apart); })) continue;
    taken.push_back(grip);
    hands.push_back(hand);
  }
  return taken;
}

TEST(Rank, DifferentGripsAreThoseOfTheDefinition) {
  for (const Precision precision : {Precision::single, Precision::full}) {
    const SweptScene swept(RESULT_SCENE, precision);
    const char* weights = "force=0.6,contacts=0";
    const auto used = read_weights(weights, swept.scene);
    for (const bool all : {true, false}) {
      const auto matches = [&](FileValues& file, std::uint64_t grip) { return all || file.of("fingers_used", 0, grip) >= 3; };
      const std::vector<std::string> where(all ? 0 : 1, "fingers_used >= 3");
      const std::size_t vessels = all ? 2 : 1;  // the condition above looks at the first vessel
      for (std::size_t v = 0; v < vessels; ++v) {
        const auto in_order = by_hand(swept, v, used, matches, swept.plan->grips());
        for (const double apart : {5e-3, 25e-3, 80e-3}) {
          const auto expected = different(swept, v, in_order, 8, apart);
          for (const std::size_t pool : {std::size_t{1}, std::size_t{3}, std::size_t{0}}) {
            const Ranking ranking = ranked(swept, {weights, where, 8, apart, pool});
            EXPECT_EQ(grip_indices(ranking.lists[v]), expected) << apart << " " << pool;
            EXPECT_EQ(ranking.matching[v], in_order.size()) << "counted in one pass alone";
          }
        }
      }
    }
  }
}

TEST(Rank, NearGripsAreLeftOut) {
  const SweptScene swept(RESULT_SCENE);
  const Ranking near = ranked(swept, {"", {}, 8}), apart = ranked(swept, {"", {}, 8, 80e-3, 0});
  for (std::size_t v = 0; v < 2; ++v) {
    ASSERT_FALSE(near.lists[v].empty());
    EXPECT_EQ(grip_indices(near.lists[v])[0], grip_indices(apart.lists[v])[0]) << "the best is the best";
    EXPECT_NE(grip_indices(near.lists[v]), grip_indices(apart.lists[v]));
  }
}

TEST(Rank, WithTheSweepsDistanceItIsTheSweepsOwnList) {
  const TemporaryFolder folder;
  Scene scene = scene_from(edited(RESULT_SCENE, "apart_mm = 0", "apart_mm = 40"));
  SweepOptions options;
  options.output = folder / "a.nc";
  options.on = "core";
  for (const Precision precision : {Precision::full, Precision::single}) {
    options.precision = precision;
    testing::internal::CaptureStdout();
    EXPECT_EQ(run_sweep(scene, options), ExitCode::done);
    testing::internal::GetCapturedStdout();
    SweepResult result(options.output);
    const Plan plan(scene, keeps_vectors(result.variables()));
    result.use(scene, plan);
    const Ranking ranking =
        rank_grips(result, scene, plan, {"", {}, 5, scene.output.apart, 2}, [&] { return make_core_evaluator(scene); });
    for (std::size_t v = 0; v < 2; ++v) {
      std::vector<std::uint64_t> own;
      for (const Candidate& candidate : result.best(v)) own.push_back(candidate.index);
      EXPECT_EQ(grip_indices(ranking.lists[v]), own);
      EXPECT_FALSE(own.empty());
    }
  }
}

TEST(Rank, GripsOfSeveralRankingsAreMergedByWhatIsAskedFor) {
  const double none = std::nan("");
  std::vector<MergedGrip> grips(4);
  const std::array<std::array<double, 4>, 4> numbers{
      {{0.9, 0.3, 0.2, 7}, {0.8, 0.6, 0.1, 9}, {0.9, none, none, none}, {0, none, 1.5, 0}}};
  for (std::size_t i = 0; i < grips.size(); ++i) {
    grips[i].ranking = i;
    grips[i].grip.score = numbers[i][0];
    grips[i].grip.robust.low = grips[i].grip.robust.mean = numbers[i][1];
    grips[i].grip.efforts.worst = numbers[i][2];
    grips[i].grip.efforts.push = numbers[i][3];
  }
  const auto order = [&](RankBy by, std::size_t best) {
    std::vector<std::size_t> places;
    for (const MergedGrip& grip : merged(grips, by, best)) {
      places.push_back(grip.ranking);
      EXPECT_EQ(grip.grip.rank, places.size());
    }
    return places;
  };
  using Places = std::vector<std::size_t>;
  EXPECT_EQ(order(RankBy::score, 9), (Places{0, 2, 1, 3})) << "what is not known is less than all";
  EXPECT_EQ(order(RankBy::robust, 9), (Places{1, 0, 2, 3}));
  EXPECT_EQ(order(RankBy::worst_effort, 3), (Places{1, 0, 3}));
  EXPECT_EQ(order(RankBy::push, 2), (Places{1, 0}));
  std::swap(grips[0], grips[1]);
  for (MergedGrip& grip : grips) grip.grip = BestGrip();
  EXPECT_EQ(order(RankBy::score, 9), (Places{1, 0, 2, 3})) << "equal ones stay in their order";
}

}  // namespace
}  // namespace wholehand::sweeps
