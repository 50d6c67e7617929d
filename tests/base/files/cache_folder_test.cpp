// SPDX-License-Identifier: MIT
// sanitizers: address
// Where the cache is, and its bound: what counts, what goes first, and what never goes.
#include "base/files/cache_folder.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "base/text/error.h"
#include "tests/support/environment.h"

namespace wholehand {
namespace {

namespace fs = std::filesystem;

class CacheFolder : public testing::Test {
 protected:
  CacheFolder() {
    std::string name = (fs::temp_directory_path() / "wholehand-XXXXXX").string();
    folder = mkdtemp(name.data());
    fs::create_directories(folder / "grids");
  }
  ~CacheFolder() override { fs::remove_all(folder); }

  // A file of so many bytes, last used so many hours ago.
  fs::path add(const std::string& name, std::uintmax_t bytes, int hours_ago) const {
    const fs::path file = folder / name;
    std::ofstream(file).put('x');
    fs::resize_file(file, bytes);
    fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(hours_ago));
    return file;
  }

  static std::string key(char digit) { return std::string(32, digit); }

  fs::path folder;
};

TEST_F(CacheFolder, IsWhereTheUserKeepsSuchThings) {
  const ScopedVariable home("HOME", "/home/someone");
  {
    const ScopedVariable cache("XDG_CACHE_HOME", "/var/cache/someone");
    EXPECT_EQ(cache_folder(), "/var/cache/someone/wholehand");
  }
  for (const char* no_path : {static_cast<const char*>(nullptr), "", "relative/path"}) {
    const ScopedVariable cache("XDG_CACHE_HOME", no_path);
    EXPECT_EQ(cache_folder(), "/home/someone/.cache/wholehand");
  }
}

TEST_F(CacheFolder, IsNowhereWithoutAHome) {
  const ScopedVariable cache("XDG_CACHE_HOME", nullptr);
  for (const char* no_path : {static_cast<const char*>(nullptr), "", "here"}) {
    const ScopedVariable home("HOME", no_path);
    EXPECT_EQ(cache_folder(), "");
  }
}

TEST_F(CacheFolder, UnusedForLongestGoesFirst) {
  const fs::path old = add("grids/" + key('a') + ".grid", 100, 5), pipelines = add(key('b') + "-123.pipelines", 100, 6),
                 recent = add("grids/" + key('c') + ".grid", 100, 1);
  EXPECT_EQ(cache_use(folder.string()).files, 3u);
  EXPECT_EQ(cache_use(folder.string()).bytes, 300u);
  make_cache_room(folder.string(), 100, 400);
  EXPECT_EQ(cache_use(folder.string()).files, 3u) << "all fit";
  touch_cached(pipelines.string());
  make_cache_room(folder.string(), 100, 399);
  EXPECT_FALSE(fs::exists(old));
  EXPECT_TRUE(fs::exists(pipelines) && fs::exists(recent));
  make_cache_room(folder.string(), 0, 100);
  EXPECT_FALSE(fs::exists(recent));
  EXPECT_TRUE(fs::exists(pipelines)) << "used just now";
}

TEST_F(CacheFolder, OnlyFilesOfItsOwnNamesCountAndGo) {
  for (const std::string& name : std::vector<std::string>{
           key('a'), key('a') + ".txt", key('a') + "a.grid", "notes.grid", key('g') + ".grid", key('a') + "-x.pipelines",
           key('a') + "-1.pipelines.bak", key('a') + ".grid.old", "mine.pipelines"}) {
    add(name, 1000, 100);
    add("grids/" + name, 1000, 100);
  }
  const fs::path aim = add("aim", 1000, 100), link = folder / (key('e') + ".grid");
  fs::create_symlink(aim, link);
  fs::create_directories(folder / "grids" / (key('f') + ".grid"));
  const auto all = std::distance(fs::recursive_directory_iterator(folder), {});
  EXPECT_EQ(cache_use(folder.string()).files, 0u);
  make_cache_room(folder.string(), 1, 0);
  EXPECT_EQ(std::distance(fs::recursive_directory_iterator(folder), {}), all);
}

TEST_F(CacheFolder, WhatWasBegunLongAgoGoesAndWhatIsBeingWrittenStays) {
  const fs::path left_over = add("grids/" + key('a') + ".Ab3dEf.partial", 10, 2),
                 begun = add("grids/" + key('b') + ".Ab3dEf.partial", 10, 0),
                 abandoned = add(key('c') + "-5.pipelines.4711", 10, 2), whole = add(key('d') + ".grid", 100, 0);
  make_cache_room(folder.string(), 0, 110);
  EXPECT_FALSE(fs::exists(left_over) || fs::exists(abandoned));
  EXPECT_TRUE(fs::exists(begun) && fs::exists(whole));
  make_cache_room(folder.string(), 0, 109);
  EXPECT_TRUE(fs::exists(begun));
  EXPECT_FALSE(fs::exists(whole)) << "what is being written counts";
}

TEST_F(CacheFolder, AFileThatIsOpenStaysReadable) {
  const fs::path file = add(key('a') + ".grid", 5000, 1);
  std::ifstream open(file, std::ios::binary);
  make_cache_room(folder.string(), 0, 0);
  EXPECT_FALSE(fs::exists(file));
  EXPECT_EQ(std::distance(std::istreambuf_iterator<char>(open), {}), 5000);
}

TEST_F(CacheFolder, WithoutAFolderThereIsNothing) {
  EXPECT_EQ(cache_use("/proc/nonexistent").files, 0u);
  make_cache_room("/proc/nonexistent", 1, 0);
  touch_cached("/proc/nonexistent");
}

TEST_F(CacheFolder, TheLimitIsTheUsers) {
  for (const char* given : {static_cast<const char*>(nullptr), ""}) {
    const ScopedVariable unset("WHOLEHAND_CACHE_MIB", given);
    EXPECT_EQ(cache_limit(), std::uintmax_t{1} << 30);
  }
  const ScopedVariable two("WHOLEHAND_CACHE_MIB", "2");
  EXPECT_EQ(cache_limit(), 2u << 20);
  for (const char* wrong : {"-1", "1.5", "2 GB", "0x10", " 1", "1000000001", "99999999999999999999999"}) {
    const ScopedVariable variable("WHOLEHAND_CACHE_MIB", wrong);
    try {
      cache_limit();
      ADD_FAILURE() << wrong;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      EXPECT_NE(std::string(error.what()).find("WHOLEHAND_CACHE_MIB '" + std::string(wrong) + "'; allowed: a whole number"),
                std::string::npos)
          << error.what();
    }
  }
}

TEST_F(CacheFolder, IsSaidInOneLine) {
  const ScopedVariable cache("XDG_CACHE_HOME", folder.c_str()), limit("WHOLEHAND_CACHE_MIB", "300");
  fs::create_directories(folder / "wholehand/grids");
  EXPECT_EQ(cache_text(), "cache  " + folder.string() + "/wholehand  0.0 MiB in 0 files, at most 300 MiB (WHOLEHAND_CACHE_MIB)\n");
  add("wholehand/grids/" + key('a') + ".grid", 3 << 19, 0);
  EXPECT_NE(cache_text().find("  1.5 MiB in 1 file, "), std::string::npos);
  const ScopedVariable off("WHOLEHAND_CACHE_MIB", "0");
  EXPECT_NE(cache_text().find(", not used (WHOLEHAND_CACHE_MIB)"), std::string::npos);
  const ScopedVariable nowhere("XDG_CACHE_HOME", nullptr), homeless("HOME", nullptr);
  EXPECT_NE(cache_text().find("none: "), std::string::npos);
}

}  // namespace
}  // namespace wholehand
