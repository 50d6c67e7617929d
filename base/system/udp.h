// SPDX-License-Identifier: MIT
// UDP: addresses as users write them, and sockets that never wait.
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

// Reads HOST:PORT, of HOST an IPv6 address in brackets and PORT from `least_port` to LARGEST_PORT. What is wrong with the text ("there is no
// port"); empty: nothing.
std::string read_host_port(const std::string& text, int least_port, HostPort& into);
// Reads the port alone; false: it is none.
bool read_port(const std::string& text, int least_port, int& port);

// Where a datagram goes to or comes from. Plain data: copies and comparisons neither allocate nor throw.
class UdpAddress {
 public:
  UdpAddress() = default;
  UdpAddress(const sockaddr* bytes, socklen_t size) noexcept;

  const sockaddr* bytes() const noexcept { return reinterpret_cast<const sockaddr*>(&bytes_); }
  socklen_t size() const noexcept { return size_; }
  int family() const noexcept { return bytes_.ss_family; }
  int port() const noexcept;
  // The same host's other port.
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

// The address of a host. Receivers on this machine mostly listen on IPv4 alone, so of a name with both kinds it is that one. `place` begins the
// message of the Error (failure) that is thrown where there is none.
UdpAddress find_udp_address(const HostPort& where, const std::string& place);

// An open socket; its methods do not throw, allocate or wait.
class UdpSocket {
 public:
  // Throws Error (failure), beginning with `place`.
  UdpSocket(int family, const std::string& place);
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  // Several machines may listen at an address.
  void allow_broadcast() noexcept;
  // Receives at this address from now on; its port 0 is any that is free. 0, or the error's number.
  int bind(const UdpAddress& address) noexcept;
  UdpAddress address() const noexcept;

  // False, and errno says why: the system did not take it. Signal handlers may call it.
  bool send(std::span<const char> bytes, const UdpAddress& to) const noexcept;
  // The next datagram: how many bytes it has, of which as many as there is room are in `into`. -1: none waits.
  std::int64_t receive(std::span<char> into, UdpAddress& from) const noexcept;
  // Waits until a datagram is there, s at most. False: none is.
  bool wait(double seconds) const noexcept;

 private:
  int socket_;
};

}  // namespace wholehand
