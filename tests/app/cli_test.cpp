// SPDX-License-Identifier: MIT
// The built program: usage errors, exit codes, standard streams. What the commands compute is tested elsewhere.
// sanitizers: address
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "recordings/recording.h"
#include "tests/support/program.h"

#ifdef WHOLEHAND_PROGRAM

namespace {

using wholehand::expect_error;
using wholehand::Outcome;
using wholehand::run;

constexpr const char* GRIP = "grip small --vessel tumbler --height-mm 50";

TEST(CommandLine, TellsVersionAndHelp) {
  const Outcome version = run("PROGRAM --version 2>&1");
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.output,
            "wholehand " WHOLEHAND_VERSION "\nwholehand devices lists what there is to compute on and to feel with\n");
  for (const char* arguments : {"--help", "sweep --help", "report --help", "grip -h", "check --help", "devices --help"}) {
    const Outcome help = run(std::string("PROGRAM ") + arguments + " 2>&1");
    EXPECT_EQ(help.code, 0) << arguments;
    EXPECT_NE(help.output.find("Usage:"), std::string::npos) << help.output;
  }
}

TEST(CommandLine, HelpIsTheSameAsACommand) {
  for (const auto& [as_command, as_option] : std::vector<std::pair<std::string, std::string>>{
           {"help", "--help"}, {"help sweep", "sweep --help"}, {"help stability wall", "stability wall --help"}}) {
    const Outcome help = run("PROGRAM " + as_command + " 2>&1");
    EXPECT_EQ(help.code, 0) << as_command;
    EXPECT_EQ(help.output, run("PROGRAM " + as_option + " 2>&1").output) << as_command;
  }
}

TEST(CommandLine, ListsTheShippedScenes) {
  const Outcome scenes = run("PROGRAM scenes 2>&1");
  EXPECT_EQ(scenes.code, 0);
  EXPECT_NE(
      scenes.output.find("\nthree_beakers  beaker1, beaker2, beaker3            Three laboratory vessels of about 250 to 400 mL, "),
      std::string::npos)
      << scenes.output;
  EXPECT_EQ(std::count(scenes.output.begin(), scenes.output.end(), '\n'), 4);
}

