// SPDX-License-Identifier: MIT
// Standard output and standard error that never stop the work: what cannot be written is lost, and reported at the end.
#pragma once

#include <string>
#include <string_view>

namespace wholehand {

// Call first in main. Files that are opened later do not take the place of closed standard streams; a closed pipe is no signal; and `stdout` and
// `stderr` become streams on which no write fails, so that printing code need not care. What standard error does not take is
// lost. What standard output does not take is lost too, and finish_output() reports it.
void prepare_output();

// Writes `text` to standard output at once. Here and in what follows, what steers a terminal is replaced (base/text/printable.h): only line feeds and
// tabs
// of `text` stay. Nothing else of the program prints, so that no name of a file or a device reaches a terminal as it is.
void print(std::string_view text);

// Writes one line to standard error at once: as it is, and as a note of the program.
void print_to_stderr(std::string_view line);
void print_note(const std::string& line);

// Whether standard output is a pipe whose reader has gone, as far as it was noticed: nobody wants to read more. Where printing is all that is
// left to do, this is the end of it.
bool is_output_abandoned();

// Flushes. Throws Error (failure) unless everything that was printed has been written, or its reader did not want it.
void finish_output();

}  // namespace wholehand
