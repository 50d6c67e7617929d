// SPDX-License-Identifier: MIT
// The built program: help, usage errors and exit codes. What the commands compute is tested elsewhere.
// sanitizers: address
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "base/system/version.h"
#include "tests/support/files.h"
#include "tests/support/program.h"

#ifdef WHOLEHAND_PROGRAM

namespace {

using wholehand::expect_error;
using wholehand::Outcome;
using wholehand::run;
using wholehand::SMALL_GRIP;

TEST(CommandUsage, TellsVersionAndHelp) {
  const Outcome version = run("PROGRAM --version 2>&1");
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.output, std::string("wholehand ") + wholehand::version() +
                                "\n`wholehand devices` lists the devices that compute, and the grippers\n");
  EXPECT_EQ(run("PROGRAM -V 2>&1").output, version.output);
  for (const char* arguments : {"--help", "sweep --help", "report --help", "grip -h", "check --help", "devices --help"}) {
    const Outcome help = run(std::string("PROGRAM ") + arguments + " 2>&1");
    EXPECT_EQ(help.code, 0) << arguments;
    EXPECT_NE(help.output.find("Usage:"), std::string::npos) << help.output;
  }
}

TEST(CommandUsage, HelpIsTheSameAsACommand) {
  for (const auto& [as_command, as_option] : std::vector<std::pair<std::string, std::string>>{
           {"help", "--help"}, {"help sweep", "sweep --help"}, {"help stability wall", "stability wall --help"}}) {
    const Outcome help = run("PROGRAM " + as_command + " 2>&1");
    EXPECT_EQ(help.code, 0) << as_command;
    EXPECT_EQ(help.output, run("PROGRAM " + as_option + " 2>&1").output) << as_command;
  }
}

TEST(CommandUsage, ListsTheShippedScenes) {
  const Outcome scenes = run("PROGRAM scenes 2>&1");
  EXPECT_EQ(scenes.code, 0);
  EXPECT_NE(
      scenes.output.find("\nthree_beakers  beaker1, beaker2, beaker3            Three laboratory vessels of about 250 to 400 mL, "),
      std::string::npos)
      << scenes.output;
  EXPECT_EQ(std::count(scenes.output.begin(), scenes.output.end(), '\n'), 4);
}

// Arguments, and what the one line says, with code 2.
void expect_refusals(const std::vector<std::pair<std::string, std::string>>& refusals) {
  for (const auto& [arguments, gist] : refusals) expect_error(arguments, 2, gist);
}

TEST(CommandUsage, RefusesWrongCommandsAndSweeps) {
  expect_refusals({
      {"", "the command is missing; allowed: sweep, merge, rank, compare, report, grip, trials, study, check, "},
      {"", ", scenes or help; see wholehand --help"},
      {"swep",
       "unknown command 'swep' (did you mean 'sweep'?); the commands are sweep, merge, rank, compare, report, grip, trials, study, "
       "check, "},
      {"stab", "unknown command 'stab' (did you mean 'stability'?); the commands are "},
      {"xyzzy", "unknown command 'xyzzy'; the commands are sweep, "},
      {"help swep", "unknown command 'swep' (did you mean 'sweep'?); the commands are sweep, "},
      {"help stability wal", "unknown command 'wal' (did you mean 'wall'?); the commands are wall"},
      {"help sweep small", "wholehand sweep has no commands of its own; found 'small'"},
      {"sweep --presision float", "--presision (did you mean '--precision'?); see wholehand sweep --help"},
      {"sweep --bset=5", "--bset=5 (did you mean '--best'?); see wholehand sweep --help"},
      {"grip small --vessl tumbler --height-mm 50",
       "--vessel is required; unknown option '--vessl' (did you mean '--vessel'?); see"},
      {"stability wall --mass 1", "unknown option '--mass' (did you mean '--mass-kg'?); see wholehand stability wall --help"},
      {"sweep three_beaker", "no scene file 'three_beaker' (did you mean 'three_beakers'?); give the path"},
      {"--bogus", "--bogus; see wholehand --help"},
      {"sweep --bogus", "--bogus; see wholehand sweep --help"},
      {"sweep small other", "other; see wholehand sweep --help"},
      {"sweep --on", "--on"},
      {"sweep --on core --on core", "--on"},
      {"sweep --best", "--best"},
      {"sweep ''", "must not be empty"},
      {"sweep small -o ''", "must not be empty"},
      {"sweep small --on ''", "must not be empty"},
      {"check small --on 0", "no Vulkan device"},
      {"sweep --best 1.5", "--best '1.5'; allowed: a whole number, 0 to 100000"},
      {"sweep --best -1", "--best '-1'"},
      {"sweep --threads 0", "--threads '0'; allowed: a whole number, 1 to 1024"},
      {"sweep --precision half", "--precision 'half'; allowed: float or double"},
      {"sweep no_such_scene",
       "no scene file 'no_such_scene'; give the path of a TOML file or one of the shipped scenes: mixing_board, paper_pose, small, "
       "three_beakers"},
      {"sweep /", "'/' is a directory"},
      {"sweep /dev/null", "/dev/null:1:1: the scene lacks 'vessel'"},
      {"check no_such_scene", "no scene file 'no_such_scene'"},
  });
}

