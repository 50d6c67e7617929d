// SPDX-License-Identifier: MIT
// A y-monotone line or arc in the (r, y) half plane, as core/sdf.h has it.
#ifndef ELEMENT_GLSL
#define ELEMENT_GLSL

#include "real.glsl"

struct Element {
  Vec2 a, b, center;
  Real radius;
  int side, supports;
};

// From a record: layout.h says what `code` holds.
Element make_element(Vec2 a, Vec2 b, Vec2 center, Real radius, Real code) {
  return Element(a, b, center, radius, SIDE_OF(int(code)), SUPPORTS_OF(int(code)));
}

// The cavity's pieces and the quadrature's rule, from storage buffers: the liquid is computed once a vessel, so their loads do not show.
layout(std430, binding = BINDING_CAVITY) readonly buffer CavityBlock { Real cavity_values[]; };
layout(std430, binding = BINDING_QUADRATURE) readonly buffer QuadratureBlock { Real quadrature_values[]; };

Element cavity_element(int i) {
  int at = OUTLINE_STRIDE * i;
  return make_element(Vec2(cavity_values[at], cavity_values[at + 1]), Vec2(cavity_values[at + 2], cavity_values[at + 3]),
                      Vec2(cavity_values[at + 4], cavity_values[at + 5]), cavity_values[at + 6], cavity_values[at + 7]);
}

#define QUADRATURE_COUNT int(scene.quadrature_count)
Real quadrature_cosine(int i) { return quadrature_values[2 * i]; }
Real quadrature_weight(int i) { return quadrature_values[2 * i + 1]; }

#endif
