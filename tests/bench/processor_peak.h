// SPDX-License-Identifier: MIT
// What the processor can do at most: multiply-adds, and copies.
#pragma once

#include <string>

#include "core/backend.h"

namespace wholehand::bench {

struct ProcessorPeak {
  std::string instructions;  // of the best set: "AVX-512"
  double operations = 0;     // a second, two a multiply-add
};

// Peak of `threads` at once, the best of some tries, with the fastest vector instructions. Counts processor time, so that other work on
// the machine changes the figure little.
ProcessorPeak processor_peak(Precision precision, int threads);
// One number at a time: a product, and then a sum.
ProcessorPeak scalar_peak(Precision precision, int threads);
// Bytes a second, read and written together, of copies between arrays of twice the last cache, from 64 to 512 MiB.
double processor_copy_rate(int threads);

}  // namespace wholehand::bench
