// SPDX-License-Identifier: MIT
#include "base/files/pictures.h"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/files/files.h"
#include "tests/support/environment.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"

namespace wholehand {
namespace {

std::string some_picture() { return "<svg><title>a</title>" + std::string(PICTURE_MARK) + "</svg>\n"; }

std::ptrdiff_t entries_of(const TemporaryFolder& folder) {
  return std::distance(std::filesystem::directory_iterator(folder.path()), {});
}

TEST(Pictures, AreWrittenWhole) {
  const TemporaryFolder folder;
  const std::string first = folder / "it's a line.svg", second = folder / "b.svg";
  std::ofstream(second) << "of before";
  EXPECT_EQ(write_pictures({{first, some_picture()}, {second, some_picture()}}), "");
  EXPECT_EQ(file_text(first), some_picture());
  EXPECT_EQ(file_text(second), some_picture());
  EXPECT_EQ(entries_of(folder), 2) << "nothing else is left";
  EXPECT_EQ(write_pictures({}), "");
}

TEST(Pictures, FailureIsASentenceAndLeavesNothing) {
  const TemporaryFolder folder;
  const std::string file = folder / "missing/a.svg";
  EXPECT_EQ(write_pictures({{file, some_picture()}}),
            "no picture: cannot write " + file + ": No such file or directory; make room, or name another file");
  EXPECT_EQ(entries_of(folder), 0);
}

TEST(Pictures, AFullDiskLeavesWhatWasThere) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.svg";
  std::ofstream(file) << some_picture();
  const auto before = std::signal(SIGXFSZ, SIG_IGN);
  std::string failure;
  {
    const FileSizeLimit limit(1000);
    failure = write_pictures({{file, std::string(5000, ' ')}});
  }
  std::signal(SIGXFSZ, before);
  EXPECT_EQ(failure, "no picture: cannot write " + file + ": File too large; make room, or name another file");
  EXPECT_EQ(file_text(file), some_picture());
  EXPECT_EQ(entries_of(folder), 1) << "no half of it is left";
}

TEST(Pictures, WhatLiesAtTheTemporaryNameStays) {
  const TemporaryFolder folder;
  const std::string first = folder / "a.svg", second = folder / "b.svg", mine = folder / "mine";
  std::ofstream(mine) << "mine";
  const std::string link = temporary_name(second);
  std::filesystem::create_symlink(mine, link);
  EXPECT_EQ(write_pictures({{first, some_picture()}, {second, some_picture()}}),
            "no picture: cannot write " + second + ": File exists; make room, or name another file");
  EXPECT_EQ(file_text(mine), "mine");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(file_text(first), some_picture()) << "the others are there";
  EXPECT_EQ(entries_of(folder), 3);
}

TEST(Pictures, SeveralThatAreMissingAreCounted) {
  const TemporaryFolder folder;
  const std::string none = folder / "missing/a.svg";
  const std::string failure = write_pictures({{none, "a"}, {folder / "b.svg", "b"}, {folder / "missing/c.svg", "c"}});
  EXPECT_TRUE(failure.starts_with("2 of 3 pictures are missing: cannot write " + none + ": ")) << failure;
}

}  // namespace
}  // namespace wholehand
