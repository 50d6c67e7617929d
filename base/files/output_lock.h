// SPDX-License-Identifier: MIT
// Who may write a result: one process at a time.
#pragma once

#include <string>

namespace wholehand {

// Held from before anything of a result is made or removed until it is whole or given up. The kernel releases it with the process,
// however that ends; the file that stays then is no obstacle. Where a file system knows no locks, the process that the file names
// decides, as long as it lives here; one on another machine is unknown here and no obstacle (see ResultFile::check_own).
class OutputLock {
 public:
  // `path`: of the lock's own file, made where it is not there. `what` -o names, for messages: "file" or "folder". Throws Error:
  // (usage) another process holds it, and which, or the file is something else; (failure) it cannot be made.
  explicit OutputLock(const std::string& path, const char* what = "file");
  // Removes the file.
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  std::string path_;
  int file_ = -1;
};

}  // namespace wholehand
