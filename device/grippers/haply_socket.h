// SPDX-License-Identifier: MIT
// A WebSocket of a client, by Boost.Beast, with a patience for each call. This is the only file that compiles Beast.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/system/udp.h"

namespace wholehand::device {

// One connection. One thread at a time may use it.
class HaplySocket {
 public:
  enum class Got : std::uint8_t { message, nothing, closed };

  // Connects within `patience` s for each step; the resolution of a name has the patience of the system. Throws Error (failure) that begins with
  // `place`, the address in words: nothing listens there, it does not answer, or it does not speak WebSocket.
  HaplySocket(const HostPort& at, const std::string& place, double patience);
  ~HaplySocket();
  HaplySocket(const HaplySocket&) = delete;
  HaplySocket& operator=(const HaplySocket&) = delete;

  // Sends a text. False: it did not go within `patience` s, or the connection is closed; then it stays closed.
  bool send(const std::string& text, double patience) noexcept;
  // The next text, waiting at most `patience` s.
  Got receive(std::string& into, double patience) noexcept;
  // Says goodbye, and closes in any case.
  void close(double patience) noexcept;
  // The address of the other end: one text for all addresses of this machine's loopback.
  std::string peer() const;
  // The file descriptor: a signal handler may send a whole frame there while no other call sends.
  int descriptor() const noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// HOST:PORT, with an IPv6 HOST in brackets.
std::string authority(const HostPort& at);

// The body of GET http://HOST:PORT/target; empty: no answer within `patience` s (for each step; not for the resolution of a name), or one that is no
// success.
std::string http_get(const HostPort& at, const std::string& target, double patience) noexcept;

}  // namespace wholehand::device
