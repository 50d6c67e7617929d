// SPDX-License-Identifier: MIT
#include "sweeps/result/mark.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>

#include "base/text/error.h"
#include "tests/support/environment.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"

namespace wholehand::sweeps {
namespace {

SweepMark some_mark() {
  SweepMark mark;
  mark.identity = {{"scene", "text with \"quotes\"\nand lines"}, {"device", "a"}};
  mark.wall_seconds = 1.0 / 3;
  mark.kernel_seconds = 0.1;
  mark.vessels.resize(2);
  VesselProgress& vessel = mark.vessels[1];
  vessel.done = (std::uint64_t{1} << 40) + 1;
  vessel.best = {{0.1 + 0.2, 7}, {1e-17, ~std::uint64_t{0}}};
  vessel.stretches = {{0, 5, "ab"}, {5, vessel.done, "cd"}};
  vessel.counts = {11, {1, 2, 3, 4, 5, 6, 7}, 8, 9, 10, 11, 12, 15, 13, 14, 17, 16, {INFINITY, 1.0 / 11, 15}};
  vessel.heat_map = {1.0 / 7, NAN, 0};
  vessel.lists = {{{{1.0 / 9, 3}, {0.1, 4}}, Candidate{0.1, 9}, false}, {{}, {}, true}};
  mark.in_place = {{100, 20}, {std::uint64_t{1} << 50, 8}};
  mark.structure = "0123";
  return mark;
}

TEST(Mark, ComesBackBitForBit) {
  const TemporaryFolder folder;
  save_mark(folder / "m", some_mark());
  SweepMark mark;
  ASSERT_TRUE(load_mark(folder / "m", mark));
  const SweepMark expected = some_mark();
  EXPECT_EQ(mark.identity, expected.identity);
  EXPECT_EQ(mark.wall_seconds, expected.wall_seconds);
  EXPECT_EQ(mark.in_place, expected.in_place);
  EXPECT_EQ(mark.structure, expected.structure);
  ASSERT_EQ(mark.vessels.size(), 2u);
  EXPECT_EQ(mark.vessels[0].done, 0u);
  ASSERT_EQ(mark.vessels[1].stretches.size(), 2u);
  EXPECT_EQ(mark.vessels[1].stretches[1].first, 5u);
  EXPECT_EQ(mark.vessels[1].stretches[1].checksum, "cd");
  const VesselProgress &a = mark.vessels[1], &b = expected.vessels[1];
  EXPECT_EQ(a.done, b.done);
  ASSERT_EQ(a.best.size(), 2u);
  EXPECT_EQ(a.best[0].score, b.best[0].score);
  EXPECT_EQ(a.best[1].score, b.best[1].score);
  EXPECT_EQ(a.best[1].index, b.best[1].index);
  ASSERT_EQ(a.lists.size(), 2u);
  ASSERT_EQ(a.lists[0].chosen.size(), 2u);
  EXPECT_EQ(a.lists[0].chosen[0].score, 1.0 / 9);
  EXPECT_EQ(a.lists[0].chosen[1].index, 4u);
  ASSERT_TRUE(a.lists[0].decided);
  EXPECT_EQ(a.lists[0].decided->score, 0.1);
  EXPECT_EQ(a.lists[0].decided->index, 9u);
  EXPECT_FALSE(a.lists[0].is_complete);
  EXPECT_TRUE(a.lists[1].chosen.empty());
  EXPECT_FALSE(a.lists[1].decided);
  EXPECT_TRUE(a.lists[1].is_complete);
  EXPECT_EQ(a.counts.by_reason, b.counts.by_reason);
  EXPECT_EQ(a.counts.blocked, 10u);
  EXPECT_EQ(a.counts.through_table, 11u);
  EXPECT_EQ(a.counts.self_overlap, 12u);
  EXPECT_EQ(a.counts.only_deep, 13u);
  EXPECT_EQ(a.counts.not_held, 14u);
  EXPECT_EQ(a.counts.unjudged, 17u);
  EXPECT_EQ(a.counts.beyond_wrist, 15u);
  EXPECT_EQ(a.counts.at_gate, 16u);
  EXPECT_TRUE(a.counts.least_bad == b.counts.least_bad);
  EXPECT_TRUE(mark.vessels[0].counts.least_bad == LeastBad());
  ASSERT_EQ(a.heat_map.size(), 3u);
  EXPECT_EQ(a.heat_map[0], b.heat_map[0]);
  EXPECT_TRUE(std::isnan(a.heat_map[1]));
}

TEST(Mark, SaysWhereTheGripsOfShardsLie) {
  const TemporaryFolder folder;
  SweepMark mark;
  save_mark(folder / "m", some_mark());
  ASSERT_TRUE(load_mark(folder / "m", mark));
  EXPECT_FALSE(mark.shards);
  EXPECT_EQ(mark.vessels[1].stretches[1].shard, "");
  for (const std::optional<std::uint64_t>& height : {std::optional<std::uint64_t>(), std::optional<std::uint64_t>(4096)}) {
    SweepMark parted = some_mark();
    parted.vessels[1].stretches[1].shard = "node-2.cluster";
    parted.shards = ShardMark{"0a1b", {std::uint64_t{1} << 40, 36, {{512, 6, 4}, {9000, 1, 8}}, height, {70, 80}}, true};
    save_mark(folder / "m", parted);
    ASSERT_TRUE(load_mark(folder / "m", mark));
    EXPECT_EQ(mark.vessels[1].stretches[0].shard, "");
    EXPECT_EQ(mark.vessels[1].stretches[1].shard, "node-2.cluster");
    ASSERT_TRUE(mark.shards);
    EXPECT_EQ(mark.shards->id, "0a1b");
    EXPECT_EQ(mark.shards->layout, parted.shards->layout);
    EXPECT_TRUE(mark.shards->is_ended);
  }
}

TEST(Mark, MissingIsNoneAndDamagedIsAnError) {
  const TemporaryFolder folder;
  SweepMark mark;
  EXPECT_FALSE(load_mark(folder / "m", mark));
  for (const char* text : {"", "{", "{}", "[1]", R"({"format":2})", R"({"format":1,"identity":3})"}) {
    std::ofstream(folder / "m") << text;
    EXPECT_THROW(load_mark(folder / "m", mark), Error) << text;
  }
}

TEST(Mark, OneOfAnotherVersionIsCalledSo) {
  const TemporaryFolder folder;
  std::ofstream(folder / "m") << MARK_START << "4 00\n{}";
  SweepMark mark;
  try {
    load_mark(folder / "m", mark);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("another version"), std::string::npos) << error.what();
  }
}

TEST(Mark, VersionsBefore04AreRefused) {
  const TemporaryFolder folder;
  SweepMark mark = some_mark();
  mark.identity["version"] = "0.3.0";
  save_mark(folder / "m", mark);
  EXPECT_EQ(refusal_line([&] { load_mark(folder / "m", mark); }),
            (folder / "m") + ": written by version 0.3.0; this version reads files from 0.4.0 on: " + BEGIN_AGAIN);
}

TEST(Mark, APipeIsNotWaitedFor) {
  const TemporaryFolder folder;
  const std::string path = folder / "mark";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  SweepMark mark;
  EXPECT_THROW(load_mark(path, mark), Error);
}

TEST(Mark, ADifferentByteAnywhereIsRefused) {
  const TemporaryFolder folder;
  save_mark(folder / "m", some_mark());
  const std::string whole = file_text(folder / "m");
  EXPECT_EQ(whole.rfind(MARK_START, 0), 0u);
  SweepMark mark;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    std::ofstream(folder / "m") << damaged;
    EXPECT_THROW(load_mark(folder / "m", mark), Error) << at;
  }
  std::ofstream(folder / "m") << whole.substr(0, whole.size() - 1);
  EXPECT_THROW(load_mark(folder / "m", mark), Error);
}