TEST(CommandUsage, RefusesWrongWallsAndFiles) {
  expect_refusals({
      {"stability", "stability"},
      {"stability wall --damping-Nspm 1 --rate-hz 1000", "--mass-kg is required"},
      {"stability wall --mass-kg 0 --damping-Nspm 1 --rate-hz 1000", "--mass-kg '0'; allowed: a number, "},
      {"stability wall --mass-kg 0.1 --damping-Nspm 1 --rate-hz 1000 --delay-samples 9",
       "--delay-samples '9'; allowed: a whole number, 0 to 4"},
      {"stability wall --mass-kg 0.1 --damping-Nspm 1 --rate-hz 1000 --finger 1,2", "--finger '1,2'; allowed: three numbers"},
      {"devices --dhd-library ''", "must not be empty"},
      {"session", "recording is required"},
      {"session ''", "must not be empty"},
      {"session /nonexistent.nc", "/nonexistent.nc: cannot be read: No such file or directory"},
      {"session /tmp", "/tmp: is a directory; name a recording"},
      {"session /dev/null", "/dev/null: is a device or pipe; name a recording"},
      {"session /proc/self/status", "/proc/self/status: is not a recording"},
      {"session a.nc b.nc", "a.nc: cannot be read"},
      {"report", "result is required"},
      {"report ''", "must not be empty"},
      {"report a.nc -o ''", "must not be empty"},
      {"report /nonexistent.nc", "/nonexistent.nc: cannot be read: No such file or directory"},
      {"report /tmp", "/tmp: is a directory; name the result file of a sweep"},
      {"report /dev/null", "/dev/null: is a device or pipe; name the result file of a sweep"},
      {"report /proc/self/status", "/proc/self/status: is not a result file"},
      {"report a.nc b.nc", "b.nc; see wholehand report --help"},
      {"devices extra", "extra; see wholehand devices --help"},
  });
}

