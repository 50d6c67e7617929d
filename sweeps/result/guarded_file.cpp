// SPDX-License-Identifier: MIT
#include "sweeps/result/guarded_file.h"

#include <fmt/format.h>
#include <netcdf.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "base/text/error.h"
#include "sweeps/result/guarded_server.h"

namespace wholehand::sweeps {
namespace {

constexpr int SILENT_SECONDS = 60;                    // after which the process is given up: a disk may be slow
constexpr std::uint64_t LARGEST_CATALOGUE = 1 << 28;  // bytes

// The path as the NetCDF library takes it.
std::string absolute_name(const std::string& path, double& bytes) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) throw usage_error(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  if (!S_ISREG(status.st_mode))
    throw usage_error(fmt::format("{}: is a {}; name the result file of a sweep", path,
                                  S_ISDIR(status.st_mode) ? "directory" : "device or pipe"));
  if (access(path.c_str(), R_OK) != 0) throw usage_error(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  bytes = static_cast<double>(status.st_size);
  char* absolute = realpath(path.c_str(), nullptr);
  if (!absolute) throw usage_error(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  const std::string name = absolute;
  std::free(absolute);
  return name;
}

}  // namespace

GuardedFile::GuardedFile(const std::string& path) : path_(path) {
  start(absolute_name(path, bytes_));
  try {
    expect_good("");
    read_catalogue();
  } catch (...) {
    stop();
    throw;
  }
}

GuardedFile::~GuardedFile() { stop(); }

void GuardedFile::stop() {
  close(socket_);
  kill(process_, SIGKILL);  // it has nothing to lose, and may be where nothing ends
  while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) continue;
}

void GuardedFile::start(const std::string& name) {
  int ends[2] = {-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0) process_ = fork();
  if (process_ == 0) guarded::serve(ends[1], name);
  const int error = errno;
  if (ends[1] >= 0) close(ends[1]);
  if (process_ < 0) {
    if (ends[0] >= 0) close(ends[0]);
    throw failure_error(fmt::format("{}: cannot start a process that reads it: {}", path_, std::strerror(error)));
  }
  socket_ = ends[0];
}

void GuardedFile::fail(const std::string& why) const {
  throw usage_error(fmt::format("{}: is damaged, or is not a NetCDF-4 file: {}", path_, why));
}

void GuardedFile::take(void* data, std::size_t size) const {
  if (!guarded::take_all(socket_, data, size, SILENT_SECONDS)) fail("it cannot be read");
}

void GuardedFile::send(const void* data, std::size_t size) const {
  if (!guarded::send_all(socket_, data, size)) fail("it cannot be read");
}

void GuardedFile::expect_good(const std::string& what) const {
  std::int32_t status = 0;
  take(&status, sizeof status);
  if (guarded::is_usable(status)) return;
  const char* why = status > 0 ? std::strerror(status) : nc_strerror(status);
  fail(what.empty() ? why : fmt::format("{} cannot be read: {}", what, why));
}

void GuardedFile::read_catalogue() {
  std::uint64_t size = 0;
  take(&size, sizeof size);
  if (size > LARGEST_CATALOGUE) fail("its list of contents is too long");
  std::string bytes(size, ' ');
  take(bytes.data(), bytes.size());
  try {
    for (guarded::CatalogueReader catalogue(bytes); !catalogue.is_at_end();) {
      const auto entry = catalogue.value<guarded::Entry>();
      if (entry == guarded::Entry::variable) {
        Stored variable;
        variable.id = catalogue.value<std::int32_t>();
        variable.name = catalogue.text();
        variable.type = catalogue.value<std::int32_t>();
        const auto dims = catalogue.value<std::uint64_t>();
        if (dims > guarded::MOST_DIMENSIONS) throw std::runtime_error("too many dimensions");
        while (variable.shape.size() < dims) variable.shape.push_back(catalogue.value<std::uint64_t>());
        variables_.push_back(variable);
      } else {
        const std::string name = catalogue.text();
        if (entry == guarded::Entry::text) texts_[name] = catalogue.text();
        if (entry == guarded::Entry::number) numbers_[name] = catalogue.value<double>();
      }
    }
  } catch (const std::runtime_error&) {
    fail("it cannot be read");
  }
}

const GuardedFile::Stored* GuardedFile::find(const std::string& name) const {
  const auto found = std::find_if(variables_.begin(), variables_.end(), [&](const Stored& v) { return v.name == name; });
  return found == variables_.end() ? nullptr : &*found;
}

std::optional<std::string> GuardedFile::text(const std::string& name) const {
  const auto found = texts_.find(name);
  return found == texts_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<double> GuardedFile::number(const std::string& name) const {
  const auto found = numbers_.find(name);
  return found == numbers_.end() ? std::nullopt : std::optional(found->second);
}

void GuardedFile::read(const Stored& variable, std::span<const std::size_t> start, std::span<const std::size_t> count,
                       double* out) const {
  guarded::Request request;
  request.variable = variable.id;
  request.dimensions = variable.shape.size();
  std::size_t values = 1;
  for (std::size_t k = 0; k < variable.shape.size(); ++k) {
    request.start[k] = start[k];
    request.count[k] = count[k];
    values *= count[k];
  }
  send(&request, sizeof request);
  expect_good(variable.name);
  take(out, values * sizeof(double));
}

}  // namespace wholehand::sweeps
