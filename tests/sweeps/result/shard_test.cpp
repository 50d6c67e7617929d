// SPDX-License-Identifier: MIT
// Shards: distinguished from each other and from foreign files.
#include "sweeps/result/shard.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/files/files.h"
#include "base/text/error.h"
#include "sweeps/result/output_names.h"
#include "tests/support/files.h"

namespace wholehand::sweeps {
namespace {

const RunLayout LAYOUT{10, 1, {{600, 1, 8}}, {}, {}};

TEST(Shard, IsKnownByItsSweep) {
  const TemporaryFolder folder;
  const std::string path = shard_path(output_names(folder / "a.nc"), "n1");
  EXPECT_EQ(path, folder / "a.nc.n1.shard");
  const std::string id = new_shard_id(), other = new_shard_id();
  EXPECT_NE(id, other);
  EXPECT_FALSE(is_shard(path, id));
  make_shard(path, id, LAYOUT);
  EXPECT_TRUE(is_shard(path, id));
  EXPECT_FALSE(is_shard(path, other));
  make_shard(path, other, LAYOUT);  // of another sweep: begun again
  EXPECT_TRUE(is_shard(path, other));
}

TEST(Shard, ReplacesNothingElse) {
  const TemporaryFolder folder;
  std::ofstream(folder / "s") << "of somebody else, and quite long enough";
  EXPECT_THROW(make_shard(folder / "s", new_shard_id(), LAYOUT), Error);
  EXPECT_EQ(file_text(folder / "s"), "of somebody else, and quite long enough");
}

TEST(Shard, ValuesLeaveItsFirstLineAlone) {
  const TemporaryFolder folder;
  for (const RunLayout& layout : {RunLayout{10, 1, {{600, 1, 8}, {50, 1, 8}}, {}, {}}, RunLayout{10, 1, {{600, 1, 8}}, 50, {}},
                                  RunLayout{10, 1, {{600, 1, 8}}, {}, {900, 50}}})
    EXPECT_THROW(make_shard(folder / "s", new_shard_id(), layout), Error);
  EXPECT_FALSE(begins_with(folder / "s", SHARD_START));
}

// Every value has one place, whatever the vessel, plane, copy and stretch.
TEST(RunLayout, NoTwoValuesShareAPlace) {
  const RunLayout layout{7, 3, {{1000, 2, 4}, {2000, 1, 8}}, 4000, {5000, 6000}};
  std::vector<bool> is_taken(8000);
  for (std::size_t vessel = 0; vessel < 2; ++vessel)
    for (const auto& [first, count] : {std::pair{0, 3}, {3, 4}})
      for (std::uint64_t copy = 0; copy < layout.copies; ++copy)
        layout.visit(vessel, static_cast<std::uint64_t>(first), static_cast<std::uint64_t>(count), copy,
                     [&](std::size_t run, FileRange range) {
                       if (copy > 0 && run >= 3) return;  // heights and axes: the same for all copies
                       for (std::uint64_t byte = range.offset; byte < range.offset + range.size; ++byte) {
                         EXPECT_FALSE(is_taken.at(byte)) << byte;
                         is_taken.at(byte) = true;
                       }
                     });
  // 2 vessels x 7 grips x 3 copies of 2 x 4 + 8 B, 2 x 7 heights and 2 axes of 7
  EXPECT_EQ(std::count(is_taken.begin(), is_taken.end(), true), 2 * 7 * 3 * 16 + 2 * 7 * 8 + 2 * 7 * 8);
}

}  // namespace
}  // namespace wholehand::sweeps
