// SPDX-License-Identifier: MIT
#include "base/files/files.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/text/error.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"

namespace wholehand {
namespace {

ExitCode refused(const std::string& path) {
  try {
    check_output_path(path);
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.code;
  }
  return ExitCode::done;
}

TEST(Files, OnlyResultsAreOverwritten) {
  const TemporaryFolder folder;
  std::ofstream(folder / "notes.txt") << "my notes, and more of them";
  std::ofstream(folder / "empty");
  std::ofstream(folder / "result.nc") << "\x89HDF\r\n\x1a\nand so on";
  EXPECT_THROW(check_overwrites_result(folder / "notes.txt"), Error);
  EXPECT_NO_THROW(check_overwrites_result(folder / "empty"));
  EXPECT_NO_THROW(check_overwrites_result(folder / "missing"));
  EXPECT_NO_THROW(check_overwrites_result(folder / "result.nc"));
}

TEST(Files, FoldersAreMadeOrRefused) {
  const TemporaryFolder folder;
  const auto refused_folder = [](const std::string& path) {
    try {
      make_output_folder(path);
    } catch (const Error& error) {
      return error.code;
    }
    return ExitCode::done;
  };
  EXPECT_EQ(refused_folder(folder / "new"), ExitCode::done);
  EXPECT_TRUE(std::filesystem::is_directory(folder / "new"));
  EXPECT_EQ(refused_folder(folder / "new"), ExitCode::done) << "there already";
  EXPECT_EQ(refused_folder(folder / "missing/new"), ExitCode::usage);
  try {
    make_output_folder(folder / "missing/new/");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.what(),
              "-o " + (folder / "missing/new/") + ": " + (folder / "missing") + " is not a directory; create it or name another");
  }
  std::ofstream(folder / "file") << "x";
  EXPECT_EQ(refused_folder(folder / "file"), ExitCode::usage);
  EXPECT_EQ(refused_folder(folder / "file/new"), ExitCode::usage);
  EXPECT_EQ(refused_folder(""), ExitCode::usage);
  EXPECT_EQ(refused_folder("-"), ExitCode::usage) << "standard output";
  EXPECT_FALSE(std::filesystem::exists("-"));
  EXPECT_EQ(refused_folder("/proc/wholehand"), ExitCode::usage) << "no such file or directory, says the kernel";
}

// One that may not be looked into is not "no directory".
TEST(Files, AFolderInOneThatMayNotBeLookedIntoIsAFailure) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "locked/parent");
  std::filesystem::permissions(folder / "locked", std::filesystem::perms::none);
  const bool is_root = geteuid() == 0;  // root may read anywhere
  if (is_root && seteuid(65534) != 0) GTEST_SKIP() << "root cannot become another user here";
  const std::string path = folder / "locked/parent/new", line = refusal_line([&] { make_output_folder(path); }, ExitCode::failure);
  if (is_root) {
    ASSERT_EQ(seteuid(0), 0);
  }
  std::filesystem::permissions(folder / "locked", std::filesystem::perms::owner_all);
  EXPECT_EQ(line, "-o " + path + ": cannot make that folder: Permission denied; name one elsewhere");
}

TEST(Files, PathsThatCannotBecomeFilesAreRefused) {
  const TemporaryFolder folder;
  EXPECT_EQ(refused(folder / "new.nc"), ExitCode::done);
  EXPECT_EQ(refused(folder.path()), ExitCode::usage) << "a directory";
  EXPECT_EQ(refused(folder / "missing/new.nc"), ExitCode::usage);
  EXPECT_EQ(refused(folder / ""), ExitCode::usage);
  EXPECT_EQ(refused("/dev/full"), ExitCode::usage) << "a device: never renamed over";
  std::ofstream(folder / "file") << "x";
  EXPECT_EQ(refused(folder / "file"), ExitCode::done) << "overwritten by the final rename";
  EXPECT_EQ(refused(folder / "file/new.nc"), ExitCode::usage);
  EXPECT_EQ(refused("/proc/new.nc"), ExitCode::failure) << "root may write anywhere, but no file can be made there";
}

