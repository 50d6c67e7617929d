// SPDX-License-Identifier: MIT
#include "device/recordings/fields.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>
#include <vector>

namespace wholehand::device {
namespace {

static_assert(std::is_standard_layout_v<Tick> && std::is_trivially_copyable_v<Tick>, "a field is its offset");
static_assert(sizeof(bool) == 1 && sizeof(int) == 4);

constexpr double LARGEST_INT = std::numeric_limits<int>::max();
constexpr double LARGEST_WHOLE_DOUBLE = 9007199254740992;  // 2^53

const std::array<const char*, 3> READ_NAMES{"value", "timeout", "error"};
const std::array<const char*, 2> YES_NO_NAMES{"no", "yes"};

constexpr const char* NOT_SAID = "";
constexpr const char* NONE_IS_NAN = "NaN: there is none";
constexpr const char* TURN_COUNTS = "a turn counts at the radius of the torsional friction";
constexpr const char* BITS_OF_JOINTS = "bit j: joint j; thumb 0 to 3, then five each for index, middle, ring and little finger";
constexpr const char* BITS_OF_FINGERS = "bit f: finger f; 0 thumb, 1 index, 2 middle, 3 ring, 4 little";

// Scalars, vectors and tables of reals.
RecordedField reals(const char* name, const char* units, const char* long_name, const char* comment, const char* dimensions,
                    std::size_t offset) {
  return {name, units, long_name, comment, dimensions, RecordedAs::real, offset};
}

RecordedField real_one(const char* name, const char* units, const char* long_name, const char* comment, std::size_t offset) {
  return reals(name, units, long_name, comment, "", offset);
}

RecordedField always_finite(RecordedField field) {
  field.is_finite = true;
  return field;
}

RecordedField word_field(const char* name, const char* long_name, const char* comment, std::size_t offset) {
  return {name, "1", long_name, comment, "", RecordedAs::word, offset};
}

RecordedField integer_field(const char* name, const char* long_name, const char* comment, double least, double most,
                            std::size_t offset) {
  return {name, "1", long_name, comment, "", RecordedAs::integer, offset, least, most};
}

template <std::size_t COUNT>
RecordedField flag_of(const char* name, const char* long_name, const std::array<const char*, COUNT>& meanings, std::size_t offset) {
  return {name, "1", long_name, NOT_SAID, "", RecordedAs::flag, offset, 0, COUNT - 1, false, meanings.data()};
}

// In one piece however long, because it is one table: a row a field.
std::vector<RecordedField> make_recorded_fields() {
  return {
      // ---- the device ----
      {"tick", "1", "periods since the start", "ascending; a number is missing where a period was missed", "", RecordedAs::number,
       offsetof(Tick, number), 0, LARGEST_WHOLE_DOUBLE},
      flag_of("read", "what reading the device gave", READ_NAMES, offsetof(Tick, read)),
      flag_of("fault", "why the session let go", FAULT_NAMES, offsetof(Tick, fault)),
      reals("device_position", "m", "position of the gripper, device frame", "middle between the two tracked points", "xyz",
            offsetof(Tick, device.position)),
      reals("device_rotation", "1", "rotation of the gripper in the device frame", NOT_SAID, "row column",
            offsetof(Tick, device.rotation)),
      real_one("device_gap", "m", "gap of the gripper", NOT_SAID, offsetof(Tick, device.gap)),
      word_field("device_buttons", "pressed buttons", "bit k: button k", offsetof(Tick, device.buttons)),
      word_field("device_sequence", "number of the measurement by the device", NOT_SAID, offsetof(Tick, device.sequence)),
      real_one("device_time", "s", "time of the measurement by the device's clock", "0 where it has none",
               offsetof(Tick, device.time)),
      // ---- the session ----
      flag_of("state", "state of the session", SESSION_STATE_NAMES, offsetof(Tick, state)),
      integer_field("vessel_index", "vessel that is touched, held or on its way back", "-1: none", -1, LIVE_VESSELS - 1,
                    offsetof(Tick, vessel)),
      integer_field("guidance_index", "guidance point that is shown", "modulo their count on each vessel; -1: none", -1,
                    LARGEST_INT, offsetof(Tick, guidance)),
      // ---- the hand ----
      reals("hand_midpoint", "m", "midpoint of the tips of thumb and index finger, world frame", NOT_SAID, "xyz",
            offsetof(Tick, middle)),
      reals("hand_rotation", "1", "rotation of the hand's gripper axes in the world frame", NOT_SAID, "row column",
            offsetof(Tick, hand_rotation)),
      real_one("gap", "m", "distance between the tips of thumb and index finger", NOT_SAID, offsetof(Tick, gap)),
      real_one("closure", "1", "closure of thumb and index finger: 0 open, 1 closed", NOT_SAID, offsetof(Tick, closure)),
      reals("tips", "m", "tips of thumb and index finger, world frame", NOT_SAID, "contact xyz", offsetof(Tick, tips)),
      reals("proxies", "m", "proxies of the tips, world frame", NOT_SAID, "contact xyz", offsetof(Tick, proxies)),
      word_field("touch_mask", "points touching in the posed hand", BITS_OF_JOINTS, offsetof(Tick, touch_mask)),
      word_field("used_mask", "fingers with a touching point", BITS_OF_FINGERS, offsetof(Tick, used_mask)),
      // ---- the vessel ----
      reals("vessel_place", "m", "origin of that vessel, world frame", NOT_SAID, "xyz", offsetof(Tick, vessel_place)),
      reals("vessel_rotation", "1", "rotation of that vessel in the world frame", NOT_SAID, "row column",
            offsetof(Tick, vessel_rotation)),
      real_one("tilt", "rad", "angle between that vessel's axis and up", NOT_SAID, offsetof(Tick, tilt)),
      real_one("grasp_height", "m", "height of the middle of the tips at the grasp, vessel frame", NONE_IS_NAN,
               offsetof(Tick, grasp_height)),
      real_one("guidance_distance", "m", "distance of the grasp from the guidance point", NONE_IS_NAN,
               offsetof(Tick, guidance_distance)),
      // ---- liquid ----
      reals("liquid_volume", "m3", "volume of the liquid in the vessel", NOT_SAID, "vessel", offsetof(Tick, volume)),
      reals("arrived_volume", "m3", "volume of the vessel's liquid that arrived in the target", NOT_SAID, "vessel",
            offsetof(Tick, arrived)),
      reals("spilled_volume", "m3", "volume of the vessel's liquid that was spilled", NOT_SAID, "vessel", offsetof(Tick, spilled)),
      real_one("flow", "m3 s-1", "flow over the held vessel's lip", NOT_SAID, offsetof(Tick, flow)),
      // ---- forces ----
      reals("coupling_force", "N", "force of the surface on each tip before the grasp, world frame", NOT_SAID, "contact xyz",
            offsetof(Tick, coupling)),
      real_one("weight", "N", "weight of vessel and liquid, as far as it is lifted", NOT_SAID, offsetof(Tick, weight)),
      real_one("torque", "N m", "torque of the paper's eq. (1)", NOT_SAID, offsetof(Tick, torque)),
      real_one("exact_torque", "N m", "torque about the tilt direction, positive topples further", NOT_SAID,
               offsetof(Tick, exact_torque)),
      real_one("normal_force", "N", "normal force", NOT_SAID, offsetof(Tick, normal_force)),
      real_one("opening_force", "N", "force of the gripper's opening against the grasp", NOT_SAID, offsetof(Tick, opening_force)),
      real_one("feedback_force", "N", "force of the method at the gripper, before limits, ramp and slew", NOT_SAID,
               offsetof(Tick, feedback)),
      real_one("hold_force", "N", "force per finger that a soft-finger pinch needs to hold the vessel",
               "infinite where not antipodal; NaN: there is none", offsetof(Tick, hold_force)),
      real_one("grip_force", "N", "the user's grip force", "feedback force less what the normal force rose since the grasp",
               offsetof(Tick, user_force)),
      real_one("safety_margin", "N", "the user's grip force less the force that holding takes now",
               "without [live] slide NaN; minus infinity where not antipodal", offsetof(Tick, safety_margin)),
      real_one("slip_distance", "m", "way of the contacts along the surface since the grasp", TURN_COUNTS,
               offsetof(Tick, slip_distance)),
      real_one("slip_angle", "rad", "turn of the vessel in the fingers since the grasp",
               "right-handed about the line from the thumb to the index finger of a right hand, left-handed of a left hand",
               offsetof(Tick, slip_angle)),
      real_one("slip_speed", "m s-1", "speed of the contacts along the surface", TURN_COUNTS, offsetof(Tick, slip_speed)),
      reals("wanted_arm_force", "N", "force of the method at the arm, device frame", NOT_SAID, "xyz", offsetof(Tick, wanted.arm)),
      real_one("wanted_gripper_force", "N", "force of the method on each finger", "positive opens", offsetof(Tick, wanted.grip)),
      reals("wanted_across_force", "N", "force of the method across the closing line, device frame",
            "on the tip at the gripper's +x; the other one feels the opposite", "xyz", offsetof(Tick, wanted.across)),
      always_finite(reals("written_arm_force", "N", "force at the arm after limits, ramp and slew, device frame", NOT_SAID, "xyz",
                          offsetof(Tick, written.arm))),
      always_finite(real_one("written_gripper_force", "N", "force on each finger after limits, ramp and slew", "positive opens",
                             offsetof(Tick, written.grip))),
      always_finite(reals("written_across_force", "N", "force across the closing line after limits, ramp and slew, device frame",
                          "zero where the device cannot push each tip by itself", "xyz", offsetof(Tick, written.across))),
      // ---- counts and timing ----
      integer_field("grasps", "grasps since the start", NOT_SAID, 0, LARGEST_INT, offsetof(Tick, grasps)),
      integer_field("grips_lost", "grips lost since the start", NOT_SAID, 0, LARGEST_INT, offsetof(Tick, lost)),
      integer_field("destinations", "vessels set down at the destination since the start", NOT_SAID, 0, LARGEST_INT,
                    offsetof(Tick, destinations)),
      flag_of("task_done", "whether the task is done", YES_NO_NAMES, offsetof(Tick, task_done)),
      always_finite(real_one("latency", "s", "from the tick's time to when the loop woke", NOT_SAID, offsetof(Tick, latency))),
      always_finite(real_one("step_time", "s", "from having the measurement until the force was written",
                             "waiting for the device not included", offsetof(Tick, step_time))),
  };
}

// Numbers along dimensions other than the vessels, which have their own count in the file and in a Tick.
std::size_t fixed_values(std::string_view dimensions, std::size_t vessels) {
  if (dimensions == "xyz") return 3;
  if (dimensions == "row column") return 9;
  if (dimensions == "contact xyz") return 6;
  return dimensions == "vessel" ? vessels : 1;
}

template <class Number>
Number number_at(const char* at) {
  Number value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

template <class Number>
bool put_number(char* at, Number value) {
  std::memcpy(at, &value, sizeof value);
  return true;
}

std::size_t size_in_tick(RecordedAs as) {
  if (as == RecordedAs::flag) return 1;
  return as == RecordedAs::real || as == RecordedAs::number ? 8 : 4;
}

bool load_one(const char* from, const RecordedField& field, char* to) {
  const auto is_within = [&field](double value) { return value >= field.least && value <= field.most; };
  switch (field.as) {
    case RecordedAs::real: {
      const double value = classic::load_real(from);
      return put_number(to, value) && (!field.is_finite || std::isfinite(value));
    }
    case RecordedAs::number: {
      const double value = classic::load_real(from);
      return is_within(value) && value == std::floor(value) && put_number(to, static_cast<std::int64_t>(value));
    }
    case RecordedAs::word:
      return put_number(to, classic::load_32(from));
    case RecordedAs::integer: {
      const auto value = static_cast<std::int32_t>(classic::load_32(from));
      return is_within(value) && put_number(to, value);
    }
    case RecordedAs::flag:
      return is_within(static_cast<signed char>(*from)) && put_number(to, *from);
  }
  return false;
}

void append_one(std::string& bytes, const char* from, RecordedAs as) {
  switch (as) {
    case RecordedAs::real:
      return classic::append_real(bytes, number_at<double>(from));
    case RecordedAs::number:
      return classic::append_real(bytes, static_cast<double>(number_at<std::int64_t>(from)));
    case RecordedAs::word:
    case RecordedAs::integer:
      return classic::append_32(bytes, number_at<std::uint32_t>(from));
    case RecordedAs::flag:
      bytes += *from;
      bytes.append(3, '\0');
  }
}

}  // namespace

std::span<const RecordedField> recorded_fields() {
  static const std::vector<RecordedField> RECORDED = make_recorded_fields();
  return RECORDED;
}

std::size_t recorded_values(const RecordedField& field, std::size_t vessels) { return fixed_values(field.dimensions, vessels); }

std::size_t bytes_in_tick(const RecordedField& field) {
  return fixed_values(field.dimensions, LIVE_VESSELS) * size_in_tick(field.as);
}

void append_field(std::string& bytes, const RecordedField& field, const Tick& tick, std::size_t vessels) {
  const char* from = reinterpret_cast<const char*>(&tick) + field.offset;
  const std::size_t size = size_in_tick(field.as), count = recorded_values(field, vessels);
  for (std::size_t k = 0; k < count; ++k) append_one(bytes, from + k * size, field.as);
}

bool load_field(const char* bytes, const RecordedField& field, Tick& tick, std::size_t vessels) {
  char* to = reinterpret_cast<char*>(&tick) + field.offset;
  // flags are one number each, so their padding is no concern here
  const std::size_t size = size_in_tick(field.as), count = recorded_values(field, vessels);
  for (std::size_t k = 0; k < count; ++k) {
    if (!load_one(bytes + k * size, field, to + k * size)) return false;
  }
  return true;
}

}  // namespace wholehand::device
