// SPDX-License-Identifier: MIT
#include "tests/support/mock_grippers.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/hidraw.h>
#include <linux/usbdevice_fs.h>
#include <pty.h>
#include <sys/stat.h>
#include <umockdev-1.0/umockdev.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace wholehand {
namespace {

constexpr std::size_t HIDRAW_QUEUE = 63;
constexpr std::uint8_t ENDPOINT_IN = 0x81, ENDPOINT_OUT = 0x01;

// Before main(): the preloaded library must be there when the first device is looked for. A list of tests needs none.
__attribute__((constructor)) void start_again_preloaded(int argc, char** argv, char**) {
  const char* const before = std::getenv("LD_PRELOAD");
  if (before && std::strstr(before, "libumockdev-preload")) return;  // where there is no such library, the tests say so
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "--gtest_list_tests") == 0) return;
  setenv("LD_PRELOAD", (std::string("libumockdev-preload.so.0") + (before ? std::string(":") + before : "")).c_str(), 1);
  execv("/proc/self/exe", argv);
}

template <class T>
struct Unref {
  void operator()(T* object) const { g_object_unref(object); }
};
using Data = std::unique_ptr<UMockdevIoctlData, Unref<UMockdevIoctlData>>;

// What the pointer at `offset` of that memory points to, as memory of this process.
Data resolve(UMockdevIoctlData* data, std::size_t offset, std::size_t size) {
  return Data(umockdev_ioctl_data_resolve(data, offset, size, nullptr));
}

void complete(UMockdevIoctlClient* client, long result, int error = 0) {
  umockdev_ioctl_client_complete(client, error ? -1 : result, error);
}

std::string hex(protocol::Bytes bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

void add(UMockdevTestbed* testbed, const std::string& description) {
  GError* error = nullptr;
  if (umockdev_testbed_add_from_string(testbed, description.c_str(), &error)) return;
  std::fprintf(stderr, "umockdev: %s\n", error->message);
  std::abort();
}

double monotonic() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// About the middle of a gripper's workspace, some millimetres to and fro, and a turn about an axis that is none of the three.
GripperState moving(double time) {
  GripperState state;
  state.position = {0.010 * std::sin(3 * time), 0.005 * std::cos(2 * time), -0.007 * std::sin(time)};
  const double angle = 0.5 * std::sin(2 * time), c = std::cos(angle), s = std::sin(angle), u = 1 - c, x = 0.6, z = 0.8;
  state.rotation = {c + u * x * x, -s * z, u * x * z,  //
                    s * z,         c,      -s * x,     //
                    u * x * z,     s * x,  c + u * z * z};
  state.gap = 0.0125 + 0.010 * std::cos(time);
  state.buttons = static_cast<std::uint32_t>(time * 10) & 1;
  return state;
}

}  // namespace

// ---- the bench ----

// umockdev looks whether it is preloaded once, and rightly only after the first testbed.
MockBench::MockBench() : testbed_(umockdev_testbed_new()) {
  if (umockdev_in_mock_environment()) return;
  std::fprintf(stderr, "libumockdev-preload.so.0 is not loaded: is the package umockdev there?\n");
  std::abort();
}

MockBench::~MockBench() { g_object_unref(testbed_); }

std::string MockBench::root() const {
  char* const root = umockdev_testbed_get_root_dir(testbed_);
  const std::string answer = root;
  g_free(root);
  return answer;
}

// ---- what both have ----

MockSettings::MockSettings() : motion(moving) {
  identity.flags = protocol::HAS_ROTATION;
  identity.rate = 500;
  identity.force = 12'000'000;
  identity.grip = 8'000'000;
  identity.gap = {0, 25'000'000};
  identity.watchdog = 100'000;
  constexpr char NAME[] = "mock gripper";
  std::copy(std::begin(NAME), std::end(NAME), identity.name.begin());
}

MockGripper::MockGripper(const MockSettings& settings) : settings_(settings), start_(monotonic()) {
  watchdog_ = {protocol::WATCHDOG_ON, settings.identity.watchdog};
}

void MockGripper::start() {
  thread_ = std::thread([this] {
    auto next = std::chrono::steady_clock::now();
    const auto period =
        std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(settings_.period));
    while (!is_stopping_) {
      next = std::max(next + period, std::chrono::steady_clock::now());  // what was missed is not made up for
      std::this_thread::sleep_until(next);
      const std::lock_guard guard(lock_);
      if (is_unplugged_) continue;
      check_watchdog();
      frame();
      if (const Bytes report = measure(); !report.empty()) send(report);
    }
  });
}

