// SPDX-License-Identifier: MIT
// Files that belong together: those of a run take the place of an earlier run's all at once.
#pragma once

#include <string>
#include <vector>

namespace wholehand {

// On the way each file has another name, beside its own. So a disk that fills up leaves the earlier files as they were.
class FileSet {
 public:
  FileSet() = default;
  // Removes what has not been given its own name.
  ~FileSet();
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;

  // Where to write what becomes the file that `path` is or points to. Nothing is there yet.
  std::string on_the_way(const std::string& path);
  // The set has no such file: what is at `path` goes when the others get their names.
  void without(const std::string& path);

  // Flushes all files, and only then renames them, in the order in which they were asked for. Throws Error (failure); a file that
  // cannot be flushed is found before the first one is renamed.
  void give_names(const char* remedy);

  // A message with the files' own names in place of those on the way.
  std::string with_own_names(std::string message) const;

 private:
  struct File {
    std::string path, on_the_way;
  };
  std::vector<File> files_;
  std::vector<std::string> absent_;
};

}  // namespace wholehand
