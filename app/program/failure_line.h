// SPDX-License-Identifier: MIT
// A last line where the program itself fails, instead of an end by a signal without a word.
#pragma once

namespace wholehand {

// Call first, even before the libraries' own initialization. From then on a failure that comes as a signal (SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL,
// SIGTRAP, SIGSYS), on any thread that does not block it, and an
// exception that nobody catches write one line to standard error and end the process with exit code 3. Libraries that do not look
// whether there was memory fail like that: the line says so where memory is known to be short. All that this needs is made ready here. Not
// to be called under a sanitizer, which has handlers of its own. PanicGuard takes these signals over while it lives.
void prepare_failure_line();

}  // namespace wholehand
