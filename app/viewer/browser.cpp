// SPDX-License-Identifier: MIT
#include "app/viewer/browser.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "base/system/output.h"

extern char** environ;

namespace wholehand {
namespace {

bool is_set(const char* name) {
  const char* value = std::getenv(name);
  return value && *value;
}

}  // namespace

bool has_desktop() { return (is_set("DISPLAY") || is_set("WAYLAND_DISPLAY")) && isatty(STDOUT_FILENO) && geteuid() != 0; }

BrowserWindow::BrowserWindow(const std::string& address, bool on_standard_error) {
  if (on_standard_error) {
    print_to_stderr("view: " + address);
  } else {
    print(fmt::format("view: {}\n", address));
  }
  if (has_desktop()) open(address);
}

BrowserWindow::~BrowserWindow() {
  if (!file_.empty()) unlink(file_.c_str());
}

// Best effort: the address is printed anyhow.
void BrowserWindow::open(const std::string& address) {
  std::string file = fmt::format("{}/wholehand-XXXXXX.html", is_set("XDG_RUNTIME_DIR") ? std::getenv("XDG_RUNTIME_DIR") : "/tmp");
  const int made = mkostemps(file.data(), 5, O_CLOEXEC);  // readable by its owner only
  if (made < 0) return;
  file_ = file;
  const std::string page = fmt::format(
      "<!doctype html><meta charset=\"utf-8\"><title>wholehand</title><meta http-equiv=\"refresh\" content=\"0;url={}\">", address);
  const bool is_written = write(made, page.data(), page.size()) == static_cast<ssize_t>(page.size());
  close(made);
  if (!is_written) return;
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&quiet, stream, "/dev/null", O_RDWR, 0);
  std::string program = "xdg-open";
  char* arguments[] = {program.data(), file.data(), nullptr};
  pid_t process = 0;
  posix_spawnp(&process, "xdg-open", &quiet, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&quiet);
}

}  // namespace wholehand
