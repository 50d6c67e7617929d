// SPDX-License-Identifier: MIT
#include "app/program/failure_line.h"

#include <cxxabi.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <typeinfo>

#include "base/system/failure_signals.h"
#include "base/system/memory_limit.h"

namespace wholehand {
namespace {

alignas(std::max_align_t) char failure_stack[64 * 1024];
// printed until prepare_words() has found a memory limit
char without_memory[200] = "out of memory; ask for less at once";
char why[200] = "; please report it, unless memory ran out";  // after the signal, of an unknown failure
std::atomic<bool> is_memory_short{false};
std::atomic<pid_t> first_thread{0};  // that failed; 0: none
static_assert(std::atomic<bool>::is_always_lock_free &&
              std::atomic<pid_t>::is_always_lock_free);  // otherwise a signal handler could not use them
std::terminate_handler terminate_before = nullptr;

void add_text(char* line, std::size_t size, const char* text) { std::strncat(line, text, size - std::strlen(line) - 1); }

// One write, so that no other thread's words come between.
void on_failure(int signal) {
  const pid_t self = gettid();
  pid_t none = 0;
  if (!first_thread.compare_exchange_strong(none, self)) {
    if (none == self) _exit(3);  // in here
    for (;;) pause();            // until the first one ends the process
  }
  char line[400] = "wholehand: ";
  if (is_memory_short) {
    add_text(line, sizeof line, without_memory);
  } else {
    add_text(line, sizeof line, "the program failed (");
    for (const FailureSignal& one : FAILURE_SIGNALS)
      if (one.number == signal) add_text(line, sizeof line, one.name);
    add_text(line, sizeof line, ")");
    add_text(line, sizeof line, why);
  }
  add_text(line, sizeof line, "\n");
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line, std::strlen(line));
  _exit(3);
}

[[noreturn]] void on_no_memory() {
  is_memory_short = true;
  throw std::bad_alloc();
}

// An uncaught exception ends in SIGABRT either way. The previous handler names it, but needs memory for that.
void on_uncaught() {
  const std::type_info* type = abi::__cxa_current_exception_type();
  if (type && *type == typeid(std::bad_alloc)) is_memory_short = true;
  if (!is_memory_short && terminate_before) terminate_before();
  std::abort();
}

void prepare_words() {
  const std::string limit = memory_limit_text();
  if (limit.empty()) return;
  std::snprintf(without_memory, sizeof without_memory, "out of memory%s; ask for less at once", limit.c_str());
  std::snprintf(why, sizeof why, "%s; raise that", limit.c_str());
}

}  // namespace

void prepare_failure_line() {
  std::set_new_handler(on_no_memory);
  const std::terminate_handler before = std::set_terminate(on_uncaught);
  if (before != on_uncaught) terminate_before = before;
  stack_t stack{};
  stack.ss_sp = failure_stack;
  stack.ss_size = sizeof failure_stack;
  sigaltstack(&stack, nullptr);
  struct sigaction action {};
  action.sa_handler = on_failure;
  action.sa_flags = SA_ONSTACK | SA_NODEFER;
  for (const FailureSignal& one : FAILURE_SIGNALS) sigaction(one.number, &action, nullptr);
  prepare_words();  // last, as it needs memory itself
}

}  // namespace wholehand
