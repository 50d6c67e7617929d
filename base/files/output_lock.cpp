// SPDX-License-Identifier: MIT
#include "base/files/output_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string_view>

#include "base/text/error.h"

namespace wholehand {
namespace {

constexpr std::string_view HOLDER =
    "wholehand process ";     // the first characters of the lock's file; then the number, " on " and the machine's name
constexpr int ATTEMPTS = 50;  // 10 ms apart: a process that was just killed may not be quite gone

enum class Taken { yes, no, retry };

std::string content(int file) {
  std::array<char, 256> text{};
  const ssize_t size = pread(file, text.data(), text.size(), 0);
  return {text.data(), static_cast<std::size_t>(size > 0 ? size : 0)};
}

std::string own_node() {
  std::array<char, 65> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "";
  return name.data();
}

// The holder that the lock's file names. A process number is meaningless on another machine.
struct Holder {
  pid_t process = 0;  // 0: nobody
  std::string node;   // empty: this one
};

Holder holder(int file) {
  const std::string text = content(file);
  if (!text.starts_with(HOLDER)) return {};
  Holder holder{static_cast<pid_t>(std::atoi(text.c_str() + HOLDER.size())), ""};
  const std::size_t on = text.find(" on ", HOLDER.size());
  if (on != std::string::npos) holder.node = text.substr(on + 4, text.find('\n', on) - on - 4);
  if (holder.node == own_node()) holder.node.clear();
  return holder;
}

// "process 1234 (wholehand)", or "process 1234 on node7".
std::string process_text(const Holder& holder) {
  if (holder.process <= 0) return "another process";
  if (!holder.node.empty()) return fmt::format("process {} on {}", holder.process, holder.node);
  std::string name;
  std::getline(std::ifstream(fmt::format("/proc/{}/comm", holder.process)), name);
  return fmt::format("process {}", holder.process) + (name.empty() ? "" : " (" + name + ")");
}

bool is_at(const std::string& path, int file) {
  struct stat named {
  }, open{};
  return lstat(path.c_str(), &named) == 0 && fstat(file, &open) == 0 && named.st_dev == open.st_dev && named.st_ino == open.st_ino;
}

Taken try_lock(const std::string& path, int file) {
  if (flock(file, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) return Taken::no;
    const Holder other = holder(file);  // no locks here
    const bool is_known = other.process > 0 && other.process != getpid() && other.node.empty();
    if (is_known && (kill(other.process, 0) == 0 || errno == EPERM)) return Taken::no;
  }
  // its holder removed the file meanwhile, so this lock protects nothing
  return is_at(path, file) ? Taken::yes : Taken::retry;
}

}  // namespace

OutputLock::OutputLock(const std::string& path, const char* what) : path_(path) {
  Holder other;
  for (int attempt = 0; attempt < ATTEMPTS; ++attempt) {
    file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    const int error = errno;
    const bool is_read_only = file_ < 0 && (error == EACCES || error == EPERM);
    // left behind by another user; it can still be locked
    if (is_read_only) file_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    const auto refuse_foreign = [&] {
      throw usage_error(fmt::format("{}: is there and is no lock of wholehand's; move it, or name another {} with -o", path, what));
    };
    if (file_ < 0) {
      if (error == EISDIR || error == ELOOP) refuse_foreign();
      throw failure_error(
          fmt::format("{}: cannot make this lock: {}; make room, or name another {} with -o", path, std::strerror(error), what));
    }
    const std::string text = content(file_);
    if (!text.empty() && !text.starts_with(HOLDER)) {
      close(file_);
      refuse_foreign();
    }
    const Taken taken = try_lock(path, file_);
    if (taken == Taken::yes && is_read_only) return;
    if (taken == Taken::yes) {
      const std::string line = fmt::format("{}{} on {}\n", HOLDER, getpid(), own_node());
      // a full disk leaves the lock without a name, but it still locks
      if (ftruncate(file_, 0) != 0 || pwrite(file_, line.data(), line.size(), 0) < 0) errno = 0;
      return;
    }
    other = holder(file_);
    close(file_);
    file_ = -1;
    if (taken == Taken::no) usleep(10000);
  }
  throw usage_error(
      fmt::format("{}: {} writes this result; wait for it, or name another {} with -o", path, process_text(other), what));
}

OutputLock::~OutputLock() {
  if (file_ < 0) return;
  unlink(path_.c_str());  // while it is held, so that waiting processes find another file under this name
  close(file_);
}

}  // namespace wholehand
