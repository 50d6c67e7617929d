// SPDX-License-Identifier: MIT
// A kernel that includes this is built twice (SMALL comes from the build). llvmpipe runs each instruction on a vector of lanes: its wide build has
// loops
// unrolled and numbers in registers. Every other driver takes the small build: loops as they are, and what is rarely read in the group's
// memory or in a buffer. Beside these macros they differ where SMALL stands: in accessors, and in a few lines of reserve.comp and gauge.glsl.
#ifndef BUILD_GLSL
#define BUILD_GLSL

#extension GL_EXT_control_flow_attributes : require

#if SMALL
#define UNROLL [[dont_unroll]]
#define UNROLL_PRECISE [[dont_unroll]]
#else
#define UNROLL [[unroll]]
#define UNROLL_PRECISE  // left to the driver: spirv-opt would lose `precise` (cmake/embed_module.cmake), or the number of turns is a constant of the scene
#endif

// A branch of the kernels of efforts as a loop of one turn, which a `continue` leaves: with branches AMD's compiler takes 132 to 136 registers for
// reserve.comp, and the budget is 128.
#define ONCE_IF(condition) [[dont_unroll]] for (bool once = condition; once; once = false)

#endif
