// SPDX-License-Identifier: MIT
// The liquid of fills and tilts of a vessel, one invocation per state from push.first on, and the weight of glass and liquid together.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "liquid.glsl"

layout(local_size_x_id = CONST_GROUP_SIZE) in;
layout(std430, binding = BINDING_TILTS) readonly buffer TiltBlock { Real tilts_in[]; };
layout(std430, binding = BINDING_FILLS) readonly buffer FillBlock { Real fills_in[]; };
layout(std430, binding = BINDING_CAPACITY) readonly buffer CapacityBlock { Real capacity_in[]; };
layout(std430, binding = BINDING_LIQUID) writeonly buffer LiquidBlock { Real liquid_out[]; };
layout(std430, binding = BINDING_LOADS) writeonly buffer LoadBlock { Real loads_out[]; };

void main() {
  uint state = push.first + INVOCATION;
  if (state >= push.count) return;
  uint fill = state / scene.tilts;
  uint tilt = state % scene.tilts;
  Real filled = fills_in[fill] * scene.capacity;
  // liquid that poured at a smaller tilt is gone
  Real volume = min(filled, capacity_in[uint(WHOLE_DEGREES) + tilt]);
  int before = min(int(tilts_in[3u * tilt + 2u] * (Real(90) / HALF_PI)), WHOLE_DEGREES - 1);
  for (int degree = 0; degree <= before; ++degree) volume = min(volume, capacity_in[degree]);
  LiquidState liquid = liquid_at(volume, tilts_in[3u * tilt], tilts_in[3u * tilt + 1u]);
  Real mass = liquid.volume * scene.liquid_density;
  uint at = LIQUID_STRIDE * state;
  liquid_out[at] = liquid.volume;
  liquid_out[at + 1u] = mass;
  liquid_out[at + 2u] = liquid.lean;
  liquid_out[at + 3u] = liquid.height;
  liquid_out[at + 4u] = filled - liquid.volume;
  Real together = scene.vessel_mass + mass;
  Real share = together > Real(0) ? mass / together : Real(0);
  at = LOAD_STRIDE * state;
  loads_out[at] = together;
  loads_out[at + 1u] = share;
  loads_out[at + 2u] = share * liquid.lean;
  loads_out[at + 3u] = share * liquid.height;
}
