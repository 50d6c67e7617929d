// SPDX-License-Identifier: MIT
// What the options of `wholehand live` ask for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

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

}  // namespace wholehand
