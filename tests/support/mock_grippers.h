// SPDX-License-Identifier: MIT
// Open grippers that are not there: the device's side of docs/gripper-protocol.md over umockdev, so that hidapi and libusb find and
// use them as they would real ones. They show what is done, not how fast: a call into umockdev takes up to a millisecond.
//
// umockdev works by a preloaded library. A program that links this file starts itself again with it.
#pragma once

#include <sys/types.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "device/grippers/protocol.h"
#include "device/session/tick.h"

struct _UMockdevTestbed;
struct _UMockdevIoctlBase;
struct _UMockdevIoctlClient;
struct _UMockdevIoctlData;

namespace wholehand {

// The machine's devices while it lives: none but the mocks on it. One at a time, and a number on it is used once.
class MockBench {
 public:
  MockBench();
  ~MockBench();
  MockBench(const MockBench&) = delete;
  MockBench& operator=(const MockBench&) = delete;
  _UMockdevTestbed* testbed() const { return testbed_; }
  std::string root() const;  // where its /dev and /sys lie

 private:
  _UMockdevTestbed* testbed_;
};

// What a mock does wrong from now on.
enum class Mischief {
  none,
  silent,         // sends nothing
  short_report,   // half of one
  long_report,    // some bytes more
  wrong_version,  // of the next version
  wrong_id,
  garbage,        // random bytes of the right length
  same_sequence,  // measures once and sends that again and again
  number_back,    // its sequence goes down
  alternating,    // of two sequence numbers, in turn
  clock_back,     // steps back by a millisecond each time
  no_rotation,    // a quaternion of zeros
  not_homed,
  fault,
  takes_no_force,  // does not take output reports
};

struct MockSettings {
  device::protocol::Identity identity;  // 12 N, grip 8 N, gap 0 to 25 mm, right-handed, with rotation, 500 Hz, "mock gripper"
  double period = 2e-3;                 // between measurements, s
  std::uint32_t first_time = 0;         // of the device's clock, us
  std::uint8_t version = device::protocol::VERSION;
  // The device's clock goes on by `step`, s, with each output that it takes, and by 1 us with each measurement: no watchdog trips where a
  // busy machine stalls. 0: the machine's clock.
  double step = 2e-3;
  bool keeps_watchdog = false;  // does not take another period
  bool is_gripper = true;       // false: something else, by its descriptors
  // Position, rotation, gap and buttons at a time of the device's clock, s; the rest is the mock's own. From two threads, and under
  // the mock's lock: it must depend on nothing else.
  std::function<device::GripperState(double)> motion;
  MockSettings();
};

// A device behind either transport. Thread safe.
class MockGripper {
 public:
  explicit MockGripper(const MockSettings& settings);
  virtual ~MockGripper() = default;
  MockGripper(const MockGripper&) = delete;
  MockGripper& operator=(const MockGripper&) = delete;

  void misbehave(Mischief mischief);
  virtual void unplug() = 0;

  device::GripperState motion_at(double time) const { return settings_.motion(time); }
  std::vector<device::protocol::OutputReport> outputs() const;  // all that were taken
  int rejected() const;                                         // output reports that were none
  bool has_force() const;                                       // after its own watchdog
  bool has_tripped() const;
  device::protocol::Watchdog watchdog() const;
  const std::string& node() const { return node_; }  // /dev/..
  virtual std::string address() const = 0;           // for --device

 protected:
  using Bytes = std::vector<std::uint8_t>;
  // The device's own program, under the lock.
  Bytes measure();                                          // empty: nothing to send
  std::optional<Bytes> get_feature(std::uint8_t id) const;  // none: stalls
  bool set_feature(device::protocol::Bytes report);
  bool take_output(device::protocol::Bytes report);  // false: not taken
  virtual void send(const Bytes& report) = 0;        // called under the lock, as is
  virtual void frame() {}                            // before each measurement
  void start();
  void stop();  // by each destructor, before what send() needs goes

  mutable std::mutex lock_;
  std::string node_;
  bool is_unplugged_ = false;
  Mischief mischief_ = Mischief::none;

 private:
  double now() const;  // s on its clock
  void check_watchdog();

  MockSettings settings_;
  double start_;
  std::uint32_t sequence_ = 0, heard_ = 0;
  std::uint32_t odd_ = 0;            // measurements since its numbers went wrong
  std::uint32_t sent_time_ = 0;      // us
  std::optional<double> kept_time_;  // of the one measurement that is repeated
  device::protocol::Watchdog watchdog_;
  bool has_force_ = false, has_tripped_ = false;
  double last_heard_ = 0;
  int rejected_ = 0;
  std::vector<device::protocol::OutputReport> outputs_;
  std::uint32_t random_ = 1;
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
};

class HidMock final : public MockGripper {
 public:
  explicit HidMock(MockBench& bench, const MockSettings& settings = {}, int number = 0);
  ~HidMock() override;
  void unplug() override;
  std::string address() const override { return "hid:" + node_; }

 private:
  static int on_ioctl(_UMockdevIoctlBase*, _UMockdevIoctlClient* client, HidMock* self);
  static int on_read(_UMockdevIoctlBase*, _UMockdevIoctlClient* client, HidMock* self);
  static int on_write(_UMockdevIoctlBase*, _UMockdevIoctlClient* client, HidMock* self);
  static void on_connected(_UMockdevIoctlBase*, _UMockdevIoctlClient* client, HidMock* self);
  void send(const Bytes& report) override;
  Bytes descriptor() const;
  bool is_open();
  void empty();

  MockBench& bench_;
  const bool is_gripper_;
  std::string path_;  // in /sys
  _UMockdevIoctlBase* handler_;
  int master_ = -1, slave_ = -1;  // of the pty behind the node: a byte in it for each report that waits
  std::deque<Bytes> queue_;
  std::vector<_UMockdevIoctlClient*> clients_;
};

class UsbMock final : public MockGripper {
 public:
  explicit UsbMock(MockBench& bench, const MockSettings& settings = {}, int number = 1);
  ~UsbMock() override;
  void unplug() override;
  std::string address() const override { return "usb:" + id(); }
  static std::string id() { return "f055:5748"; }

 private:
  struct Urb {
    _UMockdevIoctlClient* client;
    _UMockdevIoctlData* data;
  };
  static int on_ioctl(_UMockdevIoctlBase*, _UMockdevIoctlClient* client, UsbMock* self);
  void send(const Bytes& report) override;
  void frame() override;
  void submit(_UMockdevIoctlClient* client);
  void reap(_UMockdevIoctlClient* client);
  void discard(_UMockdevIoctlClient* client);
  void claim(_UMockdevIoctlClient* client, bool is_claim);
  void bulk(_UMockdevIoctlClient* client);
  void finish(const Urb& urb, int status, int length);

  MockBench& bench_;
  std::string path_;
  _UMockdevIoctlBase* handler_;
  _UMockdevIoctlClient* claimed_ = nullptr;
  std::deque<Urb> flying_, done_;
};

// No permission for a node while it lives, for root neither.
class Refusal {
 public:
  Refusal(const MockBench& bench, const MockGripper& gripper);
  ~Refusal();
  Refusal(const Refusal&) = delete;
  Refusal& operator=(const Refusal&) = delete;

 private:
  std::string file_;
  mode_t mode_ = 0;
  uid_t user_;
};

}  // namespace wholehand
