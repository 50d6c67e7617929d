// SPDX-License-Identifier: MIT
#include "device/grippers/omega_gripper.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>

#include "base/system/output.h"
#include "base/text/error.h"
#include "device/grippers/dhd_library.h"
#include "device/grippers/session_lock.h"
#include "device/loop/panic.h"

namespace wholehand::device {

Triple from_dhd(const Triple& vector) { return {vector[1], vector[2], vector[0]}; }
Triple to_dhd(const Triple& vector) { return {vector[2], vector[0], vector[1]}; }

Rotation rotation_from_dhd(const double frame[3][3]) {
  constexpr int AXIS[3] = {1, 2, 0};  // of the SDK, for each of the device frame
  Rotation rotation;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rotation[3 * row + column] = frame[AXIS[row]][AXIS[column]];
  }
  return rotation;
}

namespace {

constexpr const char* PLACE = "omega";    // names the library in messages
constexpr double WATCHDOG_STEP = 125e-6;  // s
constexpr int WATCHDOG_STEPS = 255;
constexpr std::array<double, 2> GAP{0, 25e-3};  // m, of the data sheets

// Types: the constants DHD_DEVICE_OMEGA331 and so on, as CHAI3D's src/devices/CDeltaDevices.h has them. Forces: the table in CHAI3D's
// src/devices/CDeltaDevices.cpp. For the sigma.7, 12 N until somebody has read the data sheet, which reportedly allows 20 N.
struct Model {
  int type;
  const char* name;
  bool is_left_handed;
  double force, grip;  // N
};
constexpr std::array<Model, 4> MODELS{
    {{35, "omega.7", false, 12, 8}, {37, "omega.7", true, 12, 8}, {104, "sigma.7", false, 12, 8}, {105, "sigma.7", true, 12, 8}}};

bool is_plain(char letter) { return letter >= ' ' && letter <= '~'; }

// A vendor's library has no known encoding: letters beyond ASCII become '?', line ends a space.
std::string printable(std::string text) {
  for (char& letter : text)
    if (!is_plain(letter)) letter = letter == '\n' ? ' ' : '?';
  return text;
}

std::string dhd_error(const DhdLibrary& dhd) {
  const char* words = dhd.error_get_last_str();
  return printable(words && *words ? words : "no reason given");
}

std::string address_of(int number) { return number == 0 ? "omega" : fmt::format("omega:{}", number); }

const char* hand_name(const Model& model) { return model.is_left_handed ? "left hand" : "right hand"; }

// An open device; closed on destruction, unless closed before.
class Connection {
 public:
  Connection(const DhdLibrary& dhd, int number) : dhd_(dhd), id_(dhd.open_id(static_cast<char>(number))) {
    if (id_ >= 0) return;
    throw failure_error(fmt::format(
        "{}: cannot open device {}: {}; likely another program has it open, or you may not use it (device/udev/60-wholehand.rules)",
        address_of(number), number, dhd_error(dhd)));
  }
  ~Connection() { close(); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  char id() const { return static_cast<char>(id_); }
  void close() {
    if (is_open_) dhd_.close(id());
    is_open_ = false;
  }

 private:
  const DhdLibrary& dhd_;
  int id_;
  bool is_open_ = true;
};

std::string system_name(const DhdLibrary& dhd, char id) {
  const char* name = dhd.get_system_name(id);
  return name && *name ? printable(name) : "unnamed device";
}

const Model& model_of(const DhdLibrary& dhd, char id) {
  const int type = dhd.get_system_type(id);
  for (const Model& model : MODELS) {
    if (model.type == type) return model;
  }
  throw failure_error(
      fmt::format("omega: {} (type {}) is not supported; supported are omega.7 and sigma.7, for the right and the left hand",
                  system_name(dhd, id), type));
}

int count_devices(const DhdLibrary& dhd) {
  const int count = dhd.get_device_count();
  if (count > 0) return count;
  throw failure_error(
      "omega: Force Dimension's SDK finds no device; is one attached and switched on, and may you use it "
      "(device/udev/60-wholehand.rules)?");
}

// Checks the number before locking and opening the device. Returns it.
int check_number(const DhdLibrary& dhd, int number) {
  const int count = count_devices(dhd);
  if (number >= 0 && number < count) return number;
  throw failure_error(fmt::format("omega: there is no device {}; Force Dimension's SDK counts {}, from 0", number, count));
}

// -1: the device or this release of the SDK has none.
int serial_of(const DhdLibrary& dhd, char id) {
  unsigned short serial = 0;
  return dhd.get_serial_number && dhd.get_serial_number(&serial, id) >= 0 ? serial : -1;
}

std::string lock_name(int number) { return fmt::format("omega-{}", number); }

bool is_finite(const Triple& vector) { return std::isfinite(vector[0]) && std::isfinite(vector[1]) && std::isfinite(vector[2]); }

// Opens each device that is free, and closes it again.
int number_of_serial(const DhdLibrary& dhd, int serial) {
  if (!dhd.get_serial_number)
    throw failure_error(fmt::format("omega: {} has no dhdGetSerialNumber; name a device by its number", dhd.path));
  const int count = count_devices(dhd);
  std::string others;
  for (int number = 0; number < count; ++number) {
    try {
      const SessionLock lock(lock_name(number));
      const Connection connection(dhd, number);
      const int found = serial_of(dhd, connection.id());
      if (found == serial) return number;
      others += found < 0 ? fmt::format("; device {} gives none", number) : fmt::format("; device {} has {}", number, found);
    } catch (const Error& error) {
      others += fmt::format("; device {}: {}", number, error.what());
    }
  }
  throw failure_error(fmt::format("omega: no free device has the serial number {}{}", serial, others));
}

class OmegaGripper final : public Gripper {
 public:
  // `serial` is that of the device, or -1 for any: numbers change as devices come and go.
  OmegaGripper(const DhdLibrary& dhd, double watchdog, int number, int serial)
      : dhd_(dhd), lock_(lock_name(check_number(dhd_, number))), connection_(dhd_, number), id_(connection_.id()) {
    const Model& model = model_of(dhd_, id_);
    limits_.name = system_name(dhd_, id_);
    limits_.address = address_of(serial < 0 ? number : serial);
    if (serial >= 0 && serial_of(dhd_, id_) != serial)
      throw failure_error(limits_.address + ": the devices changed while they were searched; start again");
    limits_.force = model.force;
    limits_.grip = model.grip;
    limits_.gap = GAP;
    limits_.rate = 4000;
    limits_.is_left_handed = model.is_left_handed;
    // Left-hand devices count gripper angle and force in the opposite direction, according to the vendor's torus example of SDK 3.6, CHAI3D's
    // src/devices/CDeltaDevices.cpp and jhu-saw/sawForceDimensionSDK's mtsForceDimension.cpp.
    opening_ = model.is_left_handed ? -1 : 1;
    protect(watchdog);
  }

