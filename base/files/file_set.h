// SPDX-License-Identifier: MIT
// Files that belong together: those of a run take the place of an earlier run's once all of them are whole.
#pragma once

#include <string>
#include <vector>

namespace wholehand {

// On the way each file has another name beside its own, which ends in ".new". So a disk that fills up leaves the earlier files as
// they were. The names are always the same: a lock must keep other processes from them (OutputLock).
class FileSet {
 public:
  FileSet() = default;
  // Removes what has not been given its own name.
  ~FileSet();
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;

  // What becomes the file that `path` is or points to has this name on the way.
  static std::string temporary_name(const std::string& path);

  // Where to write what becomes the file that `path` is or points to. Nothing is there yet: what a killed process left goes.
  std::string temporary_path(const std::string& path);
  // Writes `text` there. Throws Error (failure) with the remedy.
  void write(const std::string& path, const std::string& text, const char* remedy);
  // Leaves no file at `path`: commit() removes what is there, and nothing written for it takes its place.
  void remove_on_commit(const std::string& path);

  // Flushes all files, and only then renames them, one after the other in the order in which they were asked for. Throws Error
  // (failure) with the remedy; a file that cannot be flushed is found before the first one is renamed. A process that is killed
  // among the renames, or a rename that fails, leaves some files of the set and some earlier ones.
  void commit(const char* remedy);

  // A message with the files' own names in place of those on the way.
  std::string with_own_names(std::string message) const;

 private:
  struct File {
    std::string path, temporary_path;
  };
  std::vector<File> files_;
  std::vector<std::string> absent_;
};

}  // namespace wholehand
