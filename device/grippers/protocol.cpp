// SPDX-License-Identifier: MIT
#include "device/grippers/protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/readable.h"
#include "core/quaternion.h"

namespace wholehand::device::protocol {
namespace {

constexpr std::array<std::uint8_t, 4> MAGIC{'W', 'H', 'G', 'P'};

class Writer {
 public:
  explicit Writer(std::span<std::uint8_t> into) : into_(into) {}
  void u8(std::uint8_t value) { into_[at_++] = value; }
  void u16(std::uint16_t value) { bytes(value, 2); }
  void u32(std::uint32_t value) { bytes(value, 4); }
  void i32(std::int32_t value) { bytes(static_cast<std::uint32_t>(value), 4); }

 private:
  void bytes(std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i) u8(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  std::span<std::uint8_t> into_;
  std::size_t at_ = 0;
};

class Reader {
 public:
  explicit Reader(Bytes from) : from_(from) {}
  std::uint8_t u8() { return from_[at_++]; }
  std::uint16_t u16() { return static_cast<std::uint16_t>(bytes(2)); }
  std::uint32_t u32() { return bytes(4); }
  std::int32_t i32() { return static_cast<std::int32_t>(bytes(4)); }

 private:
  std::uint32_t bytes(int count) {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i) value |= static_cast<std::uint32_t>(u8()) << (8 * i);
    return value;
  }
  Bytes from_;
  std::size_t at_ = 0;
};

// The version before the length: another version may have another length, and the version is what to say then.
Wrong head_wrong(Bytes bytes, std::uint8_t id, std::size_t size) {
  if (bytes.size() >= 2 && bytes[0] == id && bytes[1] != VERSION) return Wrong::version;
  if (bytes.size() != size) return Wrong::length;
  return bytes[0] == id ? Wrong::nothing : Wrong::id;
}

bool is_within(std::int64_t value, std::int64_t least, std::int64_t most) { return value >= least && value <= most; }

bool is_unit(const std::array<std::int32_t, 4>& quaternion) {
  double square = 0;
  for (const std::int32_t part : quaternion) square += (part / QUATERNION_ONE) * (part / QUATERNION_ONE);
  return std::abs(std::sqrt(square) - 1) <= QUATERNION_TOLERANCE;
}

// Printable, and nothing but zeros after the first zero.
bool is_name(const std::array<char, 24>& name) {
  const auto end = std::find(name.begin(), name.end(), '\0');
  return std::all_of(name.begin(), end, [](char c) { return c >= ' ' && c <= '~'; }) &&
         std::all_of(end, name.end(), [](char c) { return c == '\0'; });
}

std::int32_t clamped(double value, double most) {
  if (std::isnan(value)) return 0;
  return static_cast<std::int32_t>(std::clamp(value, -most, most));
}

Rotation rotation_of(const std::array<std::int32_t, 4>& quaternion) {
  double square = 0;
  for (const std::int32_t part : quaternion) square += static_cast<double>(part) * part;
  const double length = std::sqrt(square);
  const double w = quaternion[0] / length, x = quaternion[1] / length, y = quaternion[2] / length, z = quaternion[3] / length;
  return to_rotation(glm::mat3_cast(glm::dquat(w, x, y, z)));
}

// The largest of the four parts is computed from the diagonal, the others from it: no part is a small difference of large ones.
std::array<double, 4> quaternion_of(const Rotation& r) {
  const std::array<double, 4> squares{1 + r[0] + r[4] + r[8], 1 + r[0] - r[4] - r[8], 1 - r[0] + r[4] - r[8],
                                      1 - r[0] - r[4] + r[8]};
  const auto largest = std::max_element(squares.begin(), squares.end()) - squares.begin();
  const double four = 2 * std::sqrt(squares[static_cast<std::size_t>(largest)]);  // four times the largest part
  const double yz = r[7] - r[5], zx = r[2] - r[6], xy = r[3] - r[1];
  switch (largest) {
    case 0:
      return {four / 4, yz / four, zx / four, xy / four};
    case 1:
      return {yz / four, four / 4, (r[1] + r[3]) / four, (r[2] + r[6]) / four};
    case 2:
      return {zx / four, (r[1] + r[3]) / four, four / 4, (r[5] + r[7]) / four};
    default:
      return {xy / four, (r[2] + r[6]) / four, (r[5] + r[7]) / four, four / 4};
  }
}

// clang-format off
constexpr std::uint8_t REPORT_DESCRIPTOR[] = {
    0x06, 0x00, 0xFF,              // usage page: vendor 0xFF00
    0x0A, 0x48, 0x57,              // usage: gripper 0x5748
    0xA1, 0x01,                    // collection: application
    0x15, 0x00,                    //   logical minimum: 0
    0x26, 0xFF, 0x00,              //   logical maximum: 255
    0x75, 0x08,                    //   report size: 8 bits
    0x85, INPUT_ID,                //   report id: 1
    0x09, 0x01,                    //   usage: measurement
    0x95, INPUT_SIZE - 1,          //   report count: 51 bytes
    0x81, 0x02,                    //   input: data, variable, absolute
    0x85, OUTPUT_ID,               //   report id: 2
    0x09, 0x02,                    //   usage: force
    0x95, OUTPUT_SIZE - 1,         //   report count: 23 bytes
    0x91, 0x02,                    //   output: data, variable, absolute
    0x85, IDENTITY_ID,             //   report id: 3
    0x09, 0x03,                    //   usage: identity
    0x95, IDENTITY_SIZE - 1,       //   report count: 55 bytes
    0xB1, 0x02,                    //   feature: data, variable, absolute
    0x85, WATCHDOG_ID,             //   report id: 4
    0x09, 0x04,                    //   usage: watchdog
    0x95, WATCHDOG_SIZE - 1,       //   report count: 7 bytes
    0xB1, 0x02,                    //   feature: data, variable, absolute
    0xC0,                          // end collection
};
// clang-format on

}  // namespace

const char* words(Wrong wrong) {
  switch (wrong) {
    case Wrong::nothing:
      return "";
    case Wrong::length:
      return "a report of the wrong length";
    case Wrong::id:
      return "a report of the wrong id";
    case Wrong::version:
      return "a report of another protocol version";
    case Wrong::magic:
      return "an identity without WHGP";
    case Wrong::fault:
      return "the device reports a fault of its own";
    case Wrong::not_homed:
      return "the device is not homed";
    case Wrong::no_unit:
      return "a quaternion that is no rotation";
    case Wrong::range:
      return "a number out of its range";
    case Wrong::tripped:
      return "the device's watchdog has tripped";
    case Wrong::older:
      return "its sequence numbers go back";
    case Wrong::clock:
      return "its clock steps back";
  }
  return "";
}

Wrong decode(Bytes bytes, InputReport& report) noexcept {
  if (const Wrong wrong = head_wrong(bytes, INPUT_ID, INPUT_SIZE); wrong != Wrong::nothing) return wrong;
  Reader reader(bytes.subspan(2));
  InputReport read;
  read.status = reader.u16();
  read.sequence = reader.u32();
  read.time = reader.u32();
  for (std::int32_t& part : read.position) part = reader.i32();
  for (std::int32_t& part : read.quaternion) part = reader.i32();
  read.gap = reader.i32();
  read.buttons = reader.u32();
  read.heard = reader.u32();
  // first what makes the numbers worthless: a device that is not homed has no pose to send
  if (read.status & FAULT) return Wrong::fault;
  if (!(read.status & HOMED)) return Wrong::not_homed;
  for (const std::int32_t part : read.position)
    if (!is_within(part, -MOST_POSITION, MOST_POSITION)) return Wrong::range;
  if (!is_within(read.gap, LEAST_GAP, MOST_GAP)) return Wrong::range;
  if (!is_unit(read.quaternion)) return Wrong::no_unit;
  report = read;
  return Wrong::nothing;
}

Wrong decode(Bytes bytes, OutputReport& report) noexcept {
  if (const Wrong wrong = head_wrong(bytes, OUTPUT_ID, OUTPUT_SIZE); wrong != Wrong::nothing) return wrong;
  Reader reader(bytes.subspan(2));
  OutputReport read;
  read.flags = reader.u16();
  read.sequence = reader.u32();
  for (std::int32_t& part : read.arm) part = reader.i32();
  read.grip = reader.i32();
  for (const std::int32_t part : {read.arm[0], read.arm[1], read.arm[2], read.grip})
    if (!is_within(part, -MOST_FORCE, MOST_FORCE)) return Wrong::range;
  report = read;
  return Wrong::nothing;
}

Wrong decode_identity(Bytes bytes, Identity& identity) noexcept {
  // the magic before the version: what does not have it is no gripper, and its second byte means nothing
  if (bytes.size() < 8) return Wrong::length;
  if (bytes[0] != IDENTITY_ID) return Wrong::id;
  if (!std::equal(MAGIC.begin(), MAGIC.end(), bytes.begin() + 4)) return Wrong::magic;
  identity.version = bytes[1];
  if (const Wrong wrong = head_wrong(bytes, IDENTITY_ID, IDENTITY_SIZE); wrong != Wrong::nothing) return wrong;
  Reader reader(bytes.subspan(2));
  Identity read;
  read.flags = reader.u16();
  reader.u32();  // the magic
  read.rate = reader.u32();
  read.force = reader.i32();
  read.grip = reader.i32();
  for (std::int32_t& end : read.gap) end = reader.i32();
  read.watchdog = reader.u32();
  for (char& c : read.name) c = static_cast<char>(reader.u8());
  const bool is_in_range = is_within(read.rate, 1, MOST_RATE) && is_within(read.force, 0, MOST_FORCE) &&
                           is_within(read.grip, 0, MOST_FORCE) && is_within(read.gap[0], LEAST_GAP, MOST_GAP) &&
                           is_within(read.gap[1], LEAST_GAP, MOST_GAP) && read.gap[0] < read.gap[1] &&
                           is_within(read.watchdog, LEAST_WATCHDOG, MOST_WATCHDOG) && is_name(read.name);
  if (!is_in_range) return Wrong::range;
  identity = read;
  return Wrong::nothing;
}

Wrong decode(Bytes bytes, Watchdog& watchdog) noexcept {
  if (const Wrong wrong = head_wrong(bytes, WATCHDOG_ID, WATCHDOG_SIZE); wrong != Wrong::nothing) return wrong;
  Reader reader(bytes.subspan(2));
  Watchdog read;
  read.flags = reader.u16();
  read.period = reader.u32();
  if (!is_within(read.period, LEAST_WATCHDOG, MOST_WATCHDOG)) return Wrong::range;
  watchdog = read;
  return Wrong::nothing;
}

InputBytes encode(const InputReport& report) noexcept {
  InputBytes bytes;
  Writer writer(bytes);
  writer.u8(INPUT_ID);
  writer.u8(VERSION);
  writer.u16(report.status);
  writer.u32(report.sequence);
  writer.u32(report.time);
  for (const std::int32_t part : report.position) writer.i32(part);
  for (const std::int32_t part : report.quaternion) writer.i32(part);
  writer.i32(report.gap);
  writer.u32(report.buttons);
  writer.u32(report.heard);
  return bytes;
}

OutputBytes encode(const OutputReport& report) noexcept {
  OutputBytes bytes;
  Writer writer(bytes);
  writer.u8(OUTPUT_ID);
  writer.u8(VERSION);
  writer.u16(report.flags);
  writer.u32(report.sequence);
  for (const std::int32_t part : report.arm) writer.i32(part);
  writer.i32(report.grip);
  return bytes;
}

IdentityBytes encode(const Identity& identity) noexcept {
  IdentityBytes bytes;
  Writer writer(bytes);
  writer.u8(IDENTITY_ID);
  writer.u8(identity.version);
  writer.u16(identity.flags);
  for (const std::uint8_t letter : MAGIC) writer.u8(letter);
  writer.u32(identity.rate);
  writer.i32(identity.force);
  writer.i32(identity.grip);
  for (const std::int32_t end : identity.gap) writer.i32(end);
  writer.u32(identity.watchdog);
  for (const char c : identity.name) writer.u8(static_cast<std::uint8_t>(c));
  return bytes;
}

WatchdogBytes encode(const Watchdog& watchdog) noexcept {
  WatchdogBytes bytes;
  Writer writer(bytes);
  writer.u8(WATCHDOG_ID);
  writer.u8(VERSION);
  writer.u16(watchdog.flags);
  writer.u32(watchdog.period);
  return bytes;
}

Bytes report_descriptor() { return REPORT_DESCRIPTOR; }

// Items up to the first collection: a prefix byte with the tag, the type and how many bytes of data follow (0, 1, 2 or 4). A usage of
// four bytes has its page in the upper half.
bool is_gripper(Bytes descriptor) noexcept {
  std::uint32_t page = 0, usage = 0;
  for (std::size_t at = 0; at < descriptor.size();) {
    const std::uint8_t prefix = descriptor[at];
    if (prefix == 0xFE) return false;  // a long item: none has been defined
    const std::size_t size = (prefix & 3) == 3 ? 4 : prefix & 3;
    if (at + 1 + size > descriptor.size()) return false;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value |= static_cast<std::uint32_t>(descriptor[at + 1 + i]) << (8 * i);
    switch (prefix & 0xFC) {
      case 0x04:
        page = value;
        break;
      case 0x08:
        usage = size == 4 ? value & 0xFFFF : value;
        if (size == 4) page = value >> 16;
        break;
      case 0xA0:
        return page == USAGE_PAGE && usage == USAGE;
      default:
        break;
    }
    at += 1 + size;
  }
  return false;
}

Wrong Measurements::check(const InputReport& report) const noexcept {
  if (is_first_) return Wrong::nothing;
  if (static_cast<std::int32_t>(report.sequence - last_sequence_) < 0) return Wrong::older;
  return static_cast<std::int32_t>(report.time - last_time_) < 0 ? Wrong::clock : Wrong::nothing;
}

GripperState Measurements::state(const InputReport& report) noexcept {
  if (is_first_) {
    time_ = report.time;
    is_first_ = false;
  } else {
    time_ += static_cast<std::int32_t>(report.time - last_time_);
  }
  last_time_ = report.time;
  last_sequence_ = report.sequence;
  GripperState state;
  for (std::size_t axis = 0; axis < 3; ++axis) state.position[axis] = report.position[axis] / METER;
  if (has_rotation_) state.rotation = rotation_of(report.quaternion);
  state.gap = report.gap / METER;
  state.buttons = report.buttons;
  state.sequence = report.sequence;
  state.time = static_cast<double>(time_) / SECOND;
  return state;
}

InputReport report_of(const GripperState& state) noexcept {
  InputReport report;
  report.status = HOMED;
  report.sequence = state.sequence;
  report.time = static_cast<std::uint32_t>(std::llround(std::fmod(state.time * SECOND, 4294967296.0)));
  for (std::size_t axis = 0; axis < 3; ++axis)
    report.position[axis] = clamped(std::round(state.position[axis] * METER), MOST_POSITION);
  const std::array<double, 4> quaternion = quaternion_of(state.rotation);
  for (std::size_t i = 0; i < 4; ++i) report.quaternion[i] = clamped(std::round(quaternion[i] * QUATERNION_ONE), QUATERNION_ONE);
  report.gap = std::max(clamped(std::round(state.gap * METER), MOST_GAP), LEAST_GAP);
  report.buttons = state.buttons;
  return report;
}

OutputReport output_of(const GripperForce& force) noexcept {
  OutputReport report;
  for (std::size_t axis = 0; axis < 3; ++axis) report.arm[axis] = clamped(force.arm[axis] * NEWTON, MOST_FORCE);
  report.grip = clamped(force.grip * NEWTON, MOST_FORCE);
  return report;
}

GripperLimits limits_of(const Identity& identity, const std::string& address) {
  GripperLimits limits;
  limits.name = std::string(identity.name.begin(), std::find(identity.name.begin(), identity.name.end(), '\0'));
  limits.address = address;
  limits.force = identity.force / NEWTON;
  limits.grip = identity.grip / NEWTON;
  limits.gap = {identity.gap[0] / METER, identity.gap[1] / METER};
  limits.rate = identity.rate;
  limits.has_rotation = (identity.flags & HAS_ROTATION) != 0;
  limits.is_left_handed = (identity.flags & LEFT_HANDED) != 0;
  return limits;
}

std::string summary_of(const GripperLimits& limits) {
  return fmt::format("{:g} N, grip {:g} N, gap {:g} to {:g} mm, {} Hz, {}-handed{}", limits.force, limits.grip, limits.gap[0] * 1e3,
                     limits.gap[1] * 1e3, plain_text(limits.rate), limits.is_left_handed ? "left" : "right",
                     limits.has_rotation ? "" : ", rotation not measured");
}

}  // namespace wholehand::device::protocol
