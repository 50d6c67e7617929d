// SPDX-License-Identifier: MIT
// httplib's server for this machine only: so many connections at once and no more, on threads that are there from the start.
#pragma once

#include <httplib.h>

#include <mutex>
#include <set>
#include <string>
#include <thread>

namespace wholehand {

// Each connection has a thread of its own. One too many is refused and closed by the thread that takes connections, so that whoever opens
// hundreds keeps nobody else from those that are there for longer than they are idle.
class LocalServer final : public httplib::Server {
 public:
  explicit LocalServer(std::size_t connections);
  // Stops.
  ~LocalServer() override;
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  // Binds 127.0.0.1; 0: any free port. Returns the port. Throws Error: (usage) the port is another program's or needs more rights;
  // (failure) no port can be had.
  int bind(int port);
  // Begins to answer, when it is bound and all handlers are set. Once.
  void start();
  // Cuts all connections and ends the threads. Once more does nothing.
  void stop_all();

 private:
  bool process_and_close_socket(socket_t socket) override;
  void serve(socket_t socket);

  std::size_t connections_;
  std::mutex mutex_;  // of the next two
  bool is_over_ = false;
  std::set<socket_t> open_;
  std::thread listening_;
  // The thread that takes connections, set by itself before the first one. A connection that it has to serve is one too many.
  std::thread::id taking_;
};

}  // namespace wholehand