TEST(Mark, WhatNoSweepCanHaveDoneIsRefused) {
  SweepMark mark;
  mark.vessels.resize(1);
  VesselProgress& vessel = mark.vessels[0];
  vessel.done = 10;
  vessel.counts.grips = 10;
  vessel.counts.by_reason = {4, 6};
  vessel.best = {{0.5, 9}};
  vessel.stretches = {{0, 7, "a"}, {7, 10, "b"}};
  vessel.lists = {{{{0.5, 9}}, Candidate{0.5, 9}, false}, {}};
  const MarkBounds bounds{1, 10, 1, 2, 1, true, true};
  EXPECT_NO_THROW(check_progress("m", mark, bounds));
  const auto refused = [&](const std::string& gist, const std::function<void(SweepMark&)>& change) {
    SweepMark changed = mark;
    change(changed);
    try {
      check_progress("m", changed, bounds);
      ADD_FAILURE() << "accepted: " << gist;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(gist), std::string::npos) << error.what();
    }
  };
  refused("2 vessels of 1", [](SweepMark& m) { m.vessels.resize(2); });
  for (const std::uint64_t done : {std::uint64_t{11}, ~std::uint64_t{0}, std::uint64_t{1} << 63})
    refused("grips are done of 10", [&](SweepMark& m) { m.vessels[0].done = done; });
  refused("9 grips are done and 10 counted", [](SweepMark& m) { m.vessels[0].done = 9; });
  refused("10 grips are done and 11 sorted", [](SweepMark& m) { m.vessels[0].counts.by_reason[2] = 1; });
  refused("1 implausible grips and 2 through the table", [](SweepMark& m) {
    m.vessels[0].counts.implausible = 1;
    m.vessels[0].counts.through_table = 2;
  });
  refused("1 implausible grips and 2 with fingers in each other", [](SweepMark& m) {
    m.vessels[0].counts.implausible = 1;
    m.vessels[0].counts.self_overlap = 2;
  });
  refused("0 implausible grips and 1 beyond the wrist", [](SweepMark& m) { m.vessels[0].counts.beyond_wrist = 1; });
  refused("0 implausible grips and 1 only deep", [](SweepMark& m) { m.vessels[0].counts.only_deep = 1; });
  refused("4 feasible grips, 3 implausible, 2 not held, 0 at the gate and 0 not judged", [](SweepMark& m) {
    m.vessels[0].counts.implausible = 3;
    m.vessels[0].counts.not_held = 2;
  });
  refused("4 feasible grips, 0 implausible, 0 not held, 5 at the gate and 0 not judged",
          [](SweepMark& m) { m.vessels[0].counts.at_gate = 5; });
  refused("grip 10 is nearest to holding of 10", [](SweepMark& m) { m.vessels[0].counts.least_bad = {2, 1, 10}; });
  refused("2 best grips are kept of 1", [](SweepMark& m) { m.vessels[0].best.push_back({0.4, 1}); });
  refused("grip 10 is one of the best of 10", [](SweepMark& m) { m.vessels[0].best[0].index = 10; });
  refused("a stretch from 6 follows 7", [](SweepMark& m) { m.vessels[0].stretches[1].first = 6; });
  refused("10 grips are done and 7 have a checksum", [](SweepMark& m) { m.vessels[0].stretches.pop_back(); });
  refused("1 of 2 lists are begun at 10 grips", [](SweepMark& m) { m.vessels[0].lists.pop_back(); });
  refused("2 of 2 lists are begun at 7 grips", [](SweepMark& m) {
    VesselProgress& v = m.vessels[0];
    v.done = v.counts.grips = 7;
    v.counts.by_reason = {7};
    v.best[0].index = 6;
  });
  refused("2 grips are chosen of 1", [](SweepMark& m) { m.vessels[0].lists[1].chosen = {{0.4, 1}, {0.3, 1}}; });
  refused("grip 10 is chosen of 10", [](SweepMark& m) { m.vessels[0].lists[0].chosen[0].index = 10; });
}

TEST(Mark, DifferenceIsNamed) {
  const SweepMark mark = some_mark();
  EXPECT_NO_THROW(check_identity("x.partial", mark, mark.identity));
  auto other = mark.identity;
  other["device"] = "b";
  try {
    check_identity("x.partial", mark, other);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_STREQ(error.what(),
                 "--resume: x.partial was begun with another device (\"a\", now \"b\"); ask for the same, or start again "
                 "without --resume");
  }
  other = mark.identity;
  other["new thing"] = "c";
  EXPECT_THROW(check_identity("x.partial", mark, other), Error);
}

// With no room on the disk, here by a limit on the size of files.
TEST(Mark, WithoutRoomTheRemedyIsSaid) {
  const TemporaryFolder folder;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  std::string line;
  try {
    const FileSizeLimit limit(16);
    save_mark(folder / "m", some_mark());
  } catch (const Error& error) {
    line = error.what();
  }
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(line.find("make room and go on with --resume, or name another file with -o"), std::string::npos) << line;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "nothing half written";
}

}  // namespace
}  // namespace wholehand::sweeps
