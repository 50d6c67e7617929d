// SPDX-License-Identifier: MIT
#include "base/files/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/magic.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>
#include <vector>

#include "base/text/error.h"
#include "base/text/readable.h"

namespace wholehand {
namespace {

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

// Whether the folder of `name` is that one, under any name: /dev/fd is one of them.
bool lies_on_procfs(const std::filesystem::path& name) {
  struct statfs system {};
  return statfs(folder_of(name.string()).c_str(), &system) == 0 && system.f_type == PROC_SUPER_MAGIC;
}

// Root may write anywhere, but still cannot make a file in every folder.
void try_folder(const std::string& asked, const std::string& folder, const char* option = "-o") {
  std::string trial = folder + "/.wholehand-XXXXXX";
  const int file = mkstemp(trial.data());
  if (file < 0) {
    throw failure_error(
        fmt::format("{} {}: cannot make a file in {}: {}; name a place elsewhere", option, asked, folder, std::strerror(errno)));
  }
  close(file);
  unlink(trial.c_str());
}

bool write_all(int file, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t written = write(file, text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    done += static_cast<std::size_t>(written);
  }
  return true;
}

}  // namespace

std::string followed(const std::string& path) {
  constexpr int MOST_LINKS = 40;  // the kernel's own limit
  std::filesystem::path name = path;
  for (int links = 0; links < MOST_LINKS; ++links) {
    std::error_code no_link;
    const std::filesystem::path target = std::filesystem::read_symlink(name, no_link);
    if (no_link || lies_on_procfs(name)) break;
    name = target.is_absolute() ? target : name.parent_path() / target;
  }
  return name.string();
}

void check_output_path(const std::string& path, const char* option) {
  if (path == "-") {
    throw usage_error(fmt::format("{} -: standard output does not take a file; name one (./- where that is its name)", option));
  }
  const std::string target = followed(path);
  struct stat status {};
  if (lstat(target.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
    throw usage_error(
        fmt::format("{} {}: is a {}; name a file", option, path, S_ISDIR(status.st_mode) ? "directory" : "device or pipe"));
  }
  const std::string folder = folder_of(target);
  if (path.empty() || path.ends_with('/') || stat(folder.c_str(), &status) != 0 || !S_ISDIR(status.st_mode)) {
    throw usage_error(fmt::format("{} {}: {} is not a directory; create it or name another", option, path, folder));
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw failure_error(
        fmt::format("{} {}: cannot write to {}: {}; name a file elsewhere", option, path, folder, std::strerror(errno)));
  }
  try_folder(path, folder, option);
}

bool has_name(int file, const std::string& path) {
  struct stat own {
  }, named{};
  return fstat(file, &own) == 0 && lstat(path.c_str(), &named) == 0 && own.st_dev == named.st_dev && own.st_ino == named.st_ino;
}

bool is_same_file(const std::string& a, const std::string& b) {
  struct stat one {
  }, other{};
  return stat(a.c_str(), &one) == 0 && stat(b.c_str(), &other) == 0 && one.st_dev == other.st_dev && one.st_ino == other.st_ino;
}

namespace {

// The first bytes of the file at `path`. Nothing: it does not exist. Anything but a regular file counts as having no known bytes.
std::optional<std::string> head_of(const std::string& path, std::size_t size) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return errno == ENOENT ? std::nullopt : std::optional<std::string>("?");
  if (!S_ISREG(status.st_mode)) return "?";
  if (status.st_size == 0) return "";
  std::string head(size, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head.empty() ? "?" : head;  // that cannot be read
}

Error is_foreign(const std::string& path, const char* what, const char* option) {
  return usage_error(fmt::format("{} {}: is there and is no {}; name another, or remove it", option, path, what));
}

}  // namespace

void check_overwrites_kind(const std::string& path, std::string_view start, const char* what, const char* option) {
  const std::optional<std::string> head = head_of(path, start.size());
  if (head && !head->empty() && *head != start) throw is_foreign(path, what, option);
}

void check_overwrites_nothing(const std::string& path, const char* option) {
  const std::optional<std::string> head = head_of(path, 1);
  if (head && !head->empty()) {
    throw usage_error(fmt::format("{} {}: the file exists and is not overwritten; name another file, or remove it", option, path));
  }
}

bool begins_with(const std::string& path, std::string_view start) { return head_of(path, start.size()) == start; }

bool has_mark(const std::string& path, std::string_view mark) {
  const std::optional<std::string> head = head_of(path, 1 << 16);
  return head && head->find(mark) != std::string::npos;
}

void check_overwrites_marked(const std::string& path, std::string_view mark, const char* what, const char* option) {
  const std::optional<std::string> head = head_of(path, 1);
  if (head && !head->empty() && !has_mark(path, mark)) throw is_foreign(path, what, option);
}

void check_overwrites_result(const std::string& path) { check_overwrites_kind(path, NETCDF4_START, "result file", "-o"); }

void make_output_folder(const std::string& path) {
  if (path.empty()) throw usage_error("-o: name a folder");
  if (path == "-") throw usage_error("-o -: a folder is made, and none goes to standard output; name one (./- is one too)");
  if (mkdir(path.c_str(), 0777) != 0 && errno != EEXIST) {
    const int error = errno;
    const bool is_misnamed = error == ENOENT || error == ENOTDIR;
    struct stat status {};
    std::string name = path;
    while (name.size() > 1 && name.ends_with('/')) name.pop_back();
    const std::string parent = folder_of(name);
    // with EACCES nothing is known of the parent
    if (is_misnamed && (stat(parent.c_str(), &status) != 0 || !S_ISDIR(status.st_mode)))
      throw usage_error(fmt::format("-o {}: {} is not a directory; create it or name another", path, parent));
    throw Error(is_misnamed ? ExitCode::usage : ExitCode::failure,
                fmt::format("-o {}: cannot make that folder: {}; name one elsewhere", path, std::strerror(error)));
  }
  struct stat status {};
  if (stat(path.c_str(), &status) != 0 || !S_ISDIR(status.st_mode)) {
    throw usage_error(fmt::format("-o {}: is there and is not a folder; name another", path));
  }
  try_folder(path, path);
}

double free_bytes(const std::string& path) {
  struct statvfs disk {};
  double bytes = 1e300;
  if (statvfs(folder_of(path).c_str(), &disk) == 0) bytes = static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize);
  struct rlimit limit {};
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    bytes = std::min(bytes, static_cast<double>(limit.rlim_cur));
  }
  return bytes;
}

