// SPDX-License-Identifier: MIT
// How many lanes of a vector do useful work, for a benchmark that compiles the kernels with COUNTS_LANES. Nothing in the program's own.
#ifndef LANES_GLSL
#define LANES_GLSL

#ifdef COUNTS_LANES
#extension GL_KHR_shader_subgroup_ballot : require

layout(std430, binding = BINDING_LANES) buffer LaneBlock { uint useful_lanes, all_lanes; };

// Each time that a subgroup comes by: its lanes that are here and for which this is useful, and all that it has.
void count_lanes(bool is_useful) {
  uint useful = subgroupBallotBitCount(subgroupBallot(is_useful));
  if (subgroupElect()) {
    atomicAdd(useful_lanes, useful);
    atomicAdd(all_lanes, gl_SubgroupSize);
  }
}
#define COUNT_LANES(is_useful) count_lanes(is_useful)
#else
#define COUNT_LANES(is_useful)
#endif

#endif
