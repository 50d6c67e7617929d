// SPDX-License-Identifier: MIT
#include "base/system/udp.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <memory>
#include <system_error>

#include "base/text/error.h"

namespace wholehand {
namespace {

constexpr std::size_t LARGEST_HOST = 253;  // of a name in the DNS

using Addresses = std::unique_ptr<addrinfo, void (*)(addrinfo*)>;

const addrinfo* preferred(const addrinfo* first) {
  for (const addrinfo* address = first; address; address = address->ai_next)
    if (address->ai_family == AF_INET) return address;
  return first;
}

bool is_host(const std::string& host, bool has_brackets) {
  const auto is_of_host = [has_brackets](char c) {
    const bool is_alphanumeric = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    return is_alphanumeric || c == '.' || c == '-' || c == '_' || (has_brackets && (c == ':' || c == '%'));
  };
  return host.size() <= LARGEST_HOST && std::all_of(host.begin(), host.end(), is_of_host);
}

}  // namespace

bool read_port(const std::string& text, int least_port, int& port) {
  const char *begin = text.data(), *end = begin + text.size();
  const auto [stop, error] = std::from_chars(begin, end, port);
  return error == std::errc{} && stop == end && port >= least_port && port <= LARGEST_PORT;
}

std::string read_host_port(const std::string& text, int least_port, HostPort& into) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || text.back() == ']') return "there is no port";
  into.host = text.substr(0, colon);
  const bool has_brackets = !into.host.empty() && into.host.front() == '[' && into.host.back() == ']';
  if (has_brackets) into.host = into.host.substr(1, into.host.size() - 2);
  if (into.host.empty()) return "there is no host";
  if (!is_host(into.host, has_brackets)) return "its host is not valid";
  if (!read_port(text.substr(colon + 1), least_port, into.port))
    return fmt::format("its port is not a whole number from {} to {}", least_port, LARGEST_PORT);
  return "";
}

UdpAddress::UdpAddress(const sockaddr* bytes, socklen_t size) noexcept
    : size_(std::min(size, static_cast<socklen_t>(sizeof bytes_))) {
  std::memcpy(&bytes_, bytes, size_);
}

// At the same place in both families.
constexpr std::size_t PORT_AT = offsetof(sockaddr_in, sin_port);
static_assert(PORT_AT == offsetof(sockaddr_in6, sin6_port));

int UdpAddress::port() const noexcept {
  in_port_t port = 0;
  std::memcpy(&port, reinterpret_cast<const char*>(&bytes_) + PORT_AT, sizeof port);
  return ntohs(port);
}

UdpAddress UdpAddress::with_port(int port) const noexcept {
  UdpAddress other = *this;
  const in_port_t there = htons(static_cast<in_port_t>(port));
  std::memcpy(reinterpret_cast<char*>(&other.bytes_) + PORT_AT, &there, sizeof there);
  return other;
}

bool UdpAddress::is_loopback() const noexcept {
  if (family() == AF_INET) {
    sockaddr_in in{};
    std::memcpy(&in, &bytes_, sizeof in);
    return ntohl(in.sin_addr.s_addr) >> 24 == 127;
  }
  sockaddr_in6 in{};
  std::memcpy(&in, &bytes_, sizeof in);
  return IN6_IS_ADDR_LOOPBACK(&in.sin6_addr);
}

bool UdpAddress::operator==(const UdpAddress& other) const noexcept {
  return size_ == other.size_ && std::memcmp(&bytes_, &other.bytes_, size_) == 0;
}

std::string UdpAddress::host() const {
  char text[NI_MAXHOST] = "";
  getnameinfo(bytes(), size_, text, sizeof text, nullptr, 0, NI_NUMERICHOST);
  return text;
}

UdpAddress find_udp_address(const HostPort& where, const std::string& place) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(where.host.c_str(), std::to_string(where.port).c_str(), &hints, &found);
  if (error != 0) {
    throw failure_error(fmt::format("{}: host '{}' is not found: {}; give another host, or its address", place, where.host,
                                    error == EAI_SYSTEM ? std::strerror(errno) : gai_strerror(error)));
  }
  const Addresses all(found, freeaddrinfo);
  const addrinfo& address = *preferred(all.get());
  return {address.ai_addr, address.ai_addrlen};
}

UdpSocket::UdpSocket(int family, const std::string& place)
    : socket_(::socket(family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  if (socket_ < 0) throw failure_error(fmt::format("{}: no socket: {}", place, std::generic_category().message(errno)));
}

UdpSocket::~UdpSocket() { close(socket_); }

void UdpSocket::allow_broadcast() noexcept {
  const int on = 1;
  setsockopt(socket_, SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
}

int UdpSocket::bind(const UdpAddress& address) noexcept {
  return ::bind(socket_, address.bytes(), address.size()) == 0 ? 0 : errno;
}

UdpAddress UdpSocket::address() const noexcept {
  sockaddr_storage bytes{};
  socklen_t size = sizeof bytes;
  getsockname(socket_, reinterpret_cast<sockaddr*>(&bytes), &size);
  return {reinterpret_cast<const sockaddr*>(&bytes), size};
}

bool UdpSocket::send(std::span<const char> bytes, const UdpAddress& to) const noexcept {
  ssize_t sent = -1;
  do sent = sendto(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL, to.bytes(), to.size());
  while (sent < 0 && errno == EINTR);
  return sent >= 0;
}

std::int64_t UdpSocket::receive(std::span<char> into, UdpAddress& from) const noexcept {
  sockaddr_storage bytes{};
  socklen_t size = sizeof bytes;
  ssize_t length = -1;
  // the whole length, even if the datagram exceeds the buffer
  do length = recvfrom(socket_, into.data(), into.size(), MSG_TRUNC, reinterpret_cast<sockaddr*>(&bytes), &size);
  while (length < 0 && errno == EINTR);
  if (length < 0) return -1;
  from = UdpAddress(reinterpret_cast<const sockaddr*>(&bytes), size);
  return length;
}

bool UdpSocket::wait(double seconds) const noexcept {
  pollfd wanted{socket_, POLLIN, 0};
  return poll(&wanted, 1, static_cast<int>(std::lround(seconds * 1e3))) > 0;
}

}  // namespace wholehand
