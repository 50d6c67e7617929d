// SPDX-License-Identifier: MIT
#include "device/loop/panic.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>

#include <poll.h>
#include <unistd.h>

#include "base/system/failure_signals.h"
#include "device/loop/safe_line.h"

namespace wholehand::device {
namespace {

// from outside; the real-time ones are added
constexpr FailureSignal END_REQUESTS[] = {
    {SIGQUIT, "SIGQUIT"},     {SIGALRM, "SIGALRM"}, {SIGUSR1, "SIGUSR1"}, {SIGUSR2, "SIGUSR2"}, {SIGXCPU, "SIGXCPU"},
    {SIGVTALRM, "SIGVTALRM"}, {SIGPROF, "SIGPROF"}, {SIGPWR, "SIGPWR"},   {SIGIO, "SIGIO"},     {SIGSTKFLT, "SIGSTKFLT"}};
// the first of them asks the session to end, another one ends it at once
constexpr FailureSignal INTERRUPTS[] = {{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}};
// the write that meets them fails by itself
constexpr int IGNORED[] = {SIGXFSZ, SIGPIPE};

std::atomic<Gripper*> at_hand{nullptr};
std::atomic<CallWatch*> watch_at_hand{nullptr};
std::atomic<const char*> library_at_hand{nullptr};          // the library in use; null: none
std::atomic<int> libraries{0};                              // guards that say so
std::atomic<pid_t> first{0};                                // thread that failed first; 0: none
std::atomic<int> depth{0};                                  // of its failures
static_assert(std::atomic<Gripper*>::is_always_lock_free);  // otherwise a signal handler could not read it

constexpr int WRITE_LASTS = 2;  // ms: of a force that is being handed over

constexpr std::size_t HANDLER_STACK = 64 * 1024;  // bytes: more than any processor's registers and what panic() needs

// "" where it is none of them.
template <std::size_t N>
const char* name_of(int signal, const FailureSignal (&all)[N]) {
  for (const FailureSignal& one : all)
    if (one.number == signal) return one.name;
  return "";
}

// Writes the force's fate into the line.
void release_in_panic(Gripper& gripper, SafeLine& line) {
  const ForceSize last = gripper.last_written_force();
  ReleaseResult outcome = ReleaseResult::refused;
  // once: a panic() that fails comes back here
  if (depth == 1) {
    outcome = gripper.panic();
    CallWatch* const watch = watch_at_hand;
    if (outcome == ReleaseResult::not_attempted && watch) outcome = watch->rescue();
  }
  add_force_words(line, outcome, last, depth <= 2 ? gripper.limits().watchdog : 0);
}

// `line` says what happened, `advice` what the user should do.
[[noreturn]] void end_here(SafeLine& line, const char* advice) {
  // the first thread releases the force; another one that fails meanwhile waits for it to end the process
  const pid_t self = gettid();
  pid_t none = 0;
  if (!first.compare_exchange_strong(none, self) && none != self)
    for (;;) pause();
  if (++depth > 3) _exit(3);
  Gripper* const gripper = at_hand;
  if (gripper) {
    // a force that the haptic thread is writing meanwhile must not follow the zero; the next one is zero itself
    poll(nullptr, 0, WRITE_LASTS);
    line.add("; ");
    release_in_panic(*gripper, line);
    line.add(", state released");
  }
  line.add(advice).add("\n");
  const ssize_t written = write(STDERR_FILENO, line.text().data(), line.text().size());
  static_cast<void>(written);
  _exit(3);
}

[[noreturn]] void on_panic(int signal) {
  const char* const failure = name_of(signal, FAILURE_SIGNALS);
  const bool has_failed = *failure != '\0';
  const char* name = signal == SIGABRT ? "an assertion or an uncaught error" : has_failed ? failure : name_of(signal, END_REQUESTS);
  if (*name == '\0') name = name_of(signal, INTERRUPTS);
  SafeLine line;
  line.add(has_failed ? "wholehand: live: the program failed (" : "wholehand: live: ended by a signal (").add(name);
  if (*name == '\0') line.add("SIGRTMIN+").add(signal - SIGRTMIN, 0);
  line.add(")");
  end_here(line, has_failed ? "; please report it" : "");
}

// exit() during a session or a call of a device's library: nothing of this program does that.
void on_exit_within(int code) {
  const char* const place = at_hand ? "live" : libraries > 0 ? library_at_hand.load() : nullptr;
  if (!place) return;
  SafeLine line;
  line.add("wholehand: ").add(place).add(": a library ended the program by exit(").add(code, 0).add(")");
  end_here(line, "");
}

void watch_exits() {
  static const bool is_watched = [] {
    on_exit([](int code, void*) { on_exit_within(code); }, nullptr);
    std::at_quick_exit([] { on_exit_within(0); });
    return true;
  }();
  static_cast<void>(is_watched);
}

}  // namespace

void end_by_signal(int signal) noexcept { on_panic(signal); }

bool is_releasing() noexcept { return first.load(std::memory_order_relaxed) != 0; }

void PanicGuard::set(int signal, const struct sigaction& action) {
  Before before;
  before.signal = signal;
  if (sigaction(signal, &action, &before.action) == 0) before_.push_back(before);
}

PanicGuard::PanicGuard(Gripper& gripper, CallWatch* watch) {
  watch_exits();
  watch_at_hand = watch;
  at_hand = &gripper;
  struct sigaction action {};
  action.sa_handler = on_panic;
  action.sa_flags = SA_ONSTACK | SA_NODEFER;  // so that the same failure within panic() comes back here
  for (const FailureSignal& failure : FAILURE_SIGNALS) set(failure.number, action);
  const auto set_unless_ignored = [&](int signal) {
    struct sigaction now {};
    if (sigaction(signal, nullptr, &now) == 0 && now.sa_handler != SIG_IGN) set(signal, action);
  };
  for (const FailureSignal& request : END_REQUESTS) set_unless_ignored(request.number);
  for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal) set_unless_ignored(signal);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  for (const int signal : IGNORED) set(signal, ignore);
}

PanicGuard::~PanicGuard() {
  // the handlers first: while they are installed there is a gripper
  for (const Before& before : before_) sigaction(before.signal, &before.action, nullptr);
  at_hand = nullptr;
  watch_at_hand = nullptr;
}

ExitGuard::ExitGuard(const char* place) {
  watch_exits();
  library_at_hand = place;
  ++libraries;
}

ExitGuard::~ExitGuard() { --libraries; }

HandlerStack::HandlerStack() : bytes_(HANDLER_STACK) {
  stack_t stack{};
  stack.ss_sp = bytes_.data();
  stack.ss_size = bytes_.size();
  sigaltstack(&stack, &before_);
}

HandlerStack::~HandlerStack() { sigaltstack(&before_, nullptr); }

}  // namespace wholehand::device