TEST(CommandUsage, RefusesWrongTrials) {
  expect_refusals({
      {"trials", "scene is required"},
      {"trials small", "--output is required"},
      {"trials small -o ''", "must not be empty"},
      {"trials no_such_scene -o t", "no scene file 'no_such_scene'"},
      {"trials small -o t --grips -1", "--grips '-1'; allowed: a whole number, 0 to 100000"},
      {"trials small -o t --grips 0 --best 0", "no grip is left to try"},
      {"trials small -o t --vessel tumblr", "has no such vessel; the nearest is 'tumbler'"},
      {"trials small -o t --fill 1.5", "--fill '1.5'; allowed: a number, 0 to 1"},
      {"trials small -o t --tilt-deg -5", "--tilt-deg '-5'; allowed: a number, 0 to 180"},
      {"trials small -o t --tilt-deg 10 181", "--tilt-deg '181'; allowed: a number, 0 to 180"},
      {"trials small -o t --protocol push", "--protocol 'push'; allowed: fill-tilt, six-forces or both"},
      {"trials small -o t --model glove", "--model 'glove'; allowed: hand or contacts"},
      {"trials small -o t --mass-kg 0", "--mass-kg '0'; allowed: a number, "},
      {"trials small -o t --friction 11", "--friction '11'; allowed: a number, 0 to 10"},
      {"trials small -o t --threads 0", "--threads '0'; allowed: a whole number, 1 to 1024"},
      {"trials small -o t --seed x", "--seed 'x'"},
  });
}

TEST(CommandUsage, RefusesWrongGrips) {
  expect_refusals({
      {"grip", "scene is required"},
      {"grip small", "--vessel is required"},
      {"grip small --vessel tumbler", "the place of the grip is missing; give --height-mm, or --thumb-mm and --index-mm"},
      {"grip small --vessel tumblr --height-mm 50", "has no such vessel; the nearest is 'tumbler'"},
      {"grip small --vessel tumbler --height-mm 5x", "--height-mm '5x'; allowed: a number, -10000 to 20000"},
      {"grip small --vessel tumbler --height-mm nan", "--height-mm 'nan'"},
      {"grip small --vessel tumbler --height-mm ''", "--height-mm"},
      {"grip small --vessel tumbler --thumb-mm 1,2,3", "--thumb-mm requires --index-mm"},
      {"grip small --vessel tumbler --index-mm 1,2,3", "--index-mm requires --thumb-mm"},
      {"grip small --vessel tumbler --thumb-mm 1,2,3 --index-mm 4,5,6 --height-mm 4", "excludes"},
      {"grip small --vessel tumbler --thumb-mm 1,2 --index-mm 4,5,6", "--thumb-mm '1,2'; allowed: three numbers x,y,z"},
      {"grip small --vessel tumbler --thumb-mm 1,2,3 --index-mm 1,2,3", "are the same point"},
      {"grip small --vessel tumbler --thumb-mm 1,2,3 --index-mm 1,9,3", "must not be vertical"},
      {std::string(SMALL_GRIP) + " --tilt-deg 181", "--tilt-deg '181'; allowed: a number, 0 to 180"},
      {std::string(SMALL_GRIP) + " --fill 0.5 1.1", "--fill '1.1'; allowed: a number, 0 to 1"},
      {std::string(SMALL_GRIP) + " --hand-scale 0", "--hand-scale '0'; allowed: a number, 0.05 to 20"},
      {std::string(SMALL_GRIP) + " --on no-such-device", "no-such-device"},
      {"sweep small --on no-such-device", "no-such-device"},
      {"check small --on no-such-device", "no-such-device"},
      {"check small --on core", "name a Vulkan device"},
      {"grip paper_pose --vessel beaker1 --height-mm 50 --fill 0.5", "has no [liquid]"},
      {"grip paper_pose --vessel beaker1 --height-mm 50 --fill-ml 50", "--fill-ml: "},
      {std::string(SMALL_GRIP) + " --fill-ml 6000", "--fill-ml 6000: vessel 'tumbler' holds "},
  });
}

