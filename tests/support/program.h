// SPDX-License-Identifier: MIT
// The built program, run in a shell.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#ifdef WHOLEHAND_PROGRAM

namespace wholehand {

// A command that is quickly done.
constexpr const char* SMALL_GRIP = "grip small --vessel tumbler --height-mm 50";

struct Outcome {
  int code = -1;
  std::string output;  // as redirected by the command
};

// `command` in a shell; PROGRAM in it stands for the program.
inline Outcome run(std::string command) {
  for (std::size_t at = 0; (at = command.find("PROGRAM", at)) != std::string::npos;) command.replace(at, 7, WHOLEHAND_PROGRAM);
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return outcome;
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) outcome.output.append(buffer.data(), n);
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

// Runs the program with stderr alone: one line, and nothing on stdout.
inline void expect_error(const std::string& arguments, int code, const std::string& gist) {
  std::string out = std::filesystem::temp_directory_path() / "wholehand_stdout_XXXXXX";
  const int file = mkstemp(out.data());
  ASSERT_GE(file, 0) << out;
  close(file);
  const Outcome errors = run("PROGRAM " + arguments + " 2>&1 >" + out);
  EXPECT_EQ(std::filesystem::file_size(out), 0u) << arguments << " printed something";
  std::filesystem::remove(out);
  EXPECT_EQ(errors.code, code) << arguments << "\n" << errors.output;
  EXPECT_EQ(errors.output.rfind("wholehand: ", 0), 0u) << errors.output;
  ASSERT_FALSE(errors.output.empty()) << arguments;
  EXPECT_EQ(errors.output.find('\n'), errors.output.size() - 1) << errors.output;
  EXPECT_NE(errors.output.find(gist), std::string::npos) << errors.output << "lacks " << gist;
}

}  // namespace wholehand

#endif
