// SPDX-License-Identifier: MIT
// HID: a hidraw node whose reads and writes come here. That there is something to read is a byte in the pty behind it.
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/hidraw.h>
#include <pty.h>
#include <umockdev-1.0/umockdev.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "tests/support/mock_grippers.h"
#include "tests/support/mock_umockdev.h"

namespace wholehand {

using namespace umockdev;

namespace {
constexpr std::size_t HIDRAW_QUEUE = 63;
}

HidMock::HidMock(MockBench& bench, const MockSettings& settings, int number)
    : MockGripper(settings), bench_(bench), is_gripper_(settings.is_gripper), handler_(umockdev_ioctl_base_new()) {
  node_ = fmt::format("/dev/hidraw{}", number);
  path_ = fmt::format("/sys/devices/mock/0003:F055:5748.{:04}", number);
  g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(on_ioctl), this);
  g_signal_connect(handler_, "handle-read", G_CALLBACK(on_read), this);
  g_signal_connect(handler_, "handle-write", G_CALLBACK(on_write), this);
  g_signal_connect(handler_, "client-connected", G_CALLBACK(on_connected), this);
  umockdev_testbed_attach_ioctl(bench.testbed(), node_.c_str(), handler_, nullptr);
  add(bench.testbed(),
      fmt::format("P: {}\nE: SUBSYSTEM=hid\nE: HID_ID=0003:0000F055:00005748\nE: HID_NAME=A wholehand gripper\nE: HID_UNIQ=\n"
                  "H: report_descriptor={}\n",
                  path_.substr(4), hex(descriptor())));
  add(bench.testbed(),
      fmt::format(
          "P: {0}/hidraw/hidraw{1}\nN: hidraw{1}\nE: SUBSYSTEM=hidraw\nE: DEVNAME=/dev/hidraw{1}\nE: MAJOR=240\nE: MINOR={1}\n"
          "A: dev=240:{1}\\n\nL: device=../../../{2}\n",
          path_.substr(4), number, std::filesystem::path(path_).filename().string()));
  master_ = umockdev_testbed_get_dev_fd(bench.testbed(), node_.c_str());
  slave_ = open(ptsname(master_), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  start();
}

HidMock::~HidMock() {
  stop();
  close(slave_);
  umockdev_testbed_detach_ioctl(bench_.testbed(), node_.c_str(), nullptr);
  if (!is_unplugged_) umockdev_testbed_remove_device(bench_.testbed(), path_.c_str());
  g_signal_handlers_disconnect_by_data(handler_, this);
  for (UMockdevIoctlClient* client : clients_) g_object_unref(client);
  g_object_unref(handler_);
}

// The master's number stays umockdev's to close; what is behind it goes, and so the node hangs up.
void HidMock::unplug() {
  const std::lock_guard guard(lock_);
  is_unplugged_ = true;
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  dup2(nothing, master_);
  close(nothing);
  umockdev_testbed_remove_device(bench_.testbed(), (path_ + "/hidraw/" + node_.substr(5)).c_str());
  umockdev_testbed_remove_device(bench_.testbed(), path_.c_str());
}

// The report descriptor. A device that is no gripper has another last byte of its usage.
HidMock::Bytes HidMock::descriptor() const {
  Bytes bytes(device::protocol::report_descriptor().begin(), device::protocol::report_descriptor().end());
  if (!is_gripper_) ++bytes[5];
  return bytes;
}

bool HidMock::is_open() {
  const auto is_gone = [](UMockdevIoctlClient* client) {
    if (umockdev_ioctl_client_get_connected(client)) return false;
    g_object_unref(client);
    return true;
  };
  clients_.erase(std::remove_if(clients_.begin(), clients_.end(), is_gone), clients_.end());
  return !clients_.empty();
}

void HidMock::empty() {
  char byte;
  for (; !queue_.empty(); queue_.pop_front()) [[maybe_unused]] const ssize_t count = ::read(slave_, &byte, 1);
}

// As the kernel does: nothing is kept for a node that nobody has open, and beyond the queue's length the newer ones are lost.
void HidMock::send(const Bytes& report) {
  if (!is_open()) return empty();
  if (queue_.size() == HIDRAW_QUEUE) return;
  queue_.push_back(report);
  [[maybe_unused]] const ssize_t count = ::write(master_, "", 1);
}

void HidMock::on_connected(UMockdevIoctlBase*, UMockdevIoctlClient* client, HidMock* self) {
  const std::lock_guard guard(self->lock_);
  self->empty();  // what waited for the session before
  g_object_ref(client);
  self->clients_.push_back(client);
}

int HidMock::on_read(UMockdevIoctlBase*, UMockdevIoctlClient* client, HidMock* self) {
  const std::lock_guard guard(self->lock_);
  if (self->is_unplugged_ || self->queue_.empty()) {
    complete(client, -1, self->is_unplugged_ ? EIO : EAGAIN);
    return true;
  }
  char byte;
  [[maybe_unused]] const ssize_t count = ::read(self->slave_, &byte, 1);
  UMockdevIoctlData* const into = umockdev_ioctl_client_get_arg(client);
  const Bytes report = self->queue_.front();
  self->queue_.pop_front();
  const std::size_t size = std::min(report.size(), static_cast<std::size_t>(into->data_len));
  std::copy_n(report.begin(), size, into->data);
  complete(client, static_cast<long>(size));
  return true;
}

int HidMock::on_write(UMockdevIoctlBase*, UMockdevIoctlClient* client, HidMock* self) {
  const std::lock_guard guard(self->lock_);
  const UMockdevIoctlData* const from = umockdev_ioctl_client_get_arg(client);
  const auto size = static_cast<std::size_t>(from->data_len);
  if (self->is_unplugged_)
    complete(client, -1, ENODEV);
  else if (!self->take_output({from->data, size}))
    complete(client, -1, ETIMEDOUT);  // what usbhid says of an endpoint that takes nothing
  else
    complete(client, static_cast<long>(size));
  return true;
}

int HidMock::on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, HidMock* self) try {
  const std::lock_guard guard(self->lock_);
  const unsigned long request = umockdev_ioctl_client_get_request(client);
  if (_IOC_TYPE(request) != 'H') return false;
  if (self->is_unplugged_) {
    complete(client, -1, ENODEV);
    return true;
  }
  const std::size_t size = _IOC_SIZE(request);
  const Data data = resolve(umockdev_ioctl_client_get_arg(client), 0, size);
  const Bytes descriptor = self->descriptor();
  if (request == HIDIOCGRDESCSIZE) {
    const int length = static_cast<int>(descriptor.size());
    std::memcpy(data->data, &length, sizeof length);
    complete(client, 0);
  } else if (request == HIDIOCGRDESC) {
    std::copy(descriptor.begin(), descriptor.end(), data->data + offsetof(hidraw_report_descriptor, value));
    complete(client, 0);
  } else if (_IOC_NR(request) == _IOC_NR(HIDIOCGFEATURE(0))) {
    const std::optional<Bytes> report = self->get_feature(data->data[0]);
    if (report) std::copy_n(report->begin(), std::min(size, report->size()), data->data);
    complete(client, report ? static_cast<long>(std::min(size, report->size())) : -1, report ? 0 : EPIPE);
  } else if (_IOC_NR(request) == _IOC_NR(HIDIOCSFEATURE(0))) {
    const bool is_taken = self->set_feature({data->data, size});
    complete(client, static_cast<long>(size), is_taken ? 0 : EPIPE);
  } else {
    return false;
  }
  return true;
} catch (const umockdev::ClientGone&) {
  return true;
}

}  // namespace wholehand
