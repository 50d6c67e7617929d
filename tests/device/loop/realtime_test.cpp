// SPDX-License-Identifier: MIT
// The haptic thread's scheduling and locked memory: the report is true.
// sanitizers: none
#include "device/loop/realtime.h"

#include <gtest/gtest.h>

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <thread>

namespace wholehand::device {
namespace {

bool mentions(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(), [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

// In a process of its own: what is locked and how a thread is scheduled ends with it.
template <class Body>
int exit_code_of(const Body& body) {
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) _exit(body());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

long locked_kib() {
  std::FILE* file = std::fopen("/proc/self/status", "r");
  char line[256];
  long kib = -1;
  while (file && std::fgets(line, sizeof line, file))
    if (std::sscanf(line, "VmLck: %ld", &kib) == 1) break;
  if (file) std::fclose(file);
  return kib;
}

TEST(Realtime, EitherIsSoOrSaysWhyNot) {
  EXPECT_EQ(exit_code_of([] {
              const auto notes = make_realtime();
              int policy = -1;
              sched_param parameters{};
              pthread_getschedparam(pthread_self(), &policy, &parameters);
              const bool is_fifo = policy == SCHED_FIFO && parameters.sched_priority >= 50;
              if (is_fifo == mentions(notes, "real-time scheduling")) return 1;
              if ((locked_kib() > 0) == mentions(notes, "memory is not locked")) return 2;
              if (prctl(PR_GET_TIMERSLACK) != 1 && !is_fifo) return 3;  // a real-time thread has none
              return 0;
            }),
            0);
}

// Someone without any right to either: a line for each, with what permits it, and the thread goes on.
TEST(Realtime, NamesTheRemedyWhereNothingIsPermitted) {
  EXPECT_EQ(exit_code_of([] {
              const rlimit none{0, 0};
              if (setrlimit(RLIMIT_RTPRIO, &none) != 0 || setrlimit(RLIMIT_MEMLOCK, &none) != 0) return 9;
              if (geteuid() == 0 && setresuid(65534, 65534, 65534) != 0) return 8;
              const auto notes = make_realtime();
              if (notes.size() != 2) return 1;
              if (!mentions(notes, "rtprio") || !mentions(notes, "memlock")) return 2;
              for (const std::string& note : notes)
                if (note.find("limits.d") == std::string::npos || note.find('\n') != std::string::npos) return 3;
              return 0;
            }),
            0);
}

TEST(Realtime, IsOfTheCallingThreadAlone) {
  EXPECT_EQ(exit_code_of([] {
              std::thread([] { make_realtime(); }).join();
              int policy = -1;
              sched_param parameters{};
              pthread_getschedparam(pthread_self(), &policy, &parameters);
              return policy == SCHED_OTHER ? 0 : 1;
            }),
            0);
}

}  // namespace
}  // namespace wholehand::device
