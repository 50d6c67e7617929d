// SPDX-License-Identifier: MIT
// Reports to and from an open gripper, whatever carries them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "device/grippers/protocol.h"
#include "device/session/tick.h"

namespace wholehand {

// Opened by its maker, closed by its destructor. No method throws; receive() and send() do not allocate of their own.
class Transport {
 public:
  Transport() = default;
  virtual ~Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;

  // How many reports wait until they are read; newer ones beyond are lost.
  virtual int queue_length() const noexcept = 0;
  // The next report in the order in which they came, waiting for it so long, s; `into` has LARGEST_SIZE bytes.
  virtual ReadOutcome receive(std::span<std::uint8_t> into, std::size_t& length, double patience) noexcept = 0;
  // False: not taken. send_now() waits until the device has it.
  virtual bool send(protocol::Bytes report) noexcept = 0;
  virtual bool send_now(protocol::Bytes report) noexcept = 0;
  // report[0] is the id; `length` is what came, id included.
  virtual bool get_feature(std::span<std::uint8_t> report, std::size_t& length) noexcept = 0;
  virtual bool set_feature(protocol::Bytes report) noexcept = 0;
  // Why the last of the above failed: a few words that stay where they are.
  virtual const char* last_error() const noexcept = 0;
  // Sends a report from a signal handler or a second thread, whatever the above are doing. False: not taken.
  virtual bool panic(protocol::Bytes report) noexcept = 0;
};

}  // namespace wholehand
