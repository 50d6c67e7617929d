// Standard output that does not fail silently.
#pragma once

#include <string>

namespace wholehand {

// Call first in main: a closed pipe becomes a write error instead of a signal, and files that are opened later do not take the place of
// closed standard streams.
void prepare_output();

// Writes `text` to standard output. Throws Error (failure) where that fails.
void print(const std::string& text);

// Throws Error (failure) unless everything that was printed has been written.
void finish_output();

}  // namespace wholehand
