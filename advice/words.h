// SPDX-License-Identifier: MIT
// An advice in words.
#pragma once

#include <string>

#include "advice/advice.h"

namespace wholehand {

// Of a hand on its way: "8 mm higher, turn 12 degrees: effort .21 to .09", "this grip is good: effort .09", or "no grip within
// reach is possible". Of a hand that holds: "at 70 degrees the grip needs .40 of your strength; tilt over the other side: .21",
// and then what another grip would take. Empty: there is nothing to advise.
std::string advice_words(const Advice& advice);

// The way from one grip to another: "8 mm higher, turn 12 degrees back, index finger 5 degrees up, 3 mm nearer to you". Less than a
// millimetre or a degree is not said. Empty: no way.
std::string way_words(const GripInput& from, const GripInput& to);

// ".21", "1.30", or "more than any strength" of an infinite effort.
std::string effort_words(double effort);

}  // namespace wholehand
