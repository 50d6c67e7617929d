// SPDX-License-Identifier: MIT
// sanitizers: none (it runs the program)
// Every grip of a coarse default sweep on either side; the program as a user runs it: a sweep on either side, killed, resumed.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "evidence/check/compare.h"
#include "host/grip_backend.h"
#include "sweeps/plan/plan.h"
#include "sweeps/plan/variables.h"
#include "tests/support/files.h"
#include "tests/support/result_reader.h"
#include "tests/support/scenes.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand {
namespace {

// A quarter of the default sweep, every grip of it, as kept in its file.
TEST(Whole, EveryGripOfACoarseDefaultSweepAgrees) {
  Scene scene = read_scene_file(find_scene("three_beakers"));
  scene.grips = three_beakers().grips;
  const auto variables = sweeps::choose_variables(scene);
  const sweeps::Plan plan(scene, sweeps::keeps_vectors(variables));
  const FieldSet fields = make_field_set(sweeps::variable_fields(variables), scene);
  const auto truth = make_core_evaluator(scene);
  const auto backend = std::make_unique<host::GripBackend>(scene, make_core_evaluator(scene), fields, "vulkan");
  Comparer comparer(scene, *truth, allowance(Precision::single));
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    std::vector<GripInput> grips(plan.grips());
    plan.fill(v, 0, grips.size(), grips.data());
    comparer.add(v, grips, gather(*backend, v, grips), gather(*truth, fields, v, grips));
  }
  EXPECT_EQ(comparer.grips(), 27648u);
  EXPECT_TRUE(comparer.holds());
  for (const Comparison& row : comparer.rows())
    EXPECT_EQ(row.outside, 0u) << row.kernel << " " << row.quantity << " worst " << row.worst << " " << row.unit << " at #"
                               << row.grip;
}

#ifdef WHOLEHAND_PROGRAM

int run(const std::string& arguments) {
  const int status = std::system((std::string("WHOLEHAND_VALIDATION=1 ") + WHOLEHAND_PROGRAM + " " + arguments).c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Whole, SweepOnVulkanAndOnTheCoreAgree) {
  const TemporaryFolder folder;
  const std::string vulkan = folder.path() + "/vulkan.nc", core = folder.path() + "/core.nc";
  ASSERT_EQ(run("sweep small --on vulkan -o " + vulkan + " >" + folder.path() + "/out.txt"), 0);
  ASSERT_EQ(run("sweep small --on core -o " + core + " >>" + folder.path() + "/out.txt"), 0);
  for (
      const auto& [name, tolerance] : std::initializer_list<std::pair<const char*, double>>{
          // that the files hold what the backends gave, each at its place; the numbers themselves are compared above, to tolerances
          // of their own
          {"gap", 1e-5},
          {"closure", 1e-4},
          {"phalanx_depth", 2e-5},
          {"score", 2e-3},
          {"peak_feedback_force", 1e-3},
          {"pouring_tilt", 1e-9}}) {
    const auto a = read_values(vulkan, name), b = read_values(core, name);
    ASSERT_EQ(a.size(), b.size()) << name;
    ASSERT_FALSE(a.empty()) << name;
    std::size_t finite = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_EQ(std::isnan(a[i]), std::isnan(b[i])) << name << " #" << i;
      if (std::isnan(a[i])) continue;
      ++finite;
      EXPECT_NEAR(a[i], b[i], tolerance) << name << " #" << i;
    }
    EXPECT_GT(finite, 0u) << name;
  }
  EXPECT_EQ(read_values(vulkan, "touch_mask"), read_values(core, "touch_mask"));
  // The k-th largest of many numbers moves by no more than the numbers do.
  const auto of_device = read_values(vulkan, "best_score"), of_core = read_values(core, "best_score");
  ASSERT_EQ(of_device.size(), of_core.size());
  std::size_t listed = 0;
  for (std::size_t i = 0; i < of_core.size(); ++i) {
    ASSERT_EQ(std::isnan(of_device[i]), std::isnan(of_core[i])) << "rank " << i << ": fewer grips are plausible than are listed";
    if (std::isnan(of_core[i])) continue;
    ++listed;
    EXPECT_NEAR(of_device[i], of_core[i], 2e-3) << "rank " << i;
  }
  EXPECT_GT(listed, 2u);

  // what is left to the program is the file of the one or of the other, to the bit
  const std::string chosen = folder.path() + "/auto.nc";
  ASSERT_EQ(run("sweep small -o " + chosen + " >>" + folder.path() + "/out.txt"), 0);
  const auto scores = read_values(chosen, "score");
  EXPECT_TRUE(scores == read_values(core, "score") || scores == read_values(vulkan, "score"));
}

