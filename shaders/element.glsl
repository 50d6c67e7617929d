// SPDX-License-Identifier: MIT
// A y-monotone line or arc in the (r, y) half plane, as core/sdf.h has it.
#ifndef ELEMENT_GLSL
#define ELEMENT_GLSL

#include "real.glsl"

struct Element {
  Vec2 a;
  Vec2 b;
  Vec2 center;
  Real radius;
  int side;
  int supports;
};

// From a record: layout.h says what `code` holds.
Element make_element(Vec2 a, Vec2 b, Vec2 center, Real radius, Real code) {
  return Element(a, b, center, radius, SIDE_OF(int(code)), SUPPORTS_OF(int(code)));
}

#endif