TEST(CommandLine, RefusesWrongUsageWithOneLineAndCode2) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "which command? sweep, rank, report, grip, check, "},
      {"", ", scenes or help; see wholehand --help"},
      {"swep", "unknown command 'swep' (did you mean 'sweep'?); the commands are sweep, rank, report, grip, check, "},
      {"stab", "unknown command 'stab' (did you mean 'stability'?); the commands are "},
      {"xyzzy", "unknown command 'xyzzy'; the commands are sweep, "},
      {"help swep", "unknown command 'swep' (did you mean 'sweep'?); the commands are sweep, "},
      {"help stability wal", "unknown command 'wal' (did you mean 'wall'?); the commands are wall"},
      {"help sweep small", "wholehand sweep has no commands of its own, so no 'small'"},
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
      {"session /proc/self/status", "/proc/self/status: is no recording"},
      {"session a.nc b.nc", "b.nc; see wholehand session --help"},
      {"report", "result is required"},
      {"report ''", "must not be empty"},
      {"report a.nc -o ''", "must not be empty"},
      {"report /nonexistent.nc", "/nonexistent.nc: cannot be read: No such file or directory"},
      {"report /tmp", "/tmp: is a directory; name the result file of a sweep"},
      {"report /dev/null", "/dev/null: is a device or pipe; name the result file of a sweep"},
      {"report /proc/self/status", "/proc/self/status: is no result file"},
      {"report a.nc b.nc", "b.nc; see wholehand report --help"},
      {"devices extra", "extra; see wholehand devices --help"},
      {"grip", "scene is required"},
      {"grip small", "--vessel is required"},
      {"grip small --vessel tumbler", "where is it held? give --height-mm, or --thumb-mm and --index-mm"},
      {"grip small --vessel tumblr --height-mm 50", "has no such vessel; the nearest is 'tumbler'"},
      {"grip small --vessel tumbler --height-mm 5x", "--height-mm '5x'; allowed: a number, -10000 to 20000"},
      {"grip small --vessel tumbler --height-mm nan", "--height-mm 'nan'"},
      {"grip small --vessel tumbler --height-mm ''", "--height-mm"},
      {"grip small --vessel tumbler --thumb-mm 1,2,3", "--thumb-mm requires --index-mm"},
      {"grip small --vessel tumbler --index-mm 1,2,3", "--index-mm requires --thumb-mm"},
      {"grip small --vessel tumbler --thumb-mm 1,2,3 --index-mm 4,5,6 --height-mm 4", "excludes"},
      {"grip small --vessel tumbler --thumb-mm 1,2 --index-mm 4,5,6", "--thumb-mm '1,2'; allowed: three numbers x,y,z"},
      {"grip small --vessel tumbler --thumb-mm 1,2,3 --index-mm 1,2,3", "are one point"},
      {"grip small --vessel tumbler --thumb-mm 1,2,3 --index-mm 1,9,3", "must not be vertical"},
      {std::string(GRIP) + " --tilt-deg 181", "--tilt-deg '181'; allowed: a number, 0 to 180"},
      {std::string(GRIP) + " --fill 0.5 1.1", "--fill '1.1'; allowed: a number, 0 to 1"},
      {std::string(GRIP) + " --hand-scale 0", "--hand-scale '0'; allowed: a number, 0.05 to 20"},
      {std::string(GRIP) + " --on no-such-device", "no-such-device"},
      {"sweep small --on no-such-device", "no-such-device"},
      {"check small --on no-such-device", "no-such-device"},
      {"check small --on core", "name a Vulkan device"},
      {"grip paper_pose --vessel beaker1 --height-mm 50 --fill 0.5", "has no [liquid]"},
      {"grip paper_pose --vessel beaker1 --height-mm 50 --fill-ml 50", "--fill-ml: "},
      {std::string(GRIP) + " --fill-ml 6000", "--fill-ml 6000: vessel 'tumbler' holds "},
      {std::string(GRIP) + " --glb", "--glb"},
      {std::string(GRIP) + " --glb ''", "must not be empty"},
      {std::string(GRIP) + " --svg ''", "must not be empty"},
      {std::string(GRIP) + " --glb /tmp", "--glb /tmp: is a directory; name a file"},
      {std::string(GRIP) + " --svg /nonexistent/a.svg", "--svg /nonexistent/a.svg: /nonexistent is not a directory"},
      {std::string(GRIP) + " --svg /dev/null", "--svg /dev/null: is a device or pipe"},
      {std::string(GRIP) + " --glb /tmp/wholehand_cli_one --svg /tmp/wholehand_cli_one", "--glb and --svg name one file"},
      {std::string(GRIP) + " --glb /tmp/wholehand_cli_one --svg /tmp/../tmp/./wholehand_cli_one", "--glb and --svg name one file"},
      {"sweep small --glb -1", "--glb '-1'; allowed: a whole number, 0 to 100000"},
      {"sweep small --glb x", "--glb 'x'"},
      {"sweep small --best 2 --glb 3 --on core -o /tmp/wholehand_cli_none.nc", "--glb 3: the best 2 of each vessel are kept"},
  };
  for (const auto& [arguments, gist] : cases) expect_error(arguments, 2, gist);
}

TEST(CommandLine, NamesFileLineAndColumn) {
  const std::string scene = std::filesystem::temp_directory_path() / "wholehand_cli_test.toml";
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
  std::filesystem::remove(scene);
}

