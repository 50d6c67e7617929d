// SPDX-License-Identifier: MIT
#include "device/loop/realtime.h"

#include <cerrno>
#include <cstdint>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

namespace wholehand::device {
namespace {

constexpr int PRIORITY = 80;              // of 1..99: above interrupt threads' 50
constexpr std::size_t STACK = 64 * 1024;  // bytes that a tick may need

void set_priority(int priority) noexcept {
  sched_param parameters{};
  parameters.sched_priority = priority;
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
}

// Touches the stack so that the first deep call faults no pages in.
void touch_stack() {
  char stack[STACK];
  explicit_bzero(stack, sizeof stack);
}

// Asks the processors not to sleep so deeply that waking takes long, for as long as the process lives: the kernel forgets it when the file
// is closed. Where that is not permitted wakings are a little later, and nothing else.
void keep_awake() {
  static const int file = open("/dev/cpu_dma_latency", O_RDWR | O_CLOEXEC);
  const std::int32_t microseconds = 0;
  if (file >= 0 && write(file, &microseconds, sizeof microseconds) < 0) errno = 0;
}

}  // namespace

void outrank_realtime() noexcept { set_priority(PRIORITY + 1); }

void assist_realtime() noexcept { set_priority(PRIORITY - 1); }

std::vector<std::string> make_realtime() {
  std::vector<std::string> notes;
  sched_param parameters{};
  parameters.sched_priority = PRIORITY;
  if (const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters); error != 0) {
    notes.push_back(fmt::format("no real-time scheduling ({}): an rtprio limit of {} in /etc/security/limits.d permits it",
                                std::strerror(error), PRIORITY));
  }
  touch_stack();
  // what is there now: the loop allocates nothing later, and a limit on locked memory must not fail what others allocate
  if (mlockall(MCL_CURRENT) != 0) {
    notes.push_back(fmt::format("memory is not locked ({}): a memlock limit of unlimited in /etc/security/limits.d permits it",
                                std::strerror(errno)));
  }
  keep_awake();
  prctl(PR_SET_TIMERSLACK, 1);  // ns; 50 us by default for threads that are not real-time
  return notes;
}

}  // namespace wholehand::device
