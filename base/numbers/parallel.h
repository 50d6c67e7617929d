// SPDX-License-Identifier: MIT
// A loop on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace wholehand {

// `requested` threads; one for each core of the machine where that is 0.
int thread_count(int requested = 0);

// Calls work(i) for each i below `count` on thread_count(threads) threads, or as many as the machine has, the calling one among them.
// They take the numbers in ascending order, each the next one when it is free. `after` is called by the calling thread after each of
// its own, with how many are done by then. What either throws ends the loop: what has begun is finished, and the failure of the
// smallest i is thrown on.
void in_parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& work,
                 const std::function<void(std::size_t)>& after = {});

}  // namespace wholehand
