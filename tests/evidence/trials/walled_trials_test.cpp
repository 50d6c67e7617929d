// SPDX-License-Identifier: MIT
// sanitizers: none (it runs the program)
// Meshes with their own walls in the real engine, by the built program: trials go as their efforts say.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <string>

#include "base/files/csv.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/walled_vessels.h"
#include "tests/support/xml.h"

#ifdef WHOLEHAND_PROGRAM

namespace wholehand {
namespace {

constexpr const char* MUG = R"(
[[vessel]]
name = "mug"
mesh = "mug.glb"
origin = "as_is"
inner_outline = [{ line = [0, 4] }, { line = [37, 4] }, { line = [37, 95] }]
)";
constexpr const char* BOWL = R"(
[[vessel]]
name = "bowl"
mesh = "bowl.glb"
origin = "as_is"
inner_outline = [{ line = [0, 4] }, { arc = [51, 55], center = [0, 55] }]
)";
constexpr const char* BOTTLE = R"(
[[vessel]]
name = "bottle"
mesh = "bottle.glb"
origin = "as_is"
inner_outline = [
  { line = [0, 4] },
  { line = [30, 4] },
  { line = [30, 120] },
  { arc = [13, 137], center = [13, 120] },
  { line = [10, 138] },
  { line = [10, 200] },
]
)";
constexpr const char* KITCHEN = R"(
[table]

[arm]

[liquid]
fills = [0, 0.5, 1]

[grips]
height_fraction = { from = 0.10, to = 0.95, count = 32 }
obliquity_deg = { from = -20, to = 20, count = 9 }
roll_deg = { from = -90, to = 30, count = 16 }

[strength]

[tilts]
deg = { from = 0, to = 150, count = 31 }
)";

// Trials whose effort leaves no doubt, and those of them that go as it says.
struct ClearTrials {
  int all = 0, right = 0;
};

class WalledTrials : public testing::Test {
 protected:
  // The program's trials of these vessels; of each by its name.
  std::map<std::string, ClearTrials> tried(const std::string& vessels, const std::string& options, int mug_sides = 64) {
    write_file(folder_ / "mug.glb", glb_text(mug_mesh(mug_sides)));
    write_file(folder_ / "bowl.glb", glb_text(bowl_mesh()));
    write_file(folder_ / "bottle.glb", glb_text(bottle_mesh()));
    write_file(folder_ / "kitchen.toml", "[scene]\nname = \"kitchen\"\npose = \"articulated\"\n" + vessels + KITCHEN);
    const Outcome ran = run("XDG_CACHE_HOME=" + folder_.path() + " PROGRAM trials " + (folder_ / "kitchen.toml") + " -o " +
                            (folder_ / "out") + " --seed 1 --fill 1 " + options + " 2>&1");
    EXPECT_EQ(ran.code, 0) << ran.output;
    said_ = ran.output;
    const auto rows = parse_csv(file_text(folder_ / "out/trials.csv"));
    std::map<std::string, ClearTrials> found;
    for (std::size_t k = 1; k < rows.size(); ++k) add(rows[0], rows[k], found[rows[k].cells[0]]);
    return found;
  }

  TemporaryFolder folder_;
  std::string said_;

 private:
  static const std::string& cell(const CsvRow& head, const CsvRow& row, const std::string& name) {
    for (std::size_t k = 0; k < head.cells.size(); ++k)
      if (head.cells[k] == name) return row.cells[k];
    throw std::out_of_range(name);
  }

  // Leaves out what does not test its own state: discarded, or lost at a smaller tilt.
  static void add(const CsvRow& head, const CsvRow& row, ClearTrials& found) {
    if (cell(head, row, "discarded") == "1" || cell(head, row, "reason") == "earlier") return;
    const double effort = std::strtod(cell(head, row, "effort").c_str(), nullptr);
    if (effort >= 0.8 && effort <= 1.2) return;
    ++found.all;
    found.right += (cell(head, row, "held") == "1") == (effort < 1);
  }
};

constexpr double RIGHT_SHARE = 0.9;

TEST_F(WalledTrials, AMugWithAHandleGoesAsItsEffortsSay) {
  const ClearTrials mug = tried(MUG + std::string("grid_mm = 1.5\n"), "--grips 3 --best 1 --tilt-deg 0", 32)["mug"];
  EXPECT_TRUE(has(said_, "convex pieces, which leave the mesh by at most 0.5")) << said_;
  EXPECT_GE(mug.all, 2);
  EXPECT_GE(mug.right, RIGHT_SHARE * mug.all) << mug.all;
  EXPECT_TRUE(has(file_text(folder_ / "out/trials.html"), "convex pieces, which leave the mesh by at most 0.5"));
}

TEST_F(WalledTrials, AMugABowlAndABottleGoAsTheirEffortsSay) {
  ClearTrials all;
  const auto found = tried(std::string(MUG) + BOWL + BOTTLE, "--grips 45 --best 2");
  ASSERT_EQ(found.size(), 3u);
  for (const auto& [name, one] : found) {
    EXPECT_GE(one.all, 10) << name;
    all.all += one.all;
    all.right += one.right;
  }
  EXPECT_GE(all.right, RIGHT_SHARE * all.all) << all.all;
}

}  // namespace
}  // namespace wholehand

#endif