// The grippers below the Vulkan devices, with the stand-in for Force Dimension's SDK.
TEST(CommandLine, ListsDevicesAndGrippers) {
  const std::string folder = std::filesystem::temp_directory_path() / "wholehand_cli_test_devices";
  std::filesystem::create_directory(folder);
  const std::string program = "WHOLEHAND_LOCK_DIR=" + folder + " WHOLEHAND_DHD_LIBRARY=" STAND_IN_DHD " PROGRAM devices 2>&1 ";
  const Outcome listed = run(program);
  EXPECT_EQ(listed.code, 0) << listed.output;
  std::size_t last = 0;
  for (const char* line :
       {"core  the reference, double precision, all threads  <- --on core\n",
        "\nsim  a virtual user, always there  <- --device sim\n",
        "\nomega  omega.7, right hand  <- --device omega\n  up to 12 N, gripper 8 N, gap 0 to 25 mm, up to 4000 Hz; SDK 3.17.6"}) {
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
  // without a driver for Vulkan: the grippers all the same, and the code of before
  const Outcome no_vulkan = run("VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent " + program);
  EXPECT_EQ(no_vulkan.code, 3) << no_vulkan.output;
  EXPECT_NE(no_vulkan.output.find("omega  omega.7, right hand"), std::string::npos) << no_vulkan.output;
  EXPECT_NE(no_vulkan.output.find("wholehand: no Vulkan driver"), std::string::npos) << no_vulkan.output;
  std::filesystem::remove_all(folder);
}

// No driver, as on a machine that has none: an error, never the core instead.
TEST(CommandLine, SaysWhenThereIsNoVulkan) {
  const std::string result = std::filesystem::temp_directory_path() / "wholehand_cli_test.nc";
  for (const std::string& arguments : {"sweep small -o " + result, std::string("check small")}) {
    const Outcome outcome =
        run("VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent PROGRAM " + arguments + " 2>&1 >/dev/null");
    EXPECT_EQ(outcome.code, 3) << outcome.output;
    EXPECT_EQ(outcome.output.find("wholehand: no Vulkan driver"), 0u) << outcome.output;
    EXPECT_EQ(outcome.output.find('\n'), outcome.output.size() - 1) << outcome.output;
    EXPECT_NE(outcome.output.find("install mesa-vulkan-drivers"), std::string::npos) << outcome.output;
    for (const char* left : {"", ".partial"}) EXPECT_FALSE(std::filesystem::exists(result + left)) << left;
  }
}

TEST(CommandLine, SaysWhenAResultCannotBeWritten) {
  const std::string result = std::filesystem::temp_directory_path() / "wholehand_cli_test.nc";
  const Outcome limited = run("ulimit -f 8; PROGRAM sweep small --on core -o " + result + " 2>&1 >/dev/null");
  EXPECT_EQ(limited.code, 3) << limited.output;
  EXPECT_NE(limited.output.find("there is room for 4.1 kB"), std::string::npos) << limited.output;
  EXPECT_EQ(limited.output.find('\n'), limited.output.size() - 1) << limited.output;
  for (const char* left : {"", ".partial", ".partial.mark", ".partial.lock", ".best.csv"})
    EXPECT_FALSE(std::filesystem::exists(result + left)) << left;
  expect_error("sweep small --on core -o -", 2, "name one (./- where that is its name)");
  expect_error("sweep small --on core -o /dev/stdout", 2, "is a device or pipe");
  expect_error("sweep small --on core -o /dev/full", 2, "/dev/full");
  expect_error("sweep small --on core -o /nonexistent/a.nc", 2, "/nonexistent");
  expect_error("sweep small --on core -o /proc/a.nc", 3, "cannot make a file in /proc");
}

TEST(CommandLine, SaysWhenItCannotWrite) {
  for (const std::string& arguments :
       {std::string("--version"), std::string("grip --help"), std::string(GRIP), std::string(GRIP) + " --json"}) {
    const Outcome full = run("PROGRAM " + arguments + " 2>&1 >/dev/full");
    EXPECT_EQ(full.code, 3) << arguments;
    EXPECT_EQ(full.output, "wholehand: cannot write to standard output: No space left on device; what was printed is incomplete\n");
    const Outcome closed = run("PROGRAM " + arguments + " 2>&1 >&-");
    EXPECT_EQ(closed.code, 3) << arguments;
    EXPECT_EQ(closed.output, "wholehand: cannot write to standard output: Bad file descriptor; what was printed is incomplete\n");
  }
  // whose output comes while it works
  const std::string result = std::filesystem::temp_directory_path() / "wholehand_cli_test.nc";
  for (const std::string& arguments : {"sweep three_beakers --on core -o " + result, std::string("check small")}) {
    const Outcome full = run("PROGRAM " + arguments + " 2>&1 >/dev/full");
    EXPECT_EQ(full.code, 3) << arguments;
    EXPECT_EQ(full.output, "wholehand: cannot write to standard output: No space left on device; what was printed is incomplete\n");
  }
  EXPECT_TRUE(std::filesystem::exists(result)) << "the result itself was written";
  for (const char* name : {".nc", ".best.csv", ".beaker1.svg", ".beaker2.svg", ".beaker3.svg"})
    std::filesystem::remove(result.substr(0, result.size() - 3) + name);
}

// The program's output goes into a pipe whose reader has gone; its code and what it says on stderr come back.
Outcome run_unread(const std::string& arguments) {
  return run("pipe=$(mktemp -u); mkfifo $pipe; exec 5<>$pipe 6>$pipe 5>&-; rm $pipe; PROGRAM " + arguments +
             " 2>&1 >&6; echo code $?");
}

TEST(CommandLine, EndsQuietlyWhereNobodyReads) {
  std::string folder = std::filesystem::temp_directory_path() / "wholehand_cli_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  for (const std::string& arguments : {std::string("--help"), std::string("scenes"), std::string(GRIP) + " --json"})
    EXPECT_EQ(run_unread(arguments).output, "code 0\n") << arguments;
  // what is asked for is done to its end
  EXPECT_EQ(run_unread("sweep small --on core -o " + folder + "/s.nc").output, "code 0\n");
  for (const char* name : {"s.nc", "s.best.csv", "s.tumbler.svg"})
    EXPECT_TRUE(std::filesystem::exists(folder + "/" + name)) << name;
  EXPECT_EQ(run_unread("live --no-clock --seconds 20 --record " + folder + "/l.nc").output, "code 0\n");
  const Outcome whole = run("PROGRAM session " + folder + "/l.nc 2>&1");
  EXPECT_EQ(whole.output.find("Session of 20.00"), 0u) << whole.output;
  // what only somebody who follows it wants ends, as by Ctrl-C
  EXPECT_EQ(run_unread("live --record " + folder + "/m.nc").output,
            "wholehand: live: nobody reads the output any more, and the session ends\ncode 130\n");
  const Outcome cut = run("PROGRAM session " + folder + "/m.nc 2>&1");
  EXPECT_NE(cut.output.find("  ended by a signal, or as nobody read its output any more\n"), std::string::npos) << cut.output;
  EXPECT_EQ(run_unread(std::string(GRIP) + " --view").output, "code 0\n");
  std::filesystem::remove_all(folder);
}

TEST(CommandLine, WorksOnWithoutItsStreams) {
  std::string folder = std::filesystem::temp_directory_path() / "wholehand_cli_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  const std::string scene = folder + "/s.toml";
  // says on stderr that it begins anew
  std::ofstream(scene) << "[[vessel]]\nname = \"v\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 100\nwall_mm = 2\n"
                       << "[grips]\nheight_mm = [50]\nroll_deg = [0]\n[output]\nkeep = [\"gap\"]\n";
  for (const char* streams : {">/dev/null 2>&-", ">/dev/null 2>/dev/full", "<&- >/dev/null 2>&-"}) {
    const Outcome swept = run("cd " + folder + " && PROGRAM sweep " + scene + " --on core --resume -o s.nc " + streams);
    EXPECT_EQ(swept.code, 0) << streams;
    EXPECT_TRUE(std::filesystem::remove(folder + "/s.nc")) << streams;
  }
  // what was to be printed and was not is a failure, at the end
  for (const char* streams : {"<&- >&- 2>&-", ">/dev/full 2>/dev/full"}) {
    EXPECT_EQ(run("PROGRAM live --view --seconds 0.5 --record " + folder + "/l.nc " + streams).code, 3) << streams;
    const Outcome recorded = run("PROGRAM session " + folder + "/l.nc 2>&1");
    EXPECT_EQ(recorded.output.find("Session of 0.50"), 0u) << recorded.output;
    std::filesystem::remove(folder + "/l.nc");
  }
  std::filesystem::remove_all(folder);
}

// Libraries that find none left say that a driver is missing, or nothing.
TEST(CommandLine, SaysThatTooFewFilesCanBeOpen) {
  for (const std::string most : {"16", "8"}) {
    for (const char* arguments : {"check small", "sweep small --on core"}) {
      const Outcome few = run("sh -c 'ulimit -n " + most + "; exec PROGRAM " + arguments + "' 2>&1 >/dev/null");
      EXPECT_EQ(few.code, 3) << few.output;
      const std::string line =
          "files that may be needed can be open at once: at most " + most + " may be; raise that limit (ulimit -n)\n";
      EXPECT_NE(few.output.find(line), std::string::npos) << few.output;
    }
  }
}

TEST(CommandLine, SaysThatAFileGrewPastItsLimit) {
  std::string folder = std::filesystem::temp_directory_path() / "wholehand_cli_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  ASSERT_EQ(run("PROGRAM sweep small --on core -o " + folder + "/a.nc 2>&1").code, 0);
  const std::string grip = "grip small --vessel tumbler --height-mm 60";
  for (const std::string& arguments : {"report " + folder + "/a.nc -o " + folder + "/p.html", grip + " --glb " + folder + "/g.glb",
                                       grip + " --svg " + folder + "/g.svg", "rank " + folder + "/a.nc -o " + folder + "/l.csv"}) {
    const Outcome outcome = run("ulimit -f 1; PROGRAM " + arguments + " 2>&1 >/dev/null");
    EXPECT_EQ(outcome.code, 3) << arguments;
    EXPECT_NE(outcome.output.find("File too large"), std::string::npos) << outcome.output;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    EXPECT_TRUE(entry.path().filename().string().starts_with("a.")) << entry.path() << " is half written";
  std::filesystem::remove_all(folder);
}

TEST(CommandLine, DoesNotWaitForAPipeToView) {
  const std::string pipe = std::filesystem::temp_directory_path() / "wholehand_cli_pipe";
  expect_error("view $(rm -f " + pipe + "; mkfifo " + pipe + "; echo " + pipe + ")", 2,
               pipe + ": is a device or pipe; name a recording");
  std::filesystem::remove(pipe);
}

TEST(CommandLine, RunsFromAnywhereAndWithStreamsClosed) {
  const Outcome grip = run("cd / && PROGRAM " + std::string(GRIP) + " --json <&- 2>&-");
  EXPECT_EQ(grip.code, 0);
  EXPECT_EQ(nlohmann::json::parse(grip.output)["vessel"], "tumbler");
}

// A vessel lifted for a second.
std::string small_recording(const std::string& folder) {
  using namespace wholehand;
  RecordingInfo info;
  info.scene_name = "bench";
  info.device.name = "omega.7";
  info.vessels = {{"one", "water", 2}};
  std::vector<Tick> ticks(1500);
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    ticks[k].number = static_cast<std::int64_t>(k);
    ticks[k].state = k < 500 ? SessionState::free : SessionState::lift;
    ticks[k].vessel = k < 500 ? -1 : 0;
    ticks[k].user_force = 3;
  }
  const std::string path = folder + "/session.nc";
  RecordingWriter writer(path, info);
  writer.append(ticks);
  writer.finish({});
  return path;
}

TEST(CommandLine, ReportsASession) {
  std::string folder = std::filesystem::temp_directory_path() / "wholehand_cli_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  const std::string path = small_recording(folder);
  const Outcome table = run("PROGRAM session " + path + " 2>&1");
  EXPECT_EQ(table.code, 0) << table.output;
  EXPECT_EQ(table.output.find("Session of 1.500 s in bench, on omega.7, 1000 Hz"), 0u) << table.output;
  const Outcome json = run("PROGRAM session " + path + " --json -o " + folder + "/out 2>&1");
  EXPECT_EQ(json.code, 0) << json.output;
  const auto report = nlohmann::json::parse(json.output);
  EXPECT_EQ(report["grasps"][0]["vessel"], "one");
  EXPECT_EQ(report["grasps"][0]["duration_s"]["lift"], 1);
  EXPECT_EQ(report["grasps"][0]["grip_before_N"]["mean"], 3);
  for (const char* name : {"session.csv", "states.csv", "session.svg"})
    EXPECT_TRUE(std::filesystem::exists(folder + "/out/" + name)) << name;
  // over its own files, and over nobody else's
  EXPECT_EQ(run("PROGRAM session " + path + " -o " + folder + "/out 2>&1").code, 0);
  for (const char* name : {"session.csv", "states.csv", "session.svg"}) {
    const std::string other = folder + "/other_" + name;
    std::filesystem::create_directory(other);
    std::ofstream(other + "/" + name) << "mine";
    expect_error("session " + path + " -o " + other, 2, std::string(name) + ": is there and is no ");
    EXPECT_EQ(std::filesystem::file_size(other + "/" + name), 4u);
  }
  // cut off in its last records: a note, and what is there
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1000);
  const Outcome cut = run("PROGRAM session " + path + " 2>&1 >/dev/null");
  EXPECT_EQ(cut.code, 0);
  EXPECT_EQ(cut.output, "wholehand: " + path + " is cut off: 1498 of 1500 ticks are there\n");
  std::filesystem::resize_file(path, 3000);
  expect_error("session " + path, 2, path + ": its header is cut off or damaged");
  expect_error("session " + path + " --json -o " + folder + "/out", 2, path + ": its header is cut off or damaged");
  std::filesystem::remove_all(folder);
}

