// SPDX-License-Identifier: MIT
#include "base/system/interrupt.h"

#include "base/system/clock.h"

namespace wholehand {
namespace {

std::atomic<bool> stop{false};
std::atomic<bool> signal_came{false};
std::atomic<int> number_of_first{0};
static_assert(std::atomic<bool>::is_always_lock_free);  // otherwise a signal handler could not set it

// A signal may be sent to the program and to its group, so one request arrives twice: a signal this soon after another is not a second request.
constexpr double SAME_REQUEST = 0.25;  // s

std::atomic<double> first_came{0};
std::atomic<void (*)(int)> another{nullptr};
static_assert(std::atomic<double>::is_always_lock_free && std::atomic<void (*)(int)>::is_always_lock_free);

void on_signal(int signal) {
  // stored first, because another thread may take the second signal at once
  double never = 0;
  first_came.compare_exchange_strong(never, monotonic_now());
  int none = 0;
  number_of_first.compare_exchange_strong(none, signal);
  if (!signal_came.exchange(true)) {
    stop = true;
    return;
  }
  if (monotonic_now() - first_came < SAME_REQUEST) return;
  if (const auto act = another.load()) return act(signal);
  struct sigaction by_default {};
  by_default.sa_handler = SIG_DFL;
  sigaction(signal, &by_default, nullptr);
  raise(signal);
}

}  // namespace

InterruptGuard::InterruptGuard(int further) : further_(further) {
  stop = false;
  signal_came = false;
  first_came = 0;
  number_of_first = 0;
  another = nullptr;
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, &interrupt_before_);
  sigaction(SIGTERM, &action, &terminate_before_);
  sigaction(SIGHUP, nullptr, &hangup_before_);
  if (further_ != 0) sigaction(further_, &action, &further_before_);
  if (hangup_before_.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup stays as it is
}

InterruptGuard::~InterruptGuard() {
  sigaction(SIGINT, &interrupt_before_, nullptr);
  sigaction(SIGTERM, &terminate_before_, nullptr);
  sigaction(SIGHUP, &hangup_before_, nullptr);
  if (further_ != 0) sigaction(further_, &further_before_, nullptr);
  another = nullptr;
}

std::atomic<bool>& InterruptGuard::flag() { return stop; }

void InterruptGuard::clear() {
  stop = false;
  if (signal_came) stop = true;
}

void InterruptGuard::on_second_signal(void (*act)(int signal)) { another = act; }

bool InterruptGuard::signalled() { return signal_came; }

int InterruptGuard::signal_number() { return number_of_first; }

}  // namespace wholehand
