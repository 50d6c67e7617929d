// SPDX-License-Identifier: MIT
// One session per device: a lock that ends with the process, however that ends.
#pragma once

#include <string>

namespace wholehand::device {

// Holds the lock file `wholehand-NAME.lock` in WHOLEHAND_LOCK_DIR, else in /run/lock, else in /tmp. The file stays behind; the lock does not. It
// works across all users.
class SessionLock {
 public:
  // `name` without slashes, e.g. "omega-0". Throws Error (failure) if another session holds it or the file cannot be made.
  explicit SessionLock(const std::string& name);
  ~SessionLock();
  SessionLock(const SessionLock&) = delete;
  SessionLock& operator=(const SessionLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace wholehand::device
