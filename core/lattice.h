// SPDX-License-Identifier: MIT
// How a lattice's samples are packed in 32-bit words, also for shaders: one float each, or two halves in units of HALF_UNIT, the first in the low
// bits.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/numbers/half.h"
#include "shaders/layout.h"

namespace wholehand {

constexpr std::size_t lattice_words(std::size_t samples, bool halves) { return halves ? (samples + 1) / 2 : samples; }
// The word that holds a sample.
constexpr std::size_t word_index(std::size_t sample, bool halves) { return halves ? sample / 2 : sample; }

// A distance, m, as a half.
inline std::uint16_t half_of(float distance) { return half_bits(distance * static_cast<float>(1 / HALF_UNIT)); }
// Puts a half in its place in the word, the other half 0; and takes it out again.
constexpr std::uint32_t placed_half(std::uint16_t half, std::size_t sample) {
  return static_cast<std::uint32_t>(half) << (sample % 2 == 0 ? 0 : 16);
}
inline std::uint16_t half_at(const std::vector<std::uint32_t>& words, std::size_t sample) {
  return static_cast<std::uint16_t>(words[sample / 2] >> (sample % 2 == 0 ? 0 : 16));
}

// The bits of a distance, m, as a sample in its place in the word, the others 0.
inline std::uint32_t sample_bits(float distance, std::size_t sample, bool halves) {
  if (!halves) return std::bit_cast<std::uint32_t>(distance);
  return placed_half(half_of(distance), sample);
}

}  // namespace wholehand
