// SPDX-License-Identifier: MIT
// The built program where it cannot write, where nobody reads, without its standard streams and at the limits of its files.
// sanitizers: none (it runs the program, for its words)
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "base/files/json.h"
#include "tests/support/files.h"
#include "tests/support/program.h"

#ifdef WHOLEHAND_PROGRAM

namespace {

using wholehand::expect_error;
using wholehand::Outcome;
using wholehand::parse_json;
using wholehand::run;
using wholehand::SMALL_GRIP;

TEST(CommandLine, SaysWhenAResultCannotBeWritten) {
  const wholehand::TemporaryFolder folder;
  const std::string result = folder / "a.nc";
  const Outcome limited = run("ulimit -f 8; PROGRAM sweep small --on core -o " + result + " 2>&1 >/dev/null");
  EXPECT_EQ(limited.code, 3) << limited.output;
  EXPECT_NE(limited.output.find("there is room for only 4.1 kB"), std::string::npos) << limited.output;
  EXPECT_EQ(limited.output.find('\n'), limited.output.size() - 1) << limited.output;
  // enough for the values, and not for the file
  const Outcome cramped = run("ulimit -f 100; PROGRAM sweep small --on core -o " + result + " 2>&1");
  EXPECT_EQ(cramped.code, 3) << cramped.output;
  EXPECT_EQ(cramped.output.rfind("wholehand: ", 0), 0u) << cramped.output;
  EXPECT_NE(cramped.output.find("there is room for only 51.2 kB"), std::string::npos) << cramped.output;
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
       {std::string("--version"), std::string("grip --help"), std::string(SMALL_GRIP), std::string(SMALL_GRIP) + " --json"}) {
    const Outcome full = run("PROGRAM " + arguments + " 2>&1 >/dev/full");
    EXPECT_EQ(full.code, 3) << arguments;
    EXPECT_EQ(full.output, "wholehand: cannot write to standard output: No space left on device; what was printed is incomplete\n");
    const Outcome closed = run("PROGRAM " + arguments + " 2>&1 >&-");
    EXPECT_EQ(closed.code, 3) << arguments;
    EXPECT_EQ(closed.output, "wholehand: cannot write to standard output: Bad file descriptor; what was printed is incomplete\n");
  }
  // whose output comes while it works
  const wholehand::TemporaryFolder folder;
  const std::string result = folder / "a.nc";
  for (const std::string& arguments : {"sweep small --on core -o " + result, std::string("check small")}) {
    const Outcome full = run("PROGRAM " + arguments + " 2>&1 >/dev/full");
    EXPECT_EQ(full.code, 3) << arguments;
    // after lines of progress, where the machine is slow
    EXPECT_TRUE(full.output.ends_with(
        "wholehand: cannot write to standard output: No space left on device; what was printed is incomplete\n"))
        << full.output;
  }
  EXPECT_TRUE(std::filesystem::exists(result)) << "the result itself was written";
}

// The program's output goes into a pipe whose reader has gone; its code and what it says on stderr come back.
Outcome run_unread(const std::string& arguments) {
  return run("pipe=$(mktemp -u); mkfifo $pipe; exec 5<>$pipe 6>$pipe 5>&-; rm $pipe; PROGRAM " + arguments +
             " 2>&1 >&6; echo code $?");
}

TEST(CommandLine, EndsQuietlyWhereNobodyReads) {
  const wholehand::TemporaryFolder temporary;
  const std::string& folder = temporary.path();
  for (const std::string& arguments : {std::string("--help"), std::string("scenes"), std::string(SMALL_GRIP) + " --json"})
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
            "wholehand: live: nobody reads the output any more, so the session ends\ncode 130\n");
  const Outcome cut = run("PROGRAM session " + folder + "/m.nc 2>&1");
  EXPECT_NE(cut.output.find("  ended by a signal, or because nobody read its output any more\n"), std::string::npos) << cut.output;
  EXPECT_EQ(run_unread(std::string(SMALL_GRIP) + " --view").output, "code 0\n");
}

TEST(CommandLine, WorksOnWithoutItsStreams) {
  const wholehand::TemporaryFolder temporary;
  const std::string& folder = temporary.path();
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
}

// Libraries that find none left say that a driver is missing, or nothing.
TEST(CommandLine, SaysThatTooFewFilesCanBeOpen) {
  for (const std::string most : {"16", "8"}) {
    for (const char* arguments : {"check small", "sweep small --on core"}) {
      const Outcome few = run("sh -c 'ulimit -n " + most + "; exec PROGRAM " + arguments + "' 2>&1 >/dev/null");
      EXPECT_EQ(few.code, 3) << few.output;
      const std::string line =
          "files that the program may need can be open at once: the limit is " + most + "; raise this limit (ulimit -n)\n";
      EXPECT_NE(few.output.find(line), std::string::npos) << few.output;
    }
  }
}

TEST(CommandLine, SaysThatAFileGrewPastItsLimit) {
  const wholehand::TemporaryFolder temporary;
  const std::string& folder = temporary.path();
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
}

TEST(CommandLine, DoesNotWaitForAPipeToView) {
  const std::string pipe = std::filesystem::temp_directory_path() / "wholehand_cli_pipe";
  expect_error("view $(rm -f " + pipe + "; mkfifo " + pipe + "; echo " + pipe + ")", 2,
               pipe + ": is a device or pipe; name a recording");
  std::filesystem::remove(pipe);
}

TEST(CommandLine, RunsFromAnywhereAndWithStreamsClosed) {
  const Outcome grip = run("cd / && PROGRAM " + std::string(SMALL_GRIP) + " --json <&- 2>&-");
  EXPECT_EQ(grip.code, 0);
  EXPECT_EQ(parse_json(grip.output)["vessel"], "tumbler");
}

}  // namespace

#endif
