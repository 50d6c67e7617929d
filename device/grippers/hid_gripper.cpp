// SPDX-License-Identifier: MIT
#include "device/grippers/hid_gripper.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <hidapi/hidapi.h>
#include <linux/hidraw.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/system/clock.h"
#include "base/text/error.h"
#include "device/grippers/protocol.h"
#include "device/grippers/protocol_gripper.h"

namespace wholehand::device {
namespace {

constexpr int HIDRAW_QUEUE = 63;  // the kernel's ring of 64 entries, one of them free

// A second descriptor of the node beside hidapi's: for the lock, which hidapi does not take, and for panic().
class Node {
 public:
  explicit Node(int fd) : fd_(fd) {}
  ~Node() {
    if (fd_ >= 0) close(fd_);
  }
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_;
};

class HidTransport final : public Transport {
 public:
  // Null where it cannot be opened; then `why` says so.
  static std::unique_ptr<HidTransport> open(const std::string& path, std::string& why);
  explicit HidTransport(int fd) : node_(fd) {}
  ~HidTransport() override {
    if (device_) hid_close(device_);
  }

  int queue_length() const noexcept override { return HIDRAW_QUEUE; }
  ReadOutcome receive(std::span<std::uint8_t> into, std::size_t& length, double patience) noexcept override;
  bool send(protocol::Bytes report) noexcept override;
  bool send_now(protocol::Bytes report) noexcept override { return send(report); }  // hidraw waits for the device
  bool get_feature(std::span<std::uint8_t> report, std::size_t& length) noexcept override;
  bool set_feature(protocol::Bytes report) noexcept override;
  const char* last_error() const noexcept override { return last_error_; }
  bool panic(protocol::Bytes report) noexcept override {
    const int saved = errno;
    const ssize_t count = ::write(node_.fd(), report.data(), report.size());
    errno = saved;
    return count == static_cast<ssize_t>(report.size());
  }

 private:
  bool failed(const char* what) noexcept {
    last_error_ = errno == ENODEV || errno == ENXIO ? "unplugged" : what;
    return false;
  }

  Node node_;
  hid_device* device_ = nullptr;
  const char* last_error_ = "";
};

// Reads the report descriptor before hidapi opens the node: hidapi 0.13.1 uses freed memory if that is not a hidraw node, and a mouse must not be
// asked for features that it lacks.
std::unique_ptr<HidTransport> HidTransport::open(const std::string& path, std::string& why) {
  auto transport = std::make_unique<HidTransport>(::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOCTTY | O_NONBLOCK));
  const int fd = transport->node_.fd();
  if (fd < 0) {
    why = errno == EACCES || errno == EPERM ? no_permission(path) : fmt::format("it cannot be opened: {}", std::strerror(errno));
    return nullptr;
  }
  int size = 0;
  hidraw_report_descriptor descriptor{};
  if (ioctl(fd, HIDIOCGRDESCSIZE, &size) < 0 || size < 0 || size > HID_MAX_DESCRIPTOR_SIZE) {
    why = "it is no hidraw node";
    return nullptr;
  }
  descriptor.size = static_cast<std::uint32_t>(size);
  if (ioctl(fd, HIDIOCGRDESC, &descriptor) < 0 || !protocol::is_gripper({descriptor.value, static_cast<std::size_t>(size)})) {
    why = fmt::format("it is no open gripper: its report descriptor does not begin with usage {:04X} of page {:04X}",
                      protocol::USAGE, protocol::USAGE_PAGE);
    return nullptr;
  }
  if (flock(fd, LOCK_EX | LOCK_NB) < 0) {
    why = errno == EWOULDBLOCK ? IN_USE : fmt::format("it cannot be locked: {}", std::strerror(errno));
    return nullptr;
  }
  transport->device_ = hid_open_path(path.c_str());
  if (!transport->device_) {
    why = "hidapi cannot open it";
    return nullptr;
  }
  return transport;
}

ReadOutcome HidTransport::receive(std::span<std::uint8_t> into, std::size_t& length, double patience) noexcept {
  const double end = monotonic_now() + patience;
  for (;;) {
    const double left = std::ceil((end - monotonic_now()) * 1e3);  // ms
    errno = 0;
    const int count = hid_read_timeout(device_, into.data(), into.size(), static_cast<int>(std::max(left, 0.0)));
    if (count > 0) {
      length = static_cast<std::size_t>(count);
      return ReadOutcome::value;
    }
    if (count == 0) return ReadOutcome::timeout;
    if (errno == EINTR && monotonic_now() < end) continue;  // a signal that somebody handles elsewhere
    if (errno == EINTR) return ReadOutcome::timeout;
    // no error number: poll() found the node hung up
    last_error_ = errno == 0 || errno == EIO || errno == ENODEV ? "unplugged" : "read error";
    return ReadOutcome::error;
  }
}

bool HidTransport::send(protocol::Bytes report) noexcept {
  const int count = hid_write(device_, report.data(), report.size());
  return count == static_cast<int>(report.size()) || failed("it takes no force");
}

bool HidTransport::get_feature(std::span<std::uint8_t> report, std::size_t& length) noexcept {
  const int count = hid_get_feature_report(device_, report.data(), report.size());
  length = static_cast<std::size_t>(std::max(count, 0));
  return count >= 0 || failed("it does not answer");
}

bool HidTransport::set_feature(protocol::Bytes report) noexcept {
  const int count = hid_send_feature_report(device_, report.data(), report.size());
  return count >= 0 || failed("it does not take the setting");
}

// Nodes and product strings of the HID devices that are grippers.
struct Listed {
  std::string path, product;
};

std::vector<Listed> list() {
  std::vector<Listed> listed;
  hid_device_info* const all = hid_enumerate(0, 0);
  for (const hid_device_info* one = all; one; one = one->next) {
    if (one->usage_page != protocol::USAGE_PAGE || one->usage != protocol::USAGE || !one->path) continue;
    Listed entry{one->path, ""};
    for (const wchar_t* c = one->product_string; c && *c; ++c)
      entry.product += *c >= L' ' && *c <= L'~' ? static_cast<char>(*c) : '?';
    // a device with several collections is listed once for each
    const bool is_new =
        std::none_of(listed.begin(), listed.end(), [&entry](const Listed& other) { return other.path == entry.path; });
    if (is_new) listed.push_back(entry);
  }
  hid_free_enumeration(all);
  return listed;
}

}  // namespace

std::unique_ptr<Gripper> open_hid(const std::string& path, double watchdog_s) {
  std::string node = path;
  if (node.empty()) {
    const std::vector<Listed> listed = list();
    if (listed.empty())
      throw failure_error(
          fmt::format("no gripper found over HID: no device's report descriptor begins with usage {:04X} of page {:04X}",
                      protocol::USAGE, protocol::USAGE_PAGE));
    node = listed.front().path;
  }
  const std::string address = "hid:" + node;
  std::string why;
  std::unique_ptr<HidTransport> transport = HidTransport::open(node, why);
  if (!transport) throw failure_error(fmt::format("{}: {}", address, why));
  return open_over(std::move(transport), address, watchdog_s);
}

std::vector<GripperFound> find_hid_grippers() {
  std::vector<GripperFound> grippers;
  for (const Listed& one : list()) {
    GripperFound found{"hid:" + one.path, one.product, "", ""};
    const std::unique_ptr<HidTransport> transport = HidTransport::open(one.path, found.missing);
    grippers.push_back(described(std::move(found), transport.get()));
  }
  return grippers;
}

}  // namespace wholehand::device