  ~OmegaGripper() override { close(); }

  const GripperLimits& limits() const noexcept override { return limits_; }

  // The SDK is thread-safe (docs/devices.md), so a second thread may call it; but a call that does not return may hold what others wait for.
  ReleaseResult release() noexcept override {
    if (!is_enabled_) return ReleaseResult::no_force;
    if (send(GripperForce{})) return ReleaseResult::written;
    fail_by("force not taken");
    return ReleaseResult::refused;
  }
  ReleaseResult release_from_watchdog() noexcept override {
    if (!is_enabled_) return ReleaseResult::no_force;
    return is_open_ && send(GripperForce{}) ? ReleaseResult::written : ReleaseResult::refused;
  }
  void close() noexcept override {
    if (!is_open_) return;
    // a force may be on until one of the two has removed it; tries both
    if (is_enabled_ && send(GripperForce{})) is_enabled_ = false;
    if (dhd_.stop(id_) >= 0) is_enabled_ = false;
    is_open_ = false;  // before: no other thread may use a number that was given back
    connection_.close();
  }
  ReleaseResult panic() noexcept override { return is_enabled_ ? ReleaseResult::not_attempted : ReleaseResult::no_force; }

  ReadOutcome read(GripperState& state, std::int64_t) noexcept override {
    GripperState fresh = state;
    if (!read_pose(fresh)) return ReadOutcome::error;
    fresh.buttons = dhd_.get_button_mask ? dhd_.get_button_mask(id_) : 0;
    fresh.sequence = ++reads_;
    fresh.time = dhd_.get_time();
    has_read_ = has_read_ || is_finite(fresh);
    state = fresh;
    return ReadOutcome::value;
  }

