// SPDX-License-Identifier: MIT
// USB: usbfs. Its node is a plain file, always ready, so that libusb asks over and over for what is done.
#include <fmt/format.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <umockdev-1.0/umockdev.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "tests/support/mock_grippers.h"
#include "tests/support/mock_umockdev.h"

namespace wholehand {

using namespace umockdev;

namespace {

constexpr std::uint8_t ENDPOINT_IN = 0x81, ENDPOINT_OUT = 0x01;

// Descriptors; that of the interface, between configuration and endpoints, says what the device is.
constexpr std::uint8_t DEVICE[]{18, 1, 0x00, 0x02, 0, 0, 0, 64, 0x55, 0xF0, 0x48, 0x57, 0x00, 0x01, 0, 0, 0, 1};
constexpr std::uint8_t CONFIGURATION[]{9, 2, 32, 0, 1, 1, 0, 0x80, 50};
constexpr std::uint8_t ENDPOINTS[]{7, 5, ENDPOINT_IN, 3, 64, 0, 1, 7, 5, ENDPOINT_OUT, 3, 64, 0, 1};

}  // namespace

UsbMock::UsbMock(MockBench& bench, const MockSettings& settings, int number)
    : MockGripper(settings), bench_(bench), handler_(umockdev_ioctl_base_new()) {
  node_ = fmt::format("/dev/bus/usb/001/{:03}", number);
  path_ = fmt::format("/sys/devices/mock/usb{}", number);
  // something else differs in its protocol
  const auto usb_protocol = static_cast<std::uint8_t>(device::protocol::USB_PROTOCOL + (settings.is_gripper ? 0 : 1));
  const std::array<std::uint8_t, 9> face{9, 4, 0, 0, 2, device::protocol::USB_CLASS, device::protocol::USB_SUBCLASS, usb_protocol,
                                         0};
  g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(on_ioctl), this);
  umockdev_testbed_attach_ioctl(bench.testbed(), node_.c_str(), handler_, nullptr);
  add(bench.testbed(),
      fmt::format(
          "P: {0}\nN: bus/usb/001/{1:03}\nE: SUBSYSTEM=usb\nE: DRIVER=usb\nE: DEVTYPE=usb_device\nE: BUSNUM=001\nE: DEVNUM={1:03}\n"
          "E: DEVNAME=/dev/bus/usb/001/{1:03}\nA: busnum=1\\n\nA: devnum={1}\\n\nA: bConfigurationValue=1\\n\nA: speed=480\\n\n"
          "A: product=A wholehand gripper\\n\nH: descriptors={2}\n",
          path_.substr(4), number, hex(DEVICE) + hex(CONFIGURATION) + hex(face) + hex(ENDPOINTS)));
  start();
}

UsbMock::~UsbMock() {
  stop();
  umockdev_testbed_detach_ioctl(bench_.testbed(), node_.c_str(), nullptr);
  if (!is_unplugged_) umockdev_testbed_remove_device(bench_.testbed(), path_.c_str());
  g_signal_handlers_disconnect_by_data(handler_, this);
  for (const Urb& urb : flying_) g_object_unref(urb.data);
  for (const Urb& urb : done_) g_object_unref(urb.data);
  if (claimed_) g_object_unref(claimed_);
  g_object_unref(handler_);
}

void UsbMock::unplug() {
  const std::lock_guard guard(lock_);
  is_unplugged_ = true;
  for (; !flying_.empty(); flying_.pop_front()) finish(flying_.front(), -ESHUTDOWN, 0);
  umockdev_testbed_uevent(bench_.testbed(), path_.c_str(), "remove");
  umockdev_testbed_remove_device(bench_.testbed(), path_.c_str());
}

void UsbMock::finish(const Urb& urb, int status, int length) {
  auto* const memory = reinterpret_cast<usbdevfs_urb*>(urb.data->data);
  memory->status = status;
  memory->actual_length = length;
  done_.push_back(urb);
}

// Where no transfer waits for it the measurement is lost.
void UsbMock::send(const Bytes& report) {
  const auto at = std::find_if(flying_.begin(), flying_.end(), [](const Urb& urb) {
    return reinterpret_cast<usbdevfs_urb*>(urb.data->data)->endpoint == ENDPOINT_IN;
  });
  if (at == flying_.end()) return;
  const Urb urb = *at;
  flying_.erase(at);
  auto* const memory = reinterpret_cast<usbdevfs_urb*>(urb.data->data);
  const std::size_t size = std::min(report.size(), static_cast<std::size_t>(memory->buffer_length));
  std::copy_n(report.begin(), size, static_cast<std::uint8_t*>(memory->buffer));
  finish(urb, 0, static_cast<int>(size));
}

// What waits to go out goes now, as far as the device takes it.
void UsbMock::frame() {
  for (auto at = flying_.begin(); at != flying_.end();) {
    auto* const memory = reinterpret_cast<usbdevfs_urb*>(at->data->data);
    const device::protocol::Bytes bytes{static_cast<const std::uint8_t*>(memory->buffer),
                                        static_cast<std::size_t>(memory->buffer_length)};
    if (memory->endpoint != ENDPOINT_OUT || !take_output(bytes)) {
      ++at;
      continue;
    }
    const Urb urb = *at;
    at = flying_.erase(at);
    finish(urb, 0, memory->buffer_length);
  }
}

