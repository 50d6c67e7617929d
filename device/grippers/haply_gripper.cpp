// SPDX-License-Identifier: MIT
#include "device/grippers/haply_gripper.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "base/system/clock.h"
#include "base/text/error.h"
#include "core/prepare.h"
#include "core/quaternion.h"
#include "core/vectors.h"
#include "device/grippers/haply_exchange.h"
#include "device/grippers/haply_service.h"
#include "device/grippers/haply_tips.h"
#include "device/grippers/session_lock.h"

namespace wholehand::device {
namespace {

constexpr double CLOSING_TIME = 0.5;                // s from open to closed while the grip's first button is pressed, and back
constexpr double RELEASE_PATIENCE = READ_PATIENCE;  // s for the answer to zero force; beyond CALL_PATIENCE the watch would ask too
constexpr double PANIC_PATIENCE = 20e-3;            // s, in a signal handler
constexpr double LONGEST_STEP = 50e-3;              // s: of the follower, after missed ticks
constexpr std::uint32_t CLOSING_BUTTON = 1;

Triple difference(const Triple& a, const Triple& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

// The rotation in the device frame, by a unit quaternion w, x, y, z in Haply's frame.
glm::dmat3 turn_of(const std::array<double, 4>& q) {
  const Triple v = haply::from_haply({q[1], q[2], q[3]});
  return glm::mat3_cast(to_quat(Quaternion{v[0], v[1], v[2], q[0]}));
}

// The hand's opening above its closed gap: the tips that touch are the closed hand.
double opening_of(const HandData& hand) {
  const PreparedHand prepared = prepare_hand(hand);
  return hand.scale * (prepared.gap_open - prepared.gap_closed);
}

// Watches the devices until all of them have moved, and are still.
class Stillness {
 public:
  Stillness(const HaplyCalibration& calibration, std::size_t count) : calibration_(calibration), count_(count) {}

  bool holds(const haply::Measurement& now, double moment) {
    if (!first_) first_ = anchor_ = now;
    for (std::size_t k = 0; k < count_; ++k) {
      has_moved_[k] = has_moved_[k] || distance(now.cursors[k], first_->cursors[k]) > calibration_.travel;
      if (!has_moved_[k] || distance(now.cursors[k], anchor_.cursors[k]) > calibration_.rest || since_ == 0) {
        anchor_ = now;
        since_ = moment;
      }
    }
    return moment - since_ >= calibration_.still;
  }

 private:
  const HaplyCalibration& calibration_;
  std::size_t count_;
  std::optional<haply::Measurement> first_;
  haply::Measurement anchor_;
  std::array<bool, 2> has_moved_{};
  double since_ = 0;  // s on the clock
};

class HaplyGripper final : public Gripper {
 public:
  HaplyGripper(HaplyService service, std::unique_ptr<HaplySocket> idle, const haply::Devices& devices, const HostPort& at,
               const Scene& scene, double watchdog)
      : lock_(fmt::format("haply-{}-{}", service.socket->peer(), at.port)),
        place_(haply_place(at)),
        devices_(devices),
        has_two_(devices.count() == 2),
        had_idle_(idle != nullptr),
        period_(1 / scene.live.rate),
        exchange_(std::move(service.socket), std::move(idle), devices, service.version, watchdog) {
    limits_.name = has_two_ ? "two Inverse3" : "Inverse3 with VerseGrip";
    limits_.address = fmt::format("{}/{}{}{}", place_, devices.arms[0], has_two_ ? "," : "", devices.arms[1]);
    limits_.force = has_two_ ? TWO_TIPS_FORCE : INVERSE3_FORCE;
    limits_.grip = has_two_ ? TWO_TIPS_GRIP : 0;
    limits_.pushes_each_tip = has_two_;
    limits_.gap = {0, opening_of(scene.hand)};
    limits_.rate = HAPLY_RATE;
    limits_.is_left_handed = scene.hand.handedness == Handedness::left;
    // "if you stop sending them, the device returns to idle": docs.haply.co/inverseSDK/service/realtime/control-commands, without a time
    limits_.watchdog = UNKNOWN_WATCHDOG;
    gap_ = limits_.gap[1];
  }

  // Until the person has shown the origin. Throws Error (failure).
  void calibrate(const HaplyCalibration& calibration, const std::function<void(const std::string&)>& say);

  const GripperLimits& limits() const noexcept override { return limits_; }
  ReadOutcome read(GripperState& state, std::int64_t tick) noexcept override;
  bool write(const GripperForce& force) noexcept override;
  ReleaseResult release() noexcept override;
  ReleaseResult release_from_watchdog() noexcept override {
    const bool has_zero = is_released_.load() || exchange_.drop(false, RELEASE_PATIENCE);
    return has_zero ? ReleaseResult::written : ReleaseResult::refused;
  }
  ReleaseResult panic() noexcept override {
    return exchange_.panic(PANIC_PATIENCE) ? ReleaseResult::written : ReleaseResult::refused;
  }
  void close() noexcept override { exchange_.stop(); }
  const char* last_error() const noexcept override { return last_error_; }
  std::vector<std::string> notes_for_report() const override;

 private:
  void fill_tips(const haply::Measurement& now, double seconds, GripperState& state) noexcept;
  void fill_grip(const haply::Measurement& now, double seconds, GripperState& state) noexcept;

  const SessionLock lock_;
  const std::string place_;
  const haply::Devices devices_;
  const bool has_two_, had_idle_;
  const double period_;  // s
  GripperLimits limits_;
  haply::Measurement origin_;   // as calibrated
  glm::dmat3 grip_upright_{1};  // inverse of the grip's rotation there
  ClosingLine line_;
  Rotation rotation_{NO_ROTATION};
  double gap_ = 0;          // of a grip, m
  std::int64_t tick_ = -1;  // of the last state
  std::uint32_t reads_ = 0;
  const char* last_error_ = "";
  std::atomic<bool> is_released_{false};  // the service has answered the last zero force
  HaplyExchange exchange_;                // last: its thread ends first
};

void HaplyGripper::calibrate(const HaplyCalibration& calibration, const std::function<void(const std::string&)>& say) {
  say(fmt::format("{}: move, {}, and keep still for {:g} s; this place becomes the origin (docs/devices.md)", limits_.address,
                  has_two_ ? "touch the tips together in the middle of your workspace"
                           : "hold the grip in the middle of your workspace as you would hold an upright vessel",
                  calibration.still));
  const double end = monotonic_now() + calibration.patience;
  Stillness stillness(calibration, devices_.count());
  haply::Measurement now;
  for (;;) {
    const bool is_new = exchange_.take(now, READ_PATIENCE);
    const double moment = monotonic_now();
    if (!exchange_.is_open())
      throw failure_error(fmt::format("{}: {} during the calibration", limits_.address, exchange_.ending()));
    if (is_new && stillness.holds(now, moment)) break;
    if (moment > end) {
      const std::string wrong = exchange_.wrong();
      throw failure_error(
          fmt::format("{}: not calibrated within {:g} s: {}", limits_.address, calibration.patience,
                      wrong.empty() ? "move the devices first, and then keep them still" : "the service sends " + wrong));
    }
  }
  origin_ = now;
  grip_upright_ = glm::transpose(turn_of(now.orientation));
  say(fmt::format(
      "{}: calibrated; {}", limits_.address,
      has_two_ ? "grip by thumb and index finger"
               : fmt::format("the grip's first button closes the hand, within {:g} s, and no grip force is felt", CLOSING_TIME)));
}

ReadOutcome HaplyGripper::read(GripperState& state, std::int64_t tick) noexcept {
  haply::Measurement now;
  const bool is_new = exchange_.take(now, READ_PATIENCE);
  if (!exchange_.is_open()) {
    last_error_ = exchange_.ending();
    return ReadOutcome::error;
  }
  if (!is_new) {
    const char* const wrong = exchange_.wrong();
    last_error_ = *wrong ? wrong : "no new state of the service for 10 ms";
    return ReadOutcome::timeout;
  }
  const double seconds = tick_ < 0 ? 0 : std::clamp(period_ * static_cast<double>(tick - tick_), 0.0, LONGEST_STEP);
  tick_ = tick;
  if (has_two_)
    fill_tips(now, seconds, state);
  else
    fill_grip(now, seconds, state);
  state.sequence = ++reads_;
  state.time = 0;
  return ReadOutcome::value;
}

void HaplyGripper::fill_tips(const haply::Measurement& now, double seconds, GripperState& state) noexcept {
  const Triple left = haply::from_haply(difference(now.cursors[0], origin_.cursors[0]));
  const Triple right = haply::from_haply(difference(now.cursors[1], origin_.cursors[1]));
  const Triple between = difference(right, left);
  line_.follow(between, seconds);
  rotation_ = rotation_along(line_.direction(), rotation_);
  state.position = midpoint(left, right);
  state.rotation = rotation_;
  state.gap = dot(between, line_.direction());
  state.buttons = 0;
}

void HaplyGripper::fill_grip(const haply::Measurement& now, double seconds, GripperState& state) noexcept {
  const double step = limits_.gap[1] * seconds / CLOSING_TIME;
  gap_ = std::clamp(gap_ + (now.buttons & CLOSING_BUTTON ? -step : step), 0.0, limits_.gap[1]);
  state.position = haply::from_haply(difference(now.cursors[0], origin_.cursors[0]));
  state.rotation = to_rotation(turn_of(now.orientation) * grip_upright_);
  state.gap = gap_;
  state.buttons = now.buttons;
}

bool HaplyGripper::write(const GripperForce& force) noexcept {
  const bool is_number = is_finite(force);
  std::array<Triple, 2> tips{};
  if (is_number && has_two_)
    tips = tip_forces(force, line_.direction(), INVERSE3_FORCE);
  else if (is_number)
    tips[0] = capped(force.arm, INVERSE3_FORCE);
  for (Triple& tip : tips) tip = haply::to_haply(tip);
  exchange_.put(tips);
  if (!is_number) last_error_ = "a force that is NaN or infinite";
  if (exchange_.is_open()) return is_number;
  last_error_ = exchange_.ending();
  return false;
}

ReleaseResult HaplyGripper::release() noexcept {
  is_released_ = exchange_.drop(true, RELEASE_PATIENCE);
  if (is_released_) return ReleaseResult::written;
  last_error_ = exchange_.is_open() ? "the service does not answer zero force" : exchange_.ending();
  return ReleaseResult::refused;
}

std::vector<std::string> HaplyGripper::notes_for_report() const {
  std::vector<std::string> lines;
  if (!had_idle_) lines.push_back(place_ + ": the service took no second connection, over which zero force would go at a crash");
  if (const std::int64_t count = exchange_.wrong_count(); count > 0)
    lines.push_back(fmt::format("{}: messages of the service that could not be used: {}", place_, count));
  if (const std::int64_t count = exchange_.unasked_count(); count > 0)
    lines.push_back(fmt::format("{}: messages of the service that no message had asked for: {}", place_, count));
  return lines;
}

}  // namespace

std::unique_ptr<Gripper> open_haply(const HaplyAddress& address, const Scene& scene, double watchdog,
                                    const std::function<void(const std::string&)>& say, const HaplyCalibration& calibration) {
  constexpr double IDLE_PATIENCE = 2;  // s
  if (!(watchdog > 0)) throw usage_error("haply: the watchdog must be longer than 0 s");
  HaplyService service = meet_haply_service(address.at);
  const haply::Devices devices = choose_haply_devices(service.inventory, address);
  std::unique_ptr<HaplySocket> idle;
  try {
    idle = std::make_unique<HaplySocket>(address.at, haply_place(address.at), IDLE_PATIENCE);
  } catch (const Error&) {  // the session does without, and its report says so
  }
  auto gripper = std::make_unique<HaplyGripper>(std::move(service), std::move(idle), devices, address.at, scene, watchdog);
  gripper->calibrate(calibration, say);
  return gripper;
}

}  // namespace wholehand::device
