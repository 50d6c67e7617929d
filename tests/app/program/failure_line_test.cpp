// SPDX-License-Identifier: MIT
// Where the program itself fails: one line and exit code 3, whatever failed and on whatever thread. (A sanitizer has handlers of
// its own.)
// sanitizers: none
#include "app/program/failure_line.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/system/block_signals.h"
#include "tests/support/program.h"

namespace wholehand {
namespace {

struct Said {
  int code = -1;  // 1000 + signal where one ended it
  std::string text;
};

Said failing_child(const std::function<void()>& body) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDERR_FILENO);
    close(ends[0]);
    alarm(20);
    prepare_failure_line();
    body();
    _exit(0);
  }
  close(ends[1]);
  Said said;
  char part[512];
  for (ssize_t got = 0; (got = read(ends[0], part, sizeof part)) > 0;) said.text.append(part, static_cast<std::size_t>(got));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  said.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  return said;
}

void fill_stack(volatile char* before);
void (*volatile once_more)(volatile char*) = fill_stack;  // so that the compiler does not see where it leads
void fill_stack(volatile char* before) {
  volatile char here[4096];
  here[0] = before[0];
  once_more(here);
}

void* volatile kept;  // so that the compiler leaves no allocation out

constexpr const char* FAILED = "wholehand: the program failed (SIG";

TEST(FailureLine, IsSaidOnceWhateverFails) {
  const std::pair<const char*, std::function<void()>> failures[] = {
      {"SEGV)", [] { std::raise(SIGSEGV); }},
      {"SEGV)",
       [] {
         char none = 0;
         fill_stack(&none);
       }},
      {"ABRT)", [] { std::abort(); }},
      {"FPE)", [] { std::raise(SIGFPE); }},
      {"SEGV)",
       [] {
         const BlockSignals inherited;
         std::thread([] { *const_cast<volatile int*>(static_cast<int*>(nullptr)) = 1; }).join();
       }},
  };
  for (const auto& [signal, fail] : failures) {
    const Said said = failing_child(fail);
    EXPECT_EQ(said.code, 3) << said.text;
    EXPECT_EQ(said.text, FAILED + std::string(signal) + "; please report it, unless memory ran out\n");
  }
}

TEST(FailureLine, SaysThatMemoryHasRunOut) {
  const Said said = failing_child([] { std::thread([]() noexcept { kept = ::operator new (std::size_t{1} << 62); }).join(); });
  EXPECT_EQ(said.code, 3);
  EXPECT_EQ(said.text, "wholehand: out of memory; ask for less at once\n");
  // what is caught is no failure
  const Said caught = failing_child([] {
    try {
      kept = ::operator new (std::size_t{1} << 62);
    } catch (const std::bad_alloc&) {
    }
  });
  EXPECT_EQ(caught.code, 0);
  EXPECT_EQ(caught.text, "");
}

TEST(FailureLine, NamesTheLimitOfMemory) {
  const Said said = failing_child([] {
    const rlimit space{std::uint64_t{1} << 40, RLIM_INFINITY};
    setrlimit(RLIMIT_AS, &space);
    prepare_failure_line();
    std::raise(SIGBUS);
  });
  EXPECT_EQ(said.code, 3);
  EXPECT_EQ(
      said.text,
      FAILED + std::string("BUS), and the process may use 1099511 MB of address space and no more (ulimit -v); raise that\n"));
}

TEST(FailureLine, OtherExceptionsAreNamed) {
  const Said said = failing_child([] { std::thread([] { throw std::runtime_error("a reason"); }).join(); });
  EXPECT_EQ(said.code, 3);
  EXPECT_NE(said.text.find("a reason"), std::string::npos) << said.text;
  EXPECT_TRUE(said.text.ends_with(FAILED + std::string("ABRT); please report it, unless memory ran out\n"))) << said.text;
}

#ifdef WHOLEHAND_PROGRAM

// What the last line of a run is that did not go well.
void expect_last_line(const Outcome& outcome, const std::string& what) {
  EXPECT_TRUE(outcome.code == 0 || outcome.code == 3) << what << ": " << outcome.code << "\n" << outcome.output;
  if (outcome.code == 0) return;
  ASSERT_FALSE(outcome.output.empty()) << what;
  const std::size_t last = outcome.output.rfind('\n', outcome.output.size() - 2);
  EXPECT_EQ(outcome.output.compare(last == std::string::npos ? 0 : last + 1, 11, "wholehand: "), 0) << what << "\n"
                                                                                                    << outcome.output;
}

// Memory that ends, for good or for one allocation, anywhere in a run: in the initialization of libraries, in C code that does not
// look, in ours.
TEST(FailureLine, EveryRunWithoutMemoryEndsByIt) {
  int failed = 0;
  for (const char* lasting : {"", "MALLOC_FAILS=1 "}) {
    for (int works = 0; works < 60000; works += 1 + works / 4) {
      const std::string limit = lasting + std::string("MALLOC_WORKS=") + std::to_string(works);
      const Outcome outcome = run("timeout 60 env LD_PRELOAD=" STAND_IN_MALLOC " " + limit +
                                  " PROGRAM grip small --vessel tumbler --height-mm 50 2>&1 >/dev/null");
      expect_last_line(outcome, limit);
      if (outcome.code == 3) ++failed;
    }
  }
  EXPECT_GT(failed, 5) << "memory never ran out";
}

// A driver's compiler ends by itself where it finds no memory. A driver whose own thread could not be started never finishes; the
// program waits for 120 s, says so and ends without the driver. A driver may also keep one of its calls for ever; 150 s are given to that. The test
// gives 180.
TEST(FailureLine, EveryRunWithinALimitOfMemoryEndsByIt) {
  int ended = 0;
  for (const auto& [on, limits] : std::vector<std::pair<std::string, std::vector<int>>>{{"core", {110, 115, 120, 125, 130}},
                                                                                        {"vulkan", {250, 350, 450, 500, 550}}}) {
    for (const int megabytes : limits) {
      const std::string limit = "ulimit -v " + std::to_string(megabytes * 1000) + "; ";
      const std::string command = "ulimit -c 0; " + limit + "timeout 180 PROGRAM grip small --vessel tumbler --height-mm 50 --on " +
                                  on + " 2>&1 >/dev/null";
      const Outcome outcome = run(command);
      if (outcome.code == 127) continue;  // the system's loader, before the program, in a line of its own
      expect_last_line(outcome, limit + on);
      if (outcome.code == 3 && on == "core") {
        EXPECT_NE(outcome.output.find("(ulimit -v)"), std::string::npos) << limit << outcome.output;
      }
      ++ended;
    }
  }
  EXPECT_GE(ended, 5);
}

#endif

}  // namespace
}  // namespace wholehand
