// SPDX-License-Identifier: MIT
// The whole report, as a user asks for it.
// sanitizers: none
#include "evidence/check/stability.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "tests/support/files.h"

namespace wholehand {
namespace {

int program(const std::string& arguments, const std::string& said) {
  const int status = std::system((std::string(WHOLEHAND_PROGRAM) + " " + arguments + " >" + said + " 2>&1").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Stability, WritesTablesPicturesAndASummary) {
  const TemporaryFolder folder;
  const std::string report = folder / "report";
  ASSERT_EQ(program("stability --quick --seed 7 -o " + report, folder / "said"), 0) << file_text(folder / "said");
  for (const char* name : {"wall.csv", "wall_limits.csv", "wall.svg", "wall_integrators.svg", "grip_loop.csv", "grip_loop.svg",
                           "extreme.csv", "stability.md"})
    EXPECT_FALSE(file_text(report + "/" + name).empty()) << name;
  const std::string summary = file_text(report + "/stability.md");
  for (const char* part : {"seed 7", "llvmpipe", "; 0 of the passive walls did not settle", "| 100 g, 1 N s/m |", "largest k_open",
                           "--unsafe-gains", "| creases_and_rim |", " 0 values are not finite"})
    EXPECT_NE(summary.find(part), std::string::npos) << part;
  EXPECT_NE(file_text(folder / "said").find(summary), std::string::npos);

  // once more, in this process and with two of the scenes: one seed, one answer
  StabilityOptions options;
  options.folder = folder / "again";
  options.quick = true;
  options.seed = 7;
  for (const std::string& file : extreme_scene_files())
    if (file.ends_with("/dwarf.toml") || file.ends_with("/no_friction.toml"))
      options.extremes.push_back(extreme_case(read_scene_file(file)));
  ASSERT_EQ(options.extremes.size(), 2u);
  testing::internal::CaptureStdout();
  EXPECT_EQ(run_stability(options), ExitCode::done);
  testing::internal::GetCapturedStdout();
  for (const char* name : {"wall.csv", "wall_limits.csv", "grip_loop.csv"})
    EXPECT_EQ(file_text(report + "/" + name), file_text(options.folder + "/" + name)) << name;
  std::istringstream rows(file_text(options.folder + "/extreme.csv"));
  const std::string all = file_text(report + "/extreme.csv");
  int found = 0;
  for (std::string row; std::getline(rows, row); ++found) EXPECT_NE(all.find(row + "\n"), std::string::npos) << row;
  EXPECT_EQ(found, 1 + 2 * 4);
}

TEST(Stability, WrongUseIsOneLine) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  for (const std::string& arguments : {std::string("stability"), "stability -o " + (folder / "missing/report"),
                                       "stability -o " + (folder / "file"), "stability --on nothing -o " + (folder / "report"),
                                       "stability --seed x -o " + (folder / "report"), std::string("stability wall --mass-kg 1"),
                                       std::string("stability --quick wall --mass-kg 1 --damping-Nspm 1 --rate-hz 1000")}) {
    EXPECT_EQ(program(arguments, folder / "said"), 2) << arguments;
    const std::string said = file_text(folder / "said");
    EXPECT_EQ(said.find('\n'), said.size() - 1) << said;
  }
  EXPECT_FALSE(file_exists(folder / "report")) << "nothing was made";
  std::ofstream(folder / "wall.csv") << "mine";
  EXPECT_EQ(program("stability --on core -o " + folder.path(), folder / "said"), 2);
  EXPECT_NE(file_text(folder / "said").find("wall.csv: is there and is no table of wholehand stability"), std::string::npos)
      << file_text(folder / "said");
  EXPECT_EQ(file_text(folder / "wall.csv"), "mine");
  program("stability wall --mass-kg 1", folder / "said");
  EXPECT_NE(file_text(folder / "said").find("see wholehand stability wall --help"), std::string::npos)
      << file_text(folder / "said");
}

}  // namespace
}  // namespace wholehand
