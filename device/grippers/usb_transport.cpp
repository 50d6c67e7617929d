// SPDX-License-Identifier: MIT
#include "device/grippers/usb_transport.h"

#include <fmt/format.h>
#include <linux/usbdevice_fs.h>
#include <poll.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cerrno>

#include "base/system/clock.h"
#include "device/grippers/protocol_gripper.h"
#include "device/loop/panic.h"

namespace wholehand::device {
namespace {

constexpr int OUT_PATIENCE = 10;                               // writes that find the one before still under way
constexpr double STALE_OUTPUT = 10e-3;                         // s: several periods of any loop that has not stood still
constexpr unsigned CONTROL_PATIENCE = 500;                     // ms
constexpr unsigned RELEASE_PATIENCE = 100;                     // ms
constexpr unsigned PANIC_PATIENCE = 5;                         // ms
constexpr std::uint8_t REQUEST_IN = 0xC1, REQUEST_OUT = 0x41;  // vendor requests to an interface

const char* status_words(libusb_transfer_status status) {
  switch (status) {
    case LIBUSB_TRANSFER_NO_DEVICE:
      return "unplugged";
    case LIBUSB_TRANSFER_STALL:
      return "its endpoint is halted";
    case LIBUSB_TRANSFER_OVERFLOW:
      return words(protocol::Wrong::length);
    default:
      return "a transfer failed";
  }
}

}  // namespace

std::unique_ptr<UsbTransport> UsbTransport::open(libusb_context* context, libusb_device* device, const UsbPart& part,
                                                 std::string& why) {
  libusb_device_handle* handle = nullptr;
  if (const int code = libusb_open(device, &handle); code != 0) {
    const std::string node =
        fmt::format("/dev/bus/usb/{:03}/{:03}", libusb_get_bus_number(device), libusb_get_device_address(device));
    why = code == LIBUSB_ERROR_ACCESS ? no_permission(node) : fmt::format("it cannot be opened: {}", libusb_strerror(code));
    return nullptr;
  }
  if (const int code = libusb_claim_interface(handle, part.interface); code != 0) {
    why = code == LIBUSB_ERROR_BUSY ? IN_USE : fmt::format("it cannot be claimed: {}", libusb_strerror(code));
    libusb_close(handle);
    return nullptr;
  }
  return std::make_unique<UsbTransport>(context, handle, part);
}

bool UsbTransport::start() {
  find_descriptor();
  output_ = libusb_alloc_transfer(0);
  if (!output_) return false;
  libusb_fill_interrupt_transfer(output_, handle_, part_.out, output_bytes_.data(), static_cast<int>(output_bytes_.size()),
                                 on_output, this, 0);
  for (Incoming& incoming : incoming_) {
    incoming.owner = this;
    incoming.transfer = libusb_alloc_transfer(0);
    if (!incoming.transfer) return false;
    libusb_fill_interrupt_transfer(incoming.transfer, handle_, part_.in, incoming.bytes.data(),
                                   static_cast<int>(incoming.bytes.size()), on_input, &incoming, 0);
    submit(incoming);
  }
  return true;
}

UsbTransport::~UsbTransport() {
  is_closing_ = true;
  for (Incoming& incoming : incoming_)
    if (incoming.is_in_flight) libusb_cancel_transfer(incoming.transfer);
  if (is_output_in_flight_) libusb_cancel_transfer(output_);
  bool is_all_done = wait_while(is_output_in_flight_, RELEASE_PATIENCE * 1e-3);
  for (const Incoming& incoming : incoming_) is_all_done &= wait_while(incoming.is_in_flight, RELEASE_PATIENCE * 1e-3);
  libusb_release_interface(handle_, part_.interface);
  libusb_close(handle_);
  if (!is_all_done) return;  // a kernel that keeps a canceled transfer: libusb may still read it
  for (Incoming& incoming : incoming_) libusb_free_transfer(incoming.transfer);
  libusb_free_transfer(output_);
}

// libusb names its descriptors only in its poll list, where the device node is the one that is waited on for writing (usbfs reports
// finished transfers so). The context has no other device open.
void UsbTransport::find_descriptor() {
  const libusb_pollfd** const list = libusb_get_pollfds(context_);
  for (const libusb_pollfd** one = list; one && *one; ++one)
    if ((*one)->events & POLLOUT) descriptor_ = (*one)->fd;
  libusb_free_pollfds(list);
}

bool UsbTransport::failed(int code, const char* what) noexcept {
  last_error_ = code == LIBUSB_ERROR_NO_DEVICE ? "unplugged" : what;
  return false;
}

// ---- input ----

void UsbTransport::submit(Incoming& incoming) noexcept {
  const int code = libusb_submit_transfer(incoming.transfer);
  incoming.is_in_flight = code == 0;
  if (code == 0) return;
  has_input_failed_ = true;
  input_error_ = code == LIBUSB_ERROR_NO_DEVICE ? "unplugged" : "a transfer failed";
}

void UsbTransport::on_input(libusb_transfer* transfer) {
  Incoming& incoming = *static_cast<Incoming*>(transfer->user_data);
  UsbTransport& self = *incoming.owner;
  incoming.is_in_flight = false;
  if (self.is_closing_) return;
  if (transfer->status == LIBUSB_TRANSFER_COMPLETED) {
    self.take(incoming);
    self.submit(incoming);
    return;
  }
  // for good: a session that goes on is no use, and where it was unplugged the transfers that follow say so
  self.has_input_failed_ = true;
  self.input_error_ = status_words(transfer->status);
}

void UsbTransport::take(const Incoming& incoming) noexcept {
  if (count_ == reports_.size()) {  // nobody reads: the oldest goes
    first_ = (first_ + 1) % reports_.size();
    --count_;
  }
  Report& report = reports_[(first_ + count_) % reports_.size()];
  report.bytes = incoming.bytes;
  report.length = static_cast<std::size_t>(incoming.transfer->actual_length);
  ++count_;
}

// Lets libusb work, at most so long; it comes back early when something happened.
bool UsbTransport::wait_for(double seconds) noexcept {
  timeval time{};
  time.tv_usec = static_cast<suseconds_t>(std::clamp(seconds, 0.0, 0.5) * 1e6);
  const int code = libusb_handle_events_timeout_completed(context_, &time, nullptr);
  return code == 0 || code == LIBUSB_ERROR_INTERRUPTED || failed(code, "libusb fails");
}

bool UsbTransport::wait_while(const bool& is_busy, double seconds) noexcept {
  const double end = monotonic_now() + seconds;
  while (is_busy) {
    const double left = end - monotonic_now();
    if (left <= 0 || !wait_for(left)) return false;
  }
  return true;
}

ReadOutcome UsbTransport::receive(std::span<std::uint8_t> into, std::size_t& length, double patience) noexcept {
  const double end = monotonic_now() + patience;
  for (bool has_looked = false;; has_looked = true) {
    if (count_ > 0) {
      const Report& report = reports_[first_];
      length = std::min(report.length, into.size());
      std::copy_n(report.bytes.begin(), length, into.begin());
      first_ = (first_ + 1) % reports_.size();
      --count_;
      return ReadOutcome::value;
    }
    if (has_input_failed_) {
      last_error_ = input_error_;
      return ReadOutcome::error;
    }
    const double left = end - monotonic_now();
    if (has_looked && left <= 0) return ReadOutcome::timeout;
    if (!wait_for(left)) return ReadOutcome::error;
  }
}

// ---- output ----

bool UsbTransport::submit_output() noexcept {
  const int code = libusb_submit_transfer(output_);
  is_output_in_flight_ = code == 0;
  return code == 0 || failed(code, "it takes no force");
}

void UsbTransport::on_output(libusb_transfer* transfer) {
  UsbTransport& self = *static_cast<UsbTransport*>(transfer->user_data);
  self.is_output_in_flight_ = false;
  if (self.is_closing_) return;
  if (transfer->status == LIBUSB_TRANSFER_CANCELLED) return;  // send_now() does without it
  self.late_outputs_ = 0;
  if (transfer->status != LIBUSB_TRANSFER_COMPLETED || transfer->actual_length != transfer->length) {
    self.has_output_failed_ = true;
    self.output_error_ = transfer->status == LIBUSB_TRANSFER_COMPLETED ? "it took half a report" : status_words(transfer->status);
    return;
  }
  if (!self.has_next_output_) return;
  self.has_next_output_ = false;
  // the process stalled meanwhile: the old force must not come back
  if (monotonic_now() - self.next_since_ >= STALE_OUTPUT) return;
  // nor may it follow the zero of a handler or a second thread
  if (self.next_panics_ != self.panics_ || is_releasing()) return;
  self.output_bytes_ = self.next_output_;
  if (!self.submit_output()) {
    self.has_output_failed_ = true;
    self.output_error_ = self.last_error_;
  }
}

// One output is in progress, and one more waits, the newest: a slow device gets the present force when it gets any.
bool UsbTransport::send(protocol::Bytes report) noexcept {
  const int panics = panics_;
  if (is_output_in_flight_ && !wait_for(0)) return false;
  if (has_output_failed_) {
    last_error_ = output_error_;
    return false;
  }
  auto& into = is_output_in_flight_ ? next_output_ : output_bytes_;
  std::copy_n(report.begin(), std::min(report.size(), into.size()), into.begin());
  // a second thread has written zero while libusb was waited for
  if (!is_output_in_flight_) return panics != panics_ || submit_output();
  has_next_output_ = true;
  next_panics_ = panics;
  next_since_ = monotonic_now();
  return ++late_outputs_ <= OUT_PATIENCE || failed(0, "it takes no force");
}

bool UsbTransport::send_now(protocol::Bytes report) noexcept {
  has_next_output_ = false;
  if (!wait_while(is_output_in_flight_, RELEASE_PATIENCE * 1e-3)) {
    libusb_cancel_transfer(output_);
    wait_while(is_output_in_flight_, RELEASE_PATIENCE * 1e-3);
  }
  // a copy: libusb's interface is not const
  std::array<std::uint8_t, protocol::OUTPUT_SIZE> bytes{};
  std::copy_n(report.begin(), std::min(report.size(), bytes.size()), bytes.begin());
  int sent = 0;
  const int code =
      libusb_interrupt_transfer(handle_, part_.out, bytes.data(), static_cast<int>(bytes.size()), &sent, RELEASE_PATIENCE);
  return (code == 0 && sent == static_cast<int>(bytes.size())) || failed(code, "it takes no force");
}

// Straight to the kernel, because libusb may be in the middle of something: the call waits for the transfer, which queues behind the one in progress
// and is then the last.
bool UsbTransport::panic(protocol::Bytes report) noexcept {
  ++panics_;
  if (descriptor_ < 0) return false;
  const int saved = errno;
  usbdevfs_bulktransfer transfer{};  // goes to interrupt endpoints too
  transfer.ep = part_.out;
  transfer.len = static_cast<unsigned>(report.size());
  transfer.timeout = PANIC_PATIENCE;
  transfer.data = const_cast<std::uint8_t*>(report.data());
  const int count = ioctl(descriptor_, USBDEVFS_BULK, &transfer);
  errno = saved;
  return count == static_cast<int>(report.size());
}

// ---- features ----

bool UsbTransport::get_feature(std::span<std::uint8_t> report, std::size_t& length) noexcept {
  const auto value = static_cast<std::uint16_t>(protocol::FEATURE_REPORT << 8 | report[0]);
  const int code =
      libusb_control_transfer(handle_, REQUEST_IN, protocol::GET_REPORT, value, static_cast<std::uint16_t>(part_.interface),
                              report.data(), static_cast<std::uint16_t>(report.size()), CONTROL_PATIENCE);
  length = static_cast<std::size_t>(std::max(code, 0));
  return code >= 0 || failed(code, "it does not answer");
}

bool UsbTransport::set_feature(protocol::Bytes report) noexcept {
  const auto value = static_cast<std::uint16_t>(protocol::FEATURE_REPORT << 8 | report[0]);
  std::array<std::uint8_t, protocol::LARGEST_SIZE> bytes{};
  std::copy_n(report.begin(), std::min(report.size(), bytes.size()), bytes.begin());
  const int code =
      libusb_control_transfer(handle_, REQUEST_OUT, protocol::SET_REPORT, value, static_cast<std::uint16_t>(part_.interface),
                              bytes.data(), static_cast<std::uint16_t>(report.size()), CONTROL_PATIENCE);
  return code == static_cast<int>(report.size()) || failed(code, "it does not take the setting");
}

}  // namespace wholehand::device
