// SPDX-License-Identifier: MIT
// Where the vessel's outline comes from. Three ways, chosen when the shader is compiled, give the same numbers at very different cost
// (docs/results/): 0 reads elements and their number from a storage buffer in the loop; 1 copies a uniform buffer into the invocation
// once, the number specialized; 2 carries the coordinates as specialization constants, so that the distance folds into the pipeline.
#ifndef OUTLINE_GLSL
#define OUTLINE_GLSL

#extension GL_EXT_control_flow_attributes : require

#include "element.glsl"

layout(constant_id = CONST_SDF_KIND) const int SDF_KIND = SDF_OUTLINE;
layout(constant_id = CONST_LID) const int LID = -1;

#if OUTLINE_SOURCE == 0

layout(std430, binding = BINDING_OUTLINE) readonly buffer OutlineBlock { Real outline_values[]; };
#define OUTLINE_COUNT int(scene.outline_count)
#define OUTLINE_LOOP
Element outline_element(int i) {
  int at = OUTLINE_STRIDE * i;
  return make_element(Vec2(outline_values[at], outline_values[at + 1]), Vec2(outline_values[at + 2], outline_values[at + 3]),
                      Vec2(outline_values[at + 4], outline_values[at + 5]), outline_values[at + 6], outline_values[at + 7]);
}
void load_outline() {}

#elif OUTLINE_SOURCE == 1

layout(constant_id = CONST_OUTLINE_COUNT) const int OUTLINE_COUNT = MAX_OUTLINE;
layout(std140, binding = BINDING_OUTLINE) uniform OutlineBlock { Vec4 outline_values[2 * MAX_OUTLINE]; };
#define OUTLINE_LOOP [[unroll]]
Element outline_copy[OUTLINE_COUNT];
Element outline_element(int i) { return outline_copy[i]; }
void load_outline() {
  OUTLINE_LOOP for (int i = 0; i < OUTLINE_COUNT; ++i) {
    Vec4 ends = outline_values[2 * i];
    Vec4 rest = outline_values[2 * i + 1];
    outline_copy[i] = make_element(ends.xy, ends.zw, rest.xy, rest.z, rest.w);
  }
}

#else

layout(constant_id = CONST_OUTLINE_COUNT) const int OUTLINE_COUNT = MAX_OUTLINE;
#define OUTLINE_LOOP [[unroll]]
Element outline_copy[OUTLINE_COUNT];
Element outline_element(int i) { return outline_copy[i]; }
#include "outline_constants.glsl"

#endif

layout(constant_id = CONST_LATTICE_BITS) const int LATTICE_BITS = 32;
layout(binding = BINDING_LATTICE) uniform usamplerBuffer lattice_words;

#endif
