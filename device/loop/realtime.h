// SPDX-License-Identifier: MIT
// A thread that wakes on time, where the system permits it.
#pragma once

#include <string>
#include <vector>

namespace wholehand {

// Puts the calling thread under SCHED_FIFO, above everything but the kernel's own, and locks the memory that the process has by now. Returns
// a line, with the remedy, for each that is not permitted: the loop runs without it, and later wakings are then the system's.
std::vector<std::string> make_realtime();

// Puts the calling thread above such a one, where that is permitted: for a watching thread that sleeps most of the time.
void outrank_realtime() noexcept;

}  // namespace wholehand
