// SPDX-License-Identifier: MIT
// The validation layer in every test: a message fails the test that caused it. Including this header in one file of a test
// executable installs it there.
#pragma once

namespace wholehand {

// Switches validation on for the process and those that it starts, unless WHOLEHAND_VALIDATION is set already; has each test
// checked for messages; keeps the driver loaded to the end (leaks are looked for at exit, when what an unloaded library had in use
// has lost its owner). Once, before main. Returns true.
bool install_vulkan_listener();

inline const bool VULKAN_LISTENER_INSTALLED = install_vulkan_listener();

}  // namespace wholehand
