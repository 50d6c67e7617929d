// SPDX-License-Identifier: MIT
// Files that belong together: a run's files replace an earlier run's only when all of them are complete.
#pragma once

#include <string>
#include <vector>

namespace wholehand {

// Until commit() each file has a temporary name beside its own, ending in ".new". So a full disk leaves the earlier files intact. The temporary names
// are fixed, so a lock must keep other processes away (OutputLock).
class FileSet {
 public:
  FileSet() = default;
  // Removes files that have not been renamed.
  ~FileSet();
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;

  // The temporary name of the file that `path` is or points to.
  static std::string temporary_name(const std::string& path);

  // Returns where to write the file that `path` is or points to. Removes what a killed process left there.
  std::string temporary_path(const std::string& path);
  // Writes `text` to it. Throws Error (failure) with the remedy.
  void write(const std::string& path, const std::string& text, const char* remedy);
  // Adds `text` to it, so that a large file need not be in memory at once. Throws Error (failure) with the remedy.
  void append(const std::string& path, const std::string& text, const char* remedy);
  // Leaves no file at `path`: commit() removes an existing file and writes no new one.
  void remove_on_commit(const std::string& path);

  // Flushes all files, and only then renames them in the order in which they were requested. Throws Error (failure) with the remedy; a flush that
  // fails prevents all renames. If the process is killed during the renames, or a rename fails, some files are new and some old.
  void commit(const char* remedy);

  // The message with final names in place of temporary ones.
  std::string with_own_names(std::string message) const;

 private:
  struct File {
    std::string path, temporary_path;
  };
  std::vector<File> files_;
  std::vector<std::string> absent_;
};

}  // namespace wholehand
