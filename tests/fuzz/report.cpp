// SPDX-License-Identifier: MIT
// Reports of any bytes at all, as a device or a host might send them: decoding stays within its bounds, and what it accepts keeps
// the promises of device/grippers/protocol.h: numbers finite and in their ranges, a rotation that is one, and the same bytes when it is
// encoded again.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "device/grippers/protocol.h"
#include "tests/fuzz/must.h"

namespace wholehand::device::protocol {
namespace {

// Accepted reports have one encoding, whole: nothing in them is dropped or made up.
template <class Encoded>
void must_be(const Encoded& again, Bytes bytes) {
  must(std::equal(again.begin(), again.end(), bytes.begin(), bytes.end()), "another report when encoded again");
}

void must_be_rotation(const Rotation& r) {
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) {
      const double dot = r[3 * a] * r[3 * b] + r[3 * a + 1] * r[3 * b + 1] + r[3 * a + 2] * r[3 * b + 2];
      must(std::abs(dot - (a == b)) < 1e-12, "axes that are not orthonormal");
    }
  const double volume =
      r[0] * (r[4] * r[8] - r[5] * r[7]) - r[1] * (r[3] * r[8] - r[5] * r[6]) + r[2] * (r[3] * r[7] - r[4] * r[6]);
  must(std::abs(volume - 1) < 1e-12, "a rotation that mirrors");
}

void try_input(Bytes bytes) {
  InputReport report;
  if (decode(bytes, report) != Wrong::nothing) return;
  must_be(encode(report), bytes);
  Measurements measurements(true);
  const device::GripperState state = measurements.state(report);
  for (const double part : state.position) must(std::abs(part) <= 2, "a position out of range");
  must(state.gap >= -0.010 && state.gap <= 1, "a gap out of range");
  must(state.time >= 0 && state.time < 4295, "a time out of range");
  must_be_rotation(state.rotation);
  // and back through what the loop sees: a unit quaternion or its negative, everything else as it was
  const InputReport back = report_of(state);
  must(back.position == report.position && back.gap == report.gap && back.sequence == report.sequence &&
           back.buttons == report.buttons,
       "a state that is another report");
  must(back.time == report.time, "another time");
  InputReport again;
  must(decode(encode(back), again) == Wrong::nothing, "a report of a state that is rejected");
}

void try_output(Bytes bytes) {
  OutputReport report;
  if (decode(bytes, report) != Wrong::nothing) return;
  must_be(encode(report), bytes);
  for (const std::int32_t part : {report.arm[0], report.arm[1], report.arm[2], report.grip})
    must(std::abs(part) <= MOST_FORCE, "a force out of range");
}

void try_features(Bytes bytes) {
  Identity identity;
  if (decode_identity(bytes, identity) == Wrong::nothing) {
    must_be(encode(identity), bytes);
    const device::GripperLimits limits = limits_of(identity, "");
    must(limits.force >= 0 && limits.grip >= 0 && limits.force <= 1000 && limits.grip <= 1000, "a largest force out of range");
    must(limits.gap[0] < limits.gap[1], "a gap that does not open");
    must(limits.rate >= 1 && limits.rate <= 8000, "a rate out of range");
    for (const char c : summary_of(limits) + limits.name) must(c >= ' ' && c <= '~', "a line with control characters");
  }
  Watchdog watchdog;
  if (decode(bytes, watchdog) != Wrong::nothing) return;
  must_be(encode(watchdog), bytes);
  must(watchdog.period >= LEAST_WATCHDOG && watchdog.period <= MOST_WATCHDOG, "a watchdog out of range");
}

}  // namespace
}  // namespace wholehand::device::protocol

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const wholehand::device::protocol::Bytes bytes(data, size);
  wholehand::device::protocol::try_input(bytes);
  wholehand::device::protocol::try_output(bytes);
  wholehand::device::protocol::try_features(bytes);
  wholehand::device::protocol::is_gripper(bytes);
  return 0;
}
