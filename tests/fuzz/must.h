// SPDX-License-Identifier: MIT
// What a fuzz target promises: libFuzzer takes an abort for a finding.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

namespace wholehand {

inline void must(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "%s\n", what);
  std::abort();
}
inline void must(bool holds, const std::string& what) { must(holds, what.c_str()); }

}  // namespace wholehand
