// SPDX-License-Identifier: MIT
// Sends reports to and from an open gripper, over any carrier.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "device/grippers/protocol.h"
#include "device/session/tick.h"

namespace wholehand::device {

// The maker opens it, the destructor closes it. No method throws; receive() and send() allocate nothing themselves.
class Transport {
 public:
  Transport() = default;
  virtual ~Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;

  // How many unread reports can wait; further ones are lost.
  virtual int queue_length() const noexcept = 0;
  // The next report in order of arrival, waiting at most so long, s; `into` has LARGEST_SIZE bytes.
  virtual ReadOutcome receive(std::span<std::uint8_t> into, std::size_t& length, double patience) noexcept = 0;
  // False: not accepted. send_now() waits until the device has it.
  virtual bool send(protocol::Bytes report) noexcept = 0;
  virtual bool send_now(protocol::Bytes report) noexcept = 0;
  // report[0] is the id; `length` is the received length, id included.
  virtual bool get_feature(std::span<std::uint8_t> report, std::size_t& length) noexcept = 0;
  virtual bool set_feature(protocol::Bytes report) noexcept = 0;
  // Why the last of the above failed: a static text.
  virtual const char* last_error() const noexcept = 0;
  // Sends a report from a signal handler or a second thread, even while the above run. False: not accepted.
  virtual bool panic(protocol::Bytes report) noexcept = 0;
};

}  // namespace wholehand::device
