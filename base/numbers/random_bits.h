// SPDX-License-Identifier: MIT
// Pseudo-random numbers, the same on every machine.
#pragma once

#include <cstdint>

namespace wholehand {

// SplitMix64 (Steele, Lea & Flood 2014): bits that look unrelated to those of neighboring numbers ..
constexpr std::uint64_t mixed_bits(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}
// .. and the next of a sequence. Neighboring seeds give unrelated sequences.
constexpr std::uint64_t SPLIT_MIX_STEP = 0x9E3779B97F4A7C15u;
constexpr std::uint64_t split_mix(std::uint64_t& state) { return mixed_bits(state += SPLIT_MIX_STEP); }

// 64 bits as a number in [0, 1), a multiple of 2^-53.
constexpr double unit_interval(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

}  // namespace wholehand
