// SPDX-License-Identifier: MIT
#include "app/commands/driver_watch.h"

#include <unistd.h>

#include <csignal>

namespace wholehand {
namespace {

// Takes no lock and no memory: the hanging thread may hold a lock, and the cause may be a lack of memory.
void on_alarm(int) {
  constexpr char LINE[] = "wholehand: the Vulkan driver did not return within 150 s; try again, or use --on core\n";
  static_assert(DRIVER_PATIENCE == 150, "as the line says");
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, LINE, sizeof LINE - 1);
  _exit(3);
}

}  // namespace

DriverWatch::DriverWatch(const std::string& on) {
  if (on == "core") return;
  std::signal(SIGALRM, on_alarm);
  alarm(DRIVER_PATIENCE);
}

DriverWatch::~DriverWatch() { alarm(0); }

}  // namespace wholehand
