// SPDX-License-Identifier: MIT
// What lies beside a result is written over only where a sweep wrote it.
#include "sweeps/result/companions.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "base/files/files.h"
#include "base/files/folder_files.h"
#include "base/text/error.h"
#include "sweeps/result/output_names.h"
#include "tests/support/fake_backend.h"
#include "tests/support/files.h"

namespace wholehand::sweeps {
namespace {

std::string companion_refusal(const Scene& scene, const OutputNames& names, bool best, bool pictures, int glb) {
  try {
    check_companions(scene, names, best, pictures, glb);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    return error.what();
  }
  return "";
}

TEST(Companions, ForeignFilesAreRefusedAndOwnOnesAreNot) {
  const TemporaryFolder folder;
  const Scene scene = fake_scene();
  const OutputNames names = output_names(folder / "a.nc");
  struct Case {
    const char *name, *own, *foreign;
  };
  for (const auto& [name, own, foreign] :
       {Case{"a.best.csv", "vessel,rank,height_mm,azimuth_deg\n", "name,price\nvessel,3\n"},
        Case{"a.second.svg", "<svg>\n<metadata>chart of wholehand</metadata>", "<svg><title>wholehand</title></svg>"},
        Case{"a.first_vessel.2.glb", "glTF....JSON{\"asset\":{\"generator\":\"wholehand 1\"}}", "glTF....JSON{\"asset\":{}}"},
        Case{"a.nc.partial", "\x89HDF\r\n\x1a\n", "a text of mine"},
        Case{"a.nc.partial.mark", "wholehand mark 3 00\n{}", "a text of mine"}}) {
    const std::string path = folder / name;
    std::ofstream(path) << foreign;
    const std::string line = companion_refusal(scene, names, true, true, 2);
    EXPECT_EQ(line.rfind("-o " + path + ": is there and is no ", 0), 0u) << line;
    std::ofstream(path) << own;
    EXPECT_EQ(companion_refusal(scene, names, true, true, 2), "") << name;
    std::ofstream(path).close();
    EXPECT_EQ(companion_refusal(scene, names, true, true, 2), "") << name << ", empty";
  }
}

TEST(Companions, AResultWhoseCompanionsAreAnothersIsRefused) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.nc") << NETCDF4_START;
  const std::string line = companion_refusal(fake_scene(), output_names(folder / "a"), true, true, 0);
  EXPECT_EQ(line.rfind("-o " + (folder / "a") + ": " + (folder / "a.nc") + " exists", 0), 0u) << line;
  EXPECT_EQ(companion_refusal(fake_scene(), output_names(folder / "a.nc"), true, true, 0), "");
  std::ofstream(folder / "b") << NETCDF4_START;
  EXPECT_NE(companion_refusal(fake_scene(), output_names(folder / "b.nc"), true, true, 0), "");
}

TEST(Companions, ALinkInPlaceOfThePartialFileIsRefused) {
  const TemporaryFolder folder;
  const OutputNames names = output_names(folder / "a.nc");
  std::filesystem::create_symlink("nowhere", names.partial);
  const std::string line = companion_refusal(fake_scene(), names, false, false, 0);
  EXPECT_EQ(line.rfind("-o " + names.partial + ": is a link", 0), 0u) << line;
}

TEST(Companions, FilesOfOthersInAnOutputFolderAreRefused) {
  const TemporaryFolder folder;
  constexpr FolderTable tables[] = {{"a.csv", "one,two"}, {"a.md", "# Own"}};
  const char* const pictures[] = {"a.svg"};
  const auto refusal = [&]() -> std::string {
    try {
      check_folder_files(folder.path(), "study", tables, pictures);
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(), "") << "nothing is there";
  struct Case {
    const char *name, *own, *foreign;
  };
  for (const auto& [name, own, foreign] :
       {Case{"a.csv", "one,two\n1,2\n", "one;two\n"}, Case{"a.md", "# Own words", "# Notes"},
        Case{"a.svg", "<svg><metadata>chart of wholehand</metadata>", "<svg><title>Plot</title>"}}) {
    const std::string path = folder / name;
    std::ofstream(path) << foreign;
    EXPECT_EQ(refusal().rfind("-o " + path + ": is there and is no ", 0), 0u) << refusal();
    std::ofstream(path) << own;
    EXPECT_EQ(refusal(), "") << name;
  }
}

TEST(Companions, WhatIsNotWrittenIsNotLookedAt) {
  const TemporaryFolder folder;
  const OutputNames names = output_names(folder / "a.nc");
  for (const char* name : {"a.best.csv", "a.second.svg", "a.second.1.glb"}) std::ofstream(folder / name) << "mine";
  EXPECT_EQ(companion_refusal(fake_scene(), names, false, false, 0), "");
  EXPECT_FALSE(is_best_list(names.best));
  EXPECT_FALSE(is_best_list(folder / "missing"));
}

}  // namespace
}  // namespace wholehand::sweeps
