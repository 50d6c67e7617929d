// SPDX-License-Identifier: MIT
// The open gripper protocol on the wire, as pure functions. docs/gripper-protocol.md defines it, and a test checks its example against this file byte
// for byte. Little endian; over HID and USB alike, a report's first byte is its id.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "device/loop/gripper.h"
#include "device/session/tick.h"

namespace wholehand::device::protocol {

constexpr std::uint8_t VERSION = 1;

// These identify a gripper, whatever its vendor and product id.
constexpr std::uint16_t USAGE_PAGE = 0xFF00, USAGE = 0x5748;                         // HID: of its first application collection
constexpr std::uint8_t USB_CLASS = 0xFF, USB_SUBCLASS = 0x57, USB_PROTOCOL = 0x48;   // USB: of its interface
constexpr std::uint8_t GET_REPORT = 0x01, SET_REPORT = 0x09, FEATURE_REPORT = 0x03;  // USB: vendor requests, as HID numbers them

constexpr std::uint8_t INPUT_ID = 1, OUTPUT_ID = 2, IDENTITY_ID = 3, WATCHDOG_ID = 4;
// Sizes of the reports in bytes, id included, and the largest size of any report.
constexpr std::size_t INPUT_SIZE = 52, OUTPUT_SIZE = 24, IDENTITY_SIZE = 56, WATCHDOG_SIZE = 8, LARGEST_SIZE = 64;
using InputBytes = std::array<std::uint8_t, INPUT_SIZE>;
using OutputBytes = std::array<std::uint8_t, OUTPUT_SIZE>;
using IdentityBytes = std::array<std::uint8_t, IDENTITY_SIZE>;
using WatchdogBytes = std::array<std::uint8_t, WATCHDOG_SIZE>;
using Bytes = std::span<const std::uint8_t>;

// Units of the integers on the wire.
constexpr double METER = 1e9, NEWTON = 1e6, SECOND = 1e6;
constexpr double QUATERNION_ONE = 1 << 30;

// Largest allowed numbers, in those units; a report beyond them is rejected whole.
constexpr std::int32_t MOST_POSITION = 2'000'000'000, LEAST_GAP = -10'000'000, MOST_GAP = 1'000'000'000;
constexpr std::int32_t MOST_FORCE = 1'000'000'000;                                            // 1000 N
constexpr std::uint32_t MOST_RATE = 8000, LEAST_WATCHDOG = 2'000, MOST_WATCHDOG = 1'000'000;  // Hz; 2 ms and 1 s
constexpr double QUATERNION_TOLERANCE = 1e-3;  // of the length: 16-bit integers that were shifted up still pass

enum Status : std::uint16_t { FORCE_ON = 1, WATCHDOG_TRIPPED = 2, HOMED = 4, SATURATED = 8, FAULT = 16 };
enum OutputFlag : std::uint16_t { ENABLE = 1 };
enum IdentityFlag : std::uint16_t { LEFT_HANDED = 1, HAS_ROTATION = 2 };
enum WatchdogFlag : std::uint16_t { WATCHDOG_ON = 1 };

// Bits of `status` and `flags` that this version does not name are kept and ignored.
struct InputReport {
  std::uint16_t status = 0;
  std::uint32_t sequence = 0;
  std::uint32_t time = 0;                    // us, wraps
  std::array<std::int32_t, 3> position{};    // nm
  std::array<std::int32_t, 4> quaternion{};  // w, x, y, z, of QUATERNION_ONE
  std::int32_t gap = 0;                      // nm
  std::uint32_t buttons = 0;
  std::uint32_t heard = 0;  // sequence of the last output report that the device accepted
};

struct OutputReport {
  std::uint16_t flags = 0;
  std::uint32_t sequence = 0;
  std::array<std::int32_t, 3> arm{};  // uN
  std::int32_t grip = 0;              // uN, positive opens
};

struct Identity {
  std::uint8_t version = VERSION;
  std::uint16_t flags = 0;
  std::uint32_t rate = 0;             // input reports a second, Hz
  std::int32_t force = 0, grip = 0;   // largest, uN
  std::array<std::int32_t, 2> gap{};  // closed, open, nm
  std::uint32_t watchdog = 0;         // period after power-on, us
  std::array<char, 24> name{};        // printable ASCII, filled up with zeros
};

struct Watchdog {
  std::uint16_t flags = 0;
  std::uint32_t period = 0;  // us
};

// What is wrong with a report.
enum class Wrong : std::uint8_t { nothing, length, id, version, magic, fault, not_homed, no_unit, range, tripped, older, clock };
const char* words(Wrong wrong);  // "wrong length", ..: a static text

// Decoding changes the result only if it returns `nothing`; `decode_identity` fills in the version whenever it can be read. A decoded input report is
// homed, without fault, and within the ranges above; the caller judges whether its watchdog tripped.
Wrong decode(Bytes bytes, InputReport& report) noexcept;
Wrong decode(Bytes bytes, OutputReport& report) noexcept;
Wrong decode_identity(Bytes bytes, Identity& identity) noexcept;
Wrong decode(Bytes bytes, Watchdog& watchdog) noexcept;

InputBytes encode(const InputReport& report) noexcept;
OutputBytes encode(const OutputReport& report) noexcept;
IdentityBytes encode(const Identity& identity) noexcept;
WatchdogBytes encode(const Watchdog& watchdog) noexcept;

// The HID report descriptor that every gripper of this version has.
Bytes report_descriptor();
// Whether the first application collection of a HID report descriptor is a gripper's.
bool is_gripper(Bytes report_descriptor) noexcept;

// Converts reports, in order of arrival, to the loop's states, and unwraps the device's clock.
class Measurements {
 public:
  explicit Measurements(bool has_rotation) : has_rotation_(has_rotation) {}
  // What is wrong with a report after the last converted one: an older sequence number, or a clock that has stepped back. Both wrap; less than half a
  // round ahead counts as later. The loop judges a repeated number.
  Wrong check(const InputReport& report) const noexcept;
  GripperState state(const InputReport& report) noexcept;

 private:
  bool has_rotation_, is_first_ = true;
  std::uint32_t last_time_ = 0, last_sequence_ = 0;
  std::int64_t time_ = 0;  // us
};

// The report for a state, as a device sends it. Clamps numbers to the wire's ranges.
InputReport report_of(const GripperState& state) noexcept;

// Newton to uN, rounded towards zero so that no limit is exceeded; clamped to MOST_FORCE.
OutputReport output_of(const GripperForce& force) noexcept;

GripperLimits limits_of(const Identity& identity, const std::string& address);
// "12 N, grip 8 N, gap 0 to 25 mm, 1000 Hz, right-handed"
std::string summary_of(const GripperLimits& limits);

}  // namespace wholehand::device::protocol
