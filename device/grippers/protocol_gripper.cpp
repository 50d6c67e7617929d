// SPDX-License-Identifier: MIT
#include "device/grippers/protocol_gripper.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "base/system/clock.h"
#include "base/text/error.h"
#include "core/vectors.h"

namespace wholehand::device {
namespace {

using protocol::Wrong;

constexpr double START_PATIENCE = 1;  // s: for the first measurement; a device may have something to finish
constexpr int MOST_QUEUES = 8;        // read at once at most, so that a device faster than its reader does not hold it up forever
constexpr double LEAST_WATCHDOG_SHARE = 0.5;  // a device rounds its watchdog period down, and not to nothing

// Forces beyond the device's limits are scaled to them, direction kept: the last guard before the wire.
GripperForce limited(const GripperForce& force, const GripperLimits& limits) {
  GripperForce answer = force;
  const double size = norm(force.arm);
  if (size > limits.force)
    for (double& part : answer.arm) part *= limits.force / size;
  answer.grip = std::clamp(force.grip, -limits.grip, limits.grip);
  return answer;
}

class ProtocolGripper final : public Gripper {
 public:
  ProtocolGripper(std::unique_ptr<Transport> transport, const protocol::Identity& identity, const std::string& address)
      : transport_(std::move(transport)),
        limits_(protocol::limits_of(identity, address)),
        measurements_(limits_.has_rotation),
        release_(protocol::encode(protocol::OutputReport{})) {}
  ~ProtocolGripper() override { transport_->send_now(release_); }

  const GripperLimits& limits() const noexcept override { return limits_; }
  ReadOutcome read(GripperState& state, std::int64_t) noexcept override;
  bool write(const GripperForce& force) noexcept override;
  ReleaseResult release() noexcept override {
    if (transport_->send_now(release_)) return ReleaseResult::written;
    last_error_ = transport_->last_error();
    return ReleaseResult::refused;
  }
  const char* last_error() const noexcept override { return last_error_; }
  ReleaseResult panic() noexcept override {
    // the flag first, so that a write in between also sends no force
    has_panicked_.store(true);
    return release_from_watchdog();
  }
  ReleaseResult release_from_watchdog() noexcept override {
    return transport_->panic(release_) ? ReleaseResult::written : ReleaseResult::refused;
  }

  // The steps of the start; each throws Error (failure).
  void send_release();
  void set_watchdog(double seconds);
  void wait_for_measurement();

 private:
  ReadOutcome next(GripperState& state, double patience) noexcept;

