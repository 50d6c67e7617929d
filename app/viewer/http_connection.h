// SPDX-License-Identifier: MIT
// One connection of a browser, as httplib reads and writes it, with limits on size and duration of requests.
#pragma once

#include <httplib.h>

#include <chrono>
#include <cstddef>
#include <string>

namespace wholehand {

constexpr std::size_t LARGEST_HEAD = 16 * 1024;  // bytes of a request line and its headers; a browser's have one or two thousand
constexpr std::size_t LARGEST_BODY = 64 * 1024;
constexpr std::chrono::milliseconds IDLE_PATIENCE{2000};     // between two requests
constexpr std::chrono::milliseconds REQUEST_PATIENCE{5000};  // for a whole request, from its first byte
constexpr std::chrono::milliseconds WRITE_PATIENCE{2000};    // without progress

// Reads and checks a request's whole head before httplib sees any of it: httplib does not limit lines, and parses some headers with std::regex, which
// recurses with every character. Unneeded headers (ranges, compression) are hidden from it, and values that it would decode in Host and Origin are
// spoiled.
class HttpConnection final : public httplib::Stream {
 public:
  // Does not close the socket.
  explicit HttpConnection(int socket);

  // none: nothing came, or only part of it; the connection is no longer usable.
  enum class Head { whole, none, too_large, body_too_large, not_allowed };
  Head await_head();
  // Whether the whole request was read: its head, and a body of the length that the head states. No read goes beyond it.
  bool is_taken() const { return left_ == 0; }

  bool is_readable() const override;
  bool is_writable() const override;
  ssize_t read(char* data, std::size_t size) override;
  ssize_t write(const char* data, std::size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override;

 private:
  using Clock = std::chrono::steady_clock;
  ssize_t receive(char* data, std::size_t size, Clock::time_point until);
  Head look_at_head(std::size_t size);

  int socket_;
  std::string buffer_;       // received
  std::size_t at_ = 0;       // of it taken
  std::size_t left_ = 0;     // bytes of this request not yet taken
  Clock::time_point until_;  // of this request
};

}  // namespace wholehand
