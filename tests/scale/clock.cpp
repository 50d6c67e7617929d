// SPDX-License-Identifier: MIT
// The program's clock in a simulation (base/system/clock.h).
#include "base/system/clock.h"

#include <simgrid/s4u.hpp>

namespace wholehand {

double monotonic_now() noexcept { return simgrid::s4u::Engine::is_initialized() ? simgrid::s4u::Engine::get_clock() : 0; }

void pause_for(double seconds) { simgrid::s4u::this_actor::sleep_for(seconds); }

}  // namespace wholehand
