// SPDX-License-Identifier: MIT
// Runs a live session from its command line: gripper, loop, recording and messages.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/text/error.h"

namespace wholehand {

struct LiveOptions {
  std::string scene;  // as for the other commands; empty: a replay's recorded one, else DEFAULT_LIVE_SCENE
  std::string device = "sim";
  double rate = 0;                      // Hz; 0: the scene's, or the recorded one
  std::string record;                   // file; empty: none
  double seconds = 0;                   // 0: until the user is done, or forever
  std::uint64_t seed = 1;               // of the simulated user
  std::optional<std::uint64_t> person;  // number of the virtual person; absent: the median one
  std::string dhd_library;              // empty: the scene's, or wherever it is found
  bool unsafe_gains = false;            // whatever their limits
  bool no_clock = false;                // as fast as possible: simulated and recorded users only
  bool view = false;                    // in the browser
  int view_port = 0;                    // 0: any that is free
  bool advise = false;                  // which grip would be better
  std::string advise_on;                // as for open_backend; empty: vulkan, and core without a device
  bool follow_advice = false;           // the simulated user does
  std::string stream;                   // osc://HOST:PORT; empty: nowhere
  bool json = false;                    // prints only the report at the end on standard output
};

inline constexpr const char* DEFAULT_LIVE_SCENE = "mixing_board";

// Runs the session, and prints events and a final report. Returns done, or interrupted after a signal or when nobody reads the output any more (a
// session without a clock goes on). Throws Error: (usage) a request that is not allowed; (failure) the device cannot be opened, or a fault ended the
// session; the line says which. If a device call does not return, it ends the process itself, with the line and the exit code of a failure.
ExitCode run_live(const LiveOptions& options);

}  // namespace wholehand
