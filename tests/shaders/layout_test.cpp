// SPDX-License-Identifier: MIT
// The numbers of shaders/layout.h, which C++ and GLSL both read: no id twice, no gap in an enumeration, the same values as the
// enums and names of core/; and its structs, laid out alike in C++ and in the compiled shaders.
// sanitizers: none
#include "shaders/layout.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <map>
#include <regex>
#include <span>
#include <string>
#include <type_traits>

#include "core/result.h"
#include "core/scene.h"
#include "host/shaders.h"
#include "host/turns.h"

namespace wholehand {
namespace {

// Names with a prefix and their integer values, as the file's text has them.
std::map<std::string, long> defined(const std::string& prefix) {
  std::ifstream file(std::string(WHOLEHAND_SOURCE_DIR) + "/shaders/layout.h");
  EXPECT_TRUE(file);
  const std::regex define("#define (" + prefix + "_\\w+) (0x[0-9A-Fa-f]+|\\d+)\\b.*");
  std::map<std::string, long> values;
  std::smatch match;
  for (std::string line; std::getline(file, line);) {
    if (std::regex_match(line, match, define)) values[match[1]] = std::stol(match[2], nullptr, 0);
  }
  EXPECT_FALSE(values.empty()) << prefix;
  return values;
}

// Values 0 .. count - 1, each once.
void expect_enumeration(const std::string& prefix, std::size_t count) {
  std::map<long, std::string> names;
  for (const auto& [name, value] : defined(prefix)) {
    EXPECT_TRUE(names.emplace(value, name).second) << name << " has the value of " << names[value];
  }
  EXPECT_EQ(names.size(), count) << prefix;
  EXPECT_EQ(names.begin()->first, 0) << prefix;
  EXPECT_EQ(names.rbegin()->first, static_cast<long>(count) - 1) << prefix;
}

TEST(Layout, EnumerationsAreCompleteAndUnique) {
  expect_enumeration("REASON", REASON_NAMES.size());
  expect_enumeration("AXIS", GRIP_AXES);
  expect_enumeration("BINDING", BINDINGS);
  expect_enumeration("POSE", 3);
  expect_enumeration("SDF", 2);
  expect_enumeration("TORQUE", 2);
  expect_enumeration("REFERENCE", 2);
}

TEST(Layout, RealFieldsComeBeforeUintFields) {
  int next = 0;
#define EXPECT_NEXT(name, number) EXPECT_EQ(number, next++) << #name;
  REAL_FIELD_LIST(EXPECT_NEXT)
  EXPECT_EQ(next, REAL_FIELDS);
  UINT_FIELD_LIST(EXPECT_NEXT)
  EXPECT_EQ(next, FIELDS);
#undef EXPECT_NEXT
}

TEST(Layout, SpecializationConstantsDoNotOverlap) {
  // CONST_PLANE is the first of FIELDS ids
  std::map<long, std::string> owner;
  for (const auto& [name, first] : defined("CONST")) {
    long count = 1;
    if (name == "CONST_PLANE") count = FIELDS;
    for (long id = first; id < first + count; ++id) {
      EXPECT_TRUE(owner.emplace(id, name).second) << name << " takes id " << id << " of " << owner[id];
    }
  }
}

TEST(Layout, StatusBitsDoNotOverlap) {
  const unsigned fingers = (1u << FINGERS) - 1;
  unsigned used = 0;
  for (const unsigned bits :
       {unsigned(STATUS_REASON_MASK), unsigned(STATUS_PLAUSIBLE), unsigned(STATUS_ANTIPODAL), unsigned(STATUS_GRAZING),
        unsigned(STATUS_PROXY_UNSETTLED), unsigned(STATUS_THROUGH_TABLE), unsigned(STATUS_SELF_OVERLAP),
        unsigned(STATUS_CONTACT_UNDECIDED), unsigned(STATUS_OUT_OF_TURNS), unsigned(STATUS_NOT_HELD), unsigned(STATUS_BEYOND_WRIST),
        fingers << STATUS_BLOCKED_SHIFT, fingers << STATUS_UNSETTLED_SHIFT}) {
    EXPECT_EQ(used & bits, 0u) << std::hex << bits;
    used |= bits;
  }
  EXPECT_GE(unsigned(STATUS_REASON_MASK), REASON_NAMES.size() - 1);
}

TEST(Layout, ReasonsAreThoseOfTheCore) {
  EXPECT_EQ(unsigned(Reason::none), REASON_NONE);
  EXPECT_EQ(unsigned(Reason::degenerate), REASON_DEGENERATE);
  EXPECT_EQ(unsigned(Reason::not_converged), REASON_NOT_CONVERGED);
  EXPECT_EQ(unsigned(Reason::misses), REASON_MISSES);
  EXPECT_EQ(unsigned(Reason::too_wide), REASON_TOO_WIDE);
  EXPECT_EQ(unsigned(Reason::too_narrow), REASON_TOO_NARROW);
  EXPECT_EQ(unsigned(Reason::on_mouth), REASON_ON_MOUTH);
  const std::array<std::string, 7> names = {"", "degenerate", "not_converged", "misses", "too_wide", "too_narrow", "on_mouth"};
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(REASON_NAMES[i], names[i]);
}

TEST(Layout, KindsAreThoseOfTheScene) {
  EXPECT_EQ(int(Pose::articulated), POSE_ARTICULATED);
  EXPECT_EQ(int(Pose::paper), POSE_PAPER);
  EXPECT_EQ(int(Pose::rigged), POSE_RIGGED);
  EXPECT_EQ(int(Torque::paper), TORQUE_PAPER);
  EXPECT_EQ(int(Torque::exact), TORQUE_EXACT);
  EXPECT_EQ(int(TorqueReference::per_object), REFERENCE_PER_OBJECT);
  EXPECT_EQ(int(TorqueReference::per_grip), REFERENCE_PER_GRIP);
}

TEST(Layout, TheHandHasItsJoints) {
  EXPECT_EQ(FINGERS, FINGER_COUNT);
  EXPECT_EQ(JOINTS, JOINT_COUNT);
  EXPECT_EQ(THUMB_TIP, 3);      // thumb: joints 0..3
  EXPECT_EQ(INDEX_TIP, 4 + 4);  // index: joints 4..8
  EXPECT_LE(JOINTS, 32);        // masks are one uint
}

TEST(Layout, GroupSizesFitEveryDevice) {
  EXPECT_LE(GROUP_SIZE, 128);  // the least maxComputeWorkGroupInvocations that Vulkan promises
  EXPECT_EQ(GROUP_SIZE & (GROUP_SIZE - 1), 0);
}

TEST(Layout, SelectionLeavesLessInEachPass) { EXPECT_GT(SELECT_ENTRIES, host::SELECT_LARGEST); }

// ---- structs: offsets in C++ against those that the SPIR-V carries ----

using Offsets = std::map<std::string, std::size_t>;

static_assert(std::is_standard_layout_v<Parameters<float>> && std::is_trivially_copyable_v<Parameters<float>>);
static_assert(std::is_standard_layout_v<Parameters<double>> && std::is_trivially_copyable_v<Parameters<double>>);
static_assert(sizeof(Push) <= 128);  // bytes of push constants that every device has

template <class Real>
Offsets parameter_offsets() {
  using P = Parameters<Real>;
  Offsets offsets;
#define OFFSET(member) offsets[#member] = offsetof(P, member)
  OFFSET(bound_height), OFFSET(bound_radius), OFFSET(lattice_x), OFFSET(lattice_y), OFFSET(lattice_z), OFFSET(lattice_spacing);
  OFFSET(center_x), OFFSET(center_y), OFFSET(center_z), OFFSET(gravity);
  OFFSET(force_base), OFFSET(force_range), OFFSET(force_max), OFFSET(reference);
  OFFSET(largest_mass), OFFSET(largest_share), OFFSET(largest_height);
  OFFSET(friction), OFFSET(torsion), OFFSET(friction_angle), OFFSET(grip_strength);
  OFFSET(thumb_strength), OFFSET(index_strength), OFFSET(middle_strength), OFFSET(ring_strength), OFFSET(little_strength);
  OFFSET(palm_strength), OFFSET(tip_radii), OFFSET(pour_sense), OFFSET(table_top);
  OFFSET(shoulder_x), OFFSET(shoulder_y), OFFSET(shoulder_z), OFFSET(upper_arm), OFFSET(forearm), OFFSET(wrist_radius);
  OFFSET(lid_radius), OFFSET(lid_height), OFFSET(lid), OFFSET(elbow_radius), OFFSET(flexion), OFFSET(extension), OFFSET(ulnar),
      OFFSET(radial), OFFSET(pronation), OFFSET(supination);
  OFFSET(weight_fingers), OFFSET(weight_contacts), OFFSET(weight_depth), OFFSET(weight_posture), OFFSET(weight_force);
  OFFSET(weight_hold), OFFSET(outline_count), OFFSET(lattice_nx), OFFSET(lattice_ny), OFFSET(lattice_nz);
  OFFSET(fills), OFFSET(tilts);
#undef OFFSET
  return offsets;
}

const Offsets PUSH_OFFSETS = {
    {"count", offsetof(Push, count)},   {"stride", offsetof(Push, stride)},       {"first", offsetof(Push, first)},
    {"number", offsetof(Push, number)}, {"floor_low", offsetof(Push, floor_low)}, {"floor_high", offsetof(Push, floor_high)},
    {"flag", offsetof(Push, flag)}};

// Member offsets of the struct of a module that has a member of this name; empty: none has.
Offsets offsets_in(std::span<const std::uint32_t> words, const std::string& member) {
  constexpr std::uint32_t OP_MEMBER_NAME = 6, OP_MEMBER_DECORATE = 72, DECORATION_OFFSET = 35;
  std::map<std::uint32_t, std::map<std::uint32_t, std::string>> names;  // of type and member
  std::map<std::uint32_t, std::map<std::uint32_t, std::size_t>> offsets;
  for (std::size_t i = 5; i < words.size() && words[i] >> 16 > 0; i += words[i] >> 16) {
    const std::uint32_t opcode = words[i] & 0xFFFF;
    if (opcode == OP_MEMBER_NAME) names[words[i + 1]][words[i + 2]] = reinterpret_cast<const char*>(&words[i + 3]);
    if (opcode == OP_MEMBER_DECORATE && words[i + 3] == DECORATION_OFFSET) offsets[words[i + 1]][words[i + 2]] = words[i + 4];
  }
  for (const auto& [type, members] : names) {
    Offsets found;
    for (const auto& [number, name] : members) {
      if (offsets[type].contains(number)) found[name] = offsets[type][number];
    }
    if (found.contains(member)) return found;
  }
  return {};
}

TEST(Layout, ParametersLieAlikeInEveryShader) {
  int compared = 0;
  for (const EmbeddedShader& shader : embedded_shaders()) {
    const Offsets found = offsets_in(shader.words, "bound_height");
    if (found.empty()) continue;
    EXPECT_EQ(found, shader.precision == 1 ? parameter_offsets<double>() : parameter_offsets<float>())
        << shader.name << ", precision " << shader.precision;
    ++compared;
  }
  EXPECT_GT(compared, 0);
}

TEST(Layout, PushConstantsLieAlikeInEveryShader) {
  int compared = 0;
  for (const EmbeddedShader& shader : embedded_shaders()) {
    const Offsets found = offsets_in(shader.words, "number");
    if (found.empty()) continue;
    EXPECT_EQ(found, PUSH_OFFSETS) << shader.name << ", precision " << shader.precision;
    ++compared;
  }
  EXPECT_GT(compared, 0);
}

}  // namespace
}  // namespace wholehand
