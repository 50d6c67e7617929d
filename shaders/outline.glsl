// SPDX-License-Identifier: MIT
// The source of the vessel's outline, chosen at compile time: 0 reads elements and their number from a storage buffer in the loop; 1 copies them into
// registers once, with a specialized number (docs/results has the cost).
#ifndef OUTLINE_GLSL
#define OUTLINE_GLSL

#include "build.glsl"
#include "real.glsl"

// A y-monotone line or arc in the (r, y) half plane, as in core/sdf.h.
struct Element {
  Vec2 a, b, center;
  Real radius;
  int side, supports;
};

// From a record: layout.h defines `code`.
Element make_element(Vec2 a, Vec2 b, Vec2 center, Real radius, Real code) {
  return Element(a, b, center, radius, SIDE_OF(int(code)), SUPPORTS_OF(int(code)));
}

layout(constant_id = CONST_SDF_KIND) const int SDF_KIND = SDF_OUTLINE;

#if OUTLINE_SOURCE == 0

layout(std430, binding = BINDING_OUTLINE) readonly buffer OutlineBlock { Real outline_values[]; };
#define OUTLINE_COUNT int(scene.outline_count)
#define OUTLINE_LOOP [[dont_unroll]]
Element outline_element(int i) {
  int at = OUTLINE_STRIDE * i;
  return make_element(Vec2(outline_values[at], outline_values[at + 1]), Vec2(outline_values[at + 2], outline_values[at + 3]),
                      Vec2(outline_values[at + 4], outline_values[at + 5]), outline_values[at + 6], outline_values[at + 7]);
}
void load_outline() {}

#else

layout(constant_id = CONST_OUTLINE_COUNT) const int OUTLINE_COUNT = MAX_OUTLINE;
// Not a uniform block: lavapipe 22.3 takes its numbers that decide a branch for constants, and may recompile the kernel in every dispatch.
layout(std430, binding = BINDING_OUTLINE) readonly buffer OutlineBlock { Vec4 outline_values[]; };
layout(constant_id = CONST_ARCS) const int ARCS = -1;
#define OUTLINE_LOOP [[unroll]]
Element outline_copy[OUTLINE_COUNT];
Element outline_element(int i) { return outline_copy[i]; }
void load_outline() {
  OUTLINE_LOOP for (int i = 0; i < OUTLINE_COUNT; ++i) {
    Vec4 ends = outline_values[2 * i];
    Vec4 rest = outline_values[2 * i + 1];
    outline_copy[i] = make_element(ends.xy, ends.zw, rest.xy, rest.z, rest.w);
    if ((ARCS >> i & 1) == 0) outline_copy[i].side = 0;  // a driver then omits the code for arcs
  }
}

#endif

layout(constant_id = CONST_LATTICE_BITS) const int LATTICE_BITS = 32;
layout(binding = BINDING_LATTICE) uniform usamplerBuffer lattice_words;

#endif
