// SPDX-License-Identifier: MIT
// A grip given by its six numbers in a program call, under the rules of scene files and the command line.
#pragma once

#include <array>
#include <optional>

#include "core/result.h"
#include "core/scene.h"

namespace wholehand {

constexpr std::size_t GRIP_NUMBERS = 6;
extern const std::array<const char*, GRIP_NUMBERS> GRIP_NUMBER_NAMES;  // "height" .. "hand_scale", as GripInput has them
extern const std::array<const char*, GRIP_NUMBERS> GRIP_NUMBER_UNITS;  // "m", "rad" or "1"

// The ranges of the six numbers in a scene, SI.
struct AskedGrips {
  // A mesh's samples reach only as far as the largest hand of [grips] hand_scale needs, so its grips may not be larger.
  explicit AskedGrips(const Scene& scene);
  std::array<double, GRIP_NUMBERS> low{}, high{};
};

// The index of the first number that is not finite or out of its range. Nothing if all are allowed.
std::optional<std::size_t> grip_fault(const AskedGrips& allowed, const GripInput& grip) noexcept;

// The six numbers in the order of their names.
constexpr std::array<double, GRIP_NUMBERS> grip_numbers(const GripInput& grip) noexcept {
  return {grip.height, grip.azimuth, grip.obliquity, grip.roll, grip.offset, grip.hand_scale};
}

}  // namespace wholehand
