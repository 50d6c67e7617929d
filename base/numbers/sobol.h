// SPDX-License-Identifier: MIT
// Sobol points for sampling without a grid: a digital sequence in base 2, shifted by a seed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace wholehand {

constexpr int SOBOL_DIMENSIONS = 6;                                    // as many as AXIS_* of shaders/layout.h
constexpr std::uint64_t SOBOL_LARGEST_COUNT = std::uint64_t{1} << 32;  // points; the sequence has 32 bits

using SobolPoint = std::array<double, SOBOL_DIMENSIONS>;  // each in (0, 1)

// Direction numbers of Joe & Kuo (2008, new-joe-kuo-6), in Gray code order, so that any point is reached at once and its successor
// costs one exclusive or per dimension. The seed gives a digital shift (exclusive or with a fixed word per dimension): it keeps
// every stratification of the sequence and repeats. A point is in the middle of its cell of 2^-32, so it is never 0 or 1.
//
// Written here since no small permissive package of Debian has it (Boost is 145 MB, GSL is under the GPL).
class Sobol {
 public:
  explicit Sobol(std::uint64_t seed);

  // Points first .. first + count - 1 of the sequence; first + count <= SOBOL_LARGEST_COUNT. Thread-safe.
  void points(std::uint64_t first, std::size_t count, SobolPoint* out) const;

  // The unshifted sequence's integers at an index, x = value / 2^32, as published tables list them.
  static std::array<std::uint32_t, SOBOL_DIMENSIONS> integers(std::uint64_t index);

 private:
  std::array<std::uint32_t, SOBOL_DIMENSIONS> shift_{};
};

}  // namespace wholehand
