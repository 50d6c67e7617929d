// SPDX-License-Identifier: MIT
// Runs a live session from its command line: gripper, loop, recording and messages.
#pragma once

#include "app/commands/live_options.h"
#include "base/text/error.h"

namespace wholehand {

// Runs the session, and prints events and a final report. Returns done, or interrupted after a signal or when nobody reads the output any more (a
// session without a clock goes on). Throws Error: (usage) a request that is not allowed; (failure) the device cannot be opened, or a fault ended the
// session; the line says which. If a device call does not return, it ends the process itself, with the line and the exit code of a failure.
ExitCode run_live(const LiveOptions& options);

}  // namespace wholehand
