// SPDX-License-Identifier: MIT
// The one clock: of loops, watches and everything above core/ that is timed. Waits on a condition or a queue take std::chrono's, which
// is the same. A file of its own holds both functions, so that a simulation can link others in their place (tests/scale).
#pragma once

namespace wholehand {

// s since some moment; never steps. A signal handler may ask, too.
double monotonic_now() noexcept;

// Sleeps for `seconds`.
void pause_for(double seconds);

}  // namespace wholehand
