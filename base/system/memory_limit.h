// SPDX-License-Identifier: MIT
// The memory limit of the process, for messages: when memory is short, the limit is the likeliest reason.
#pragma once

#include <sys/resource.h>

#include <string>

namespace wholehand {

// ", and the process may use 500 MB of address space and no more (ulimit -v)"; "" if there is no such limit.
inline std::string memory_limit_text() {
  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) != 0 || space.rlim_cur == RLIM_INFINITY) return "";
  return ", and the process may use " + std::to_string(space.rlim_cur / 1000000) + " MB of address space and no more (ulimit -v)";
}

}  // namespace wholehand
