// SPDX-License-Identifier: MIT
#include "system/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>

extern char** environ;

namespace wholehand {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds CHILD_LOOK{2};  // between two looks at whether it has ended

// A broken pipe is an error of the write here, not a signal.
class IgnorePipeSignal {
 public:
  IgnorePipeSignal() {
    struct sigaction ignore {};
    ignore.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &ignore, &before_);
  }
  ~IgnorePipeSignal() { sigaction(SIGPIPE, &before_, nullptr); }

 private:
  struct sigaction before_ {};
};

struct Started {
  int error = 0;  // an errno
  pid_t process = 0;
};

// `input` becomes its standard input. Signals are as a shell would give them.
Started start_child(const std::string& program, int input) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&files, stream, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  std::string name = program;
  char* arguments[] = {name.data(), nullptr};
  Started started;
  started.error = posix_spawnp(&started.process, program.c_str(), &files, &attributes, arguments, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return started;
}

// Writes what the pipe takes now. False: nothing is left to write, or nobody to read it.
bool feed(int pipe, std::string_view& input) {
  if (input.empty()) return false;
  const ssize_t written = write(pipe, input.data(), input.size());
  if (written < 0) return errno == EAGAIN || errno == EINTR;
  input.remove_prefix(static_cast<std::size_t>(written));
  return !input.empty();
}

// Feeds the process by `pipe`, which is closed then, until it has ended or `end` has come.
ChildEnd attend(pid_t process, int pipe, std::string_view input, Clock::time_point end) {
  int status = 0;
  pid_t ended = 0;
  while ((ended = waitpid(process, &status, WNOHANG)) == 0 && Clock::now() < end) {
    if (pipe >= 0 && !feed(pipe, input)) {
      close(pipe);
      pipe = -1;
    }
    pollfd ready{pipe, POLLOUT, 0};  // -1: a pause
    poll(&ready, 1, static_cast<int>(CHILD_LOOK.count()));
  }
  if (pipe >= 0) close(pipe);
  if (ended == 0) {
    kill(-process, SIGKILL);
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) continue;
    return ChildEnd::late;
  }
  return ended == process && WIFEXITED(status) && WEXITSTATUS(status) == 0 ? ChildEnd::success : ChildEnd::failure;
}

}  // namespace

ChildEnd run_child(const std::string& program, std::string_view input, std::chrono::milliseconds limit) {
  const Clock::time_point end = Clock::now() + limit;
  const IgnorePipeSignal ignore;
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return ChildEnd::no_start;
  const Started started = start_child(program, ends[0]);
  close(ends[0]);
  if (started.error != 0) {
    close(ends[1]);
    return started.error == ENOENT ? ChildEnd::missing : ChildEnd::no_start;
  }
  fcntl(ends[1], F_SETFL, O_NONBLOCK);
  return attend(started.process, ends[1], input, end);
}

}  // namespace wholehand
