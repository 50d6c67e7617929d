// SPDX-License-Identifier: MIT
// A browser that does as it likes: plain sockets, not the library that serves.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>

namespace wholehand {

struct HttpReply {
  int status = 0;                              // 0: none came
  std::map<std::string, std::string> headers;  // names in lower case
  std::string body;
};

class HttpSocket {
 public:
  explicit HttpSocket(int port, int receive_buffer = 0) {
    socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (receive_buffer > 0) setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_open_ = connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~HttpSocket() {
    if (socket_ >= 0) close(socket_);
  }
  HttpSocket(HttpSocket&& other) noexcept
      : socket_(std::exchange(other.socket_, -1)), is_open_(other.is_open_), received_(std::move(other.received_)) {}
  HttpSocket& operator=(HttpSocket&&) = delete;

  bool is_open() const { return is_open_; }
  void send(const std::string& text) {
    for (std::size_t sent = 0; sent < text.size();) {
      const ssize_t put = ::send(socket_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
      if (put <= 0) return;
      sent += static_cast<std::size_t>(put);
    }
  }
  void end_sending() { shutdown(socket_, SHUT_WR); }
  // Up to and with `end`; what is there where the other side closes, nothing comes for 20 s, or no end is there after 60 s: a stream of
  // frames gives a sign of life each second.
  std::string read_until(const std::string& end) {
    const auto until = std::chrono::steady_clock::now() + PATIENCE;
    std::size_t at = 0;
    while ((at = received_.find(end)) == std::string::npos) {
      if (std::chrono::steady_clock::now() > until || !receive()) return std::exchange(received_, "");
    }
    std::string text = received_.substr(0, at + end.size());
    received_.erase(0, text.size());
    return text;
  }
  // All until then.
  std::string read_all() {
    const auto until = std::chrono::steady_clock::now() + PATIENCE;
    while (std::chrono::steady_clock::now() < until && receive()) {
    }
    return std::exchange(received_, "");
  }
  // Status and headers; the body where its length is given.
  HttpReply read_reply() {
    HttpReply reply;
    const std::string head = read_until("\r\n\r\n");
    if (head.rfind("HTTP/1.1 ", 0) != 0) return reply;
    reply.status = std::atoi(head.c_str() + 9);
    for (std::size_t line = head.find("\r\n"); line + 4 < head.size(); line = head.find("\r\n", line + 2)) {
      const std::size_t colon = head.find(": ", line), end = head.find("\r\n", line + 2);
      if (colon == std::string::npos || colon > end) break;
      std::string name = head.substr(line + 2, colon - line - 2);
      std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      reply.headers[name] = head.substr(colon + 2, end - colon - 2);
    }
    if (reply.headers.count("content-length")) {
      const std::size_t length = std::strtoul(reply.headers["content-length"].c_str(), nullptr, 10);
      while (received_.size() < length && receive()) {
      }
      reply.body = received_.substr(0, length);
      received_.erase(0, reply.body.size());
    }
    return reply;
  }
  // The data of the next server-sent event with that name ("": a frame); empty where there is none any more.
  std::string read_event(const std::string& name = "") {
    // right behind another event, without a chunk's header between them, it has no newline of its own before it
    const std::string start = name.empty() ? "data: " : "event: " + name + "\ndata: ";
    if (read_until(start).size() < start.size()) return "";
    std::string data = read_until("\n\n");
    return data.size() < 2 ? "" : data.substr(0, data.size() - 2);
  }

 private:
  static constexpr std::chrono::seconds PATIENCE{60};
  bool receive() {
    pollfd poll_for{socket_, POLLIN, 0};
    if (poll(&poll_for, 1, 20000) <= 0) return false;
    char part[16384];
    const ssize_t got = recv(socket_, part, sizeof part, 0);
    if (got <= 0) return false;
    received_.append(part, static_cast<std::size_t>(got));
    return true;
  }
  int socket_ = -1;
  bool is_open_ = false;
  std::string received_;
};

// Where a view is: "http://127.0.0.1:PORT/TOKEN/".
struct ViewAddress {
  explicit ViewAddress(const std::string& text) {
    const std::size_t colon = text.find("127.0.0.1:");
    if (colon == std::string::npos) return;
    port = std::atoi(text.c_str() + colon + 10);
    const std::size_t slash = text.find('/', colon);
    token = text.substr(slash + 1, text.find('/', slash + 1) - slash - 1);
  }
  int port = 0;
  std::string token;
  std::string host() const { return "127.0.0.1:" + std::to_string(port); }
  std::string request(const std::string& path, const std::string& headers = "") const {
    return "GET /" + token + "/" + path + " HTTP/1.1\r\nHost: " + host() + "\r\n" + headers + "\r\n";
  }
  std::string post(const std::string& body, const std::string& headers = "Content-Type: application/json\r\n") const {
    return "POST /" + token + "/control HTTP/1.1\r\nHost: " + host() + "\r\n" + headers +
           "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
  }
  HttpReply get(const std::string& path, const std::string& headers = "") const {
    HttpSocket socket(port);
    socket.send(request(path, headers));
    return socket.read_reply();
  }
};

}  // namespace wholehand
