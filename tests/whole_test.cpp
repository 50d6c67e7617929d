// sanitizers: none (it runs the program)
// The program as a user runs it: a sweep on either side, killed, resumed.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/support/result_reader.h"

namespace wholehand {
namespace {

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
  for (const auto& [name, tolerance] : std::initializer_list<std::pair<const char*, double>>{
           // single precision's stop tolerance, 1e-6 m, through the kernels: lengths to 20 micrometres where a finger rests aslant,
           // forces by their conditioning (docs/method.md); scores are sums of such terms over 10 mm
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
}

TEST(Whole, KilledSweepOnVulkanResumesToTheSameBits) {
  const TemporaryFolder folder;
  const std::string scene = folder.path() + "/many.toml", whole = folder.path() + "/whole.nc",
                    killed = folder.path() + "/killed.nc";
  std::ofstream(scene)
      << "[[vessel]]\nname = \"v\"\nshape = \"flask\"\ndiameter_mm = 85\nneck_mm = 34\nheight_mm = 140\nwall_mm = 1.5\n"
         "[grips]\nsampling = \"sobol\"\ncount = 300000\nseed = 7\nheight_fraction = { from = 0.1, to = 0.9 }\n"
         "roll_deg = { from = -90, to = 30 }\n[output]\nkeep = [\"score\", \"touch_mask\", \"gap\"]\n";
  ASSERT_EQ(run("sweep " + scene + " -o " + whole + " >" + folder.path() + "/out.txt"), 0);
  const pid_t child = fork();
  if (child == 0) {
    execl(WHOLEHAND_PROGRAM, WHOLEHAND_PROGRAM, "sweep", scene.c_str(), "-o", killed.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  usleep(700000);
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) {
    EXPECT_NE(access(killed.c_str(), F_OK), 0) << "a killed sweep leaves no file that looks whole";
  }
  ASSERT_EQ(run("sweep " + scene + " -o " + killed + " --resume >>" + folder.path() + "/out.txt 2>&1"), 0);
  for (const char* name : {"score", "touch_mask", "gap", "height_fraction", "best_score"}) {
    const auto a = read_values(whole, name), b = read_values(killed, name);
    ASSERT_EQ(a.size(), b.size()) << name;
    for (std::size_t i = 0; i < a.size(); ++i)
      ASSERT_TRUE(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i]))) << name << " #" << i;
  }
}

#endif

}  // namespace
}  // namespace wholehand
