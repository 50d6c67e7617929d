// SPDX-License-Identifier: MIT
#include "sweeps/result/guarded_server.h"

#include <fcntl.h>
#include <netcdf.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "sweeps/result/result_checksums.h"

namespace wholehand::sweeps::guarded {
namespace {

constexpr std::size_t VALUES_A_SECOND = 1 << 23;  // of a processor, at least; most answers take milliseconds
constexpr std::uint64_t MEMORY = 4ull << 30;      // bytes more than the process had
constexpr int SAYS_TOO_MUCH = NC_EHDFERR;

// Does not count what the process has used so far.
void allow_one_answer(std::size_t values = 0) {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const rlim_t limit = static_cast<rlim_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + 2 + values / VALUES_A_SECOND;
  rlimit seconds{};
  if (getrlimit(RLIMIT_CPU, &seconds) != 0) return;
  seconds.rlim_cur = std::min(limit, seconds.rlim_max);  // RLIM_INFINITY is the largest
  setrlimit(RLIMIT_CPU, &seconds);
}

void limit_memory() {
  std::uint64_t pages = 0;
  if (FILE* file = std::fopen("/proc/self/statm", "r")) {
    unsigned long read = 0;
    if (std::fscanf(file, "%lu", &read) == 1) pages = read;
    std::fclose(file);
  }
  if (pages == 0) return;
  const rlim_t limit = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) + MEMORY;
  const rlimit memory{limit, limit};
  setrlimit(RLIMIT_AS, &memory);
}

// The process keeps only the socket of what it inherited: no lock, no port, no terminal to print to.
void become_server(int socket) {
  dup2(socket, STDIN_FILENO);
  const int null = open("/dev/null", O_RDWR);
  dup2(null, STDOUT_FILENO);
  dup2(null, STDERR_FILENO);
  close_range(3, ~0U, 0);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGILL, SIGTRAP, SIGSYS, SIGXCPU, SIGALRM})
    std::signal(signal, SIG_DFL);
  // the other end answers these, and closes
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(signal, SIG_IGN);
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  limit_memory();
}

void append(std::string& bytes, const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }

template <class T>
void append(std::string& bytes, T value) {
  append(bytes, &value, sizeof value);
}

void append_text(std::string& bytes, const std::string& text) {
  append(bytes, static_cast<std::uint64_t>(text.size()));
  bytes += text;
}

bool holds_numbers(nc_type type) { return type > NC_NAT && type <= NC_UINT64 && type != NC_CHAR; }

class Server {
 public:
  Server(int socket, const std::string& name) : socket_(socket) {
    allow_one_answer();
    int status = nc_open(name.c_str(), NC_NOWRITE, &file_);
    std::string catalogue;
    if (status == NC_NOERR) status = declare(catalogue);
    send(status);
    if (status != NC_NOERR) _exit(0);
    const std::uint64_t size = catalogue.size();
    send_all(socket_, &size, sizeof size);
    send_all(socket_, catalogue.data(), catalogue.size());
  }

  void answer(const Request& request) {
    std::array<std::size_t, MOST_DIMENSIONS> start{}, count{};
    std::size_t values = 1;
    for (std::size_t k = 0; k < std::min<std::size_t>(request.dimensions, MOST_DIMENSIONS); ++k) {
      start[k] = request.start[k];
      count[k] = request.count[k];
      values *= count[k];
    }
    allow_one_answer(values);
    block_.resize(values);
    const int status = nc_get_vara_double(file_, request.variable, start.data(), count.data(), block_.data());
    send(status);
    if (is_usable(status)) send_all(socket_, block_.data(), block_.size() * sizeof(double));
  }

 private:
  void send(int status) {
    const auto value = static_cast<std::int32_t>(status);
    if (!send_all(socket_, &value, sizeof value)) _exit(0);
  }

  // Everything that the file declares, and a test read at both ends of each numeric variable.
  int declare(std::string& catalogue) {
    int count = 0, attributes = 0;
    int status = nc_inq(file_, nullptr, &count, &attributes, nullptr);
    for (int k = 0; k < attributes && status == NC_NOERR; ++k) status = add_attribute(catalogue, k);
    for (int id = 0; id < count && status == NC_NOERR; ++id) status = add_variable(catalogue, id);
    return status;
  }

  int add_attribute(std::string& catalogue, int k) {
    std::array<char, NC_MAX_NAME + 1> name{};
    nc_type type = NC_NAT;
    std::size_t length = 0;
    int status = nc_inq_attname(file_, NC_GLOBAL, k, name.data());
    if (status == NC_NOERR) status = nc_inq_att(file_, NC_GLOBAL, name.data(), &type, &length);
    if (status != NC_NOERR) return status;
    if (type == NC_CHAR) {
      std::string text(length, ' ');
      if (length > 0) status = nc_get_att_text(file_, NC_GLOBAL, name.data(), text.data());
      append(catalogue, Entry::text);
      append_text(catalogue, name.data());
      append_text(catalogue, text);
    } else if (type == NC_DOUBLE && length == 1) {
      double value = 0;
      status = nc_get_att_double(file_, NC_GLOBAL, name.data(), &value);
      append(catalogue, Entry::number);
      append_text(catalogue, name.data());
      append(catalogue, value);
    }
    return status;
  }

