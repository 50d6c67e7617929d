// SPDX-License-Identifier: MIT
// The signals by which a program fails: its own doing, and raised in the thread that did it.
#pragma once

#include <csignal>

namespace wholehand {

struct FailureSignal {
  int number;
  const char* name;
};

inline constexpr FailureSignal FAILURE_SIGNALS[] = {{SIGABRT, "SIGABRT"}, {SIGSEGV, "SIGSEGV"}, {SIGBUS, "SIGBUS"},
                                                    {SIGFPE, "SIGFPE"},   {SIGILL, "SIGILL"},   {SIGTRAP, "SIGTRAP"},
                                                    {SIGSYS, "SIGSYS"}};

}  // namespace wholehand
