// SPDX-License-Identifier: MIT
// What a result file holds: every value in its place, and the file there only when it is whole.
#include "sweeps/result/result_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>

#include "base/text/error.h"
#include "sweeps/lists/hand_lists.h"
#include "sweeps/lists/refine.h"
#include "tests/support/fake_backend.h"
#include "tests/support/files.h"
#include "tests/support/result_reader.h"
#include "tests/support/sweep_file.h"

namespace wholehand::sweeps {
namespace {

TEST(ResultFile, EveryValueIsInItsPlace) {
  const TemporaryFolder folder;
  for (const Precision precision : {Precision::single, Precision::full}) {
    for (const std::size_t chunk : {1, 7, 97, 10000}) {
      SweepFile setup(fake_scene(), folder / "a.nc", precision, chunk);
      {
        ResultFile file = setup.open();
        setup.write_all(file);
        file.finish();
      }
      expect_expected(setup, folder / "a.nc");
    }
  }
}

// Writers that share a file: one made it, another knows its places, each has its own way to the disk.
TEST(ResultFile, TwoMayWriteIntoOne) {
  struct Counted final : OutputBytes {
    Counted(const std::string& path, std::size_t& sum) : file(open(path.c_str(), O_WRONLY | O_CLOEXEC)), bytes(sum) {}
    ~Counted() override { close(file); }
    int write(const void* data, std::size_t size, std::uint64_t offset) override {
      bytes += size;
      return pwrite(file, data, size, static_cast<off_t>(offset)) == static_cast<ssize_t>(size) ? 0 : errno;
    }
    int sync() override { return fsync(file) == 0 ? 0 : errno; }
    int file;
    std::size_t& bytes;
  };
  const TemporaryFolder folder;
  for (const Precision precision : {Precision::single, Precision::full}) {
    SweepFile setup(fake_scene(), folder / "a.nc", precision);
    std::size_t bytes = 0;
    const OpenOutput counted = [&bytes](const std::string& path) { return std::make_unique<Counted>(path, bytes); };
    ResultFile first(setup.names, setup.contents, setup.backend.fields(), FileStart::reserved);
    {
      ResultFile second(setup.names, setup.contents, setup.backend.fields(), first.places(), counted);
      const std::uint64_t grips = setup.plan.grips(), half = grips / 2;
      for (std::size_t v = 0; v < setup.scene.vessels.size(); ++v) {
        setup.write(first, v, 0, half);
        setup.write(second, v, half, grips);
      }
      second.sync();
      EXPECT_EQ(bytes, second.bytes());
      // what may be listed, from the file and from who computed it
      ASSERT_TRUE(first.has_eligible());
      for (std::size_t v = 0; v < setup.scene.vessels.size(); ++v) {
        std::vector<Candidate> computed;
        RunRequest request;
        request.vessel = v;
        request.last = grips;
        request.grips = [&](std::size_t w, std::uint64_t i, std::size_t n, GripInput* out) { setup.plan.fill(w, i, n, out); };
        request.sink = [&](const PlaneChunk& chunk) { add_eligible(chunk, setup.backend.fields(), computed); };
        setup.backend.run(request);
        std::vector<Candidate> read = first.eligible(v, 0, 10);
        for (const Candidate& grip : second.eligible(v, 10, grips)) read.push_back(grip);
        ASSERT_EQ(read.size(), computed.size());
        for (std::size_t i = 0; i < read.size(); ++i) {
          EXPECT_EQ(read[i].index, computed[i].index);
          EXPECT_EQ(read[i].score, precision == Precision::single ? static_cast<float>(computed[i].score) : computed[i].score);
        }
        EXPECT_GT(read.size(), 10u);
      }
    }
    first.write_ending(BestLists(setup.scene.vessels.size()), 1, 1);
    first.finish();
    expect_expected(setup, folder / "a.nc");
  }
}

TEST(ResultFile, OddShapesAndEveryVariable) {
  const TemporaryFolder folder;
  Scene scene = fake_scene();
  scene.grips.azimuth = range_axis(0, 1, 2);
  scene.grips.height = range_axis(0.1, 0.9, 3);
  scene.grips.roll.values = {0.5};
  scene.grips.offset = range_axis(0, 0.01, 5);
  scene.table.emplace();
  scene.arm.emplace();
  scene.strength.emplace();
  scene.output.keep.emplace();
  for (const Variable& variable : variable_catalogue()) scene.output.keep->push_back(variable.name);
  SweepFile setup(scene, folder / "a.nc", Precision::full, 11);
  EXPECT_EQ(setup.plan.copies(), 1u) << "vectors are kept";
  ResultFile file = setup.open();
  setup.write_all(file);
  file.finish();
  expect_expected(setup, folder / "a.nc");
}

TEST(ResultFile, AzimuthsThatWereLeftOutAreRepeated) {
  const TemporaryFolder folder;
  SweepFile setup(fake_scene(), folder / "a.nc");
  ASSERT_EQ(setup.plan.copies(), 3u);
  ResultFile file = setup.open();
  setup.write_all(file);
  file.finish();
  const auto score = read_values(folder / "a.nc", "score");
  const std::size_t grips = setup.plan.grips();
  ASSERT_EQ(score.size(), 2 * 3 * grips);
  for (std::size_t i = 0; i < grips; ++i) {
    EXPECT_EQ(score[i], score[grips + i]);
    EXPECT_EQ(score[3 * grips + i], score[5 * grips + i]);
  }
}

TEST(ResultFile, SobolPointsComeWithTheirAxes) {
  const TemporaryFolder folder;
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 1001;
  SweepFile setup(scene, folder / "a.nc");
  ResultFile file = setup.open();
  setup.write_all(file);
  file.finish();
  expect_expected(setup, folder / "a.nc");
  const auto roll = read_values(folder / "a.nc", "roll"), height = read_values(folder / "a.nc", "height_fraction");
  ASSERT_EQ(roll.size(), 1001u);
  for (std::size_t i = 0; i < roll.size(); ++i) {
    EXPECT_EQ(roll[i], setup.plan.grip(0, i).roll);
    EXPECT_EQ(height[i] * 0.14, setup.plan.grip(1, i).height);
  }
  const auto in_meters = read_values(folder / "a.nc", "height");
  ASSERT_EQ(in_meters.size(), 2 * 1001u);
  for (std::size_t v = 0; v < 2; ++v)
    for (std::size_t i = 0; i < 1001; ++i) EXPECT_EQ(in_meters[v * 1001 + i], setup.plan.grip(v, i).height);
}

TEST(ResultFile, EndingHoldsTheBestAndTheTimes) {
  const TemporaryFolder folder;
  SweepFile setup(fake_scene(), folder / "a.nc");
  ResultFile file = setup.open();
  setup.write_all(file);
  BestGrip first, second;
  first.candidate = {0.9, 12};
  second.candidate = {0.8, 5};
  first.grip = second.grip = {0.05, 0, 0.1, -0.2, 5e-3, 1};
  file.write_ending({{first, second}, {}}, 12.5, 3.25);
  file.finish();
  EXPECT_EQ(read_values(folder / "a.nc", "best_grip"), (std::vector<double>{12, 5, -1, -1, -1, -1}));
  const auto score = read_values(folder / "a.nc", "best_score"), roll = read_values(folder / "a.nc", "best_roll");
  ASSERT_EQ(score.size(), 6u);
  EXPECT_EQ(score[0], 0.9);
  EXPECT_TRUE(std::isnan(score[2]));
  EXPECT_EQ(roll[1], -0.2);
  EXPECT_EQ(read_values(folder / "a.nc", "best_height")[0], 0.05);
}

TEST(ResultFile, ExistingResultStaysUntilTheEnd) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.nc") << "before";
  SweepFile setup(fake_scene(), folder / "a.nc");
  ResultFile file = setup.open();
  setup.write_all(file);
  EXPECT_EQ(file_text(folder / "a.nc"), "before");
  EXPECT_TRUE(file_exists(folder / "a.nc.partial"));
  file.finish();
  EXPECT_NE(file_text(folder / "a.nc"), "before");
  EXPECT_FALSE(file_exists(folder / "a.nc.partial"));
}

// Where no lock kept another job away.
TEST(ResultFile, AnothersFileUnderItsNameIsLeftAlone) {
  for (const bool is_replaced : {true, false}) {
    const TemporaryFolder folder;
    SweepFile setup(fake_scene(), folder / "a.nc");
    ResultFile file = setup.open();
    setup.write_all(file);
    file.check_own();
    std::filesystem::remove(setup.names.partial);
    if (is_replaced) std::ofstream(setup.names.partial) << "of another job";
    for (const bool is_end : {false, true}) {
      try {
        if (is_end) {
          file.finish();
        } else {
          file.write_ending(BestLists(setup.scene.vessels.size()), 1, 1);
        }
        ADD_FAILURE() << "it was not looked at";
      } catch (const Error& error) {
        EXPECT_EQ(error.code, ExitCode::failure);
        EXPECT_NE(std::strstr(error.what(), is_replaced ? ": another job replaced this file" : ": another job took away this file"),
                  nullptr)
            << error.what();
      }
    }
    EXPECT_FALSE(file_exists(folder / "a.nc"));
    if (is_replaced) {
      EXPECT_EQ(file_text(setup.names.partial), "of another job");
    }
  }
}

TEST(ResultFile, IsReadBeforeItGetsItsName) {
  const TemporaryFolder folder;
  SweepFile setup(fake_scene(), folder / "a.nc");
  ResultFile file = setup.open();
  setup.write_all(file);
  std::fstream bytes(setup.names.partial, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekp(8).write("damaged!", 8).flush();  // HDF5's first block
  try {
    file.finish();
    ADD_FAILURE() << "it was not read";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::failure);
    EXPECT_NE(std::strstr(error.what(), "start again without --resume"), nullptr) << error.what();
  }
  EXPECT_FALSE(file_exists(folder / "a.nc"));
  EXPECT_TRUE(file_exists(setup.names.partial));
}

TEST(ResultFile, TheBestOfAllHandScalesAreWrittenInPlace) {
  const TemporaryFolder folder;
  Scene scene = fake_scene();
  scene.grips.hand_scale.values = {1.1, 0.9, 1};
  SweepFile setup(scene, folder / "a.nc");
  ResultFile file = setup.open();
  SweepMark mark;
  file.vouch_for_structure(mark);
  constexpr std::uint64_t size = 2 * 3 * 3 * sizeof(double);  // vessels, hand scales, ranks
  const auto lists =
      std::count_if(mark.in_place.begin(), mark.in_place.end(), [](const FileRange& range) { return range.size == size; });
  EXPECT_EQ(static_cast<std::size_t>(lists), 2 + setup.plan.axes().size() + 1 + REFINED_COORDINATES)
      << "grip, score, axes; refined score and axes";
}

}  // namespace
}  // namespace wholehand::sweeps