void MockGripper::stop() {
  is_stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

double MockGripper::now() const { return monotonic() - start_; }

void MockGripper::check_watchdog() {
  if (!has_force_ || !(watchdog_.flags & protocol::WATCHDOG_ON) || now() - last_heard_ <= watchdog_.period / protocol::SECOND)
    return;
  has_force_ = false;
  has_tripped_ = true;
}

MockGripper::Bytes MockGripper::measure() {
  if (mischief_ == Mischief::silent) return {};
  const bool is_repeated = mischief_ == Mischief::same_sequence;
  const double since = is_repeated && kept_time_ ? *kept_time_ : now();
  kept_time_ = is_repeated ? std::optional(since) : std::nullopt;
  if (!is_repeated || sequence_ == 0) ++sequence_;
  // the clock's own microseconds first, so that the motion is that of the time that is sent
  const std::int64_t time = settings_.first_time + std::llround(since * protocol::SECOND);
  GripperState state = settings_.motion(static_cast<double>(time) / protocol::SECOND);
  state.sequence = sequence_;
  protocol::InputReport report = protocol::report_of(state);
  report.time = static_cast<std::uint32_t>(time);
  report.heard = heard_;
  odd_ = mischief_ == Mischief::number_back || mischief_ == Mischief::alternating ? odd_ + 1 : 0;
  if (mischief_ == Mischief::number_back) report.sequence -= 2 * odd_;
  if (mischief_ == Mischief::alternating) report.sequence = sequence_ - odd_ + odd_ % 2;
  if (mischief_ == Mischief::clock_back) report.time = sent_time_ - 1000;
  sent_time_ = report.time;
  if (has_force_) report.status |= protocol::FORCE_ON;
  if (has_tripped_) report.status |= protocol::WATCHDOG_TRIPPED;
  if (mischief_ == Mischief::not_homed) report.status &= static_cast<std::uint16_t>(~protocol::HOMED);
  if (mischief_ == Mischief::fault) report.status |= protocol::FAULT;
  if (mischief_ == Mischief::no_rotation) report.quaternion = {};
  const protocol::InputBytes encoded = protocol::encode(report);
  Bytes bytes(encoded.begin(), encoded.end());
  bytes[1] = settings_.version;
  switch (mischief_) {
    case Mischief::short_report:
      bytes.resize(bytes.size() / 2);
      break;
    case Mischief::long_report:
      bytes.resize(bytes.size() + 7);
      break;
    case Mischief::wrong_version:
      bytes[1] = protocol::VERSION + 1;
      break;
    case Mischief::wrong_id:
      bytes[0] = protocol::OUTPUT_ID;
      break;
    case Mischief::garbage:
      for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>((random_ = random_ * 1664525 + 1013904223) >> 24);
      break;
    default:
      break;
  }
  return bytes;
}

std::optional<MockGripper::Bytes> MockGripper::get_feature(std::uint8_t id) const {
  const auto as_bytes = [this](const auto& encoded) {
    Bytes bytes(encoded.begin(), encoded.end());
    bytes[1] = settings_.version;
    return bytes;
  };
  if (id == protocol::IDENTITY_ID) return as_bytes(protocol::encode(settings_.identity));
  if (id == protocol::WATCHDOG_ID) return as_bytes(protocol::encode(watchdog_));
  return std::nullopt;
}

bool MockGripper::set_feature(protocol::Bytes report) {
  protocol::Watchdog wish;
  if (protocol::decode(report, wish) != protocol::Wrong::nothing) return false;
  if (!settings_.keeps_watchdog) watchdog_ = wish;
  return true;
}

bool MockGripper::take_output(protocol::Bytes bytes) {
  if (mischief_ == Mischief::takes_no_force) return false;
  protocol::OutputReport report;
  if (protocol::decode(bytes, report) != protocol::Wrong::nothing) {
    ++rejected_;
    return true;
  }
  check_watchdog();
  outputs_.push_back(report);
  heard_ = report.sequence;
  last_heard_ = now();
  const bool is_enabled = (report.flags & protocol::ENABLE) != 0;
  if (!is_enabled) has_tripped_ = false;
  has_force_ = is_enabled && !has_tripped_;
  return true;
}

void MockGripper::misbehave(Mischief mischief) {
  const std::lock_guard guard(lock_);
  mischief_ = mischief;
}

std::vector<protocol::OutputReport> MockGripper::outputs() const {
  const std::lock_guard guard(lock_);
  return outputs_;
}

int MockGripper::rejected() const {
  const std::lock_guard guard(lock_);
  return rejected_;
}

bool MockGripper::has_force() const {
  const std::lock_guard guard(lock_);
  return has_force_;
}

bool MockGripper::has_tripped() const {
  const std::lock_guard guard(lock_);
  return has_tripped_;
}

protocol::Watchdog MockGripper::watchdog() const {
  const std::lock_guard guard(lock_);
  return watchdog_;
}

// ---- HID: a hidraw node whose reads and writes come here. That there is something to read is a byte in the pty behind it ----

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

// That of something else differs in the last byte of its usage.
HidMock::Bytes HidMock::descriptor() const {
  Bytes bytes(protocol::report_descriptor().begin(), protocol::report_descriptor().end());
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

int HidMock::on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, HidMock* self) {
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
}

// ---- USB: usbfs. Its node is a plain file, always ready, so that libusb asks over and over for what is done ----

UsbMock::UsbMock(MockBench& bench, const MockSettings& settings, int number)
    : MockGripper(settings), bench_(bench), handler_(umockdev_ioctl_base_new()) {
  node_ = fmt::format("/dev/bus/usb/001/{:03}", number);
  path_ = fmt::format("/sys/devices/mock/usb{}", number);
  std::array<std::uint8_t, 18 + 9 + 9 + 7 + 7> descriptors{18,
                                                           1,
                                                           0x00,
                                                           0x02,
                                                           0,
                                                           0,
                                                           0,
                                                           64,
                                                           0x55,
                                                           0xF0,
                                                           0x48,
                                                           0x57,
                                                           0x00,
                                                           0x01,
                                                           0,
                                                           0,
                                                           0,
                                                           1,  // device
                                                           9,
                                                           2,
                                                           32,
                                                           0,
                                                           1,
                                                           1,
                                                           0,
                                                           0x80,
                                                           50,  // configuration
                                                           9,
                                                           4,
                                                           0,
                                                           0,
                                                           2,
                                                           protocol::USB_CLASS,
                                                           protocol::USB_SUBCLASS,
                                                           protocol::USB_PROTOCOL,
                                                           0,  // interface
                                                           7,
                                                           5,
                                                           ENDPOINT_IN,
                                                           3,
                                                           64,
                                                           0,
                                                           1,
                                                           7,
                                                           5,
                                                           ENDPOINT_OUT,
                                                           3,
                                                           64,
                                                           0,
                                                           1};  // endpoints
  if (!settings.is_gripper) ++descriptors[18 + 9 + 7];          // the protocol of the interface
  g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(on_ioctl), this);
  umockdev_testbed_attach_ioctl(bench.testbed(), node_.c_str(), handler_, nullptr);
  add(bench.testbed(),
      fmt::format(
          "P: {0}\nN: bus/usb/001/{1:03}\nE: SUBSYSTEM=usb\nE: DRIVER=usb\nE: DEVTYPE=usb_device\nE: BUSNUM=001\nE: DEVNUM={1:03}\n"
          "E: DEVNAME=/dev/bus/usb/001/{1:03}\nA: busnum=1\\n\nA: devnum={1}\\n\nA: bConfigurationValue=1\\n\nA: speed=480\\n\n"
          "A: product=A wholehand gripper\\n\nH: descriptors={2}\n",
          path_.substr(4), number, hex(descriptors)));
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
    const protocol::Bytes bytes{static_cast<const std::uint8_t*>(memory->buffer), static_cast<std::size_t>(memory->buffer_length)};
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
    if (type == 0xC1 && request == protocol::GET_REPORT && kind == protocol::FEATURE_REPORT) {
      const std::optional<Bytes> report = get_feature(id);
      const std::size_t length = report ? std::min(size, report->size()) : 0;
      if (report) std::copy_n(report->begin(), length, buffer->data + 8);
      finish(urb, report ? 0 : -EPIPE, static_cast<int>(length));
    } else {
      const bool is_taken = type == 0x41 && request == protocol::SET_REPORT && kind == protocol::FEATURE_REPORT &&
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

int UsbMock::on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, UsbMock* self) {
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
}

// ---- no permission ----

// The mode goes to nothing, and root, whom no mode stops, becomes nobody meanwhile.
Refusal::Refusal(const MockBench& bench, const MockGripper& gripper) : user_(geteuid()) {
  file_ = bench.root() + gripper.node();
  struct stat status {};
  stat(file_.c_str(), &status);
  mode_ = status.st_mode & 07777;
  chmod(file_.c_str(), 0);
  if (user_ != 0) return;
  // what umockdev needs of the one who comes: a socket for events, and another even for an open() that is refused
  chmod(bench.root().c_str(), 0777);
  chmod((bench.root() + "/ioctl" + gripper.node()).c_str(), 0777);
  if (seteuid(65534) != 0) std::abort();
}

Refusal::~Refusal() {
  if (user_ == 0 && seteuid(0) != 0) std::abort();
  chmod(file_.c_str(), mode_);
}

}  // namespace wholehand
