// The whole report, as a user asks for it.
// sanitizers: none
#include "sweeps/stability.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>

#include "tests/support/result_reader.h"

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
  for (const char* part : {"seed 7", "llvmpipe", "0 did not settle", "| 100 g, 1 N s/m |", "Largest k_open", "--unsafe-gains",
                           "| creases_and_rim |", " 0 values are not finite"})
    EXPECT_NE(summary.find(part), std::string::npos) << part;
  EXPECT_NE(file_text(folder / "said").find(summary), std::string::npos);

  const std::string again = folder / "again";
  ASSERT_EQ(program("stability --quick --seed 7 -o " + again, folder / "said"), 0);
  for (const char* name : {"wall.csv", "wall_limits.csv", "grip_loop.csv", "extreme.csv"})
    EXPECT_EQ(file_text(report + "/" + name), file_text(again + "/" + name)) << name << ": one seed, one answer";
}

TEST(Stability, WrongUseIsOneLine) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  for (const std::string& arguments : {std::string("stability"), "stability -o " + (folder / "missing/report"),
                                       "stability -o " + (folder / "file"), "stability --on nothing -o " + (folder / "report"),
                                       "stability --seed x -o " + (folder / "report"), std::string("stability wall --mass-kg 1")}) {
    EXPECT_EQ(program(arguments, folder / "said"), 2) << arguments;
    const std::string said = file_text(folder / "said");
    EXPECT_EQ(said.find('\n'), said.size() - 1) << said;
  }
  program("stability wall --mass-kg 1", folder / "said");
  EXPECT_NE(file_text(folder / "said").find("see wholehand stability wall --help"), std::string::npos)
      << file_text(folder / "said");
}

}  // namespace
}  // namespace wholehand
