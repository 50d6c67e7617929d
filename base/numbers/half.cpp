// SPDX-License-Identifier: MIT
#include "base/numbers/half.h"

#include <algorithm>
#include <bit>

namespace wholehand {
namespace {

constexpr std::uint32_t HIDDEN = 1u << 23;  // the leading bit that a normal float does not store

}  // namespace

// The first 11 of a float's 24 significant bits stay; below 2^-14 a half has fewer, down to multiples of 2^-24.
std::uint16_t half_bits(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(std::clamp(value, -LARGEST_HALF, LARGEST_HALF));
  const std::uint32_t sign = bits >> 16 & 0x8000u;
  const int exponent = static_cast<int>(bits >> 23 & 0xFFu) - 127;
  if (exponent < -25) return static_cast<std::uint16_t>(sign);
  const std::uint32_t fraction = (bits & (HIDDEN - 1)) | HIDDEN;
  const int dropped = exponent < -14 ? 13 + (-14 - exponent) : 13;
  std::uint32_t kept = fraction >> dropped;
  const std::uint32_t rest = fraction & ((1u << dropped) - 1), middle = 1u << (dropped - 1);
  if (rest > middle || (rest == middle && (kept & 1u) != 0)) ++kept;
  // a carry into the exponent is correct
  const std::uint32_t magnitude = exponent < -14 ? kept : kept + (static_cast<std::uint32_t>(exponent + 14) << 10);
  return static_cast<std::uint16_t>(sign | magnitude);
}

}  // namespace wholehand
