#include "app/output.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>

#include "core/error.h"

namespace wholehand {
namespace {

// `cause`: an errno, 0 where it is no longer known.
[[noreturn]] void refuse_output(int cause) {
  const std::string why = cause != 0 ? std::string(": ") + std::strerror(cause) : "";
  throw failure_error("cannot write to standard output" + why + "; what was printed is incomplete");
}

}  // namespace

void prepare_output() {
  std::signal(SIGPIPE, SIG_IGN);
  // open() takes the lowest free number; read-only, so that writing there fails as it does on the closed stream
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
    if (fcntl(descriptor, F_GETFD) < 0 && errno == EBADF) {
      [[maybe_unused]] const int opened = open("/dev/null", O_RDONLY);  // nothing better is left to do where this fails
    }
  }
}

void print(const std::string& text) {
  errno = 0;
  const bool is_whole = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!is_whole) refuse_output(errno);
  finish_output();
}

void finish_output() {
  errno = 0;
  std::cout.flush();
  const bool is_written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout;
  if (is_written) return;
  refuse_output(errno);
}

}  // namespace wholehand
