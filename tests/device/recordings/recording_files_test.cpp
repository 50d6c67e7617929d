// SPDX-License-Identifier: MIT
// The file of a recording: it outlives the process and a full disk, and is never taken for whole where it is not.
// sanitizers: thread
#include "device/recordings/recording.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <netcdf.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "base/text/error.h"
#include "tests/support/environment.h"
#include "tests/support/files.h"
#include "tests/support/recorded_ticks.h"

namespace wholehand::device {
namespace {

// Killed with SIGKILL, at whatever it was doing then: the file holds whole blocks, in order.
TEST(Recording, OutlivesTheProcess) {
  const TemporaryFolder folder;
  for (int round = 0; round < 5; ++round) {
    const std::string path = (folder / fmt::format("{}.nc", round));
    int begun[2] = {};
    ASSERT_EQ(pipe(begun), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      RecordingWriter writer(path, recorded_info(2));
      std::vector<Tick> block(64);
      for (std::int64_t number = 0;;) {
        const bool is_first = number == 0;
        for (Tick& tick : block) tick.number = tick.device.sequence = static_cast<std::uint32_t>(++number);
        writer.append(block);
        if (is_first && write(begun[1], "x", 1) != 1) _exit(1);
      }
    }
    char first = 0;
    ASSERT_EQ(read(begun[0], &first, 1), 1);  // however busy the machine is
    close(begun[0]);
    close(begun[1]);
    usleep(static_cast<useconds_t>(10000 + 7000 * round));
    kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_FALSE(std::filesystem::exists(path)) << "looks finished";
    const Recording recording = read_recording(path + ".partial");
    EXPECT_GT(recording.ticks.size(), 0u);
    int file = -1;
    std::size_t records = 0;
    EXPECT_EQ(nc_open((path + ".partial").c_str(), NC_NOWRITE, &file), NC_NOERR);
    EXPECT_EQ(nc_inq_dimlen(file, 0, &records), NC_NOERR);
    EXPECT_LE(records, recording.ticks.size()) << "for everybody else, the blocks that were counted";
    nc_close(file);
    EXPECT_EQ(records % 64, 0u);
    const std::size_t bytes = std::filesystem::file_size(path + ".partial");
    for (std::size_t k = 0; k < recording.ticks.size(); ++k) ASSERT_EQ(recording.ticks[k].device.sequence, k + 1);
    // no more than the block under way is lost
    const double per_tick = 792 + 24 * 2;
    EXPECT_LT(static_cast<double>(bytes), (static_cast<double>(recording.ticks.size()) + 64) * per_tick + 20000);
  }
}

TEST(Recording, EndsWhereTheDiskIsFull) {
  const TemporaryFolder folder;
  const auto ticks = RandomTicks(5).some(500, 2);
  const std::string path = folder / "a.nc";
  std::size_t kept = 0;
  {
    const FileSizeLimit limit(120000);
    RecordingWriter writer(path, recorded_info(2));
    EXPECT_TRUE(writer.append(std::span(ticks).first(20)));
    EXPECT_FALSE(writer.append(std::span(ticks).subspan(20)));
    EXPECT_EQ(writer.last_error(), path + ": recording ended: File too large; it is complete up to here");
    kept = writer.records();
    EXPECT_GT(kept, 100u) << "what still fits is kept";
    EXPECT_LE(writer.bytes(), 120000u);
    EXPECT_GT(writer.bytes() + writer.record_size(), 120000u);
    EXPECT_FALSE(writer.append(std::span(ticks).subspan(490))) << "nothing behind a gap";
    EXPECT_EQ(writer.records(), kept);
    EXPECT_TRUE(writer.finish(recorded_end()));
  }
  EXPECT_FALSE(std::filesystem::exists(path + ".partial"));
  const Recording recording = read_recording(path);
  expect_same_ticks(recording.ticks, {ticks.begin(), ticks.begin() + static_cast<std::ptrdiff_t>(kept)});
  ASSERT_TRUE(recording.end);
  EXPECT_EQ(recording.end->missed, 17);
  EXPECT_EQ(recording.end->early, "File too large");
  EXPECT_EQ(recording.note, path + " ended before the session: File too large");
}

TEST(Recording, SaysWhenItCannotStart) {
  const TemporaryFolder folder;
  const FileSizeLimit limit(1000);
  try {
    RecordingWriter writer(folder / "a.nc", recorded_info(2));
    ADD_FAILURE() << "started";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::failure);
    EXPECT_NE(std::string(error.what()).find("cannot record: File too large"), std::string::npos) << error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.nc.partial"));
}

TEST(Recording, OverwritesNothing) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.nc";
  const auto refused = [&path] {
    try {
      RecordingWriter writer(path, recorded_info(2));
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      return std::string(error.what());
    }
    return std::string("taken");
  };
  write_file(path, "a letter");
  EXPECT_NE(refused().find("is not overwritten"), std::string::npos);
  EXPECT_EQ(file_text(path), "a letter");
  std::filesystem::remove(path);
  write_file(path + ".partial", "");
  EXPECT_NE(refused().find("exists, from a session that was killed or is still running"), std::string::npos);
  std::filesystem::remove(path + ".partial");
  write_file(path, "");  // as mktemp leaves it
  EXPECT_EQ(refused(), "taken");
  std::filesystem::remove(path + ".partial");
  EXPECT_THROW(check_recording_path(folder / "no/such/folder.nc"), Error);
  EXPECT_THROW(check_recording_path(folder / ""), Error);
}

// A file that appears under the recording's name during the session belongs to somebody else.
TEST(Recording, WhatAppearsMeanwhileStays) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.nc";
  const auto ticks = RandomTicks(6).some(20, 2);
  RecordingWriter writer(path, recorded_info(2));
  EXPECT_TRUE(writer.append(ticks));
  write_file(path, "a letter");
  EXPECT_FALSE(writer.finish(recorded_end()));
  EXPECT_EQ(writer.last_error(),
            path + ": another file appeared there during the session, and is not overwritten; the complete recording is " + path +
                ".partial");
  EXPECT_EQ(file_text(path), "a letter");
  EXPECT_TRUE(writer.is_whole());
  EXPECT_EQ(writer.place(), path + ".partial");
  expect_same_ticks(read_recording(path + ".partial").ticks, ticks);
}

