// SPDX-License-Identifier: MIT
#include "base/numbers/sobol.h"

#include <bit>

#include "base/numbers/random_bits.h"

namespace wholehand {
namespace {

constexpr int BITS = 32;
using Directions = std::array<std::array<std::uint32_t, BITS>, SOBOL_DIMENSIONS>;

// A row of Joe & Kuo's table: degree s and inner coefficients a of the primitive polynomial, first direction numbers m.
struct Polynomial {
  int degree;
  std::uint32_t coefficients;
  std::array<std::uint32_t, 4> first;
};

// Dimensions 2 to 6; dimension 1 is the van der Corput sequence.
constexpr std::array<Polynomial, SOBOL_DIMENSIONS - 1> POLYNOMIALS{{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
}};

constexpr Directions make_directions() {
  Directions directions{};
  for (int bit = 0; bit < BITS; ++bit) directions[0][bit] = std::uint32_t{1} << (BITS - 1 - bit);
  for (int dimension = 1; dimension < SOBOL_DIMENSIONS; ++dimension) {
    const Polynomial& polynomial = POLYNOMIALS[dimension - 1];
    auto& v = directions[dimension];
    const int s = polynomial.degree;
    for (int bit = 0; bit < s; ++bit) v[bit] = polynomial.first[bit] << (BITS - 1 - bit);
    for (int bit = s; bit < BITS; ++bit) {
      v[bit] = v[bit - s] ^ (v[bit - s] >> s);
      for (int k = 1; k < s; ++k) {
        if ((polynomial.coefficients >> (s - 1 - k)) & 1) v[bit] ^= v[bit - k];
      }
    }
  }
  return directions;
}

constexpr Directions DIRECTIONS = make_directions();

}  // namespace

Sobol::Sobol(std::uint64_t seed) {
  for (std::uint32_t& shift : shift_) shift = static_cast<std::uint32_t>(split_mix(seed) >> 32);
}

std::array<std::uint32_t, SOBOL_DIMENSIONS> Sobol::integers(std::uint64_t index) {
  std::array<std::uint32_t, SOBOL_DIMENSIONS> x{};
  for (std::uint64_t gray = index ^ (index >> 1); gray != 0; gray &= gray - 1) {
    const int bit = std::countr_zero(gray);
    if (bit >= BITS) break;
    for (int dimension = 0; dimension < SOBOL_DIMENSIONS; ++dimension) x[dimension] ^= DIRECTIONS[dimension][bit];
  }
  return x;
}

void Sobol::points(std::uint64_t first, std::size_t count, SobolPoint* out) const {
  auto x = integers(first);
  for (std::size_t i = 0; i < count; ++i) {
    for (int dimension = 0; dimension < SOBOL_DIMENSIONS; ++dimension) {
      out[i][dimension] = (static_cast<double>(x[dimension] ^ shift_[dimension]) + 0.5) * 0x1p-32;
    }
    const int bit = std::countr_zero(first + i + 1);  // the one bit in which successive Gray codes differ
    if (bit >= BITS) break;                           // the last point has no successor
    for (int dimension = 0; dimension < SOBOL_DIMENSIONS; ++dimension) x[dimension] ^= DIRECTIONS[dimension][bit];
  }
}

}  // namespace wholehand
