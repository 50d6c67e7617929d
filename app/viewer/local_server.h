// SPDX-License-Identifier: MIT
// httplib's server for this machine only: a fixed number of connections, on threads started in advance.
#pragma once

#include <httplib.h>

#include <mutex>
#include <set>
#include <string>
#include <thread>

namespace wholehand {

// Each connection has its own thread. The accepting thread refuses and closes any further one, so that a client who opens hundreds only blocks others
// for their idle time.
class LocalServer final : public httplib::Server {
 public:
  explicit LocalServer(std::size_t connections);
  // Stops.
  ~LocalServer() override;
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  // Binds 127.0.0.1; 0: any free port. Returns the port. Throws Error: (usage) the port is in use or needs more rights; (failure) no port is
  // available.
  int bind(int port);
  // Starts answering, once bound and all handlers are set. Call it once.
  void start();
  // Cuts all connections and ends the threads. Further calls do nothing.
  void stop_all();

 private:
  bool process_and_close_socket(socket_t socket) override;
  void serve(socket_t socket);

  std::size_t connections_;
  std::mutex mutex_;  // of the next two
  bool is_over_ = false;
  std::set<socket_t> open_;
  std::thread listening_;
  // The accepting thread, which registers itself before the first connection. A connection that it would have to serve is one too many.
  std::thread::id taking_;
};

}  // namespace wholehand
