#include "device/realtime.h"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>

namespace wholehand {
namespace {

constexpr int PRIORITY = 80;              // of 1..99: above interrupt threads' 50
constexpr std::size_t STACK = 64 * 1024;  // bytes that a tick may need

// So that the first deep call does not fault pages in.
void touch_stack() {
  char stack[STACK];
  explicit_bzero(stack, sizeof stack);
}

}  // namespace

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
  prctl(PR_SET_TIMERSLACK, 1);  // ns; 50 us by default for threads that are not real-time
  return notes;
}

}  // namespace wholehand
