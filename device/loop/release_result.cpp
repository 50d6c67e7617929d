// SPDX-License-Identifier: MIT
#include "device/loop/release_result.h"

namespace wholehand::device {
namespace {

constexpr double NO_FORCE = 0.005;  // N: what two decimals say as 0

void add_last(SafeLine& line, const ForceSize& last, double watchdog) noexcept {
  if (last.arm < NO_FORCE && last.grip < NO_FORCE) {
    line.add("the last force was zero");
    return;
  }
  line.add("the last force was ").add(last.arm, 2).add(" N at the arm and ").add(last.grip, 2).add(" N at the fingers");
  if (watchdog > 0)
    line.add("; the device's own watchdog takes it away within ").add(watchdog * 1e3, 3).add(" ms");
  else if (watchdog == UNKNOWN_WATCHDOG)
    line.add("; the device or hand must let go by itself");
  else
    line.add("; the device has no watchdog, so switch it off");
}

}  // namespace

void add_force_words(SafeLine& line, ReleaseResult outcome, const ForceSize& last, double watchdog, std::string_view why) noexcept {
  switch (outcome) {
    case ReleaseResult::no_force:
      line.add("no force is on a device");
      return;
    case ReleaseResult::written:
      line.add("zero force was written");
      return;
    case ReleaseResult::refused:
      line.add("zero force could not be written");
      if (!why.empty()) line.add(" (").add(why).add(")");
      break;
    case ReleaseResult::not_attempted:
      line.add("zero force was not written, since the device's library cannot be called now");
      break;
  }
  line.add("; ");
  add_last(line, last, watchdog);
}

}  // namespace wholehand::device
