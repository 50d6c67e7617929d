// SPDX-License-Identifier: MIT
// A y-monotone line or arc in the (r, y) half plane, as in core/sdf.h.
#ifndef ELEMENT_GLSL
#define ELEMENT_GLSL

#include "real.glsl"

struct Element {
  Vec2 a, b, center;
  Real radius;
  int side, supports;
};

// From a record: layout.h defines `code`.
Element make_element(Vec2 a, Vec2 b, Vec2 center, Real radius, Real code) {
  return Element(a, b, center, radius, SIDE_OF(int(code)), SUPPORTS_OF(int(code)));
}
#define ELEMENT_AT(values, at)                                                                                            \
  make_element(Vec2(values[at], values[at + 1]), Vec2(values[at + 2], values[at + 3]), Vec2(values[at + 4], values[at + 5]), \
               values[at + 6], values[at + 7])

// The cavity's pieces and the quadrature's rule, from storage buffers: the liquid is computed once per vessel, so their loads cost little.
layout(std430, binding = BINDING_CAVITY) readonly buffer CavityBlock { Real cavity_values[]; };
layout(std430, binding = BINDING_QUADRATURE) readonly buffer QuadratureBlock { Real quadrature_values[]; };

#define QUADRATURE_COUNT int(scene.quadrature_count)

Element cavity_element(int i) { return ELEMENT_AT(cavity_values, OUTLINE_STRIDE * i); }
Real quadrature_cosine(int i) { return quadrature_values[2 * i]; }
Real quadrature_weight(int i) { return quadrature_values[2 * i + 1]; }

#endif
