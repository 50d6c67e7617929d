// SPDX-License-Identifier: MIT
// wholehand-sweep, which ./wholehand sweep starts: its sweeps are those of the whole program.
// sanitizers: none
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>

#include "sweeps/run/code_id.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/result_reader.h"

namespace wholehand {
namespace {

TEST(SweepProgram, AnswersWhatTheWholeProgramAnswers) {
  const TemporaryFolder whole, alone;
  const std::string arguments = " sweep small --on core --best 4 -o ", result = "a.nc", list = "a.best.csv";
  ASSERT_EQ(run("PROGRAM" + arguments + (whole / result) + " >/dev/null").code, 0);
  const Outcome outcome = run("PROGRAM-sweep" + arguments + (alone / result) + " 2>&1");
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_EQ(file_text(alone / list), file_text(whole / list));
  expect_same_values(alone / result, whole / result);
}

// Writes a scene of some tenths of a second, and answers the arguments that sweep it.
std::string long_sweep(const TemporaryFolder& folder, const std::string& result) {
  write_file(folder / "a.toml",
             "[[vessel]]\nname = \"v\"\nshape = \"cylinder\"\ndiameter_mm = 70\nheight_mm = 110\nwall_mm = 1.5\n"
             "[grips]\nheight_fraction = { from = 0.1, to = 0.9, count = 400 }\nroll_deg = { from = -90, to = 30, count = 20 }\n"
             "[output]\nbest = 3\napart_mm = 0\n");
  return " sweep " + (folder / "a.toml") + " --on core --threads 1 --mark-seconds 0.01 -o " + result;
}

// Ended at the first mark.
void expect_left(const std::string& program, const std::string& arguments, const std::string& result) {
  const Outcome left = run(program + arguments + " 2>&1 >/dev/null & while [ ! -e " + result +
                           ".partial.mark ] && kill -0 $!; do :; done; kill -TERM $!; wait $!");
  ASSERT_EQ(left.code, 130) << left.output;
}

TEST(SweepProgram, EitherResumesTheSweepsOfTheOther) {
  const TemporaryFolder folder;
  const std::string whole = folder / "whole.nc", result = folder / "a.nc", arguments = long_sweep(folder, result);
  ASSERT_EQ(run("PROGRAM" + long_sweep(folder, whole) + " >/dev/null").code, 0);
  for (const auto& [first, second] : {std::pair{"PROGRAM-sweep", "PROGRAM"}, {"PROGRAM", "PROGRAM-sweep"}}) {
    expect_left(first, arguments, result);
    const Outcome ended = run(second + arguments + " --resume 2>&1 >/dev/null");
    ASSERT_EQ(ended.code, 0) << ended.output;
    EXPECT_NE(ended.output.find("wholehand: continuing "), std::string::npos) << ended.output;
    expect_same_values(result, whole);
    std::filesystem::remove(result);
  }
}

// Other code may give other bits. Here it is another digit of its id.
TEST(SweepProgram, ASweepOfOtherCodeIsRefused) {
  const TemporaryFolder folder;
  const std::string result = folder / "a.nc", arguments = long_sweep(folder, result), other = folder / "wholehand-sweep",
                    id = sweeps::code_id();
  std::string program = file_text(std::string(WHOLEHAND_PROGRAM) + "-sweep");
  const std::size_t at = program.find(id);
  ASSERT_NE(at, std::string::npos);
  program[at + 5] = id[5] == '0' ? '1' : '0';
  write_file(other, program);
  std::filesystem::permissions(other, std::filesystem::perms::owner_all);
  expect_left(other, arguments, result);
  const Outcome refused = run("PROGRAM" + arguments + " --resume 2>&1 >/dev/null");
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(refused.output, "wholehand: --resume: " + result + ".partial was begun with another code (\"" +
                                program.substr(at, id.size()) + "\", now \"" + id +
                                "\"); ask for the same, or start again without --resume\n");
}

TEST(SweepProgram, HasTheSameOptions) {
  const std::string whole = run("PROGRAM sweep --help").output, alone = run("PROGRAM-sweep sweep --help").output;
  const std::size_t end = whole.find("\nIn a checkout");  // where the words about other commands begin
  ASSERT_NE(end, std::string::npos) << whole;
  EXPECT_EQ(alone.substr(0, end), whole.substr(0, end));
  EXPECT_NE(alone.find("\nExit codes: "), std::string::npos) << alone;
}

TEST(SweepProgram, HasNoOtherCommand) {
  const Outcome outcome = run("PROGRAM-sweep rank a.nc 2>&1");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.output.find("unknown command 'rank'"), std::string::npos) << outcome.output;
}

TEST(SweepProgram, HasTheLastLineOfAFailure) {
  const TemporaryFolder folder;
  const std::string result = folder / "a.nc", words = folder / "said";
  const Outcome outcome = run("ulimit -c 0; PROGRAM-sweep sweep three_beakers --on core --threads 1 -o " + result + " >" + words +
                              " 2>&1 & while [ ! -e " + result + ".partial ]; do sleep 0.01; done; kill -SEGV $!; wait $!");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_NE(file_text(words).find("wholehand: the program failed (SIGSEGV)"), std::string::npos) << file_text(words);
}

}  // namespace
}  // namespace wholehand
