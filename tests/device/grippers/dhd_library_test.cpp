// SPDX-License-Identifier: MIT
// Force Dimension's library: where the search looks for it, and the message where there is none.
#include "device/grippers/dhd_library.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <string>

#include "tests/support/files.h"
#include "tests/support/omega_fixture.h"

namespace wholehand::device {
namespace {

TEST(DhdLibrary, SaysWhereToGetIt) {
  const ScopedVariable variable("WHOLEHAND_DHD_LIBRARY", nullptr);
  const std::string line = omega_refusal([] { load_dhd_library("", {"libnone_dhd.so.3", "libnone_dhd.so"}); });
  expect_has(line, "Force Dimension's SDK is not there (looked for libnone_dhd.so.3, libnone_dhd.so)");
  expect_has(line, "https://www.forcedimension.com/software/sdk");
  expect_has(line, "and name its path");
}

TEST(DhdLibrary, TakesTheFirstThatIsThere) {
  const ScopedVariable variable("WHOLEHAND_DHD_LIBRARY", nullptr);
  EXPECT_EQ(load_dhd_library("", {"libnone_dhd.so.3", STAND_IN_DHD, "libnone_dhd.so"}).path, STAND_IN_DHD);
  EXPECT_EQ(DHD_LIBRARY_NAMES, (std::vector<std::string>{"libdhd.so.3", "libdhd.so", "libdrd.so.3", "libdrd.so"}));
}

TEST(DhdLibrary, SaysWhyOneThatIsThereDoesNotLoad) {
  const ScopedVariable variable("WHOLEHAND_DHD_LIBRARY", nullptr);
  const TemporaryFolder folder;
  const std::string text = folder / "libdhd.so";
  { std::ofstream(text) << "no library"; }
  const std::string line = omega_refusal([&] { load_dhd_library("", {text, "libnone_dhd.so"}); });
  expect_has(line, "cannot load Force Dimension's SDK: " + text + ":");
}

// The loader would block forever, waiting for a writer.
TEST(DhdLibrary, APipeIsNotWaitedFor) {
  const TemporaryFolder folder;
  const std::string path = folder / "libdhd.so";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  expect_has(omega_refusal([&] { load_dhd_library(path); }), path + ": is no file but a folder, device or pipe; get it from ");
  const ScopedVariable variable("WHOLEHAND_DHD_LIBRARY", path.c_str());
  expect_has(omega_refusal([] { load_dhd_library(""); }), "(named by WHOLEHAND_DHD_LIBRARY): " + path + ": is no file");
}

TEST(DhdLibrary, WhatIsNamedIsNotReplaced) {
  const std::vector<std::string> names{STAND_IN_DHD};
  {
    const ScopedVariable variable("WHOLEHAND_DHD_LIBRARY", STAND_IN_DHD);
    const std::string line = omega_refusal([&] { load_dhd_library("/not/there/libdhd.so", names); });
    expect_has(line, "cannot load Force Dimension's SDK: /not/there/libdhd.so: cannot open shared object file");
    EXPECT_EQ(load_dhd_library("", {}).path, STAND_IN_DHD);
  }
  const ScopedVariable variable("WHOLEHAND_DHD_LIBRARY", "/not/here/libdhd.so");
  const std::string line = omega_refusal([&] { load_dhd_library("", names); });
  expect_has(line, "cannot load Force Dimension's SDK (named by WHOLEHAND_DHD_LIBRARY): /not/here/libdhd.so:");
  EXPECT_EQ(load_dhd_library(STAND_IN_DHD, {}).path, STAND_IN_DHD);
  const ScopedVariable empty("WHOLEHAND_DHD_LIBRARY", "");
  EXPECT_EQ(load_dhd_library("", names).path, STAND_IN_DHD) << "empty is unset";
}

TEST(DhdLibrary, NamesTheMissingFunction) {
  const std::string line = omega_refusal([] { load_dhd_library(STAND_IN_DHD_OLD); });
  expect_has(line, STAND_IN_DHD_OLD " lacks the function dhdSetWatchdog");
}

}  // namespace
}  // namespace wholehand::device
