// SPDX-License-Identifier: MIT
#include "device/usb_gripper.h"

#include <fmt/format.h>
#include <libusb-1.0/libusb.h>
#include <linux/usbdevice_fs.h>
#include <poll.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <optional>
#include <utility>

#include "core/error.h"
#include "device/panic.h"
#include "device/protocol.h"
#include "device/protocol_gripper.h"

namespace wholehand {
namespace {

using Clock = std::chrono::steady_clock;

// Input transfers in flight: the device's reports of 2 ms at the fastest rate allowed, so that a loop of 1 kHz always finds the newest.
constexpr int IN_FLIGHT = 16;
constexpr int OUT_PATIENCE = 10;                               // writes that find the one before still under way
constexpr std::chrono::milliseconds STALE_OUTPUT{10};          // several periods of any loop that has not stood still
constexpr unsigned CONTROL_PATIENCE = 500;                     // ms
constexpr unsigned RELEASE_PATIENCE = 100;                     // ms
constexpr unsigned PANIC_PATIENCE = 5;                         // ms
constexpr std::uint8_t REQUEST_IN = 0xC1, REQUEST_OUT = 0x41;  // vendor requests to an interface

struct ContextCloser {
  void operator()(libusb_context* context) const { libusb_exit(context); }
};
using Context = std::unique_ptr<libusb_context, ContextCloser>;

// What of a device is the gripper.
struct Part {
  int interface = 0;
  std::uint8_t in = 0, out = 0;  // endpoint addresses
};

class UsbTransport final : public Transport {
 public:
  // Claims the interface. Null where it cannot be opened; then `why` says so.
  static std::unique_ptr<UsbTransport> open(libusb_context* context, libusb_device* device, const Part& part, std::string& why);
  UsbTransport(libusb_context* context, libusb_device_handle* handle, const Part& part)
      : context_(context), handle_(handle), part_(part) {}
  ~UsbTransport() override;

  // Allocates what a session needs and lets the input flow; false: no memory.
  bool start();
  // From now on the context, which has no other use, goes with it.
  void keep(Context context) { kept_ = std::move(context); }

  int queue_length() const noexcept override { return IN_FLIGHT; }
  ReadOutcome receive(std::span<std::uint8_t> into, std::size_t& length, double patience) noexcept override;
  bool send(protocol::Bytes report) noexcept override;
  bool send_now(protocol::Bytes report) noexcept override;
  bool get_feature(std::span<std::uint8_t> report, std::size_t& length) noexcept override;
  bool set_feature(protocol::Bytes report) noexcept override;
  const char* trouble() const noexcept override { return trouble_; }
  bool panic(protocol::Bytes report) noexcept override;

 private:
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

  Context kept_;  // first: the last to go
  libusb_context* context_;
  libusb_device_handle* handle_;
  Part part_;
  int descriptor_ = -1;  // libusb's of the device node, for panic(); -1: not known
  std::array<Incoming, IN_FLIGHT> incoming_;
  std::array<Report, 2 * IN_FLIGHT> reports_;  // came and not taken yet: a ring
  std::size_t first_ = 0, count_ = 0;
  libusb_transfer* output_ = nullptr;
  std::array<std::uint8_t, protocol::OUTPUT_SIZE> output_bytes_{}, next_output_{};
  bool is_output_in_flight_ = false, has_next_output_ = false, has_output_failed_ = false, is_closing_ = false;
  Clock::time_point next_since_;  // when the one that waits was handed in
  int next_panics_ = 0;           // panics_ when its send() began
  std::atomic<int> panics_{0};    // calls of panic(), of any thread
  static_assert(std::atomic<int>::is_always_lock_free, "counted in a signal handler");
  int late_outputs_ = 0;
  bool has_input_failed_ = false;
  const char *input_trouble_ = "", *output_trouble_ = "";  // what the callbacks found
  const char* trouble_ = "";
};

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
  if (!is_all_done) return;  // a kernel that keeps a cancelled transfer: libusb may still look at it
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
  trouble_ = code == LIBUSB_ERROR_NO_DEVICE ? "unplugged" : what;
  return false;
}

// ---- input ----

void UsbTransport::submit(Incoming& incoming) noexcept {
  const int code = libusb_submit_transfer(incoming.transfer);
  incoming.is_in_flight = code == 0;
  if (code == 0) return;
  has_input_failed_ = true;
  input_trouble_ = code == LIBUSB_ERROR_NO_DEVICE ? "unplugged" : "a transfer failed";
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
  self.input_trouble_ = status_words(transfer->status);
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
  const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  while (is_busy) {
    const double left = std::chrono::duration<double>(end - Clock::now()).count();
    if (left <= 0 || !wait_for(left)) return false;
  }
  return true;
}

ReadOutcome UsbTransport::receive(std::span<std::uint8_t> into, std::size_t& length, double patience) noexcept {
  const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(patience));
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
      trouble_ = input_trouble_;
      return ReadOutcome::error;
    }
    const double left = std::chrono::duration<double>(end - Clock::now()).count();
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
    self.output_trouble_ = transfer->status == LIBUSB_TRANSFER_COMPLETED ? "it took half a report" : status_words(transfer->status);
    return;
  }
  if (!self.has_next_output_) return;
  self.has_next_output_ = false;
  // the process stood still meanwhile: the force of before must not come back
  if (Clock::now() - self.next_since_ >= STALE_OUTPUT) return;
  // nor may it follow the zero of a handler or a second thread
  if (self.next_panics_ != self.panics_ || is_letting_go()) return;
  self.output_bytes_ = self.next_output_;
  if (!self.submit_output()) {
    self.has_output_failed_ = true;
    self.output_trouble_ = self.trouble_;
  }
}