TEST(CommandLine, WritesAPageForASweep) {
  std::string folder = std::filesystem::temp_directory_path() / "wholehand_cli_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  const std::string result = folder + "/s.nc", page = folder + "/s.html";
  ASSERT_EQ(run("PROGRAM sweep small --on core -o " + result + " 2>&1").code, 0);
  const Outcome named = run("PROGRAM report " + result + " 2>&1");
  EXPECT_EQ(named.code, 0) << named.output;
  EXPECT_EQ(named.output.find("wrote " + page + " ("), 0u) << named.output;
  EXPECT_EQ(named.output.find('\n'), named.output.size() - 1) << named.output;
  EXPECT_GT(std::filesystem::file_size(page), 10000u);
  // over an earlier page, and over nothing else
  EXPECT_EQ(run("PROGRAM report " + result + " -o " + page + " 2>&1").code, 0);
  const auto size = std::filesystem::file_size(result);
  expect_error("report " + result + " -o " + result, 2, "this is the result file itself");
  expect_error("report " + result + " -o " + folder + "/s.best.csv", 2, "is no page of wholehand's");
  expect_error("report " + result + " -o " + folder, 2, "is a directory; name a file");
  expect_error("report " + result + " -o /nonexistent/a.html", 2, "/nonexistent is not a directory");
  EXPECT_EQ(std::filesystem::file_size(result), size);
  // what was cut off, what is no sweep's, what was not finished
  std::filesystem::remove(page);
  expect_error("report " + small_recording(folder), 2, "wholehand session");
  std::filesystem::copy_file(result, folder + "/t.nc");
  std::filesystem::resize_file(folder + "/t.nc", size / 2);
  expect_error("report " + folder + "/t.nc", 2, "is damaged");
  std::filesystem::rename(result, result + ".partial");
  expect_error("report " + result, 2, "was not finished; finish it with wholehand sweep --resume");
  EXPECT_FALSE(std::filesystem::exists(page));
  std::filesystem::remove_all(folder);
}