void check_room(const std::string& path, std::uint64_t bytes, const char* remedy) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  int error = file < 0 ? errno : 0;
  if (!error && fallocate(file, 0, 0, static_cast<off_t>(bytes)) != 0) {
    error = errno;
    if (error == EOPNOTSUPP || error == ENOSYS) {
      // a file system that cannot reserve: at least checks that it accepts something
      const std::vector<char> some(std::min<std::uint64_t>(bytes, 1 << 20));
      error = pwrite(file, some.data(), some.size(), 0) == static_cast<ssize_t>(some.size()) ? 0 : ENOSPC;
    }
  }
  if (file >= 0) {
    close(file);
    unlink(path.c_str());
  }
  if (error) {
    throw failure_error(fmt::format("{}: cannot write it ({}): {}; {}", path, readable_bytes(static_cast<double>(bytes)),
                                    std::strerror(error), remedy));
  }
}

void sync_folder_of(const std::string& path) {
  const int folder = open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  fsync(folder);
  close(folder);
}

void rename_file(const std::string& from, const std::string& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) {
    throw failure_error(fmt::format("cannot rename {} to {}: {}", from, to, std::strerror(errno)));
  }
}

bool rename_onto_nothing(const std::string& from, const std::string& to) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  struct stat there {};
  const bool is_there = lstat(to.c_str(), &there) == 0;
  if (is_there && !(S_ISREG(there.st_mode) && there.st_size == 0)) return false;
  rename_file(from, to);  // an empty file, or a file system that cannot refuse
  return true;
}

std::string temporary_name(const std::string& path) { return fmt::format("{}.{}.new", followed(path), getpid()); }

int write_new_file(const std::string& path, const std::string& text, bool durable) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return errno;
  bool good = write_all(file, text);
  if (good && durable) good = fsync(file) == 0;
  const int error = good ? 0 : errno != 0 ? errno : EIO;
  close(file);
  if (!good) unlink(path.c_str());
  return error;
}

int append_to_file(const std::string& path, const std::string& text) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file < 0) return errno;
  const int error = write_all(file, text) ? 0 : errno != 0 ? errno : EIO;
  close(file);
  return error;
}

void write_whole_file(const std::string& path, const std::string& text, bool durable, const char* remedy) {
  const std::string target = followed(path), temporary = temporary_name(path);
  const int error = write_new_file(temporary, text, durable);
  if (error != 0) throw failure_error(fmt::format("cannot write {}: {}; {}", path, std::strerror(error), remedy));
  try {
    rename_file(temporary, target);
  } catch (...) {
    unlink(temporary.c_str());
    throw;
  }
  if (durable) sync_folder_of(target);
}

}  // namespace wholehand
