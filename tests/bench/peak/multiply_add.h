// SPDX-License-Identifier: MIT
// Multiply-adds and nothing else, in chains that do not wait for each other. One source, compiled for each set of instructions by itself,
// so that the figure is the machine's and not that of the build's flags: call only what the processor has.
#pragma once

#include <cstdint>

namespace wholehand::bench {

// A multiply-add takes four or five cycles, and two begin in each. With 14 chains GCC 12 keeps them in memory and reaches 40 %. A product and its
// sum take longer, so that one number at a time reaches a twentieth less than with 14 chains in registers.
constexpr int PROCESSOR_CHAINS = 12;

// Takes `turns` turns; returns their operations, two a multiply-add. `sum` keeps the compiler from leaving them out.
using MultiplyAdd = double (*)(std::uint64_t turns, double& sum);

struct MultiplyAdds {
  MultiplyAdd in_float, in_double;
};
MultiplyAdds scalar_multiply_adds();  // number by number
MultiplyAdds vector_multiply_adds();  // vectors of 16 bytes, with what every processor of the kind has
#ifdef WHOLEHAND_PEAK_X86
MultiplyAdds avx2_multiply_adds();    // 32 bytes, fused
MultiplyAdds avx512_multiply_adds();  // 64 bytes, fused
#endif

}  // namespace wholehand::bench
