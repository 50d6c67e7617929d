// SPDX-License-Identifier: MIT
// UDP: addresses as users write them, and sockets that never block.
#pragma once

#include <sys/socket.h>

#include <cstdint>
#include <span>
#include <string>

namespace wholehand {

struct HostPort {
  std::string host;  // a name or a numeric address
  int port = 0;
};
constexpr int LARGEST_PORT = 65535;

// Reads HOST:PORT, with an IPv6 HOST in brackets and PORT from `least_port` to LARGEST_PORT. Returns what is wrong with the text ("there is no
// port"), or an empty string.
std::string read_host_port(const std::string& text, int least_port, HostPort& into);
// Reads the port alone; returns false if the text is not a port.
bool read_port(const std::string& text, int least_port, int& port);

// The source or destination of a datagram. Plain data: copies and comparisons neither allocate nor throw.
class UdpAddress {
 public:
  UdpAddress() = default;
  UdpAddress(const sockaddr* bytes, socklen_t size) noexcept;

  const sockaddr* bytes() const noexcept { return reinterpret_cast<const sockaddr*>(&bytes_); }
  socklen_t size() const noexcept { return size_; }
  int family() const noexcept { return bytes_.ss_family; }
  int port() const noexcept;
  // Another port of the same host.
  UdpAddress with_port(int port) const noexcept;
  // 127.0.0.0/8 or ::1.
  bool is_loopback() const noexcept;
  bool operator==(const UdpAddress& other) const noexcept;
  // Numeric, for messages.
  std::string host() const;

 private:
  sockaddr_storage bytes_{};
  socklen_t size_ = 0;
};

// The address of a host. If a name has IPv4 and IPv6 addresses, returns IPv4, since receivers on this machine mostly listen on IPv4 alone. Throws
// Error (failure) that begins with `place` if there is none.
UdpAddress find_udp_address(const HostPort& where, const std::string& place);

// An open socket; its methods do not throw, allocate or wait.
class UdpSocket {
 public:
  // Throws Error (failure), beginning with `place`.
  UdpSocket(int family, const std::string& place);
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  // Allows addresses at which several machines listen.
  void allow_broadcast() noexcept;
  // Receives at this address from now on; port 0 takes any free port. Returns 0, or an error number.
  int bind(const UdpAddress& address) noexcept;
  UdpAddress address() const noexcept;

  // Returns false, with errno set, if the system does not take it. Signal handlers may call it.
  bool send(std::span<const char> bytes, const UdpAddress& to) const noexcept;
  // Receives the next datagram. Returns its size; `into` gets as many of its bytes as fit. Returns -1 if none waits.
  std::int64_t receive(std::span<char> into, UdpAddress& from) const noexcept;
  // Waits for a datagram, at most s seconds. Returns false if none came.
  bool wait(double seconds) const noexcept;

 private:
  int socket_;
};

}  // namespace wholehand