TEST(Recording, APartialFileThatIsTakenAwayIsNotCalledWhole) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.nc", partial = path + ".partial";
  const auto ticks = RandomTicks(7).some(40, 2);
  {
    RecordingWriter writer(path, recorded_info(2));
    EXPECT_TRUE(writer.append(std::span(ticks).first(20)));
    std::filesystem::remove(partial);
    EXPECT_FALSE(writer.append(std::span(ticks).subspan(20)));
    EXPECT_EQ(writer.last_error(),
              path + ": recording ended: " + partial + " was removed or renamed during the session, with all recorded ticks");
    EXPECT_FALSE(writer.finish(recorded_end()));
    EXPECT_FALSE(writer.is_whole());
    EXPECT_EQ(writer.place(), "");
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  RecordingWriter writer(path, recorded_info(2));
  EXPECT_TRUE(writer.append(ticks));
  std::filesystem::rename(partial, folder / "mine");
  write_file(partial, "a letter");
  EXPECT_FALSE(writer.finish(recorded_end()));
  EXPECT_NE(writer.last_error().find("was removed or renamed"), std::string::npos);
  EXPECT_EQ(file_text(partial), "a letter");
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(Recording, APartialFileThatIsCutIsNotCalledWhole) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.nc";
  const auto ticks = RandomTicks(8).some(40, 2);
  RecordingWriter writer(path, recorded_info(2));
  EXPECT_TRUE(writer.append(std::span(ticks).first(20)));
  std::filesystem::resize_file(path + ".partial", writer.bytes() - 9 * writer.record_size() - 5);
  EXPECT_FALSE(writer.append(std::span(ticks).subspan(20))) << "nothing behind a gap";
  EXPECT_NE(writer.last_error().find(".partial was cut to "), std::string::npos) << writer.last_error();
  writer.finish(recorded_end());
  const Recording recording = read_recording(path);
  expect_same_ticks(recording.ticks, {ticks.begin(), ticks.begin() + 10});
  EXPECT_EQ(recording.note, path + " ended before the session: its file was cut");
}

TEST(Recording, ALinkIsFollowed) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.nc", target = folder / "target.nc";
  std::filesystem::create_symlink("target.nc", path);
  const auto ticks = RandomTicks(9).some(5, 2);
  {
    RecordingWriter writer(path, recorded_info(2));
    EXPECT_TRUE(std::filesystem::exists(target + ".partial"));
    EXPECT_TRUE(writer.append(ticks));
    EXPECT_TRUE(writer.finish(recorded_end()));
  }
  EXPECT_TRUE(std::filesystem::is_symlink(path));
  expect_same_ticks(read_recording(target).ticks, ticks);
  EXPECT_THROW(check_recording_path(path), Error) << "with something in it now";
  EXPECT_THROW(check_recording_path("-"), Error);
}

}  // namespace
}  // namespace wholehand::device
