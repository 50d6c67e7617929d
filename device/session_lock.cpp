#include "device/session_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "core/error.h"

namespace wholehand {
namespace {

std::string runtime_directory() {
  const char* directory = std::getenv("XDG_RUNTIME_DIR");
  struct stat status;
  const bool is_there = directory && *directory && stat(directory, &status) == 0 && S_ISDIR(status.st_mode);
  return is_there ? directory : "/tmp";
}

}  // namespace

SessionLock::SessionLock(const std::string& name) {
  const std::string path = fmt::format("{}/wholehand-{}.lock", runtime_directory(), name);
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (file_ < 0) throw failure_error(fmt::format("cannot make the lock file {}: {}", path, std::strerror(errno)));
  if (flock(file_, LOCK_EX | LOCK_NB) == 0) return;
  const int reason = errno;
  close(file_);
  if (reason == EWOULDBLOCK)
    throw failure_error(fmt::format("in use by another session of wholehand (it holds {}); end that one first", path));
  throw failure_error(fmt::format("cannot lock {}: {}", path, std::strerror(reason)));
}

SessionLock::~SessionLock() { close(file_); }

}  // namespace wholehand
