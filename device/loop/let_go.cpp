// SPDX-License-Identifier: MIT
#include "device/loop/let_go.h"

namespace wholehand {
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
    line.add("; the hand must let go by itself");
  else
    line.add("; the device has no watchdog, so switch it off");
}

}  // namespace

void add_force_words(SafeLine& line, LetGo outcome, const ForceSize& last, double watchdog, std::string_view why) noexcept {
  switch (outcome) {
    case LetGo::nothing:
      line.add("no force is on a device");
      return;
    case LetGo::written:
      line.add("zero force was written");
      return;
    case LetGo::not_taken:
      line.add("zero force could not be written");
      if (!why.empty()) line.add(" (").add(why).add(")");
      break;
    case LetGo::not_asked:
      line.add("zero force was not written, since the device's library cannot be called now");
      break;
  }
  line.add("; ");
  add_last(line, last, watchdog);
}

}  // namespace wholehand
