// SPDX-License-Identifier: MIT
// Leaf functions of sdf.glsl and contact.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "contact.glsl"
#include "probe.glsl"

Vec2 given2(int k) { return Vec2(given(k), given(k + 1)); }
Element given_element() { return make_element(given2(0), given2(2), given2(4), given(6), given(7)); }

void main() {
  if (row() >= push.count) return;
  load_outline();
  if (PROBE == PROBE_SIGNED_DISTANCE) answer(0, signed_distance(given3(0)));
  if (PROBE == PROBE_GRADIENT) {
    int element;
    answer3(0, distance_gradient(given3(0), element));
    answer(3, Real(element));
  }
  if (PROBE == PROBE_SUPPORT) {
    Support support = support_at(given3(0));
    answer(0, support.distance);
    answer(1, support.other);
    answer3(2, support.normal);
    answer(5, Real(support.element));
    answer(6, Real(support.planar));
  }
  if (PROBE == PROBE_SAFE_STEP) {
    Support support = Support(given(0), given(1), given3(2), 0, given_int(5) != 0);
    answer(0, safe_step(support, given(6), given3(7), given(10), given(11)));
  }
  if (PROBE == PROBE_CONTACT) {
    Real separation = separation_at(given3(0), given(3));
    bool settled = true;
    answer(0, separation);
    answer3(1, separation < Real(0) ? proxy_of(given3(0), given(3), settled) : given3(0));
    answer(4, Real(settled));
  }
  if (PROBE == PROBE_ELEMENT) {
    Element element = given_element();
    Vec2 q = given2(8);
    bool at_end;
    Vec2 outward = outward_of(element, q, at_end);
    if (at_end) outward *= given(10);
    answer(0, sqrt(element_distance_squared(element, q)));
    answer(1, Real(element_crosses(element, q)));
    answer(2, Real(element_spans(element, q)));
    answer(3, Real(element_convex(element, q)));
    answer(4, Real(element_supports(element, q)));
    answer(5, outward.x);
    answer(6, outward.y);
  }
  if (PROBE == PROBE_PROXY) {
    bool settled;
    answer3(0, proxy_of(given3(0), given(3), settled));
    answer(3, Real(settled));
  }
  if (PROBE == PROBE_LOCATE_CELL) {
    Cell cell = locate_cell(given3(0));
    answer3(0, Vec3(cell.i, cell.j, cell.k));
    answer3(3, cell.fraction);
    answer3(6, cell.outside);
  }
  if (PROBE == PROBE_LATTICE_SAMPLE) answer(0, lattice_sample(given_int(0), given_int(1), given_int(2)));
  if (PROBE == PROBE_DISTANCE_BEYOND) answer(0, distance_beyond(given(0), given3(1)));
  if (PROBE == PROBE_MIX_REALS) answer(0, mix_reals(given(0), given(1), given(2)));
}
