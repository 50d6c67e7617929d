// SPDX-License-Identifier: MIT
#include "base/system/output.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "base/text/error.h"
#include "base/text/printable.h"

namespace wholehand {
namespace {

struct Channel {
  int descriptor;
  std::atomic<int> failure{0};  // the errno of the first write that failed; later output is lost
};

Channel standard_output{STDOUT_FILENO}, standard_error{STDERR_FILENO};

// False: errno says why.
bool write_whole(int descriptor, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = write(descriptor, data, size);
    if (written >= 0) {
      data += written;
      size -= static_cast<std::size_t>(written);
    } else if (errno == EAGAIN) {  // the parent process made it so
      pollfd ready{descriptor, POLLOUT, 0};
      poll(&ready, 1, -1);
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

// Accepts everything, whatever happens to it; otherwise fmt would throw, and the work would end.
ssize_t take_all(void* channel, const char* data, std::size_t size) {
  Channel& to = *static_cast<Channel*>(channel);
  if (to.failure == 0 && !write_whole(to.descriptor, data, size)) to.failure = errno;
  return static_cast<ssize_t>(size);
}

// `mode`: for setvbuf. Without memory for a stream, the existing one stays.
void replace_stream(FILE*& stream, Channel& channel, int mode) {
  FILE* made = fopencookie(&channel, "w", {nullptr, take_all, nullptr, nullptr});
  if (!made) return;
  std::setvbuf(made, nullptr, mode, mode == _IONBF ? 0 : BUFSIZ);
  stream = made;
}

}  // namespace

void prepare_output() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows past its limit is an error of the write, not the end of the process
  // open() takes the lowest free number; read-only for output, so that writing there fails as it does on the closed stream
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
    if (fcntl(descriptor, F_GETFD) < 0 && errno == EBADF) {
      const int mode = descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY;
      [[maybe_unused]] const int opened = open("/dev/null", mode);  // nothing better is possible if this fails
    }
  }
  replace_stream(stdout, standard_output, isatty(STDOUT_FILENO) == 1 ? _IOLBF : _IOFBF);
  replace_stream(stderr, standard_error, _IONBF);
}

void print(std::string_view text) {
  const std::string shown = printable_lines(text);
  std::fwrite(shown.data(), 1, shown.size(), stdout);
  std::fflush(stdout);
}

void print_to_stderr(std::string_view line) {
  const std::string shown = one_line(line) + '\n';
  std::fwrite(shown.data(), 1, shown.size(), stderr);
}

void print_note(const std::string& line) { print_to_stderr("wholehand: " + line); }

bool is_output_abandoned() { return standard_output.failure == EPIPE; }

void finish_output() {
  std::fflush(stdout);
  const int failure = standard_output.failure;
  if (failure == 0 || failure == EPIPE) return;
  throw failure_error(std::string("cannot write to standard output: ") + std::strerror(failure) +
                      "; what was printed is incomplete");
}

}  // namespace wholehand
