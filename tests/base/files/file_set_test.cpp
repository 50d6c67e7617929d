// SPDX-License-Identifier: MIT
#include "base/files/file_set.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/files.h"
#include "tests/support/refusal.h"

namespace wholehand {
namespace {

int files_in(const TemporaryFolder& folder) {
  int count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++count;
  return count;
}

class FileSetTest : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"a", "b", "c"}) write_file(folder / name, "old");
  }
  TemporaryFolder folder;
};

TEST_F(FileSetTest, StandsOnceAllAreWhole) {
  FileSet set;
  for (const char* name : {"a", "b"}) set.write(folder / name, "new", "make room");
  set.remove_on_commit(folder / "c");
  for (const char* name : {"a", "b", "c"}) EXPECT_EQ(file_text(folder / name), "old") << name;
  set.commit("make room");
  for (const char* name : {"a", "b"}) EXPECT_EQ(file_text(folder / name), "new") << name;
  EXPECT_EQ(files_in(folder), 2) << "the third one is gone, and no other names are left";
}

TEST_F(FileSetTest, TakesAFilePieceByPiece) {
  {
    FileSet set;
    set.append(folder / "a", "lost", "make room");
  }
  FileSet set;
  set.append(folder / "a", "one", "make room");
  set.append(folder / "b", "other", "make room");
  set.append(folder / "a", ", two", "make room");
  EXPECT_EQ(file_text(folder / "a"), "old");
  set.commit("make room");
  EXPECT_EQ(file_text(folder / "a"), "one, two");
  EXPECT_EQ(file_text(folder / "b"), "other");
  EXPECT_EQ(refusal_line([&] { set.append(folder / "none/a", "x", "make room"); }, ExitCode::failure),
            "cannot write " + (folder / "none/a") + ": No such file or directory; make room");
}

TEST_F(FileSetTest, GivenUpItLeavesWhatWasThere) {
  {
    FileSet set;
    write_file(set.temporary_path(folder / "a"), "new");
    set.temporary_path(folder / "b");
    set.remove_on_commit(folder / "c");
  }
  for (const char* name : {"a", "b", "c"}) EXPECT_EQ(file_text(folder / name), "old") << name;
  EXPECT_EQ(files_in(folder), 3);
}

// One of them is not there, as if the disk had not taken it.
TEST_F(FileSetTest, NoneGetsItsNameWhereOneFails) {
  FileSet set;
  write_file(set.temporary_path(folder / "a"), "new");
  set.temporary_path(folder / "b");
  EXPECT_EQ(refusal_line([&] { set.commit("make room"); }, ExitCode::failure),
            "cannot write " + (folder / "b") + ": No such file or directory; make room");
  EXPECT_EQ(file_text(folder / "a"), "old");
}

// As one that was killed leaves it, whatever its number was.
TEST_F(FileSetTest, WhatAnotherProcessLeftIsOverwritten) {
  write_file(folder / "a.new", "left");
  EXPECT_EQ(FileSet::temporary_name(folder / "a"), folder / "a.new");
  FileSet set;
  set.write(folder / "a", "new", "make room");
  set.commit("make room");
  EXPECT_EQ(file_text(folder / "a"), "new");
  EXPECT_EQ(files_in(folder), 3);
}

TEST_F(FileSetTest, WhatCannotBeWrittenIsNamedWithTheRemedy) {
  std::filesystem::create_directories(folder / "a.new/b");
  EXPECT_EQ(refusal_line([&] { FileSet().write(folder / "a", "new", "make room"); }, ExitCode::failure),
            "cannot write " + (folder / "a") + ": File exists; make room");
  EXPECT_EQ(file_text(folder / "a"), "old");
}

TEST_F(FileSetTest, WhatCannotBeRenamedIsNamedWithTheRemedy) {
  FileSet set;
  for (const char* name : {"a", "b"}) set.write(folder / name, "new", "make room");
  std::filesystem::remove(folder / "a");
  std::filesystem::create_directories(folder / "a/b");
  EXPECT_EQ(refusal_line([&] { set.commit("make room"); }, ExitCode::failure),
            "cannot write " + (folder / "a") + ": Is a directory; make room");
  EXPECT_EQ(file_text(folder / "b"), "old");
}

TEST_F(FileSetTest, WhatIsGivenUpAfterAllIsNotInTheSet) {
  FileSet set;
  write_file(set.temporary_path(folder / "a"), "new");
  write_file(set.temporary_path(folder / "b"), "half");
  set.remove_on_commit(folder / "b");
  set.commit("make room");
  EXPECT_EQ(file_text(folder / "a"), "new");
  EXPECT_FALSE(file_exists(folder / "b"));
}

TEST_F(FileSetTest, ALinkStaysALink) {
  std::filesystem::create_directory(folder / "elsewhere");
  std::filesystem::create_symlink("elsewhere/data", folder / "link");
  FileSet set;
  write_file(set.temporary_path(folder / "link"), "new");
  set.commit("make room");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(file_text(folder / "elsewhere/data"), "new");
}

TEST_F(FileSetTest, MessagesNameTheFilesThemselves) {
  FileSet set;
  const std::string a = set.temporary_path(folder / "a");
  EXPECT_EQ(set.with_own_names("x " + a + " y " + a), "x " + (folder / "a") + " y " + (folder / "a"));
}

}  // namespace
}  // namespace wholehand
