// SPDX-License-Identifier: MIT
// Reports to and from an open gripper's USB interface, by libusb.
#pragma once

#include <libusb-1.0/libusb.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "device/grippers/transport.h"

namespace wholehand::device {

struct UsbContextCloser {
  void operator()(libusb_context* context) const { libusb_exit(context); }
};
using UsbContext = std::unique_ptr<libusb_context, UsbContextCloser>;

// The gripper's interface within a device.
struct UsbPart {
  int interface = 0;
  std::uint8_t in = 0, out = 0;  // endpoint addresses
};

class UsbTransport final : public Transport {
 public:
  // Claims the interface. Null if it cannot be opened; then `why` says why.
  static std::unique_ptr<UsbTransport> open(libusb_context* context, libusb_device* device, const UsbPart& part, std::string& why);
  UsbTransport(libusb_context* context, libusb_device_handle* handle, const UsbPart& part)
      : context_(context), handle_(handle), part_(part) {}
  ~UsbTransport() override;

  // Allocates what a session needs and starts the input; false: no memory.
  bool start();
  // From now on this owns the context, which nothing else uses.
  void keep(UsbContext context) { kept_ = std::move(context); }

  int queue_length() const noexcept override { return IN_FLIGHT; }
  ReadOutcome receive(std::span<std::uint8_t> into, std::size_t& length, double patience) noexcept override;
  bool send(protocol::Bytes report) noexcept override;
  bool send_now(protocol::Bytes report) noexcept override;
  bool get_feature(std::span<std::uint8_t> report, std::size_t& length) noexcept override;
  bool set_feature(protocol::Bytes report) noexcept override;
  const char* last_error() const noexcept override { return last_error_; }
  bool panic(protocol::Bytes report) noexcept override;

 private:
  // Input transfers in flight: 2 ms of the device's reports at the fastest allowed rate, so that a loop of 1 kHz always finds the newest.
  static constexpr int IN_FLIGHT = 16;

  struct Incoming {
    UsbTransport* owner = nullptr;
    libusb_transfer* transfer = nullptr;
    std::array<std::uint8_t, protocol::LARGEST_SIZE> bytes{};
    bool is_in_flight = false;
  };
  struct Report {
    std::array<std::uint8_t, protocol::LARGEST_SIZE> bytes{};
    std::size_t length = 0;
  };

  static void LIBUSB_CALL on_input(libusb_transfer* transfer);
  static void LIBUSB_CALL on_output(libusb_transfer* transfer);
  void take(const Incoming& incoming) noexcept;
  void submit(Incoming& incoming) noexcept;
  bool submit_output() noexcept;
  bool wait_for(double seconds) noexcept;
  bool wait_while(const bool& is_busy, double seconds) noexcept;
  void find_descriptor();
  bool failed(int code, const char* what) noexcept;

  UsbContext kept_;  // declared first, so destroyed last
  libusb_context* context_;
  libusb_device_handle* handle_;
  UsbPart part_;
  int descriptor_ = -1;  // libusb's descriptor of the device node, for panic(); -1: unknown
  std::array<Incoming, IN_FLIGHT> incoming_;
  std::array<Report, 2 * IN_FLIGHT> reports_;  // received but not yet read: a ring
  std::size_t first_ = 0, count_ = 0;
  libusb_transfer* output_ = nullptr;
  std::array<std::uint8_t, protocol::OUTPUT_SIZE> output_bytes_{}, next_output_{};
  bool is_output_in_flight_ = false, has_next_output_ = false, has_output_failed_ = false, is_closing_ = false;
  double next_since_ = 0;       // s of the clock, when the waiting one was submitted
  int next_panics_ = 0;         // value of panics_ when its send() began
  std::atomic<int> panics_{0};  // number of panic() calls, from any thread
  static_assert(std::atomic<int>::is_always_lock_free, "counted in a signal handler");
  int late_outputs_ = 0;
  bool has_input_failed_ = false;
  const char *input_error_ = "", *output_error_ = "";  // what the callbacks found
  const char* last_error_ = "";
};

}  // namespace wholehand::device
