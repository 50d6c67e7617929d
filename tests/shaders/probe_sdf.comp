// Leaf functions of sdf.glsl and contact.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "contact.glsl"
#include "probe.glsl"

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
    Contact contact = contact_at(given3(0), given(3));
    answer(0, contact.separation);
    answer3(1, contact.proxy);
    answer(4, Real(contact.settled));
  }
}
