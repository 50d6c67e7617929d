// SPDX-License-Identifier: MIT
#include "tests/support/mock_grippers.h"

#include <sys/stat.h>
#include <umockdev-1.0/umockdev.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace wholehand {
namespace {

// Before main(): the preloaded library must be there when the first device is looked for. A list of tests needs none.
__attribute__((constructor)) void start_again_preloaded(int argc, char** argv, char**) {
  const char* const before = std::getenv("LD_PRELOAD");
  if (before && std::strstr(before, "libumockdev-preload")) return;  // where there is no such library, the tests say so
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "--gtest_list_tests") == 0) return;
  setenv("LD_PRELOAD", (std::string("libumockdev-preload.so.0") + (before ? std::string(":") + before : "")).c_str(), 1);
  execv("/proc/self/exe", argv);
}

double monotonic() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// About the middle of a gripper's workspace, some millimeters to and fro, and a turn about an axis that is none of the three.
device::GripperState moving(double time) {
  device::GripperState state;
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
  identity.flags = device::protocol::HAS_ROTATION;
  identity.rate = 500;
  identity.force = 12'000'000;
  identity.grip = 8'000'000;
  identity.gap = {0, 25'000'000};
  identity.watchdog = 100'000;
  constexpr char NAME[] = "mock gripper";
  std::copy(std::begin(NAME), std::end(NAME), identity.name.begin());
}

MockGripper::MockGripper(const MockSettings& settings) : settings_(settings), start_(monotonic()) {
  watchdog_ = {device::protocol::WATCHDOG_ON, settings.identity.watchdog};
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

double MockGripper::now() const {
  if (settings_.step == 0) return monotonic() - start_;
  return settings_.step * static_cast<double>(outputs_.size()) + sequence_ / device::protocol::SECOND;
}

void MockGripper::check_watchdog() {
  if (!has_force_ || !(watchdog_.flags & device::protocol::WATCHDOG_ON) ||
      now() - last_heard_ <= watchdog_.period / device::protocol::SECOND)
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
  const std::int64_t time = settings_.first_time + std::llround(since * device::protocol::SECOND);
  device::GripperState state = settings_.motion(static_cast<double>(time) / device::protocol::SECOND);
  state.sequence = sequence_;
  device::protocol::InputReport report = device::protocol::report_of(state);
  report.time = static_cast<std::uint32_t>(time);
  report.heard = heard_;
  odd_ = mischief_ == Mischief::number_back || mischief_ == Mischief::alternating ? odd_ + 1 : 0;
  if (mischief_ == Mischief::number_back) report.sequence -= 2 * odd_;
  if (mischief_ == Mischief::alternating) report.sequence = sequence_ - odd_ + odd_ % 2;
  if (mischief_ == Mischief::clock_back) report.time = sent_time_ - 1000;
  sent_time_ = report.time;
  if (has_force_) report.status |= device::protocol::FORCE_ON;
  if (has_tripped_) report.status |= device::protocol::WATCHDOG_TRIPPED;
  if (mischief_ == Mischief::not_homed) report.status &= static_cast<std::uint16_t>(~device::protocol::HOMED);
  if (mischief_ == Mischief::fault) report.status |= device::protocol::FAULT;
  if (mischief_ == Mischief::no_rotation) report.quaternion = {};
  const device::protocol::InputBytes encoded = device::protocol::encode(report);
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
      bytes[1] = device::protocol::VERSION + 1;
      break;
    case Mischief::wrong_id:
      bytes[0] = device::protocol::OUTPUT_ID;
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
  if (id == device::protocol::IDENTITY_ID) return as_bytes(device::protocol::encode(settings_.identity));
  if (id == device::protocol::WATCHDOG_ID) return as_bytes(device::protocol::encode(watchdog_));
  return std::nullopt;
}

bool MockGripper::set_feature(device::protocol::Bytes report) {
  device::protocol::Watchdog requested;
  if (device::protocol::decode(report, requested) != device::protocol::Wrong::nothing) return false;
  if (!settings_.keeps_watchdog) watchdog_ = requested;
  return true;
}

bool MockGripper::take_output(device::protocol::Bytes bytes) {
  if (mischief_ == Mischief::takes_no_force) return false;
  device::protocol::OutputReport report;
  if (device::protocol::decode(bytes, report) != device::protocol::Wrong::nothing) {
    ++rejected_;
    return true;
  }
  check_watchdog();
  outputs_.push_back(report);
  heard_ = report.sequence;
  last_heard_ = now();
  const bool is_enabled = (report.flags & device::protocol::ENABLE) != 0;
  if (!is_enabled) has_tripped_ = false;
  has_force_ = is_enabled && !has_tripped_;
  return true;
}

void MockGripper::misbehave(Mischief mischief) {
  const std::lock_guard guard(lock_);
  mischief_ = mischief;
}

std::vector<device::protocol::OutputReport> MockGripper::outputs() const {
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

device::protocol::Watchdog MockGripper::watchdog() const {
  const std::lock_guard guard(lock_);
  return watchdog_;
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