  bool write(const GripperForce& force) noexcept override {
    if (!is_finite(force)) {
      if (is_enabled_) send(GripperForce{});
      return fail("a force that is not a number");
    }
    if (!has_read_) return is_none(force) || fail("no force before the first good read");
    if (!has_enabled_) {
      // before the call: one that fails half-way may have switched it on, and then zero must be written
      is_enabled_ = true;
      if (dhd_.enable_force(1, id_) < 0) return fail_by("force cannot be enabled");
      has_enabled_ = true;
    }
    return send(force) || fail_by("force not taken");
  }

  const char* last_error() const noexcept override { return last_error_.data(); }

 private:
  // Before any force: none enabled, the watchdog on, the device's own maxima set. One user of an omega.7 found the gripper's at 1 N.
  void protect(double watchdog) {
    const int steps = static_cast<int>(std::clamp(std::round(watchdog / WATCHDOG_STEP), 1.0, 1.0 * WATCHDOG_STEPS));
    limits_.watchdog = steps * WATCHDOG_STEP;
    // the firmware is left to refuse; without expert mode, the calls below say so
    dhd_.enable_expert_mode();
    dhd_.enable_force(0, id_);
    if (dhd_.set_watchdog(static_cast<unsigned char>(steps), id_) < 0) {
      // the SDK cannot be called when this program fails: without a watchdog the last force would stay on
      throw failure_error(
          fmt::format("{}: the device takes no watchdog ({}), and is not used without one", limits_.address, dhd_error(dhd_)));
    }
    if (watchdog > WATCHDOG_STEPS * WATCHDOG_STEP + WATCHDOG_STEP / 2) {
      print_note(fmt::format("{}: the watchdog is set to {:.6g} ms, the longest of the device, instead of {:.6g} ms",
                             limits_.address, WATCHDOG_STEPS * WATCHDOG_STEP * 1e3, watchdog * 1e3));
    }
    if (dhd_.set_max_force(limits_.force, id_) < 0 || dhd_.set_max_gripper_force(limits_.grip, id_) < 0) {
      throw failure_error(fmt::format("{}: the device does not take its maximum forces of {:g} N and {:g} N: {}", limits_.address,
                                      limits_.force, limits_.grip, dhd_error(dhd_)));
    }
  }

  // Thumb and index finger rest at the two tracked points. Where only one of them moves, their middle is not the SDK's position.
  bool read_pose(GripperState& state) noexcept {
    double frame[3][3], gap;
    Triple position, thumb, finger;
    if (dhd_.get_position_and_orientation_frame(&position[0], &position[1], &position[2], frame, id_) < 0) {
      return fail_by("pose not read");
    }
    if (dhd_.get_gripper_gap(&gap, id_) < 0) return fail_by("gap not read");
    if (dhd_.get_gripper_thumb_pos(&thumb[0], &thumb[1], &thumb[2], id_) < 0) return fail_by("thumb not read");
    if (dhd_.get_gripper_finger_pos(&finger[0], &finger[1], &finger[2], id_) < 0) return fail_by("finger not read");
    const Triple middle{(thumb[0] + finger[0]) / 2, (thumb[1] + finger[1]) / 2, (thumb[2] + finger[2]) / 2};
    // a position that is not finite must not be lost because it is not used
    state.position = from_dhd(is_finite(position) ? middle : position);
    state.rotation = rotation_from_dhd(frame);
    // the gripper angle of left-hand devices is negative (manual of the lambda.7, "gripper angle",
    // https://www.easymanua.ls/force-dimension/lambda-7-haptic-device/manual?p=18); no source says whether their gap is too
    state.gap = limits_.is_left_handed ? std::fabs(gap) : gap;
    return true;
  }