TEST(CommandLine, StiffestWallOfADevice) {
  const Outcome json =
      run("PROGRAM stability wall --mass-kg 0.1 --damping-Nspm 1 --rate-hz 1000 --encoder-um 20 --coulomb-N 0.015 --json");
  EXPECT_EQ(json.code, 0) << json.output;
  const auto limits = nlohmann::json::parse(json.output);
  EXPECT_EQ(limits.size(), 4u);
  EXPECT_NEAR(limits["passive_K_Npm"].get<double>(), 2000, 1e-6);
  EXPECT_NEAR(limits["linear_K_Npm"].get<double>(), 2003.3, 0.1);
  EXPECT_NEAR(limits["coulomb_K_Npm"].get<double>(), 1500, 1e-6);
  EXPECT_GT(limits["largest_stable_K_Npm"].get<double>(), 1500);
  const Outcome table = run("PROGRAM stability wall --mass-kg 0.1 --damping-Nspm 1 --rate-hz 1000 --wall-damping-Nspm 0.5");
  EXPECT_NE(table.output.find("2990.1"), std::string::npos) << table.output;
}

TEST(CommandLine, EvaluatesOneGrip) {
  const Outcome table = run("PROGRAM " + std::string(GRIP) + " --fill 0.3 0.6 --tilt-deg 0 10 20 2>&1");
  EXPECT_EQ(table.code, 0) << table.output;
  EXPECT_NE(table.output.find("Grip of tumbler in small, on core, double"), std::string::npos) << table.output;
  EXPECT_NE(table.output.find("feasible       yes"), std::string::npos) << table.output;

  const Outcome json = run("PROGRAM " + std::string(GRIP) + " --fill 0.3 0.6 --tilt-deg 0 10 20 --json 2>&1");
  EXPECT_EQ(json.code, 0) << json.output;
  const auto grip = nlohmann::json::parse(json.output);
  ASSERT_EQ(grip["states"].size(), 6u);
  EXPECT_EQ(grip["states"][1]["fill"], 0.3);
  EXPECT_EQ(grip["states"][5]["fill"], 0.6);
  const Outcome in_ml = run("PROGRAM " + std::string(GRIP) + " --fill-ml 100 --tilt-deg 0 --json 2>&1");
  EXPECT_NEAR(nlohmann::json::parse(in_ml.output)["states"][0]["liquid_volume_m3"].get<double>(), 100e-6, 1e-15);
  EXPECT_DOUBLE_EQ(grip["states"][4]["tilt_rad"].get<double>(), 10 * 3.14159265358979323846 / 180);

  // a grip that is not feasible is an answer, not an error
  const Outcome wide = run("PROGRAM " + std::string(GRIP) + " --hand-scale 0.2 --json 2>&1");
  EXPECT_EQ(wide.code, 0);
  EXPECT_EQ(nlohmann::json::parse(wide.output)["reason"], "too_wide");

  // but there is no hand to draw: nothing is written
  const std::string drawing = std::filesystem::temp_directory_path() / "wholehand_cli_test";
  for (const char* option : {"--glb", "--svg"}) {
    expect_error(std::string(GRIP) + " --hand-scale 0.2 " + option + " " + drawing, 2, "not feasible (too_wide)");
    EXPECT_FALSE(std::filesystem::exists(drawing)) << option;
  }

  // a device that computes says which it is, without disturbing what reads the object
  const Outcome device = run("PROGRAM " + std::string(GRIP) + " --on vulkan --json 2>&1 >/dev/null");
  EXPECT_EQ(device.code, 0);
  EXPECT_EQ(device.output.rfind("wholehand: on ", 0), 0u) << device.output;

  // two points of the same line
  const Outcome direct =
      run("PROGRAM grip three_beakers --vessel beaker1 --height-mm 50 --azimuth-deg 90 --roll-deg -45 --tilt-deg 30 --json");
  const Outcome points =
      run("PROGRAM grip three_beakers --vessel beaker1 --thumb-mm 0,50,40 --index-mm 0,50,-40 --roll-deg -45 --tilt-deg 30 --json");
  EXPECT_EQ(nlohmann::json::parse(direct.output), nlohmann::json::parse(points.output));
}

