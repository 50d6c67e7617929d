// SPDX-License-Identifier: MIT
// What peak.comp, copy.comp and device_peak.cpp agree on.
#ifndef WHOLEHAND_PEAK_H
#define WHOLEHAND_PEAK_H

#define CONST_FUSED 7  // specialization constant, bool: fma, or a product and a sum
#define PEAK_CHAINS 8  // of an invocation: two vectors of four
#define PEAK_STEPS 32  // of each chain in a turn of the loop, of which a CPU driver takes 65,535 at most
#define COPY_WORDS 4   // of 32 bits, that an invocation of copy.comp copies

#endif