  bool send(const GripperForce& force) noexcept {
    const Triple arm = to_dhd(force.arm);
    return dhd_.set_force_and_torque_and_gripper_force(arm[0], arm[1], arm[2], 0, 0, 0, opening_ * force.grip, id_) >= 0;
  }

  bool fail(const char* what) noexcept {
    std::snprintf(last_error_.data(), last_error_.size(), "%s", what);
    return false;
  }
  // With the SDK's words, which may change under a pointer.
  bool fail_by(const char* what) noexcept {
    const char* words = dhd_.error_get_last_str();
    std::snprintf(last_error_.data(), last_error_.size(), "%s: %s", what, words && *words ? words : "no reason given");
    for (char* letter = last_error_.data(); *letter; ++letter)
      if (!is_plain(*letter)) *letter = *letter == '\n' ? ' ' : '?';
    return false;
  }

  const ExitGuard exits_{PLACE};  // first: until the library is left
  const DhdLibrary dhd_;
  const SessionLock lock_;
  Connection connection_;
  const char id_;
  GripperLimits limits_;
  double opening_ = 1;  // sign of a gripper force that opens
  bool has_read_ = false;
  bool has_enabled_ = false;             // the device said so
  std::atomic<bool> is_enabled_{false};  // a force may be on; of any thread
  std::atomic<bool> is_open_{true};      // likewise
  std::uint32_t reads_ = 0;
  std::array<char, 160> last_error_{};
};

// One line on a device that could be opened.
GripperFound describe(const DhdLibrary& dhd, int number) {
  GripperFound found{"", fmt::format("omega device {}", number), "", ""};
  try {
    const SessionLock lock(lock_name(number));
    const Connection connection(dhd, number);
    found.name = system_name(dhd, connection.id());
    const Model& model = model_of(dhd, connection.id());
    int major = 0, minor = 0, release = 0, revision = 0;
    dhd.get_sdk_version(&major, &minor, &release, &revision);
    found.address = address_of(number);
    found.name += fmt::format(", {}", hand_name(model));
    if (const int serial = serial_of(dhd, connection.id()); serial >= OMEGA_DEVICES)
      found.name += fmt::format(", serial {}", serial);
    found.summary = fmt::format("up to {:g} N, gripper {:g} N, gap {:g} to {:g} mm, up to 4,000 Hz; SDK {}.{}.{} ({})", model.force,
                                model.grip, GAP[0] * 1e3, GAP[1] * 1e3, major, minor, release, dhd.path);
  } catch (const Error& error) {
    found.missing = error.what();
    found.remedy = error.remedy;
  }
  return found;
}

}  // namespace

std::unique_ptr<Gripper> open_omega(const std::string& library, double watchdog_s, int which) {
  if (!(watchdog_s > 0)) throw usage_error("omega: the watchdog must be longer than 0 s");
  const ExitGuard exits(PLACE);
  const DhdLibrary dhd = load_dhd_library(library);
  if (which < OMEGA_DEVICES) return std::make_unique<OmegaGripper>(dhd, watchdog_s, which, -1);
  return std::make_unique<OmegaGripper>(dhd, watchdog_s, number_of_serial(dhd, which), which);
}

std::vector<GripperFound> find_omega_grippers(const std::string& library) {
  std::vector<GripperFound> found;
  const ExitGuard exits(PLACE);
  try {
    const DhdLibrary dhd = load_dhd_library(library);
    const int count = count_devices(dhd);
    for (int number = 0; number < count; ++number) found.push_back(describe(dhd, number));
  } catch (const Error& error) {
    found.push_back({"", "omega", "", error.what(), error.remedy});
  }
  return found;
}

}  // namespace wholehand::device
