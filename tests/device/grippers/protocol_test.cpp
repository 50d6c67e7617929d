// SPDX-License-Identifier: MIT
// The wire format of open grippers: round trips, every way to be wrong, and docs/gripper-protocol.md byte for byte.
#include "device/grippers/protocol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "tests/support/files.h"
#include "tests/support/hex_blocks.h"

namespace wholehand::device::protocol {
namespace {

constexpr double WIRE_ROUNDING = 1e-9;  // m and of a rotation's parts: a nanometer, and 2^-30 rounded

InputReport some_report() {
  InputReport report;
  report.status = HOMED | FORCE_ON;
  report.sequence = 0xFFFFFFFE;
  report.time = 0x80000001;
  report.position = {-1, MOST_POSITION, -MOST_POSITION};
  report.quaternion = {0, 0, -(1 << 30), 0};
  report.gap = LEAST_GAP;
  report.buttons = 0x80000001;
  report.heard = 0x01020304;
  return report;
}

Identity some_identity() {
  Identity identity;
  identity.flags = LEFT_HANDED;
  identity.rate = 4000;
  identity.force = 12'000'000;
  identity.grip = 8'000'000;
  identity.gap = {-1'000'000, 25'000'000};
  identity.watchdog = 20'000;
  identity.name = {'n', 'o', ' ', '1'};
  return identity;
}

// ---- the document ----

std::map<std::string, std::vector<std::uint8_t>> blocks_of_document() { return hex_blocks("gripper-protocol.md"); }

std::vector<std::uint8_t> list(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

TEST(Protocol, DocumentShowsTheDescriptor) { EXPECT_EQ(blocks_of_document().at("descriptor"), list(report_descriptor())); }

TEST(Protocol, DocumentsExampleIsWhatIsSent) {
  const auto blocks = blocks_of_document();
  Identity identity;
  identity.flags = HAS_ROTATION;
  identity.rate = 1000;
  identity.force = 12'000'000;
  identity.grip = 8'000'000;
  identity.gap = {0, 25'000'000};
  identity.watchdog = 100'000;
  const std::string name = "example gripper";
  std::copy(name.begin(), name.end(), identity.name.begin());
  EXPECT_EQ(blocks.at("identity"), list(encode(identity)));
  EXPECT_EQ(blocks.at("release"), list(encode(OutputReport{})));
  EXPECT_EQ(blocks.at("watchdog"), list(encode(Watchdog{WATCHDOG_ON, 50'000})));

  GripperState state;
  state.position = {0.010, -0.020, 0.005};
  state.rotation = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  state.gap = 0.0245;
  state.buttons = 1;
  state.sequence = 1000;
  state.time = 1;
  InputReport report = report_of(state);
  report.status |= FORCE_ON;
  report.heard = 7;
  EXPECT_EQ(blocks.at("measurement"), list(encode(report)));

  OutputReport force = output_of({{1.5, -0.25, 0}, 2});
  force.flags = ENABLE;
  force.sequence = 8;
  EXPECT_EQ(blocks.at("force"), list(encode(force)));
}

// Bits that the descriptor declares a report to have, id not counted, by main item and id.
std::map<std::pair<int, int>, int> declared_bits(Bytes descriptor) {
  std::map<std::pair<int, int>, int> bits;
  int size = 0, count = 0, id = 0;
  for (std::size_t at = 0; at < descriptor.size();) {
    const int prefix = descriptor[at], length = (prefix & 3) == 3 ? 4 : prefix & 3;
    int value = 0;
    for (int i = 0; i < length; ++i) value |= descriptor[at + 1 + static_cast<std::size_t>(i)] << (8 * i);
    if ((prefix & 0xFC) == 0x74) size = value;
    if ((prefix & 0xFC) == 0x94) count = value;
    if ((prefix & 0xFC) == 0x84) id = value;
    for (const int main : {0x80, 0x90, 0xB0})
      if ((prefix & 0xFC) == main) bits[{main, id}] += size * count;
    at += 1 + static_cast<std::size_t>(length);
  }
  return bits;
}

TEST(Protocol, DescriptorDeclaresTheReportsSizes) {
  const auto bits = declared_bits(report_descriptor());
  const std::map<std::pair<int, int>, int> wanted{{{0x80, INPUT_ID}, 8 * (INPUT_SIZE - 1)},
                                                  {{0x90, OUTPUT_ID}, 8 * (OUTPUT_SIZE - 1)},
                                                  {{0xB0, IDENTITY_ID}, 8 * (IDENTITY_SIZE - 1)},
                                                  {{0xB0, WATCHDOG_ID}, 8 * (WATCHDOG_SIZE - 1)}};
  EXPECT_EQ(bits, wanted);
  for (const std::size_t size : {INPUT_SIZE, OUTPUT_SIZE, IDENTITY_SIZE, WATCHDOG_SIZE}) EXPECT_LE(size, LARGEST_SIZE);
}

TEST(Protocol, GrippersAreKnownByTheirFirstCollection) {
  EXPECT_TRUE(is_gripper(report_descriptor()));
  const std::vector<std::uint8_t> four_bytes{0x0B, 0x48, 0x57, 0x00, 0xFF, 0xA1, 0x01, 0xC0};  // the page within the usage
  EXPECT_TRUE(is_gripper(four_bytes));
  const std::vector<std::uint8_t> mouse{0x05, 0x01, 0x09, 0x02, 0xA1, 0x01, 0xC0};
  EXPECT_FALSE(is_gripper(mouse));
  std::vector<std::uint8_t> second = mouse;
  second.insert(second.end(), report_descriptor().begin(), report_descriptor().end());
  EXPECT_FALSE(is_gripper(second));
  for (std::size_t size = 0; size < 7; ++size) EXPECT_FALSE(is_gripper(report_descriptor().first(size))) << size;
}

TEST(Protocol, UdevRulesKnowTheInterface) {
  const std::string rules = file_text(WHOLEHAND_SOURCE_DIR "/device/udev/60-wholehand.rules");
  char interface[16];
  std::snprintf(interface, sizeof interface, "*:%02x%02x%02x:*", USB_CLASS, USB_SUBCLASS, USB_PROTOCOL);
  EXPECT_NE(rules.find("ENV{ID_USB_INTERFACES}==\"" + std::string(interface) + "\""), std::string::npos) << interface;
  std::istringstream lines(rules);
  for (std::string line; std::getline(lines, line);)
    EXPECT_TRUE(line.empty() || line[0] == '#' || line.ends_with("TAG+=\"uaccess\"")) << line;
}

// ---- round trips ----

TEST(Protocol, ReportsComeBackAsTheyWere) {
  InputReport input;
  ASSERT_EQ(decode(encode(some_report()), input), Wrong::nothing);
  EXPECT_EQ(encode(input), encode(some_report()));
  EXPECT_EQ(input.position, some_report().position);
  EXPECT_EQ(input.quaternion, some_report().quaternion);
  EXPECT_EQ(input.sequence, 0xFFFFFFFEu);
  EXPECT_EQ(input.heard, 0x01020304u);

  const OutputReport force{ENABLE, 77, {MOST_FORCE, -MOST_FORCE, 1}, -2};
  OutputReport output;
  ASSERT_EQ(decode(encode(force), output), Wrong::nothing);
  EXPECT_EQ(output.arm, force.arm);
  EXPECT_EQ(output.grip, -2);
  EXPECT_EQ(output.sequence, 77u);
  EXPECT_EQ(output.flags, ENABLE);

  Identity identity;
  ASSERT_EQ(decode_identity(encode(some_identity()), identity), Wrong::nothing);
  EXPECT_EQ(encode(identity), encode(some_identity()));
  EXPECT_EQ(identity.gap, some_identity().gap);

  Watchdog watchdog;
  ASSERT_EQ(decode(encode(Watchdog{WATCHDOG_ON, 2000}), watchdog), Wrong::nothing);
  EXPECT_EQ(watchdog.period, 2000u);
}

TEST(Protocol, StatesComeBackWithinANanometer) {
  // turns about each axis and about none of them, so that each part of the quaternion is the largest once
  for (const auto& [x, y, z, angle] :
       std::vector<std::array<double, 4>>{{1, 0, 0, 3.1}, {0, 1, 0, -3.1}, {0, 0, 1, 3.0}, {0.6, 0, 0.8, 0.4}, {0, 0, 1, 0}}) {
    const double c = std::cos(angle), s = std::sin(angle), u = 1 - c;
    GripperState state;
    state.rotation = {c + u * x * x,     u * x * y - s * z, u * x * z + s * y,  //
                      u * x * y + s * z, c + u * y * y,     u * y * z - s * x,  //
                      u * x * z - s * y, u * y * z + s * x, c + u * z * z};
    state.position = {0.0123456789, -0.3, 1.5};
    state.gap = 0.0171717;
    state.time = 12.5;
    Measurements measurements(true);
    const GripperState back = measurements.state(report_of(state));
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(back.rotation[i], state.rotation[i], 4 * WIRE_ROUNDING) << angle << ' ' << i;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(back.position[i], state.position[i], WIRE_ROUNDING);
    EXPECT_NEAR(back.gap, state.gap, WIRE_ROUNDING);
    EXPECT_DOUBLE_EQ(back.time, 12.5);
  }
}

TEST(Protocol, RotationIsNoneWhereItIsNotMeasured) {
  Measurements measurements(false);
  EXPECT_EQ(measurements.state(some_report()).rotation, NO_ROTATION);
}

TEST(Protocol, TimeGoesOnWhereTheClockWraps) {
  Measurements measurements(true);
  InputReport report = some_report();
  report.time = 0xFFFFFFF0;
  const double before = measurements.state(report).time;
  report.time = 0x10;
  EXPECT_EQ(measurements.check(report), Wrong::nothing);
  EXPECT_NEAR(measurements.state(report).time - before, 32e-6, 1e-9);
}

// A number up to half of the range ahead counts as later, any other as earlier.
TEST(Protocol, NumbersThatGoBackAndClocksThatStepBackAreWrong) {
  for (const std::uint32_t start : {1000u, 0u, 0xFFFFFFFFu}) {
    Measurements measurements(true);
    InputReport report = some_report();
    report.sequence = report.time = start;
    EXPECT_EQ(measurements.check(report), Wrong::nothing) << "the first may have any";
    measurements.state(report);
    const auto after = [&](std::uint32_t numbers, std::uint32_t us) {
      InputReport next = report;
      next.sequence += numbers;
      next.time += us;
      return measurements.check(next);
    };
    EXPECT_EQ(after(1, 1000), Wrong::nothing);
    EXPECT_EQ(after(1, 0), Wrong::nothing) << "two within a microsecond";
    EXPECT_EQ(after(0, 0), Wrong::nothing) << "the same once more is for the loop to judge";
    EXPECT_EQ(after(0x7FFFFFFFu, 0x7FFFFFFFu), Wrong::nothing);
    EXPECT_EQ(after(0x80000000u, 1), Wrong::older);
    EXPECT_EQ(after(0xFFFFFFFFu, 1), Wrong::older);
    EXPECT_EQ(after(1, 0xFFFFFFFFu), Wrong::clock);
    EXPECT_EQ(after(1, 0x80000000u), Wrong::clock);
  }
}

TEST(Protocol, ForcesNeverGrowByRounding) {
  const OutputReport report = output_of({{1.9999999e-6, -1.9999999e-6, std::numeric_limits<double>::quiet_NaN()}, 1e9});
  EXPECT_EQ(report.arm, (std::array<std::int32_t, 3>{1, -1, 0}));
  EXPECT_EQ(report.grip, MOST_FORCE);
}

// ---- what is wrong ----

Wrong wrong_with(const InputReport& report) {
  InputReport into;
  into.sequence = 4711;
  const Wrong wrong = decode(encode(report), into);
  if (wrong != Wrong::nothing) {
    EXPECT_EQ(into.sequence, 4711u) << "a rejected report has been written";
  }
  return wrong;
}

TEST(Protocol, LengthIdAndVersionAreChecked) {
  const InputBytes good = encode(some_report());
  InputReport report;
  std::vector<std::uint8_t> bytes = list(good);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_EQ(decode(Bytes(bytes).first(size), report), Wrong::length) << size;
  bytes.push_back(0);
  EXPECT_EQ(decode(bytes, report), Wrong::length);
  bytes = list(good);
  bytes[0] = OUTPUT_ID;
  EXPECT_EQ(decode(bytes, report), Wrong::id);
  bytes = list(good);
  bytes[1] = VERSION + 1;
  EXPECT_EQ(decode(bytes, report), Wrong::version);
  bytes.resize(30);  // another version may have another length
  EXPECT_EQ(decode(bytes, report), Wrong::version);

  OutputReport output;
  Watchdog watchdog;
  EXPECT_EQ(decode(good, output), Wrong::length);
  EXPECT_EQ(decode(Bytes(good).first(WATCHDOG_SIZE), watchdog), Wrong::id);
}

TEST(Protocol, DeviceThatIsNotReadyIsRejected) {
  InputReport report = some_report();
  report.status = 0;
  EXPECT_EQ(wrong_with(report), Wrong::not_homed);
  report.status = HOMED | FAULT;
  EXPECT_EQ(wrong_with(report), Wrong::fault);
  report.status = HOMED | WATCHDOG_TRIPPED | SATURATED | 0xFF00;  // for the caller, and bits of a later day
  EXPECT_EQ(wrong_with(report), Wrong::nothing);
}

TEST(Protocol, RangesEndWhereTheDocumentSays) {
  for (const int sign : {1, -1}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      InputReport report = some_report();
      report.position[axis] = sign * MOST_POSITION;
      EXPECT_EQ(wrong_with(report), Wrong::nothing);
      report.position[axis] += sign;
      EXPECT_EQ(wrong_with(report), Wrong::range);
      OutputReport output, into;
      output.arm[axis] = sign * (MOST_FORCE + 1);
      EXPECT_EQ(decode(encode(output), into), Wrong::range);
    }
  }
  InputReport report = some_report();
  report.gap = LEAST_GAP - 1;
  EXPECT_EQ(wrong_with(report), Wrong::range);
  report.gap = MOST_GAP;
  EXPECT_EQ(wrong_with(report), Wrong::nothing);
  report.gap = MOST_GAP + 1;
  EXPECT_EQ(wrong_with(report), Wrong::range);
  Watchdog watchdog;
  for (const std::uint32_t period : {LEAST_WATCHDOG - 1, MOST_WATCHDOG + 1, 0xFFFFFFFFu})
    EXPECT_EQ(decode(encode(Watchdog{WATCHDOG_ON, period}), watchdog), Wrong::range) << period;
}

TEST(Protocol, QuaternionsAreUnitToAThousandth) {
  InputReport report = some_report();
  const auto with_length = [&report](double length) {
    report.quaternion = {static_cast<std::int32_t>(0.6 * length * QUATERNION_ONE), 0,
                         static_cast<std::int32_t>(-0.8 * length * QUATERNION_ONE), 0};
    return wrong_with(report);
  };
  EXPECT_EQ(with_length(1.00099), Wrong::nothing);
  EXPECT_EQ(with_length(0.99901), Wrong::nothing);
  EXPECT_EQ(with_length(1.00101), Wrong::no_unit);
  EXPECT_EQ(with_length(0.99899), Wrong::no_unit);
  EXPECT_EQ(with_length(0), Wrong::no_unit);
  constexpr std::int32_t LEAST = std::numeric_limits<std::int32_t>::min();
  report.quaternion = {LEAST, LEAST, LEAST, LEAST};
  EXPECT_EQ(wrong_with(report), Wrong::no_unit);
}

TEST(Protocol, IdentityIsChecked) {
  const auto wrong_with_identity = [](const auto& spoil) {
    Identity identity = some_identity(), into;
    spoil(identity);
    return decode_identity(encode(identity), into);
  };
  EXPECT_EQ(wrong_with_identity([](Identity&) {}), Wrong::nothing);
  EXPECT_EQ(wrong_with_identity([](Identity& i) { i.rate = 0; }), Wrong::range);
  EXPECT_EQ(wrong_with_identity([](Identity& i) { i.rate = MOST_RATE + 1; }), Wrong::range);
  EXPECT_EQ(wrong_with_identity([](Identity& i) { i.force = -1; }), Wrong::range);
  EXPECT_EQ(wrong_with_identity([](Identity& i) { i.grip = MOST_FORCE + 1; }), Wrong::range);
  EXPECT_EQ(wrong_with_identity([](Identity& i) { i.gap[1] = i.gap[0]; }), Wrong::range);
  EXPECT_EQ(wrong_with_identity([](Identity& i) { i.watchdog = 0; }), Wrong::range);
  EXPECT_EQ(wrong_with_identity([](Identity& i) { i.name[1] = '\n'; }), Wrong::range);
  EXPECT_EQ(wrong_with_identity([](Identity& i) { i.name[20] = 'x'; }), Wrong::range);
  EXPECT_EQ(wrong_with_identity([](Identity& i) { i.name.fill('x'); }), Wrong::nothing);

  Identity into;
  IdentityBytes bytes = encode(some_identity());
  bytes[4] = 'w';
  EXPECT_EQ(decode_identity(bytes, into), Wrong::magic);
  bytes = encode(some_identity());
  bytes[1] = 9;
  EXPECT_EQ(decode_identity(Bytes(bytes).first(20), into), Wrong::version);
  EXPECT_EQ(into.version, 9);
  EXPECT_EQ(decode_identity(Bytes(bytes).first(7), into), Wrong::length);
}

TEST(Protocol, EveryWrongnessHasItsWords) {
  for (int i = 1; i <= static_cast<int>(Wrong::tripped); ++i) EXPECT_STRNE(words(static_cast<Wrong>(i)), "") << i;
}

TEST(Protocol, LimitsAreWhatTheIdentitySays) {
  const GripperLimits limits = limits_of(some_identity(), "hid:/dev/x");
  EXPECT_EQ(limits.name, "no 1");
  EXPECT_EQ(limits.address, "hid:/dev/x");
  EXPECT_EQ(summary_of(limits), "12 N, grip 8 N, gap -1 to 25 mm, 4,000 Hz, left-handed, rotation not measured");
}

}  // namespace
}  // namespace wholehand::device::protocol