TEST(CommandLine, DrawsAGrip) {
  std::string folder = std::filesystem::temp_directory_path() / "wholehand_cli_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  const auto head_of = [](const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::string head(4, ' ');
    file.read(head.data(), 4);
    return head;
  };
  const std::string plain = run("PROGRAM " + std::string(GRIP) + " --json").output;
  const Outcome drawn = run("PROGRAM " + std::string(GRIP) + " --json --glb " + folder + "/a.glb --svg " + folder + "/a.svg 2>&1");
  EXPECT_EQ(drawn.code, 0);
  EXPECT_EQ(drawn.output, plain);
  EXPECT_EQ(head_of(folder + "/a.glb"), "glTF");
  EXPECT_EQ(head_of(folder + "/a.svg"), "<svg");
  const std::string scene = folder + "/scene.toml";
  std::ofstream(scene) << "[[vessel]]\nname = \"v\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 100\nwall_mm = 2\n";
  expect_error("grip " + scene + " --vessel v --height-mm 50 --glb " + folder + "/../" + folder.substr(folder.rfind('/') + 1) +
                   "/scene.toml",
               2, "this is the scene file itself");
  // what is there stays, unless it is a drawing
  const std::string notes = folder + "/notes";
  std::ofstream(notes) << "not to be lost";
  expect_error(std::string(GRIP) + " --svg " + notes, 2, "is there and is no drawing of wholehand's");
  expect_error(std::string(GRIP) + " --glb " + notes, 2, "is there and is no glTF binary of wholehand's");
  std::ofstream(notes) << "<svg><title>not to be lost</title></svg>";
  expect_error(std::string(GRIP) + " --svg " + notes, 2, "is there and is no drawing of wholehand's");
  EXPECT_EQ(head_of(notes), "<svg");
  const Outcome again = run("PROGRAM " + std::string(GRIP) + " --svg " + folder + "/a.svg 2>&1");
  EXPECT_EQ(again.code, 0) << again.output;
  EXPECT_NE(again.output.find("wrote " + folder + "/a.svg\n"), std::string::npos) << again.output;
  const Outcome sweep = run("PROGRAM sweep small --on core --best 3 --glb 2 -o " + folder + "/s.nc 2>&1");
  EXPECT_EQ(sweep.code, 0) << sweep.output;
  EXPECT_NE(sweep.output.find("s.tumbler.1.glb .. "), std::string::npos) << sweep.output;
  EXPECT_EQ(head_of(folder + "/s.tumbler.2.glb"), "glTF");
  EXPECT_FALSE(std::filesystem::exists(folder + "/s.tumbler.3.glb"));
  std::filesystem::remove_all(folder);
}

