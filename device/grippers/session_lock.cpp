// SPDX-License-Identifier: MIT
#include "device/grippers/session_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "base/text/error.h"

namespace wholehand::device {
namespace {

// One for all users, since two of them may use the same device.
std::string lock_directory() {
  if (const char* named = std::getenv("WHOLEHAND_LOCK_DIR"); named && *named) return named;
  return access("/run/lock", W_OK | X_OK) == 0 ? "/run/lock" : "/tmp";
}

// Every user may lock it, whoever made it. Opens it first and makes it only where it is not there: in a folder that all may write to, a
// kernel lets no other user open a user's file with O_CREAT.
int open_lock_file(const std::string& path) {
  const int there = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (there >= 0 || errno != ENOENT) return there;
  const int made = open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0644);
  return made >= 0 || errno != EEXIST ? made : open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
}

}  // namespace

SessionLock::SessionLock(const std::string& name) {
  const std::string path = fmt::format("{}/wholehand-{}.lock", lock_directory(), name);
  file_ = open_lock_file(path);
  if (file_ < 0) throw failure_error(fmt::format("cannot make the lock file {}: {}", path, std::strerror(errno)));
  if (flock(file_, LOCK_EX | LOCK_NB) == 0) return;
  const int reason = errno;
  close(file_);
  if (reason == EWOULDBLOCK)
    throw failure_error(fmt::format("in use by another session of wholehand (it holds {}); end that one first", path));
  throw failure_error(fmt::format("cannot lock {}: {}", path, std::strerror(reason)));
}

SessionLock::~SessionLock() { close(file_); }

}  // namespace wholehand::device
