// SPDX-License-Identifier: MIT
#include "sweeps/result/output_names.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/files.h"

namespace wholehand::sweeps {
namespace {

TEST(OutputNames, NamesGoTogether) {
  const OutputNames names = output_names("out/three.nc");
  EXPECT_EQ(names.partial, "out/three.nc.partial");
  EXPECT_EQ(names.mark, "out/three.nc.partial.mark");
  EXPECT_EQ(names.best, "out/three.best.csv");
  EXPECT_EQ(names.heat_map("beaker1"), "out/three.beaker1.svg");
  EXPECT_EQ(output_names("three").best, "three.best.csv");
  EXPECT_EQ(output_names(".nc").best, ".nc.best.csv");
}

TEST(OutputNames, GoWhereALinkPoints) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "data");
  std::filesystem::create_symlink("data/target", folder / "again");
  const OutputNames names = output_names(folder / "again");
  EXPECT_EQ(names.partial, folder / "data/target.partial") << "where it can be renamed from";
  EXPECT_EQ(names.best, folder / "again.best.csv") << "beside the name that was given";
}

}  // namespace
}  // namespace wholehand::sweeps
