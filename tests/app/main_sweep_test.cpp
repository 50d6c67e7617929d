// SPDX-License-Identifier: MIT
// wholehand-sweep, which ./wholehand sweep starts: its sweeps are those of the whole program.
// sanitizers: none
#include <gtest/gtest.h>

#include <string>

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
