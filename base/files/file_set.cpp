// SPDX-License-Identifier: MIT
#include "base/files/file_set.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/files/files.h"
#include "base/text/error.h"

namespace wholehand {
namespace {

Error cannot_write(const std::string& path, int error, const char* remedy) {
  return failure_error(fmt::format("cannot write {}: {}; {}", path, std::strerror(error), remedy));
}

// Some file systems find out only here that they have no room.
void flush(const std::string& file, const std::string& own_name, const char* remedy) {
  const int opened = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  const bool is_flushed = opened >= 0 && (fsync(opened) == 0 || errno == EINVAL);  // EINVAL: this one cannot flush
  const int error = errno;
  if (opened >= 0) close(opened);
  if (!is_flushed) throw cannot_write(own_name, error, remedy);
}

}  // namespace

FileSet::~FileSet() {
  for (const File& file : files_) std::remove(file.temporary_path.c_str());
}

std::string FileSet::temporary_name(const std::string& path) { return followed(path) + ".new"; }

std::string FileSet::temporary_path(const std::string& path) {
  files_.push_back({path, temporary_name(path)});
  std::remove(files_.back().temporary_path.c_str());
  return files_.back().temporary_path;
}

void FileSet::write(const std::string& path, const std::string& text, const char* remedy) {
  const int error = write_new_file(temporary_path(path), text, false);
  if (error != 0) throw cannot_write(path, error, remedy);
}

void FileSet::append(const std::string& path, const std::string& text, const char* remedy) {
  const bool is_begun = std::any_of(files_.begin(), files_.end(), [&](const File& file) { return file.path == path; });
  const int error = append_to_file(is_begun ? temporary_name(path) : temporary_path(path), text);
  if (error != 0) throw cannot_write(path, error, remedy);
}

void FileSet::remove_on_commit(const std::string& path) {
  std::erase_if(files_, [&](const File& file) {
    if (file.path != path) return false;
    std::remove(file.temporary_path.c_str());
    return true;
  });
  absent_.push_back(path);
}

void FileSet::commit(const char* remedy) {
  for (const File& file : files_) flush(file.temporary_path, file.path, remedy);
  for (const File& file : files_)
    if (std::rename(file.temporary_path.c_str(), followed(file.path).c_str()) != 0) throw cannot_write(file.path, errno, remedy);
  for (const std::string& path : absent_) std::remove(path.c_str());
  for (const File& file : files_) sync_folder_of(followed(file.path));
  files_.clear();
}

std::string FileSet::with_own_names(std::string message) const {
  for (const File& file : files_)
    for (std::size_t at = 0; (at = message.find(file.temporary_path, at)) != std::string::npos; at += file.path.size())
      message.replace(at, file.temporary_path.size(), file.path);
  return message;
}

}  // namespace wholehand
