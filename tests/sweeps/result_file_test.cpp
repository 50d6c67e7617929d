// SPDX-License-Identifier: MIT
#include "sweeps/result_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>

#include "core/error.h"
#include "tests/support/fake_backend.h"
#include "tests/support/files.h"
#include "tests/support/result_reader.h"

namespace wholehand {
namespace {

// All that a result file needs, over the stand-in kernels.
struct SweepFile {
  SweepFile(const Scene& wanted, const std::string& path, Precision precision = Precision::full, std::size_t chunk = 97)
      : scene(wanted),
        variables(choose_variables(scene)),
        plan(scene, keeps_vectors(variables)),
        backend(scene, make_field_set(variable_fields(variables), scene), precision, chunk),
        contents{scene, plan, variables, vessel_facts(scene, backend, FakeEvaluator(scene)), backend.info(), "1", 3},
        names(output_names(path)) {}

  ResultFile open(bool resume = false) { return ResultFile(names, contents, backend.fields(), resume); }

  // Grips [first, last) of a vessel.
  void write(ResultFile& file, std::size_t vessel, std::uint64_t first, std::uint64_t last) {
    RunRequest request;
    request.vessel = vessel;
    request.first = first;
    request.last = last;
    request.grips = [&](std::size_t v, std::uint64_t i, std::size_t n, GripInput* out) { plan.fill(v, i, n, out); };
    request.sink = [&](const PlaneChunk& chunk) { file.write(chunk); };
    backend.run(request);
  }

  void write_all(ResultFile& file) {
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) write(file, v, 0, plan.grips());
    file.write_ending(std::vector<std::vector<RankedGrip>>(scene.vessels.size()), 1, 1);
  }

  Scene scene;
  std::vector<const Variable*> variables;
  Plan plan;
  FakeBackend backend;
  ResultContents contents;
  OutputNames names;
};

// Runs `work` in a process of its own; its exit code, or minus the signal that ended it.
template <class Work>
int in_child(const Work& work) {
  const pid_t child = fork();
  if (child == 0) _exit(work());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

// What the file must hold of a variable: written out from the stand-in kernels, index by index.
std::vector<double> expected_values(const SweepFile& setup, const Variable& variable) {
  std::vector<double> values;
  const std::size_t planes = variable_planes(variable, setup.scene);
  for (std::size_t v = 0; v < setup.scene.vessels.size(); ++v) {
    for (std::size_t p = 0; p < planes; ++p) {
      for (std::uint64_t stored = 0; stored < setup.plan.stored_grips(); ++stored) {
        const GripInput grip = setup.plan.grip(v, stored % setup.plan.grips());
        if (variable.type == NumberType::real) {
          values.push_back(fake_real(v, grip, variable.field, variable.plane + static_cast<int>(p)));
          continue;
        }
        const bool feasible = (fake_uint(v, grip, FIELD_STATUS) & STATUS_REASON_MASK) == REASON_NONE;
        values.push_back(feasible || variable.always ? variable.value(fake_uint(v, grip, variable.field)) : variable.missing);
      }
    }
  }
  return values;
}

void expect_expected(const SweepFile& setup, const std::string& path) {
  for (const Variable* variable : setup.variables) {
    const auto expected = expected_values(setup, *variable), found = read_values(path, variable->name);
    ASSERT_EQ(found.size(), expected.size()) << variable->name;
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_TRUE(found[i] == expected[i] || (std::isnan(found[i]) && std::isnan(expected[i])))
          << variable->name << "[" << i << "]: " << found[i] << " instead of " << expected[i];
    }
  }
}

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

TEST(ResultFile, OddShapesAndEveryVariable) {
  const TemporaryFolder folder;
  Scene scene = fake_scene();
  scene.grips.azimuth = range_axis(0, 1, 2);
  scene.grips.height = range_axis(0.1, 0.9, 3);
  scene.grips.roll.values = {0.5};
  scene.grips.offset = range_axis(0, 0.01, 5);
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
  const auto in_metres = read_values(folder / "a.nc", "height");
  ASSERT_EQ(in_metres.size(), 2 * 1001u);
  for (std::size_t v = 0; v < 2; ++v)
    for (std::size_t i = 0; i < 1001; ++i) EXPECT_EQ(in_metres[v * 1001 + i], setup.plan.grip(v, i).height);
}

TEST(ResultFile, EndingHoldsTheBestAndTheTimes) {
  const TemporaryFolder folder;
  SweepFile setup(fake_scene(), folder / "a.nc");
  ResultFile file = setup.open();
  setup.write_all(file);
  const GripInput grip{0.05, 0, 0.1, -0.2, 5e-3, 1};
  file.write_ending({{{{0.9, 12}, grip}, {{0.8, 5}, grip}}, {}}, 12.5, 3.25);
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
  EXPECT_EQ(static_cast<std::size_t>(lists), 2 + setup.plan.axes().size());
}

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
      if (name != "vessel" && name != "joint" && name != "xyz" && name != "contact") read_values(folder / "a.nc.partial", name);
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
  std::mt19937 random(3);
  int missed = 0;
  for (int k = 0; k < 120; ++k) {
    const std::size_t at = random() % whole.size();
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
  // nothing of the structure fits, a part of it, almost all
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
}  // namespace wholehand