// Starts a sweep in the background. A resumed sweep takes the backend of the first.
pid_t start(const std::string& scene, const std::string& output, bool resume) {
  const pid_t child = fork();
  if (child != 0) return child;
  setenv("WHOLEHAND_VALIDATION", "1", 1);
  freopen((output + ".said").c_str(), "w", stderr);
  freopen("/dev/null", "w", stdout);
  execl(WHOLEHAND_PROGRAM, WHOLEHAND_PROGRAM, "sweep", scene.c_str(), "-o", output.c_str(), resume ? "--resume" : "--on",
        resume ? nullptr : "vulkan", static_cast<char*>(nullptr));
  _exit(127);
}

// Waits until the file is written to, since `before`.
bool wait_for_writing(const std::string& file, std::filesystem::file_time_type before) {
  for (int tries = 0; tries < 6000; ++tries) {
    std::error_code error;
    const auto now = std::filesystem::last_write_time(file, error);
    if (!error && now > before) return true;
    usleep(10000);
  }
  return false;
}

// Interrupted, gone on with, killed in the middle of that, and gone on with again.
TEST(Whole, InterruptedAndKilledSweepOnVulkanResumesToTheSameBits) {
  const TemporaryFolder folder;
  const std::string scene = folder.path() + "/many.toml", whole = folder.path() + "/whole.nc",
                    broken = folder.path() + "/broken.nc", partial = broken + ".partial";
  // some seconds of work; lists of different grips, which take further passes, are interrupted in run_different_test
  std::ofstream(scene)
      << "[[vessel]]\nname = \"v\"\nshape = \"flask\"\ndiameter_mm = 85\nneck_mm = 34\nheight_mm = 140\nwall_mm = 1.5\n"
         "[grips]\nsampling = \"sobol\"\ncount = 800000\nseed = 7\nheight_fraction = { from = 0.1, to = 0.9 }\n"
         "roll_deg = { from = -90, to = 30 }\n[output]\napart_mm = 0\nkeep = [\"score\", \"touch_mask\", \"gap\"]\n";
  ASSERT_EQ(run("sweep " + scene + " --on vulkan -o " + whole + " >" + folder.path() + "/out.txt"), 0);

  int status = 0;
  const pid_t first = start(scene, broken, false);
  ASSERT_TRUE(wait_for_writing(partial, std::filesystem::file_time_type::min()));
  usleep(200000);
  kill(first, SIGINT);
  waitpid(first, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  const std::string line = file_text(broken + ".said");
  EXPECT_EQ(line.find("wholehand: interrupted at "), 0u) << line;
  EXPECT_EQ(line.find('\n'), line.size() - 1) << line;

  const auto before = std::filesystem::last_write_time(partial);
  const pid_t second = start(scene, broken, true);
  ASSERT_TRUE(wait_for_writing(partial, before));
  usleep(50000);
  kill(second, SIGKILL);
  waitpid(second, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "it had ended before it was killed";
  EXPECT_EQ(file_text(broken + ".said").find("wholehand: continuing "), 0u) << file_text(broken + ".said");
  EXPECT_FALSE(std::filesystem::exists(broken)) << "a killed sweep leaves no file that looks whole";

  ASSERT_EQ(run("sweep " + scene + " -o " + broken + " --resume >>" + folder.path() + "/out.txt 2>&1"), 0);
  for (const char* name : {"score", "touch_mask", "gap", "height_fraction", "best_score"}) {
    const auto a = read_values(whole, name), b = read_values(broken, name);
    ASSERT_EQ(a.size(), b.size()) << name;
    for (std::size_t i = 0; i < a.size(); ++i)
      ASSERT_TRUE(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i]))) << name << " #" << i;
  }
}

// What other tools make of a file that a real sweep wrote: ncdump's listing of it and xarray's view.
TEST(Whole, OtherToolsReadTheResult) {
  const TemporaryFolder folder;
  const std::string result = folder.path() + "/small.nc", out = folder.path() + "/out.txt";
  ASSERT_EQ(run("sweep small -o " + result + " >" + out), 0);
  ASSERT_EQ(std::system(("ncdump -h " + result + " >" + out).c_str()), 0);
  const std::string text = file_text(out);
  for (const char* part : {"vessel = 1 ;", "height = 3 ;", "azimuth = 2 ;", "obliquity = 3 ;", "roll = 4 ;", "score:long_name",
                           "gap:units = \"m\"", "gap:_FillValue", ":device = ", ":driver = ", ":scene = ", ":version = "})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  std::ofstream(folder.path() + "/look.py") << "import sys, xarray\n"
                                               "d = xarray.open_dataset(sys.argv[1])\n"
                                               "s = d['score'].isel(vessel=0)\n"
                                               "assert s.max() > 0.5 and s.min() >= 0, s\n"
                                               "assert float(d['gap'].sel(height=0.045, roll=0, method='nearest').max()) > 0.05\n"
                                               "assert d['gap'].attrs['long_name'] and d['height'].attrs['units'] == 'm'\n";
  EXPECT_EQ(std::system(("/usr/bin/python3 " + folder.path() + "/look.py " + result + " >" + out + " 2>&1").c_str()), 0)
      << file_text(out);
}

#endif

}  // namespace
}  // namespace wholehand