// Where liquid would stand in a solid stem, every command says so that evaluates the scene.
TEST(CommandLine, ACavityThatReachesIntoAStemIsNoted) {
  std::string folder = std::filesystem::temp_directory_path() / "wholehand_cli_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  const std::string scene = folder + "/wine.toml";
  std::ofstream(scene)
      << "[liquid]\nfills_ml = [0, 120]\n[[vessel]]\nname = \"wine\"\noutline = [{ line = [35, 0] }, { line = [35, 3] }, { line = "
         "[5, 6] }, { line = [5, 80] }, { arc_through = [39, 110], to = [34, 140] }, { line = [0, 140] }]\nwall_mm = 2\n";
  for (const std::string& command :
       {"grip " + scene + " --vessel wine --height-mm 110", "sweep " + scene + " --on core -o " + folder + "/w.nc",
        "check " + scene, "live " + scene + " --no-clock --seconds 0.01"}) {
    const Outcome outcome = run("PROGRAM " + command + " 2>&1 >" + folder + "/out.txt");
    const std::string note = "note: vessel 'wine': its cavity narrows to a radius of 3 mm at ";
    EXPECT_NE(outcome.output.find(note), std::string::npos) << command << ": " << outcome.output;
    EXPECT_EQ(outcome.output.find(note), outcome.output.rfind(note)) << "once";
  }
  std::filesystem::remove_all(folder);
}

}  // namespace

#endif