void UsbMock::submit(UMockdevIoctlClient* client) {
  Data data = resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(usbdevfs_urb));
  auto* const memory = reinterpret_cast<usbdevfs_urb*>(data->data);
  const Data buffer = resolve(data.get(), offsetof(usbdevfs_urb, buffer), static_cast<std::size_t>(memory->buffer_length));
  if (is_unplugged_) return complete(client, -1, ENODEV);
  const Urb urb{client, data.release()};
  if (memory->type == USBDEVFS_URB_TYPE_CONTROL) {
    const std::uint8_t *const setup = buffer->data, type = setup[0], request = setup[1], id = setup[2], kind = setup[3];
    const auto size = static_cast<std::size_t>(setup[6] | setup[7] << 8);
    if (type == 0xC1 && request == device::protocol::GET_REPORT && kind == device::protocol::FEATURE_REPORT) {
      const std::optional<Bytes> report = get_feature(id);
      const std::size_t length = report ? std::min(size, report->size()) : 0;
      if (report) std::copy_n(report->begin(), length, buffer->data + 8);
      finish(urb, report ? 0 : -EPIPE, static_cast<int>(length));
    } else {
      const bool is_taken = type == 0x41 && request == device::protocol::SET_REPORT && kind == device::protocol::FEATURE_REPORT &&
                            set_feature({buffer->data + 8, size});
      finish(urb, is_taken ? 0 : -EPIPE, is_taken ? static_cast<int>(size) : 0);
    }
  } else {
    flying_.push_back(urb);  // until there is a frame for it
  }
  complete(client, 0);
}

void UsbMock::reap(UMockdevIoctlClient* client) {
  const auto at = std::find_if(done_.begin(), done_.end(), [client](const Urb& urb) { return urb.client == client; });
  if (at == done_.end()) return complete(client, -1, is_unplugged_ ? ENODEV : EAGAIN);
  const Data pointer = resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(void*));
  umockdev_ioctl_data_set_ptr(pointer.get(), 0, at->data);
  complete(client, 0);
  g_object_unref(at->data);
  done_.erase(at);
}

void UsbMock::discard(UMockdevIoctlClient* client) {
  gulong address = 0;
  std::memcpy(&address, umockdev_ioctl_client_get_arg(client)->data, sizeof address);
  const auto at = std::find_if(flying_.begin(), flying_.end(), [client, address](const Urb& urb) {
    return urb.client == client && urb.data->client_addr == address;
  });
  if (at == flying_.end()) return complete(client, -1, EINVAL);
  const Urb urb = *at;
  flying_.erase(at);
  finish(urb, -ENOENT, 0);
  complete(client, 0);
}

void UsbMock::claim(UMockdevIoctlClient* client, bool is_claim) {
  if (claimed_ && (!umockdev_ioctl_client_get_connected(claimed_) || (claimed_ == client && !is_claim))) {
    g_object_unref(claimed_);
    claimed_ = nullptr;
  }
  if (!is_claim) return complete(client, 0);
  if (claimed_ && claimed_ != client) return complete(client, -1, EBUSY);
  if (!claimed_) claimed_ = static_cast<UMockdevIoctlClient*>(g_object_ref(client));
  complete(client, 0);
}

void UsbMock::bulk(UMockdevIoctlClient* client) {
  const Data data = resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(usbdevfs_bulktransfer));
  const auto* const transfer = reinterpret_cast<usbdevfs_bulktransfer*>(data->data);
  const std::size_t size = transfer->len;
  const bool is_ours = transfer->ep == ENDPOINT_OUT && claimed_ == client;
  const Data buffer = resolve(data.get(), offsetof(usbdevfs_bulktransfer, data), size);
  if (is_unplugged_ || !is_ours) return complete(client, -1, is_unplugged_ ? ENODEV : EINVAL);
  frame();  // what is under way goes first
  const bool is_taken = take_output({buffer->data, size});
  complete(client, static_cast<long>(size), is_taken ? 0 : ETIMEDOUT);
}

int UsbMock::on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, UsbMock* self) try {
  const std::lock_guard guard(self->lock_);
  switch (umockdev_ioctl_client_get_request(client)) {
    case USBDEVFS_GET_CAPABILITIES: {
      const Data data = resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(std::uint32_t));
      const std::uint32_t capabilities = USBDEVFS_CAP_REAP_AFTER_DISCONNECT | USBDEVFS_CAP_BULK_CONTINUATION;
      std::memcpy(data->data, &capabilities, sizeof capabilities);
      complete(client, 0);
      return true;
    }
    case USBDEVFS_CLAIMINTERFACE:
      self->claim(client, true);
      return true;
    case USBDEVFS_RELEASEINTERFACE:
      self->claim(client, false);
      return true;
    case USBDEVFS_SUBMITURB:
      self->submit(client);
      return true;
    case USBDEVFS_REAPURBNDELAY:
      self->reap(client);
      return true;
    case USBDEVFS_DISCARDURB:
      self->discard(client);
      return true;
    case USBDEVFS_BULK:
      self->bulk(client);
      return true;
    default:
      return false;
  }
} catch (const umockdev::ClientGone&) {
  return true;
}

}  // namespace wholehand
