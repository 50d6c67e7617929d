// SPDX-License-Identifier: MIT
// Result files that are resumed, killed, changed, or out of room.
#include "sweeps/result/result_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include "base/text/error.h"
#include "tests/support/fake_backend.h"
#include "tests/support/files.h"
#include "tests/support/result_reader.h"
#include "tests/support/sweep_file.h"

namespace wholehand::sweeps {
namespace {

TEST(ResultFile, ResumedInPartsIsTheSame) {
  const TemporaryFolder folder;
  SweepFile whole(fake_scene(), folder / "whole.nc"), parts(fake_scene(), folder / "parts.nc", Precision::full, 13);
  {
    ResultFile file = whole.open();
    whole.write_all(file);
    file.finish();
  }
  {
    ResultFile file = parts.open();
    parts.write(file, 0, 0, 150);
  }
  {
    ResultFile file = parts.open(true);
    parts.write(file, 0, 150, parts.plan.grips());
  }
  {
    ResultFile file = parts.open(true);
    parts.write(file, 1, 0, parts.plan.grips());
    file.write_ending({{}, {}}, 1, 1);
    file.finish();
  }
  expect_same_values(folder / "whole.nc", folder / "parts.nc");
}

// A process that is killed while it writes leaves a file that opens, and what it had synced is there.
TEST(ResultFile, KilledAtAnyMomentItCanBeOpened) {
  const TemporaryFolder folder;
  std::mt19937 random(1);
  for (int round = 0; round < 12; ++round) {
    int synced[2];
    ASSERT_EQ(pipe(synced), 0);
    const pid_t child = fork();
    if (child == 0) {
      SweepFile setup(fake_scene(), folder / "a.nc", Precision::full, 5);
      ResultFile file = setup.open();
      setup.write(file, 0, 0, setup.plan.grips());
      file.sync();
      if (write(synced[1], "x", 1) != 1) _exit(1);
      for (;;) {
        setup.write_all(file);
        file.sync();
      }
    }
    char c = 0;
    ASSERT_EQ(read(synced[0], &c, 1), 1);
    usleep(random() % 20000);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    close(synced[0]);
    close(synced[1]);
    EXPECT_FALSE(file_exists(folder / "a.nc"));
    const SweepFile setup(fake_scene(), folder / "b.nc");
    for (const std::string& name : variable_names(folder / "a.nc.partial")) {
      if (name != "vessel" && name != "joint" && name != "xyz" && name != "contact" && name != CHECKSUMS)
        read_values(folder / "a.nc.partial", name);
    }
    const Variable& score = *setup.variables.front();
    const auto expected = expected_values(setup, score), found = read_values(folder / "a.nc.partial", "score");
    EXPECT_TRUE(
        std::equal(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(setup.plan.stored_grips()), expected.begin()));
  }
}

TEST(ResultFile, StretchesAreKnownAgainHoweverTheyWereWritten) {
  const TemporaryFolder folder;
  SweepFile one(fake_scene(), folder / "one.nc", Precision::full, 97),
      other(fake_scene(), folder / "other.nc", Precision::full, 13);
  ResultFile file = one.open(), pieces = other.open();
  one.write(file, 1, 20, 170);
  const Stretch stretch = file.stretch();
  EXPECT_EQ(stretch.first, 20u);
  EXPECT_EQ(stretch.last, 170u);
  other.write(pieces, 1, 20, 90);
  other.write(pieces, 1, 90, 170);
  EXPECT_EQ(pieces.stretch().checksum, stretch.checksum) << "where chunks end does not count";
  EXPECT_TRUE(file.holds(1, stretch));
  EXPECT_FALSE(file.holds(0, stretch));
  EXPECT_FALSE(file.holds(1, {20, 169, stretch.checksum}));
  one.write(file, 1, 170, 200);
  EXPECT_EQ(file.stretch().first, 20u) << "it grows";
  EXPECT_TRUE(file.holds(1, stretch)) << "and the first part of it is what it was";
  file.end_stretch();
  one.write(file, 1, 200, 210);
  EXPECT_EQ(file.stretch().first, 200u);
}

// Any byte of the file is vouched for: by a stretch, or as structure.
TEST(ResultFile, EveryChangedByteIsNoticed) {
  const TemporaryFolder folder;
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 60;
  SweepFile setup(scene, folder / "a.nc");
  ResultFile file = setup.open();
  std::vector<Stretch> stretches;
  for (std::size_t v = 0; v < 2; ++v) {
    setup.write(file, v, 0, setup.plan.grips());
    stretches.push_back(file.stretch());
  }
  SweepMark mark;
  file.vouch_for_structure(mark);
  const auto is_as_written = [&] {
    return has_structure(setup.names.partial, mark) && file.holds(0, stretches[0]) && file.holds(1, stretches[1]);
  };
  ASSERT_TRUE(is_as_written());
  const std::string whole = file_text(setup.names.partial);
  const FileRange room = file.places().checksums;  // written last
  std::mt19937 random(3);
  int missed = 0;
  for (int k = 0; k < 120; ++k) {
    const std::size_t at = random() % whole.size();
    if (at - room.offset < room.size) continue;
    std::fstream bytes(setup.names.partial, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(at)).put(static_cast<char>(whole[at] ^ 4)).flush();
    missed += is_as_written();
    bytes.seekp(static_cast<std::streamoff>(at)).put(whole[at]).flush();
  }
  EXPECT_LE(missed, 3) << "only the best grips' places, which are written last, are not vouched for";
  std::filesystem::resize_file(setup.names.partial, whole.size() - 1);
  EXPECT_FALSE(is_as_written());
  std::filesystem::resize_file(setup.names.partial, whole.size());
}

TEST(ResultFile, FileSizeLimitIsFoundBeforeTheFirstGrip) {
  const TemporaryFolder folder;
  struct stat status {};
  {
    SweepFile setup(fake_scene(), folder / "size.nc");
    setup.open();
    stat((folder / "size.nc.partial").c_str(), &status);
  }
  // in turn: nothing, a part, or almost all of the structure remains
  for (const rlim_t limit : {rlim_t{100}, rlim_t{20000}, static_cast<rlim_t>(status.st_size - 1)}) {
    EXPECT_EQ(in_child([&] {
                std::signal(SIGXFSZ, SIG_IGN);
                const rlimit size{limit, limit};
                setrlimit(RLIMIT_FSIZE, &size);
                if (freopen((folder / "stderr").c_str(), "w", stderr) == nullptr) return 98;
                SweepFile setup(fake_scene(), folder / "a.nc");
                try {
                  setup.open();
                } catch (const Error& error) {
                  return static_cast<int>(error.code);
                }
                return 0;
              }),
              3)
        << limit;
    EXPECT_FALSE(file_exists(folder / "a.nc"));
    EXPECT_FALSE(file_exists(folder / "a.nc.partial")) << limit;
    EXPECT_EQ(file_text(folder / "stderr"), "");
  }
}

TEST(ResultFile, DiskThatFillsUpLaterIsAnErrorAndTheFileGoesOn) {
  const TemporaryFolder folder;
  EXPECT_EQ(in_child([&] {
              std::signal(SIGXFSZ, SIG_IGN);
              SweepFile setup(fake_scene(), folder / "a.nc");
              ResultFile file = setup.open();
              const rlimit size{40000, 1 << 30};
              setrlimit(RLIMIT_FSIZE, &size);
              try {
                setup.write_all(file);
              } catch (const Error& error) {
                return std::strstr(error.what(), "--resume") ? static_cast<int>(error.code) : 99;
              }
              return 0;
            }),
            3);
  EXPECT_FALSE(file_exists(folder / "a.nc"));
  SweepFile setup(fake_scene(), folder / "a.nc");
  ResultFile file = setup.open(true);
  setup.write_all(file);
  file.finish();
  expect_expected(setup, folder / "a.nc");
}

TEST(ResultFile, LinkUnderItsNameIsReplacedNotFollowed) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/full", folder / "a.nc.partial");
  SweepFile setup(fake_scene(), folder / "a.nc");
  ResultFile file = setup.open();
  setup.write_all(file);
  file.finish();
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
  expect_expected(setup, folder / "a.nc");
}

TEST(ResultFile, ResumingWhatIsNoResultFileIsRefused) {
  const TemporaryFolder folder;
  SweepFile setup(fake_scene(), folder / "a.nc");
  EXPECT_THROW(setup.open(true), Error) << "not there";
  std::ofstream(folder / "a.nc.partial") << "not NetCDF";
  EXPECT_THROW(setup.open(true), Error);
  Scene other = fake_scene();
  other.output.keep = {{"gap"}};
  { SweepFile(other, folder / "a.nc").open(); }
  EXPECT_THROW(setup.open(true), Error) << "other variables";
}

}  // namespace
}  // namespace wholehand::sweeps
