// SPDX-License-Identifier: MIT
// One session a device: a lock that ends with the process, whatever ends it.
#pragma once

#include <string>

namespace wholehand {

// Holds the lock file `wholehand-NAME.lock` in /run/lock (/tmp where that is none; or WHOLEHAND_LOCK_DIR). The file stays behind, the lock does
// not. It holds between all users.
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

}  // namespace wholehand