  std::unique_ptr<Transport> transport_;
  GripperLimits limits_;
  protocol::Measurements measurements_;
  const protocol::OutputBytes release_;
  std::array<std::uint8_t, protocol::LARGEST_SIZE> buffer_{};
  std::uint32_t sequence_ = 0;
  const char* last_error_ = "";
  std::atomic<bool> has_panicked_{false};
  static_assert(std::atomic<bool>::is_always_lock_free, "set in a signal handler");
};

// One report.
ReadOutcome ProtocolGripper::next(GripperState& state, double patience) noexcept {
  std::size_t length = 0;
  const ReadOutcome outcome = transport_->receive(buffer_, length, patience);
  if (outcome != ReadOutcome::value) {
    last_error_ = outcome == ReadOutcome::timeout ? "no report" : transport_->last_error();
    return outcome;
  }
  protocol::InputReport report;
  Wrong wrong = protocol::decode({buffer_.data(), length}, report);
  // it released its force by itself, and stays released until the next session
  if (wrong == Wrong::nothing && (report.status & protocol::WATCHDOG_TRIPPED)) wrong = Wrong::tripped;
  if (wrong == Wrong::nothing) wrong = measurements_.check(report);
  if (wrong != Wrong::nothing) {
    last_error_ = words(wrong);
    return ReadOutcome::error;
  }
  state = measurements_.state(report);
  return ReadOutcome::value;
}

// Reads all that wait, checks each, and uses the last one. If as many waited as a queue holds, newer ones have been lost: the queue's contents are
// old, and one more must come.
ReadOutcome ProtocolGripper::read(GripperState& state, std::int64_t) noexcept {
  GripperState newest;
  const int full = transport_->queue_length();
  bool must_come = true;
  for (int count = 0, since_wait = 0; count < MOST_QUEUES * full; ++count, ++since_wait) {
    const ReadOutcome outcome = next(newest, must_come ? READ_PATIENCE : 0);
    if (outcome == ReadOutcome::error || (outcome == ReadOutcome::timeout && must_come)) return outcome;
    if (outcome == ReadOutcome::timeout && since_wait < full) break;
    must_come = outcome == ReadOutcome::timeout;
    if (must_come) since_wait = -1;
  }
  state = newest;
  return ReadOutcome::value;
}

bool ProtocolGripper::write(const GripperForce& force) noexcept {
  const bool is_number = is_finite(force), has_force = is_number && !has_panicked_.load();
  protocol::OutputReport report = protocol::output_of(has_force ? limited(force, limits_) : GripperForce{});
  report.flags = has_force ? protocol::ENABLE : 0;
  report.sequence = ++sequence_;
  const bool is_taken = transport_->send(protocol::encode(report));
  if (!is_taken) last_error_ = transport_->last_error();
  if (!is_number) last_error_ = "a force that is no number";
  return is_taken && is_number;
}

void ProtocolGripper::send_release() {
  if (!transport_->send_now(release_)) throw failure_error(fmt::format("{}: {}", limits_.address, transport_->last_error()));
}

void ProtocolGripper::set_watchdog(double seconds) {
  protocol::Watchdog requested, has;
  requested.flags = protocol::WATCHDOG_ON;
  requested.period = static_cast<std::uint32_t>(std::lround(seconds * protocol::SECOND));
  std::size_t length = 0;
  buffer_[0] = protocol::WATCHDOG_ID;
  if (!transport_->set_feature(protocol::encode(requested)) ||
      !transport_->get_feature({buffer_.data(), protocol::WATCHDOG_SIZE}, length))
    throw failure_error(fmt::format("{}: its watchdog cannot be set: {}", limits_.address, transport_->last_error()));
  if (const Wrong wrong = protocol::decode({buffer_.data(), length}, has); wrong != Wrong::nothing)
    throw failure_error(fmt::format("{}: its watchdog cannot be read: {}", limits_.address, words(wrong)));
  if (!(has.flags & protocol::WATCHDOG_ON))
    throw failure_error(
        fmt::format("{}: its watchdog stays off, and without one nothing stops its force when this program does", limits_.address));
  if (has.period > requested.period || has.period < LEAST_WATCHDOG_SHARE * requested.period)
    throw failure_error(fmt::format("{}: asked for a watchdog of {:g} ms, it keeps {:g} ms", limits_.address,
                                    requested.period / 1e3, has.period / 1e3));
  limits_.watchdog = has.period / protocol::SECOND;
}

// Reports from before the release may still wait, and say that the watchdog of an earlier session tripped.
void ProtocolGripper::wait_for_measurement() {
  const double end = monotonic_now() + START_PATIENCE;
  GripperState state;
  const char* read_error = nullptr;
  while (monotonic_now() < end) {
    const ReadOutcome outcome = next(state, READ_PATIENCE);
    if (outcome == ReadOutcome::value) {
      last_error_ = "";
      return;
    }
    if (outcome == ReadOutcome::error) read_error = last_error_;
  }
  throw failure_error(fmt::format("{}: {}", limits_.address, read_error ? read_error : "it sends no measurements"));
}

void check_watchdog(double watchdog_s) {
  constexpr double LEAST = protocol::LEAST_WATCHDOG / protocol::SECOND, MOST = protocol::MOST_WATCHDOG / protocol::SECOND;
  if (!(watchdog_s >= LEAST && watchdog_s <= MOST))
    throw usage_error(fmt::format("a watchdog of {:g} s: give {:g} to {:g}", watchdog_s, LEAST, MOST));
}

}  // namespace

std::string read_identity(Transport& transport, protocol::Identity& identity) {
  protocol::IdentityBytes bytes{protocol::IDENTITY_ID};
  std::size_t length = 0;
  if (!transport.get_feature(bytes, length)) return fmt::format("it does not say what it is: {}", transport.last_error());
  const Wrong wrong = protocol::decode_identity({bytes.data(), length}, identity);
  if (wrong == Wrong::version)
    return fmt::format("it speaks version {} of the gripper protocol, this program version {}", identity.version,
                       protocol::VERSION);
  if (wrong != Wrong::nothing) return fmt::format("it does not say what it is: {}", words(wrong));
  return "";
}

GripperFound described(GripperFound found, Transport* transport) {
  protocol::Identity identity;
  if (transport) found.missing = read_identity(*transport, identity);
  if (found.missing.empty()) {
    const GripperLimits limits = protocol::limits_of(identity, found.address);
    found.name = limits.name;
    found.summary = protocol::summary_of(limits);
  } else {
    found.address.clear();
  }
  return found;
}

std::unique_ptr<Gripper> open_over(std::unique_ptr<Transport> transport, const std::string& address, double watchdog_s) {
  check_watchdog(watchdog_s);
  protocol::Identity identity;
  if (const std::string wrong = read_identity(*transport, identity); !wrong.empty())
    throw failure_error(fmt::format("{}: {}", address, wrong));
  auto gripper = std::make_unique<ProtocolGripper>(std::move(transport), identity, address);
  gripper->send_release();
  gripper->set_watchdog(watchdog_s);
  gripper->wait_for_measurement();
  return gripper;
}

std::string no_permission(const std::string& node) {
  return fmt::format(
      "no permission for {}: copy device/udev/60-wholehand.rules to /etc/udev/rules.d/, run `sudo udevadm control --reload`, and "
      "plug it in "
      "again",
      node);
}

}  // namespace wholehand::device
