// SPDX-License-Identifier: MIT
#include "app/viewer/http_connection.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

namespace wholehand {
namespace {

using std::chrono::duration_cast;
using std::chrono::milliseconds;

bool wait_for(int socket, short events, milliseconds most) {
  pollfd poll_for{socket, events, 0};
  const int found = poll(&poll_for, 1, static_cast<int>(std::max(milliseconds(0), most).count()));
  return found > 0 && (poll_for.revents & events) != 0;
}

bool is_same_letter(char a, char b) { return (a | 0x20) == (b | 0x20); }

// The headers of a head: for each line after the first its name and value.
template <typename Look>
void for_each_header(std::string& buffer, std::size_t from, std::size_t to, Look look) {
  std::size_t line = buffer.find("\r\n", from);
  while (line != std::string::npos && line + 2 < to) {
    const std::size_t start = line + 2, end = std::min(buffer.find("\r\n", start), to);
    const std::size_t colon = std::min(buffer.find(':', start), end);
    const std::size_t value = std::min(colon + 1, end);
    const std::string_view text = buffer;
    look(start, text.substr(start, colon - start), text.substr(value, end - value));
    line = end;
  }
}

// No HTTP header has one; httplib ends a value at a NUL.
bool is_control(char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7F; }

bool is_header(std::string_view name, std::string_view wanted) {
  return name.size() == wanted.size() && std::equal(name.begin(), name.end(), wanted.begin(), is_same_letter);
}

// Parses a number of bytes; anything else counts as too many.
std::size_t length_of(std::string_view text) {
  std::size_t length = 0;
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  if (text.empty() || text.size() > 8) return LARGEST_BODY + 1;
  for (const char c : text) {
    if (c < '0' || c > '9') return LARGEST_BODY + 1;
    length = 10 * length + static_cast<std::size_t>(c - '0');
  }
  return length;
}

}  // namespace

HttpConnection::HttpConnection(int socket) : socket_(socket) {}

HttpConnection::Head HttpConnection::await_head() {
  buffer_.erase(0, at_);
  at_ = left_ = 0;
  until_ = Clock::now() + (buffer_.empty() ? IDLE_PATIENCE : REQUEST_PATIENCE);
  for (std::size_t looked = 0;;) {
    const std::size_t end = buffer_.find("\r\n\r\n", looked);
    if (end != std::string::npos) return end + 4 > LARGEST_HEAD ? Head::too_large : look_at_head(end + 4);
    if (buffer_.size() > LARGEST_HEAD) return Head::too_large;
    looked = buffer_.size() < 3 ? 0 : buffer_.size() - 3;
    char part[4096];
    const ssize_t got = receive(part, sizeof part, until_);
    if (got <= 0) return Head::none;
    if (buffer_.empty()) until_ = Clock::now() + REQUEST_PATIENCE;
    buffer_.append(part, static_cast<std::size_t>(got));
  }
}

HttpConnection::Head HttpConnection::look_at_head(std::size_t size) {
  Head head = Head::whole;
  std::size_t lengths = 0;
  left_ = size;
  for_each_header(buffer_, 0, size - 2, [&](std::size_t at, std::string_view name, std::string_view value) {
    // a name is written without spaces: with them httplib might take it for another one
    if (name.empty() || name.find_first_of(" \t") != name.npos || value.data() == name.data() + name.size() ||
        std::any_of(name.begin(), name.end(), is_control) || std::any_of(value.begin(), value.end(), is_control))
      head = Head::not_allowed;
    if (is_header(name, "range") || is_header(name, "accept-encoding")) buffer_[at] = 'X';
    // httplib decodes what it reads; a host is compared as sent, and none of ours has such a letter
    if (is_header(name, "host") || is_header(name, "origin")) {
      if (value.find_first_not_of(" \t") == value.npos) head = Head::not_allowed;  // httplib ignores it, as if it were not there
      std::replace(buffer_.begin() + (value.data() - buffer_.data()),
                   buffer_.begin() + (value.data() + value.size() - buffer_.data()), '%', '!');
    }
    if (is_header(name, "transfer-encoding") || is_header(name, "expect")) head = Head::not_allowed;
    if (is_header(name, "content-length")) {
      ++lengths;
      const std::size_t length = length_of(value);
      if (length > LARGEST_BODY && head == Head::whole) head = Head::body_too_large;
      left_ += length;
    }
  });
  return lengths > 1 ? Head::not_allowed : head;
}

// Above 0: that many bytes; 0: the other side sends no more; below: too late, or broken.
ssize_t HttpConnection::receive(char* data, std::size_t size, Clock::time_point until) {
  for (;;) {
    const ssize_t got = recv(socket_, data, size, MSG_DONTWAIT);
    if (got >= 0) return got;
    if (errno == EINTR) continue;
    if (errno != EAGAIN && errno != EWOULDBLOCK) return -1;
    // one more than is left, so that the last wait is not a row of none
    if (!wait_for(socket_, POLLIN, duration_cast<milliseconds>(until - Clock::now()) + milliseconds(1))) return -1;
  }
}

bool HttpConnection::is_readable() const {
  return at_ < buffer_.size() || wait_for(socket_, POLLIN, duration_cast<milliseconds>(until_ - Clock::now()));
}

bool HttpConnection::is_writable() const { return wait_for(socket_, POLLOUT, WRITE_PATIENCE); }

ssize_t HttpConnection::read(char* data, std::size_t size) {
  const std::size_t most = std::min(size, left_);
  if (most == 0) return 0;  // its end: what follows is another request
  if (at_ == buffer_.size()) {
    const ssize_t got = receive(data, most, until_);
    if (got > 0) left_ -= static_cast<std::size_t>(got);
    return got;
  }
  const std::size_t count = std::min(most, buffer_.size() - at_);
  std::memcpy(data, buffer_.data() + at_, count);
  at_ += count;
  left_ -= count;
  return static_cast<ssize_t>(count);
}

ssize_t HttpConnection::write(const char* data, std::size_t size) {
  std::size_t sent = 0;
  while (sent < size) {
    const ssize_t put = send(socket_, data + sent, size - sent, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (put >= 0) {
      sent += static_cast<std::size_t>(put);
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      if (!is_writable()) return -1;
    } else if (errno != EINTR) {
      return -1;
    }
  }
  return static_cast<ssize_t>(sent);
}

// The server listens on one address of this machine, so the peer's address does not matter.
void HttpConnection::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip = "127.0.0.1";
  port = 0;
}
void HttpConnection::get_local_ip_and_port(std::string& ip, int& port) const { get_remote_ip_and_port(ip, port); }

socket_t HttpConnection::socket() const { return socket_; }

}  // namespace wholehand
