// SPDX-License-Identifier: MIT
// A loop on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace wholehand {

// `requested` threads; if that is 0, one for each core of the machine.
int thread_count(int requested = 0);

// Calls work(i) for each i below `count` on thread_count(threads) threads, or as many as the machine has, including the calling one. Free threads
// take the next number in ascending order. The calling thread calls `after` after each of its own, with the number done so far. An exception from
// either ends the loop: calls under way finish, and the exception of the smallest i is rethrown.
void in_parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& work,
                 const std::function<void(std::size_t)>& after = {});

}  // namespace wholehand
