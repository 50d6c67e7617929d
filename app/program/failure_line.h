// SPDX-License-Identifier: MIT
// Prints a last line if the program itself fails, instead of a silent end by a signal.
#pragma once

namespace wholehand {

// Call first, even before the libraries' own initialization. From then on, a failure signal (SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGTRAP,
// SIGSYS) on any thread that does not block it, and an uncaught exception, write one line to standard error and end the process with exit code 3.
// Libraries that do not check for memory fail like that, so the line mentions memory if it is known to be short. Everything needed is prepared here.
// Do not call under a sanitizer, which has its own handlers. A PanicGuard takes these signals over while it lives.
void prepare_failure_line();

}  // namespace wholehand
