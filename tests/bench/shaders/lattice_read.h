// SPDX-License-Identifier: MIT
// What lattice_read.comp and image_bench.cpp agree on.
#ifndef WHOLEHAND_LATTICE_READ_H
#define WHOLEHAND_LATTICE_READ_H

#define CONST_WAY 7    // specialization constant: one of these
#define WAY_NOTHING 0  // the points alone
#define WAY_BUFFER 1   // from the words of a storage buffer
#define WAY_FETCH 2    // from texels of a 3-D image
#define WAY_FILTER 3   // the image's own linear interpolation
#define WAY_TEXELS 4   // from a uniform texel buffer, as shaders/sdf.glsl does
#define BINDING_IMAGE 17
#define BINDING_TEXELS 18
#define BINDING_WORDS 19

#define RAY_STEPS 64
#define STEP_SHARE 0.875  // of what is left of the way after a step; exact in binary

#endif
