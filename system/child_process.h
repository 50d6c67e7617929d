// SPDX-License-Identifier: MIT
// Another program, fed and waited for, but not for ever.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace wholehand {

enum class ChildEnd {
  success,   // exit code 0
  failure,   // another code, or a signal
  missing,   // no such program on PATH
  no_start,  // the system lacks what it takes
  late,      // not done in time: ended, with all of its process group
};

// Runs `program` of PATH with `input` on its standard input and nothing on its other streams, in a process group of its own. Returns when it has
// ended, though what it started may go on, or when `limit` is over.
ChildEnd run_child(const std::string& program, std::string_view input, std::chrono::milliseconds limit);

}  // namespace wholehand
