// SPDX-License-Identifier: MIT
// A kernel that includes this is built twice (SMALL comes from the build). llvmpipe runs each instruction on a vector of lanes, so its wide build has
// loops unrolled and numbers in registers. All other drivers get the small build: rolled loops, with rarely read data in the group's memory or a
// buffer. Apart from these macros, the builds differ only where SMALL appears: in accessors, and in a few lines of reserve.comp and gauge.glsl.
#ifndef BUILD_GLSL
#define BUILD_GLSL

#extension GL_EXT_control_flow_attributes : require

#if SMALL
#define UNROLL [[dont_unroll]]
#define UNROLL_PRECISE [[dont_unroll]]
#else
#define UNROLL [[unroll]]
#define UNROLL_PRECISE  // left to the driver: spirv-opt would lose `precise` (cmake/embed_module.cmake), or the number of turns is a scene's constant
#endif

// A branch of the effort kernels, written as a loop of one turn that a `continue` leaves: with branches AMD's compiler needs 132 to 136 registers for
// reserve.comp, and the budget is 128.
#define ONCE_IF(condition) [[dont_unroll]] for (bool once = condition; once; once = false)

#endif
