#include "device/panic.h"

#include <algorithm>
#include <atomic>
#include <cstring>

#include <unistd.h>

namespace wholehand {
namespace {

constexpr int PANICS[PanicGuard::SIGNALS] = {SIGABRT, SIGSEGV, SIGBUS,  SIGFPE,  SIGILL,    SIGQUIT,
                                             SIGALRM, SIGUSR1, SIGUSR2, SIGXCPU, SIGVTALRM, SIGPROF};
constexpr int FAILURES = 5;  // of them, the first
std::atomic<Gripper*> at_hand{nullptr};
std::atomic<pid_t> first{0};                                // thread that failed first; 0: none
static_assert(std::atomic<Gripper*>::is_always_lock_free);  // or a signal handler could not read it

constexpr std::size_t STACK = 64 * 1024;  // bytes: more than any processor's registers and what panic() needs

void say(const char* text) {
  const ssize_t written = write(STDERR_FILENO, text, std::strlen(text));
  static_cast<void>(written);
}

const char* name_of(int signal) {
  constexpr const char* NAMES[PanicGuard::SIGNALS] = {"SIGABRT", "SIGSEGV", "SIGBUS",  "SIGFPE",  "SIGILL",    "SIGQUIT",
                                                      "SIGALRM", "SIGUSR1", "SIGUSR2", "SIGXCPU", "SIGVTALRM", "SIGPROF"};
  for (int k = 0; k < PanicGuard::SIGNALS; ++k)
    if (PANICS[k] == signal) return NAMES[k];
  return "";
}

void on_panic(int signal) {
  // the first one lets go; another thread that fails meanwhile waits for it to end the process, and a panic() that fails is given up
  const pid_t self = gettid();
  pid_t none = 0;
  if (!first.compare_exchange_strong(none, self) && none != self)
    for (;;) pause();
  Gripper* gripper = at_hand.exchange(nullptr);
  if (gripper) gripper->panic();
  const bool has_failed = std::find(PANICS, PANICS + FAILURES, signal) != PANICS + FAILURES;
  say(has_failed ? "wholehand: live: the program failed (" : "wholehand: live: ended by a signal (");
  say(signal == SIGABRT ? "an assertion or an uncaught error" : name_of(signal));
  say("); the force was let go, state released");
  say(has_failed ? "; please report it\n" : "\n");
  _exit(3);
}

}  // namespace

PanicGuard::PanicGuard(Gripper& gripper) {
  at_hand = &gripper;
  struct sigaction action {};
  action.sa_handler = on_panic;
  action.sa_flags = SA_ONSTACK | SA_NODEFER;  // so that the same failure within panic() comes back here
  for (int k = 0; k < SIGNALS; ++k) sigaction(PANICS[k], &action, &before_[k]);
}

PanicGuard::~PanicGuard() {
  for (int k = 0; k < SIGNALS; ++k) sigaction(PANICS[k], &before_[k], nullptr);
  at_hand = nullptr;
}

HandlerStack::HandlerStack() : bytes_(STACK) {
  stack_t stack{};
  stack.ss_sp = bytes_.data();
  stack.ss_size = bytes_.size();
  sigaltstack(&stack, nullptr);
}

HandlerStack::~HandlerStack() {
  stack_t none{};
  none.ss_flags = SS_DISABLE;
  sigaltstack(&none, nullptr);
}

}  // namespace wholehand
