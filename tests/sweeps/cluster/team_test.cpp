// SPDX-License-Identifier: MIT
// A team of one: its counter, what becomes of an exception, and of values that the disk lost.
#include "sweeps/cluster/team.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <system_error>

#include "core/evaluator.h"
#include "core/reader/reader.h"
#include "host/open_backend.h"
#include "sweeps/cluster/cluster_sweep.h"

namespace wholehand::sweeps {
namespace {

// MPI begins once in a process.
Team& team_of_one() {
  static int argc = 0;
  static char** argv = nullptr;
  static Team team(argc, argv);
  return team;
}

TEST(Team, WhoHasAskedSeesThatTheCounterWasStopped) {
  Team& team = team_of_one();
  team.restart_counter();
  team.ask(5);
  EXPECT_EQ(team.answer(), 0u);
  EXPECT_FALSE(team.is_stopped());
  team.ask(7);
  EXPECT_FALSE(team.is_stopped());
  EXPECT_EQ(team.answer(), 5u);
  team.stop_counter();
  team.ask(7);
  while (!team.is_stopped()) Team::nap();
  EXPECT_GE(team.answer(), Team::NO_MORE);
  EXPECT_TRUE(team.is_stopped());
  team.restart_counter();
  EXPECT_FALSE(team.is_stopped());
  team.ask(1);
  EXPECT_FALSE(team.is_stopped());
  EXPECT_EQ(team.answer(), 0u);
}

// Where only Errors were, MPI ended the job.
TEST(Team, EveryExceptionOfARankIsAnErrorOfAll) {
  const std::string folder = std::filesystem::temp_directory_path() / ("team." + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  Scene scene;
  scene.name = "empty";
  scene.file = "empty.toml";
  scene.vessels.resize(1);
  scene.vessels[0].name = "cup";
  const SweepOptions options{.output = folder + "/a.nc", .on = "core"};
  SweepParts parts;
  parts.prepare = [](const BackendChoice&) -> BackendChoice {
    throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
  };
  InterruptGuard interrupt(SIGUSR1);
  try {
    run_cluster_sweep(team_of_one(), scene, options, parts, interrupt);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::failure);
    EXPECT_EQ(std::string(error.what()), "unexpected failure: Resource temporarily unavailable");
  }
  std::filesystem::remove_all(folder);
}

// Loses one write of values: others come to the disk instead.
class LosingDisk final : public OutputBytes {
 public:
  LosingDisk(std::unique_ptr<OutputBytes> disk, int lost) : disk_(std::move(disk)), left_(lost) {}
  int write(const void* data, std::size_t size, std::uint64_t offset) override {
    if (left_-- != 0) return disk_->write(data, size, offset);
    return disk_->write(std::string(size, 'Z').data(), size, offset);
  }
  int sync() override { return disk_->sync(); }

 private:
  std::unique_ptr<OutputBytes> disk_;
  int left_;
};

// Before the result gets its name, each rank reads back what it wrote.
TEST(Team, ValuesThatTheDiskLostAreComputedAgain) {
  const std::string folder = std::filesystem::temp_directory_path() / ("lost." + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  const Scene scene = parse_scene(R"(
[[vessel]]
name = "cup"
shape = "cylinder"
diameter_mm = 60
height_mm = 100
wall_mm = 1.5
[output]
best = 3
[grips]
height_fraction = { from = 0.1, to = 0.9, count = 20 }
roll_deg = { from = -90, to = 30, count = 5 }
)",
                                  "cup.toml");
  const auto swept = [&](const std::string& name, int lost) {
    const SweepOptions options{.output = folder + "/" + name, .on = "core", .threads = 1};
    SweepParts parts;
    parts.open_backend = [&](const BackendChoice&, const FieldSet& fields) {
      return open_backend(scene, fields, "core", Precision::full, 1);
    };
    parts.open_evaluator = [&] { return make_core_evaluator(scene); };
    parts.open_core = [](const Scene& other, const FieldSet& fields) {
      return open_backend(other, fields, "core", Precision::full, 1);
    };
    parts.open_output = [&](const std::string& path) { return std::make_unique<LosingDisk>(Team::open_output(path), lost); };
    InterruptGuard interrupt(SIGUSR1);
    testing::internal::CaptureStderr();
    EXPECT_EQ(run_cluster_sweep(team_of_one(), scene, options, parts, interrupt), ExitCode::done);
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_EQ(said.find("are damaged: computing them again") != std::string::npos, lost >= 0) << said;
    std::ifstream file(options.output, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string whole = swept("whole.nc", -1);
  ASSERT_GT(whole.size(), 1000u);
  for (const int lost : {0, 1, 5}) {
    const std::string mended = swept("lost.nc", lost);
    ASSERT_EQ(mended.size(), whole.size());
    std::size_t differing = 0;
    for (std::size_t k = 0; k < whole.size(); ++k) differing += whole[k] != mended[k] ? 1 : 0;
    // two times of 8 bytes and checksums of 4 over them, and two checksums of 32 characters: of the times and of all else
    EXPECT_LE(differing, 24u + 64u);
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace wholehand::sweeps
