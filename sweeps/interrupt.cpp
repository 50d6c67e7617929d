#include "sweeps/interrupt.h"

namespace wholehand {
namespace {

std::atomic<bool> stop{false};
std::atomic<bool> signal_came{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // or a signal handler could not set it

void on_signal(int) {
  signal_came = true;
  stop = true;
}

}  // namespace

InterruptGuard::InterruptGuard() {
  stop = false;
  signal_came = false;
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART | SA_RESETHAND;
  sigaction(SIGINT, &action, &interrupt_before_);
  sigaction(SIGTERM, &action, &terminate_before_);
  sigaction(SIGHUP, nullptr, &hangup_before_);
  if (hangup_before_.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup stays as it is
}

InterruptGuard::~InterruptGuard() {
  sigaction(SIGINT, &interrupt_before_, nullptr);
  sigaction(SIGTERM, &terminate_before_, nullptr);
  sigaction(SIGHUP, &hangup_before_, nullptr);
}

std::atomic<bool>& InterruptGuard::flag() { return stop; }

void InterruptGuard::clear() {
  stop = false;
  if (signal_came) stop = true;
}

bool InterruptGuard::signalled() { return signal_came; }

}  // namespace wholehand