TEST(CommandUsage, RefusesWrongPictures) {
  expect_refusals({
      {std::string(SMALL_GRIP) + " --glb", "--glb"},
      {std::string(SMALL_GRIP) + " --glb ''", "must not be empty"},
      {std::string(SMALL_GRIP) + " --svg ''", "must not be empty"},
      {std::string(SMALL_GRIP) + " --glb /tmp", "--glb /tmp: is a directory; name a file"},
      {std::string(SMALL_GRIP) + " --svg /nonexistent/a.svg", "--svg /nonexistent/a.svg: /nonexistent is not a directory"},
      {std::string(SMALL_GRIP) + " --svg /dev/null", "--svg /dev/null: is a device or pipe"},
      {std::string(SMALL_GRIP) + " --glb /tmp/wholehand_cli_one --svg /tmp/wholehand_cli_one",
       "--glb and --svg name the same file"},
      {std::string(SMALL_GRIP) + " --glb /tmp/wholehand_cli_one --svg /tmp/../tmp/./wholehand_cli_one",
       "--glb and --svg name the same file"},
      {"sweep small --glb -1", "--glb '-1'; allowed: a whole number, 0 to 100000"},
      {"sweep small --glb x", "--glb 'x'"},
      {"sweep small --best 2 --glb 3 --on core -o /tmp/wholehand_cli_none.nc",
       "--glb 3: the sweep keeps only the best 2 grips of each vessel"},
  });
}

TEST(CommandUsage, NamesFileLineAndColumn) {
  const wholehand::TemporaryFolder folder;
  const std::string scene = folder / "a.toml";
  std::ofstream(scene) << "[scene]\npose = \"papr\"\n";
  expect_error("sweep " + scene, 2, scene + ":2:8: pose = 'papr'; allowed: \"articulated\", \"paper\" or \"rigged\"");
  // what only shows after reading
  const std::string vessel = "[[vessel]]\nname = \"v\"\nshape = \"flask\"\ndiameter_mm = 85\nneck_mm = 34\nheight_mm = 140\n";
  std::ofstream(scene) << vessel << "wall_mm = 17.5\n";
  expect_error("sweep " + scene, 2, scene + ":7:11: vessel 'v': wall_mm = 17.5");
  std::ofstream(scene) << vessel << "wall_mm = 1.5\n[hand.angles]\nmcp_deg = [66, 4]\npip_deg = [40, 12]\n";
  expect_error("check " + scene, 2, scene + ":8:1: [hand]: the gap between thumb and index tip must fall");
  std::ofstream(scene) << vessel << "wall_mm = 1.5\n[output]\nkeep = [\"scor\"]\n";
  expect_error("sweep " + scene, 2, scene + ":9:8: [output] keep: unknown variable \"scor\"");
  std::ofstream(scene) << vessel << "wall_mm = 1.5\n[grips]\nheight_fraction = { from = 0, to = 1, count = 1000000 }\n"
                       << "roll_deg = { from = 0, to = 1, count = 1000000 }\n";
  expect_error("sweep " + scene, 2, scene + ":8:1: asks for ");
  std::ofstream(scene) << "[[vessel]]\nname = \"m\"\nmesh = \"wholehand_no_such_mesh.glb\"\n";
  for (const char* command : {"grip @ --vessel m --height-mm 10", "sweep @", "check @", "live @ --no-clock --seconds 1"}) {
    std::string line = command;
    line.replace(line.find('@'), 1, scene);
    expect_error(line, 2, scene + ":3:8: ");
  }
  expect_error("error-time " + scene + " -o " + testing::TempDir(), 2, scene + ":3:8: vessel 'm' is a mesh");
}

