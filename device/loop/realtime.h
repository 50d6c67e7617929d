// SPDX-License-Identifier: MIT
// Makes a thread wake on time, if the system permits it.
#pragma once

#include <string>
#include <vector>

namespace wholehand::device {

// Puts the calling thread under SCHED_FIFO, above everything but the kernel's own, and locks the memory that the process has by now. Returns a line
// with the remedy for each that is not permitted; the loop runs without it, and the system decides later wakings.
std::vector<std::string> make_realtime();

// Gives the calling thread a higher priority than that, if permitted: for a watching thread that mostly sleeps.
void outrank_realtime() noexcept;

// Gives the calling thread a lower priority than that, if permitted: for a thread that works for the loop and must not delay it.
void assist_realtime() noexcept;

}  // namespace wholehand::device
