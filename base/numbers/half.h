// SPDX-License-Identifier: MIT
// 16-bit floats (IEEE 754 binary16), in which a lattice's samples may be stored.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

namespace wholehand {

constexpr float LARGEST_HALF = 65504;

// The half nearest to a finite number; a tie goes to the even one. Larger numbers become the largest half.
std::uint16_t half_bits(float value);

// The exact value of a half. Infinities and NaN give a quiet NaN; half_bits makes neither.
inline float half_value(std::uint16_t bits) {
  const std::uint32_t sign = (bits & 0x8000u) << 16;
  const std::uint32_t exponent = bits >> 10 & 0x1Fu, fraction = bits & 0x3FFu;
  if (exponent == 0x1F) return std::numeric_limits<float>::quiet_NaN();
  if (exponent > 0) return std::bit_cast<float>(sign | (exponent + 112) << 23 | fraction << 13);
  const float magnitude = static_cast<float>(fraction) * 0x1p-24f;
  return sign != 0 ? -magnitude : magnitude;
}

}  // namespace wholehand
