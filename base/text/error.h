// SPDX-License-Identifier: MIT
// The one exception type of code outside the kernels: a line for the user and the exit code that goes with it.
#pragma once

#include <stdexcept>
#include <string>

namespace wholehand {

enum class ExitCode : int { done = 0, no = 1, usage = 2, failure = 3, interrupted = 130 };

// Remedies that the user requests with command-line options. Libraries up to core/meshes/ attach one to an error; app/program/remedy.h has the words.
enum class Remedy {
  none,
  core,                // to compute on the core
  or_core,             // the same, after another remedy at the end of the line
  double_precision,    // to compute in double
  float_precision,     // to compute in float
  or_float_precision,  // the same, after another remedy
  name_library,        // to name the path of Force Dimension's SDK; follows the line
};

// `what()` is one line: what went wrong, where, and what to do. main catches it and prints `wholehand: <line>` to stderr, followed by the remedy's
// words.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& line, Remedy remedy = Remedy::none)
      : std::runtime_error(line), code(code), remedy(remedy) {}
  ExitCode code;
  Remedy remedy;
};

// Wrong usage or input (exit 2) and device or system failure (exit 3).
inline Error usage_error(const std::string& line, Remedy remedy = Remedy::none) { return Error(ExitCode::usage, line, remedy); }
inline Error failure_error(const std::string& line, Remedy remedy = Remedy::none) { return Error(ExitCode::failure, line, remedy); }

// Puts `place` of a scene file, if there is one, before a message.
inline std::string at_place(const std::string& place, const std::string& message) {
  return place.empty() ? message : place + ": " + message;
}

}  // namespace wholehand
