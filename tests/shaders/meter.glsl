// SPDX-License-Identifier: MIT
// How many turns of loops are left to an invocation after kernel(), of METER_TURNS: a driver that ends loops after so many ends this one early. A
// shader of the program becomes such a kernel where main is defined as kernel; this file then follows it.
#ifndef METER_GLSL
#define METER_GLSL

#undef main
#define METER_TURNS 70000u

layout(std430, binding = BINDING_LANES) buffer MeterBlock { uint most_missing; };

void main() {
  kernel();
  uint left = 0u, mixed = INVOCATION;
  while (left < METER_TURNS) {
    mixed = mixed * 1664525u + left;
    ++left;
  }
  // the mixture keeps the loop a loop
  atomicMax(most_missing, METER_TURNS - left + (mixed == 1u && left == 0u ? 1u : 0u));
}

#endif
