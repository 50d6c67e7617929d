// SPDX-License-Identifier: MIT
// The one exception type of code that is not a kernel: a line for the user and the exit code that goes with it.
#pragma once

#include <stdexcept>
#include <string>

namespace wholehand {

enum class ExitCode : int { done = 0, no = 1, usage = 2, failure = 3, interrupted = 130 };

// `what()` is one line: what went wrong, where, and what to do. Caught in main, printed to stderr as `wholehand: <line>`.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& line) : std::runtime_error(line), code(code) {}
  ExitCode code;
};

// Wrong usage or input (exit 2) and device or system failure (exit 3).
inline Error usage_error(const std::string& line) { return Error(ExitCode::usage, line); }
inline Error failure_error(const std::string& line) { return Error(ExitCode::failure, line); }

// `place` of a scene file before a message, where there is one.
inline std::string at_place(const std::string& place, const std::string& message) {
  return place.empty() ? message : place + ": " + message;
}

}  // namespace wholehand
