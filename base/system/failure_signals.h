// SPDX-License-Identifier: MIT
// The signals by which a program itself fails, raised in the thread that caused them.
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
