// SPDX-License-Identifier: MIT
// PEAK_SET names the function, and PEAK_BYTES is the size of a vector, 0: no vector. Compiled with contraction, and without vectorization.
#include "tests/bench/peak/multiply_add.h"

namespace wholehand::bench {
namespace {

#if PEAK_BYTES == 0
template <class Number>
using Vector = Number;
#else
template <class Number>
struct VectorOf {
  typedef Number type __attribute__((vector_size(PEAK_BYTES)));
};
template <class Number>
using Vector = typename VectorOf<Number>::type;
#endif

template <class Number>
double multiply_adds(std::uint64_t turns, double& sum) {
  constexpr int LANES = sizeof(Vector<Number>) / sizeof(Number);
  // with the fixed point 1: no number becomes too large or too small to be ordinary
  volatile Number small = Number(1) / 1024;
  const Vector<Number> term = Vector<Number>{} + small, factor = Number(1) - term;
  Vector<Number> chains[PROCESSOR_CHAINS];
  for (int k = 0; k < PROCESSOR_CHAINS; ++k) chains[k] = Vector<Number>{} + static_cast<Number>(k);
  for (std::uint64_t turn = 0; turn < turns; ++turn) {
#pragma GCC unroll 12
    for (int k = 0; k < PROCESSOR_CHAINS; ++k) chains[k] = chains[k] * factor + term;
  }
  for (int k = 1; k < PROCESSOR_CHAINS; ++k) chains[0] += chains[k];
#if PEAK_BYTES == 0
  sum += static_cast<double>(chains[0]);
#else
  for (int lane = 0; lane < LANES; ++lane) sum += static_cast<double>(chains[0][lane]);
#endif
  return 2.0 * PROCESSOR_CHAINS * LANES * static_cast<double>(turns);
}

}  // namespace

MultiplyAdds PEAK_SET() { return {multiply_adds<float>, multiply_adds<double>}; }

}  // namespace wholehand::bench
