// SPDX-License-Identifier: MIT
#include "app/viewer/local_server.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "app/viewer/http_connection.h"
#include "base/system/block_signals.h"
#include "base/text/error.h"

namespace wholehand {
namespace {

constexpr int WAITING = 128;               // connections that the kernel keeps until they are taken
constexpr std::size_t STACK = 512 * 1024;  // bytes per thread: a live session locks all memory, and stacks of 8 MiB would be 256
constexpr int MOST_REQUESTS = 10000;       // on one connection
constexpr int SEND_BUFFER = 64 * 1024;     // bytes: half a second of frames; a client with more unread is too slow

// Small working threads. The accepting thread handles excess work itself, at once.
class Workers final : public httplib::TaskQueue {
 public:
  explicit Workers(std::size_t count) {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, STACK);
    const BlockSignals inherited;
    for (std::size_t k = 0; k < count; ++k) {
      pthread_t thread;
      if (pthread_create(&thread, &attributes, run, this) == 0) threads_.push_back(thread);
    }
    pthread_attr_destroy(&attributes);
  }
  ~Workers() override { shutdown(); }

  void enqueue(std::function<void()> work) override {
    {
      const std::lock_guard lock(mutex_);
      if (busy_ + work_.size() < threads_.size()) {
        work_.push_back(std::move(work));
        wake_.notify_one();
        return;
      }
    }
    work();  // on the accepting thread, by which LocalServer recognizes it
  }

  void shutdown() override {
    {
      const std::lock_guard lock(mutex_);
      is_over_ = true;
    }
    wake_.notify_all();
    for (const pthread_t thread : threads_) pthread_join(thread, nullptr);
    threads_.clear();
  }

 private:
  static void* run(void* self) {
    static_cast<Workers*>(self)->work();
    return nullptr;
  }

  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [this] { return is_over_ || !work_.empty(); });
      if (work_.empty()) return;
      const auto next = std::move(work_.front());
      work_.pop_front();
      ++busy_;
      lock.unlock();
      next();
      lock.lock();
      --busy_;
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> work_;
  std::size_t busy_ = 0;
  bool is_over_ = false;
  std::vector<pthread_t> threads_;
};

// What httplib itself is not asked for.
void answer(socket_t socket, std::string_view status, std::string_view words) {
  const std::string text = fmt::format(
      "HTTP/1.1 {}\r\nConnection: close\r\nContent-Type: text/plain\r\nContent-Length: {}\r\n\r\n{}", status, words.size(), words);
  [[maybe_unused]] const ssize_t sent = send(socket, text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace

LocalServer::LocalServer(std::size_t connections) : connections_(connections) {
  new_task_queue = [this] { return new Workers(connections_); };
  set_address_family(AF_INET);
  // httplib would let another program of the same user listen at the same port
  set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  set_payload_max_length(LARGEST_BODY);
}

LocalServer::~LocalServer() { stop_all(); }

int LocalServer::bind(int port) {
  errno = 0;
  const int bound = port == 0 ? bind_to_any_port("127.0.0.1") : bind_to_port("127.0.0.1", port) ? port : -1;
  if (bound <= 0) {
    const std::string why = errno != 0 ? std::string(": ") + std::strerror(errno) : "";
    if (port == 0) throw failure_error("the viewer finds no port to listen on at 127.0.0.1" + why);
    throw usage_error(
        fmt::format("--view-port {}: cannot listen on this port{}; leave the option out for any free port", port, why));
  }
  ::listen(svr_sock_, WAITING);
  return bound;
}

void LocalServer::start() {
  const BlockSignals inherited;
  listening_ = std::thread([this] {
    taking_ = std::this_thread::get_id();
    listen_after_bind();
  });
  while (!is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

void LocalServer::stop_all() {
  {
    const std::lock_guard lock(mutex_);
    if (is_over_) return;
    is_over_ = true;
    for (const socket_t socket : open_) shutdown(socket, SHUT_RDWR);
  }
  if (!listening_.joinable()) return;
  stop();
  listening_.join();
}

bool LocalServer::process_and_close_socket(socket_t socket) {
  bool is_served = false;
  if (std::this_thread::get_id() == taking_) {
    answer(socket, "503 Service Unavailable", "too many connections\n");
  } else {
    const std::lock_guard lock(mutex_);
    is_served = !is_over_;
    if (is_served) open_.insert(socket);
  }
  if (is_served) {
    serve(socket);
    const std::lock_guard lock(mutex_);
    open_.erase(socket);
  }
  shutdown(socket, SHUT_RDWR);
  close(socket);
  return true;
}

void LocalServer::serve(socket_t socket) {
  const int yes = 1;
  setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &SEND_BUFFER, sizeof SEND_BUFFER);
  HttpConnection connection(socket);
  for (int k = 0; k < MOST_REQUESTS; ++k) {
    switch (connection.await_head()) {
      case HttpConnection::Head::whole:
        break;
      case HttpConnection::Head::none:
        return;
      case HttpConnection::Head::too_large:
        return answer(socket, "431 Request Header Fields Too Large", "");
      case HttpConnection::Head::body_too_large:
        return answer(socket, "413 Payload Too Large", "");
      case HttpConnection::Head::not_allowed:
        return answer(socket, "400 Bad Request", "");
    }
    bool is_closed = false;
    if (!process_request(connection, false, is_closed, nullptr) || is_closed) return;
    // a head that was refused still has its body to come, which is not a request, whatever it looks like
    if (!connection.is_taken()) return;
  }
}

}  // namespace wholehand