TEST(Files, LinksAreFollowedToFiles) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "data");
  std::filesystem::create_symlink("data/target", folder / "link");
  std::filesystem::create_symlink("link", folder / "again");
  EXPECT_EQ(followed(folder / "again"), folder / "data/target");
  EXPECT_EQ(followed(folder / "plain"), folder / "plain");
  EXPECT_EQ(refused(folder / "again"), ExitCode::done) << "what it points to need not be there";
  write_whole_file(folder / "again", "text", false);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "again"));
  EXPECT_EQ(file_text(folder / "data/target"), "text");
  std::filesystem::create_symlink("/dev/null", folder / "null");
  EXPECT_EQ(refused(folder / "null"), ExitCode::usage);
  std::filesystem::create_symlink("round", folder / "round");
  EXPECT_EQ(refused(folder / "round"), ExitCode::usage);
  std::filesystem::create_symlink("missing/file", folder / "nowhere");
  EXPECT_EQ(refused(folder / "nowhere"), ExitCode::usage);
}

TEST(Files, WhatIsNoRegularFileIsRefused) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(refused(folder / "pipe"), ExitCode::usage);
  EXPECT_EQ(refused("/dev/stdout"), ExitCode::usage);
  EXPECT_EQ(refused("-"), ExitCode::usage);
  // standard output that is a file: what is printed goes there, and no result
  const int file = open((folder / "out").c_str(), O_WRONLY | O_CREAT, 0600), before = dup(STDOUT_FILENO);
  dup2(file, STDOUT_FILENO);
  for (const char* path : {"/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}) EXPECT_EQ(refused(path), ExitCode::usage) << path;
  dup2(before, STDOUT_FILENO);
  close(file);
  close(before);
  EXPECT_THROW(check_overwrites_kind(folder / "pipe", "x", "list", "-o"), Error) << "and does not wait for who writes";
}

TEST(Files, OnlyEmptyFilesAreRenamedOnto) {
  const TemporaryFolder folder;
  std::ofstream(folder / "from") << "new";
  std::ofstream(folder / "there") << "old";
  std::ofstream(folder / "empty").close();
  EXPECT_FALSE(rename_onto_nothing(folder / "from", folder / "there"));
  EXPECT_EQ(file_text(folder / "there"), "old");
  EXPECT_TRUE(rename_onto_nothing(folder / "from", folder / "empty"));
  EXPECT_TRUE(rename_onto_nothing(folder / "empty", folder / "nothing"));
  EXPECT_EQ(file_text(folder / "nothing"), "new");
  EXPECT_THROW(rename_onto_nothing(folder / "missing", folder / "other"), Error);
}

TEST(Files, WholeOrNotAtAll) {
  const TemporaryFolder folder;
  const std::string path = folder / "a";
  write_whole_file(path, "one", false);
  EXPECT_EQ(file_text(path), "one");
  write_whole_file(path, "two", true);
  EXPECT_EQ(file_text(path), "two");
  EXPECT_THROW(write_whole_file(folder / "missing/a", "x", false), Error);
  EXPECT_THROW(write_whole_file("/proc/a", "x", false), Error);
  std::filesystem::create_directory(folder / "folder");
  EXPECT_THROW(write_whole_file(folder / "folder", "x", false), Error);
  std::ofstream(folder / "a.new") << "mine";
  write_whole_file(path, "three", false);
  EXPECT_EQ(file_text(folder / "a.new"), "mine") << "names of others on the way";
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files;
  EXPECT_EQ(files, 3u) << "nothing is left";
}

TEST(Files, RoomIsTriedAndGivenBack) {
  const TemporaryFolder folder;
  EXPECT_NO_THROW(check_room(folder / "a", 1 << 20));
  EXPECT_FALSE(file_exists(folder / "a"));
  EXPECT_THROW(check_room(folder / "missing/a", 1), Error);
  EXPECT_THROW(check_room(folder / "a", std::uint64_t{1} << 61), Error);
  EXPECT_FALSE(file_exists(folder / "a"));
  std::ofstream(folder / "a") << "x";
  EXPECT_THROW(check_room(folder / "a", 1), Error);
  EXPECT_EQ(file_text(folder / "a"), "x") << "nothing that is there is touched";
}

TEST(Files, FreeBytesAreThoseOfTheDisk) {
  const TemporaryFolder folder;
  EXPECT_GT(free_bytes(folder / "new.nc"), 1e6);
}

}  // namespace
}  // namespace wholehand
