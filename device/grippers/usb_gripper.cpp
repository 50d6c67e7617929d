// SPDX-License-Identifier: MIT
#include "device/grippers/usb_gripper.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <span>
#include <utility>

#include "base/text/error.h"
#include "device/grippers/protocol.h"
#include "device/grippers/protocol_gripper.h"
#include "device/grippers/usb_transport.h"

namespace wholehand::device {
namespace {

// The first interface of the active configuration that is a gripper's, with its first interrupt endpoint each way.
std::optional<UsbPart> gripper_part(libusb_device* device) {
  libusb_config_descriptor* config = nullptr;
  if (libusb_get_active_config_descriptor(device, &config) != 0) return std::nullopt;
  std::optional<UsbPart> answer;
  for (int i = 0; i < config->bNumInterfaces && !answer; ++i) {
    if (config->interface[i].num_altsetting < 1) continue;
    const libusb_interface_descriptor& setting = config->interface[i].altsetting[0];
    if (setting.bInterfaceClass != protocol::USB_CLASS || setting.bInterfaceSubClass != protocol::USB_SUBCLASS ||
        setting.bInterfaceProtocol != protocol::USB_PROTOCOL)
      continue;
    UsbPart part{setting.bInterfaceNumber};
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

UsbContext new_context() {
  libusb_context* context = nullptr;
  if (const int code = libusb_init(&context); code != 0) throw failure_error(fmt::format("libusb: {}", libusb_strerror(code)));
  return UsbContext(context);
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
  UsbPart part;
  bool is_there = false;  // a device of that id, gripper or not
};

// The first gripper, of that id where one is given.
Picked pick(libusb_context* context, const std::optional<Id>& requested) {
  Picked picked;
  const DeviceList list(context);
  for (libusb_device* device : list.all()) {
    const Id id = id_of(device);
    if (requested && (id.vendor != requested->vendor || id.product != requested->product)) continue;
    picked.is_there = true;
    const std::optional<UsbPart> part = gripper_part(device);
    if (!part) continue;
    picked.device.reset(libusb_ref_device(device));
    picked.part = *part;
    break;
  }
  return picked;
}

}  // namespace

std::unique_ptr<Gripper> open_usb(const std::string& vid_pid, double watchdog_s) {
  const std::optional<Id> requested = vid_pid.empty() ? std::nullopt : parse_id(vid_pid);
  if (!vid_pid.empty() && !requested)
    throw usage_error(
        fmt::format("usb:{}: give the vendor and product id as VVVV:PPPP, four hexadecimal digits each, or leave them out for "
                    "the first gripper found",
                    vid_pid));
  UsbContext context = new_context();
  Picked picked = pick(context.get(), requested);
  if (!picked.device && !requested)
    throw failure_error(fmt::format("no gripper found over USB: no device has an {}", INTERFACE_WORDS));
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
  const UsbContext keeper(context);
  const DeviceList list(context);
  for (libusb_device* device : list.all()) {
    const std::optional<UsbPart> part = gripper_part(device);
    if (!part) continue;
    GripperFound found{address_of(device), address_of(device), "", ""};
    const std::unique_ptr<UsbTransport> transport = UsbTransport::open(context, device, *part, found.missing);
    grippers.push_back(described(std::move(found), transport.get()));
  }
  return grippers;
}

}  // namespace wholehand::device
