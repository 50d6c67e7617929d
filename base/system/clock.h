// SPDX-License-Identifier: MIT
// The one clock for loops, watches and all timing above core/. Waits on a condition or a queue use std::chrono's, which is the same clock. Both
// functions have their own file, so that a simulation can link others (tests/scale).
#pragma once

namespace wholehand {

// Seconds since some fixed moment; never steps. Safe in a signal handler.
double monotonic_now() noexcept;

// Sleeps for `seconds`.
void pause_for(double seconds);

}  // namespace wholehand
