// SPDX-License-Identifier: MIT
// An advice in words.
#pragma once

#include <string>

#include "device/advice/advice.h"

namespace wholehand::device {

// For a moving hand: "8 mm higher, wrist 12 degrees up: effort 0.21 to 0.09", "this grip is good: effort 0.09", or "no grip within reach is
// possible". For a holding hand: "at 70 degrees the grip needs 0.40 of your strength; tilt over the other side: 0.21", and then the effort of another
// grip. Empty: there is nothing to advise, for example for a held grip that is easy at the tilts ahead but rated not possible.
std::string advice_words(const Advice& advice);

// The way from one grip to another: "8 mm higher, wrist 12 degrees up, index finger 5 degrees up, around by 20 degrees to the right, 3 mm towards
// you". Height and index finger are along the vessel's axis. The other directions (of the wrist, the hand about the vessel, and the line of the tips)
// are those in the world, as a person at +z sees them: the nearest of up, down, left, right, towards and away. `rotation`: of the vessel, to the
// world. Leaves out less than a millimeter or a degree. Empty: no way.
std::string way_words(const GripInput& from, const GripInput& to, const Rotation& rotation = NO_ROTATION,
                      Handedness handedness = Handedness::right);

// "0.21", "1.30", or "more than any strength" for an infinite effort.
std::string effort_words(double effort);

}  // namespace wholehand::device
