// SPDX-License-Identifier: MIT
// The right to write a result: one process at a time.
#pragma once

#include <string>

namespace wholehand {

// Acquire it before making or removing any part of a result; keep it until the result is complete or abandoned. The kernel releases it when the
// process ends; the file that remains does not block anyone. On file systems without locks, the process that the file names holds the lock while it
// lives on this machine; a process on another machine cannot be seen and does not block (see ResultFile::check_own).
class OutputLock {
 public:
  // `path`: the lock file, made if missing. `what`: what -o names in messages, "file" or "folder". Throws Error: (usage) another process, which the
  // message names, holds it, or the file is something else; (failure) it cannot be made.
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
