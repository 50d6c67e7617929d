#include "sweeps/files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "tests/support/result_reader.h"

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

TEST(Files, NamesGoTogether) {
  const OutputNames names = output_names("out/three.nc");
  EXPECT_EQ(names.partial, "out/three.nc.partial");
  EXPECT_EQ(names.mark, "out/three.nc.partial.mark");
  EXPECT_EQ(names.best, "out/three.best.csv");
  EXPECT_EQ(names.heat_map("beaker1"), "out/three.beaker1.svg");
  EXPECT_EQ(output_names("three").best, "three.best.csv");
  EXPECT_EQ(output_names(".nc").best, ".nc.best.csv");
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
  std::ofstream(folder / "file") << "x";
  EXPECT_EQ(refused_folder(folder / "file"), ExitCode::usage);
  EXPECT_EQ(refused_folder(folder / "file/new"), ExitCode::usage);
  EXPECT_EQ(refused_folder(""), ExitCode::usage);
  EXPECT_EQ(refused_folder("/proc/wholehand"), ExitCode::usage) << "no such file or directory, says the kernel";
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
  EXPECT_FALSE(file_exists(folder / "folder.new"));
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