// One output is under way at a time, and one more waits, the newest: a device that is slow gets the force of now when it gets any.
bool UsbTransport::send(protocol::Bytes report) noexcept {
  const int panics = panics_;
  if (is_output_in_flight_ && !wait_for(0)) return false;
  if (has_output_failed_) {
    trouble_ = output_trouble_;
    return false;
  }
  auto& into = is_output_in_flight_ ? next_output_ : output_bytes_;
  std::copy_n(report.begin(), std::min(report.size(), into.size()), into.begin());
  // a second thread has written zero while libusb was waited for
  if (!is_output_in_flight_) return panics != panics_ || submit_output();
  has_next_output_ = true;
  next_panics_ = panics;
  next_since_ = Clock::now();
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

// Straight to the kernel, since libusb may be in the middle of something: the call waits for the transfer, which queues behind the one
// that is under way, and is then the last.
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

// ---- finding and opening ----

// The first interface of the active configuration that is a gripper's, with its first interrupt endpoint each way.
std::optional<Part> gripper_part(libusb_device* device) {
  libusb_config_descriptor* config = nullptr;
  if (libusb_get_active_config_descriptor(device, &config) != 0) return std::nullopt;
  std::optional<Part> answer;
  for (int i = 0; i < config->bNumInterfaces && !answer; ++i) {
    if (config->interface[i].num_altsetting < 1) continue;
    const libusb_interface_descriptor& setting = config->interface[i].altsetting[0];
    if (setting.bInterfaceClass != protocol::USB_CLASS || setting.bInterfaceSubClass != protocol::USB_SUBCLASS ||
        setting.bInterfaceProtocol != protocol::USB_PROTOCOL)
      continue;
    Part part{setting.bInterfaceNumber};
    for (int e = setting.bNumEndpoints - 1; e >= 0; --e) {
      const libusb_endpoint_descriptor& endpoint = setting.endpoint[e];
      if ((endpoint.bmAttributes & 3) != LIBUSB_TRANSFER_TYPE_INTERRUPT) continue;
      (endpoint.bEndpointAddress & LIBUSB_ENDPOINT_IN ? part.in : part.out) = endpoint.bEndpointAddress;
    }
    if (part.in != 0 && part.out != 0) answer = part;
  }
  libusb_free_config_descriptor(config);
  return answer;
}

std::unique_ptr<UsbTransport> UsbTransport::open(libusb_context* context, libusb_device* device, const Part& part,
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

struct Id {
  std::uint16_t vendor = 0, product = 0;
};

Id id_of(libusb_device* device) {
  libusb_device_descriptor descriptor{};
  libusb_get_device_descriptor(device, &descriptor);
  return {descriptor.idVendor, descriptor.idProduct};
}

std::string address_of(libusb_device* device) {
  const Id id = id_of(device);
  return fmt::format("usb:{:04x}:{:04x}", id.vendor, id.product);
}

std::optional<Id> parse_id(const std::string& text) {
  if (text.size() != 9 || text[4] != ':') return std::nullopt;
  Id id;
  const char* const start = text.data();
  const auto vendor = std::from_chars(start, start + 4, id.vendor, 16);
  const auto product = std::from_chars(start + 5, start + 9, id.product, 16);
  if (vendor.ec != std::errc() || vendor.ptr != start + 4 || product.ec != std::errc() || product.ptr != start + 9)
    return std::nullopt;
  return id;
}

Context new_context() {
  libusb_context* context = nullptr;
  if (const int code = libusb_init(&context); code != 0) throw failure_error(fmt::format("libusb: {}", libusb_strerror(code)));
  return Context(context);
}

// All devices, as long as this lives.
class DeviceList {
 public:
  explicit DeviceList(libusb_context* context) : size_(libusb_get_device_list(context, &devices_)) {}
  ~DeviceList() {
    if (size_ >= 0) libusb_free_device_list(devices_, 1);
  }
  DeviceList(const DeviceList&) = delete;
  DeviceList& operator=(const DeviceList&) = delete;
  std::span<libusb_device*> all() const { return {devices_, static_cast<std::size_t>(std::max<ssize_t>(size_, 0))}; }

 private:
  libusb_device** devices_ = nullptr;
  ssize_t size_;
};

constexpr const char* INTERFACE_WORDS = "interface of class FF, subclass 57, protocol 48 with an interrupt endpoint each way";

struct DeviceCloser {
  void operator()(libusb_device* device) const { libusb_unref_device(device); }
};

struct Picked {
  std::unique_ptr<libusb_device, DeviceCloser> device;  // null: none
  Part part;
  bool is_there = false;  // a device of that id, gripper or not
};

// The first gripper, of that id where one is given.
Picked pick(libusb_context* context, const std::optional<Id>& wish) {
  Picked picked;
  const DeviceList list(context);
  for (libusb_device* device : list.all()) {
    const Id id = id_of(device);
    if (wish && (id.vendor != wish->vendor || id.product != wish->product)) continue;
    picked.is_there = true;
    const std::optional<Part> part = gripper_part(device);
    if (!part) continue;
    picked.device.reset(libusb_ref_device(device));
    picked.part = *part;
    break;
  }
  return picked;
}

}  // namespace

std::unique_ptr<Gripper> open_usb(const std::string& vid_pid, double watchdog_s) {
  const std::optional<Id> wish = vid_pid.empty() ? std::nullopt : parse_id(vid_pid);
  if (!vid_pid.empty() && !wish)
    throw usage_error(
        fmt::format("usb:{}: give the vendor and product id as VVVV:PPPP, four hexadecimal digits each, or leave them out for "
                    "the first gripper found",
                    vid_pid));
  Context context = new_context();
  Picked picked = pick(context.get(), wish);
  if (!picked.device && !wish) throw failure_error(fmt::format("no gripper found over USB: no device has an {}", INTERFACE_WORDS));
  if (!picked.device)
    throw failure_error(picked.is_there ? fmt::format("usb:{}: it is no open gripper: it has no {}", vid_pid, INTERFACE_WORDS)
                                        : fmt::format("usb:{}: no such device is plugged in", vid_pid));
  const std::string address = address_of(picked.device.get());
  std::string why;
  std::unique_ptr<UsbTransport> transport = UsbTransport::open(context.get(), picked.device.get(), picked.part, why);
  if (!transport) throw failure_error(fmt::format("{}: {}", address, why));
  picked.device.reset();  // the handle has its own reference, and the context must not go before this one
  transport->keep(std::move(context));
  if (!transport->start()) throw failure_error(fmt::format("{}: no memory for its transfers", address));
  return open_over(std::move(transport), address, watchdog_s);
}

std::vector<GripperFound> find_usb_grippers() {
  std::vector<GripperFound> grippers;
  libusb_context* context = nullptr;
  if (libusb_init(&context) != 0) return grippers;
  const Context keeper(context);
  const DeviceList list(context);
  for (libusb_device* device : list.all()) {
    const std::optional<Part> part = gripper_part(device);
    if (!part) continue;
    GripperFound found{address_of(device), address_of(device), "", ""};
    const std::unique_ptr<UsbTransport> transport = UsbTransport::open(context, device, *part, found.missing);
    grippers.push_back(described(std::move(found), transport.get()));
  }
  return grippers;
}

}  // namespace wholehand