  int add_variable(std::string& catalogue, int id) {
    std::array<char, NC_MAX_NAME + 1> name{};
    nc_type type = NC_NAT;
    int dims = 0;
    int status = nc_inq_var(file_, id, name.data(), &type, &dims, nullptr, nullptr);
    if (status != NC_NOERR) return status;
    if (dims < 0 || dims > static_cast<int>(MOST_DIMENSIONS)) return SAYS_TOO_MUCH;
    std::vector<int> ids(static_cast<std::size_t>(dims));
    std::vector<std::size_t> shape(ids.size());
    status = nc_inq_vardimid(file_, id, ids.data());
    for (std::size_t k = 0; k < ids.size() && status == NC_NOERR; ++k) status = nc_inq_dimlen(file_, ids[k], &shape[k]);
    if (status == NC_NOERR) status = try_ends(id, type, shape);
    if (status == NC_NOERR && name.data() == std::string_view(CHECKSUMS)) status = add_checksums(catalogue, id, type, shape);
    append(catalogue, Entry::variable);
    append(catalogue, static_cast<std::int32_t>(id));
    append_text(catalogue, name.data());
    append(catalogue, static_cast<std::int32_t>(type));
    append(catalogue, static_cast<std::uint64_t>(shape.size()));
    for (const std::size_t length : shape) append(catalogue, static_cast<std::uint64_t>(length));
    return status;
  }

  // Checksums are characters, and come as a text.
  int add_checksums(std::string& catalogue, int id, nc_type type, const std::vector<std::size_t>& shape) {
    if (type != NC_CHAR || shape.size() != 1) return SAYS_TOO_MUCH;
    std::string text(shape[0], ' ');
    const int status = nc_get_var_text(file_, id, text.data());
    append(catalogue, Entry::text);
    append_text(catalogue, CHECKSUMS);
    append_text(catalogue, text);
    return status;
  }

  // The first and the last value, and with them the parts of the file where they lie.
  int try_ends(int id, nc_type type, const std::vector<std::size_t>& shape) {
    if (!holds_numbers(type) || std::find(shape.begin(), shape.end(), 0u) != shape.end()) return NC_NOERR;
    double value = 0;
    std::vector<std::size_t> place(shape.size() + 1, 0);
    int status = nc_get_var1_double(file_, id, place.data(), &value);
    if (!is_usable(status)) return status;
    for (std::size_t k = 0; k < shape.size(); ++k) place[k] = shape[k] - 1;
    status = nc_get_var1_double(file_, id, place.data(), &value);
    return is_usable(status) ? NC_NOERR : status;
  }

  int socket_, file_ = -1;
  std::vector<double> block_;
};

}  // namespace

bool is_usable(int status) { return status == NC_NOERR || status == NC_ERANGE; }

bool send_all(int socket, const void* data, std::size_t size) {
  const auto* from = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = ::send(socket, from, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    from += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool take_all(int socket, void* data, std::size_t size, int seconds) {
  auto* to = static_cast<char*>(data);
  while (size > 0) {
    pollfd waits{socket, POLLIN, 0};
    const int ready = poll(&waits, 1, seconds == 0 ? -1 : seconds * 1000);
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return false;
    const ssize_t taken = recv(socket, to, size, 0);
    if (taken < 0 && errno == EINTR) continue;
    if (taken <= 0) return false;
    to += taken;
    size -= static_cast<std::size_t>(taken);
  }
  return true;
}

void serve(int socket, const std::string& name) {
  become_server(socket);
  try {
    Server server(STDIN_FILENO, name);
    for (Request request; take_all(STDIN_FILENO, &request, sizeof request, 0);) server.answer(request);
  } catch (...) {
    _exit(1);  // lengths that no memory holds
  }
  _exit(0);
}

std::string CatalogueReader::text() {
  const auto size = value<std::uint64_t>();
  if (size > bytes_.size() - place_) throw std::runtime_error("a text is too long");
  std::string result(size, ' ');
  copy(result.data(), size);
  return result;
}

void CatalogueReader::copy(void* to, std::size_t size) {
  if (size > bytes_.size() - place_) throw std::runtime_error("the list of contents ends too early");
  std::memcpy(to, bytes_.data() + place_, size);
  place_ += size;
}

}  // namespace wholehand::sweeps::guarded
