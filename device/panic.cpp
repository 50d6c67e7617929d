#include "device/panic.h"

#include <atomic>
#include <cstring>

#include <unistd.h>

namespace wholehand {
namespace {

constexpr int PANICS[PanicGuard::SIGNALS] = {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL};
std::atomic<Gripper*> at_hand{nullptr};
std::atomic<pid_t> first{0};                                // thread that failed first; 0: none
static_assert(std::atomic<Gripper*>::is_always_lock_free);  // or a signal handler could not read it

// The stack may be what has failed.
alignas(16) char own_stack[64 * 1024];

void say(const char* text) {
  const ssize_t written = write(STDERR_FILENO, text, std::strlen(text));
  static_cast<void>(written);
}

void on_panic(int signal) {
  // the first one lets go; another thread that fails meanwhile waits for it to end the process, and a panic() that fails is given up
  const pid_t self = gettid();
  pid_t none = 0;
  if (!first.compare_exchange_strong(none, self) && none != self)
    for (;;) pause();
  Gripper* gripper = at_hand.exchange(nullptr);
  if (gripper) gripper->panic();
  say("wholehand: live: the program failed (");
  say(signal == SIGABRT   ? "an assertion or an uncaught error"
      : signal == SIGSEGV ? "SIGSEGV"
      : signal == SIGBUS  ? "SIGBUS"
      : signal == SIGFPE  ? "SIGFPE"
                          : "SIGILL");
  say("); the force was let go, state released; please report it\n");
  _exit(3);
}

}  // namespace

PanicGuard::PanicGuard(Gripper& gripper) {
  at_hand = &gripper;
  stack_t stack{};
  stack.ss_sp = own_stack;
  stack.ss_size = sizeof own_stack;
  sigaltstack(&stack, nullptr);  // of the thread that makes the guard; others have their own to overflow
  struct sigaction action {};
  action.sa_handler = on_panic;
  action.sa_flags = SA_ONSTACK | SA_NODEFER;  // so that the same failure within panic() comes back here
  for (int k = 0; k < SIGNALS; ++k) sigaction(PANICS[k], &action, &before_[k]);
}

PanicGuard::~PanicGuard() {
  for (int k = 0; k < SIGNALS; ++k) sigaction(PANICS[k], &before_[k], nullptr);
  stack_t none{};
  none.ss_flags = SS_DISABLE;
  sigaltstack(&none, nullptr);
  at_hand = nullptr;
}

}  // namespace wholehand