// The grippers below the Vulkan devices, with the stand-in for Force Dimension's SDK.
TEST(CommandUsage, ListsDevicesAndGrippers) {
  const wholehand::TemporaryFolder temporary;
  const std::string& folder = temporary.path();
  const std::string program = "WHOLEHAND_LOCK_DIR=" + folder + " WHOLEHAND_DHD_LIBRARY=" STAND_IN_DHD " PROGRAM devices 2>&1 ";
  const Outcome listed = run(program);
  EXPECT_EQ(listed.code, 0) << listed.output;
  std::size_t last = 0;
  for (const char* line : {"\n  rounds products before it adds them, as the kernels ask (NoContraction)\n",
                           "core  the reference, double precision, all threads  <- --on core\n",
                           "\nsim  a virtual user, always there  <- --device sim\n",
                           "\nomega  omega.7, right hand, serial 4001  <- --device omega\n"
                           "  up to 12 N, gripper 8 N, gap 0 to 25 mm, up to 4,000 Hz; SDK 3.17.6",
                           "\nhaply  "}) {
    const std::size_t at = listed.output.find(line, last);
    ASSERT_NE(at, std::string::npos) << listed.output << "lacks, or has elsewhere: " << line;
    last = at;
  }
  // the option comes before the environment
  const Outcome missing = run(program + "--dhd-library /not/there/libdhd.so");
  EXPECT_EQ(missing.code, 0) << missing.output;
  EXPECT_NE(missing.output.find("\nomega  cannot be opened: cannot load Force Dimension's SDK: /not/there/libdhd.so"),
            std::string::npos)
      << missing.output;
  const Outcome old = run(program + "--dhd-library " STAND_IN_DHD_OLD);
  EXPECT_NE(old.output.find("lacks the function dhdSetWatchdog"), std::string::npos) << old.output;
  // without a driver for Vulkan: the core and the grippers all the same, and how to get a driver
  const Outcome no_vulkan = run("VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent " + program);
  EXPECT_EQ(no_vulkan.code, 0) << no_vulkan.output;
  EXPECT_EQ(no_vulkan.output.find("vulkan  cannot be used: no Vulkan driver"), 0u) << no_vulkan.output;
  for (const char* part : {"install mesa-vulkan-drivers", "\ncore  the reference, ", "\nomega  omega.7, right hand"})
    EXPECT_NE(no_vulkan.output.find(part), std::string::npos) << no_vulkan.output << "lacks " << part;
}

// No driver, as on a machine that has none: an error where a device was asked for, and the core where that is left to the program.
TEST(CommandUsage, SaysWhenThereIsNoVulkan) {
  const wholehand::TemporaryFolder folder;
  const std::string result = folder / "a.nc";
  for (const std::string& arguments : {"sweep small --on vulkan -o " + result, std::string("check small")}) {
    const Outcome outcome =
        run("VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent PROGRAM " + arguments + " 2>&1 >/dev/null");
    EXPECT_EQ(outcome.code, 3) << outcome.output;
    EXPECT_EQ(outcome.output.find("wholehand: no Vulkan driver"), 0u) << outcome.output;
    EXPECT_EQ(outcome.output.find('\n'), outcome.output.size() - 1) << outcome.output;
    EXPECT_NE(outcome.output.find("install mesa-vulkan-drivers"), std::string::npos) << outcome.output;
    for (const char* left : {"", ".partial"}) EXPECT_FALSE(std::filesystem::exists(result + left)) << left;
    if (!arguments.starts_with("check")) continue;
    const std::string words = "sweep with ";  // the remedy, which is followed
    const std::size_t remedy = outcome.output.find(words);
    ASSERT_NE(remedy, std::string::npos) << outcome.output;
    const Outcome followed =
        run("VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent PROGRAM sweep small -o " + result + " " +
            outcome.output.substr(remedy + words.size(), outcome.output.find('\n') - remedy - words.size()) + " 2>&1");
    EXPECT_EQ(followed.code, 0) << followed.output;
  }
  const std::string own = folder / "own.nc";
  const Outcome chosen = run("VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent PROGRAM sweep small -o " + own);
  EXPECT_EQ(chosen.code, 0) << chosen.output;
  EXPECT_NE(chosen.output.find("\non core, "), std::string::npos) << chosen.output;
  EXPECT_NE(chosen.output.find("\ncomputed on the CPU core, double, in "), std::string::npos) << chosen.output;
  EXPECT_TRUE(std::filesystem::exists(own));
}

}  // namespace

#endif
