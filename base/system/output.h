// SPDX-License-Identifier: MIT
// Standard output and standard error that never stop the work: unwritable text is lost, and the loss is reported at the end.
#pragma once

#include <string>
#include <string_view>

namespace wholehand {

// Call first in main. Keeps files that are opened later from taking the place of closed standard streams, ignores SIGPIPE, and makes `stdout` and
// `stderr` streams on which no write fails, so printing code need not check. Text that standard error refuses is lost; if standard output refuses
// some, finish_output() reports it.
void prepare_output();

// Writes `text` to standard output at once. This function and those below replace what controls a terminal (base/text/printable.h), except line feeds
// and tabs. Nothing else in the program prints, so no file or device name reaches a terminal unfiltered.
void print(std::string_view text);

// Writes one line to standard error at once: unchanged, or as a note of the program.
void print_to_stderr(std::string_view line);
void print_note(const std::string& line);

// Whether the reader of a standard output pipe is known to have gone. If only printing is left to do, stop.
bool is_output_abandoned();

// Flushes. Throws Error (failure) unless all output was written, or its reader had gone.
void finish_output();

}  // namespace wholehand
