// SPDX-License-Identifier: MIT
// Distances along rays as sphere tracing would ask for them, the lattice read in several ways. Each invocation goes along one ray in steps
// that shrink towards its end; the points are the same for every way, and neighboring invocations have neighboring rays.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "sdf.glsl"
#include "tests/bench/shaders/lattice_read.h"

layout(local_size_x_id = CONST_GROUP_SIZE) in;
layout(constant_id = CONST_WAY) const int WAY = WAY_BUFFER;
layout(std430, binding = BINDING_GRIPS) readonly buffer RayBlock { Real rays[]; };  // start x, y, z, way x, y, z: planes
layout(std430, binding = BINDING_REAL_OUT) writeonly buffer DistanceBlock { Real distances[]; };
layout(binding = BINDING_IMAGE) uniform sampler3D image;
layout(binding = BINDING_TEXELS) uniform samplerBuffer texels;
layout(std430, binding = BINDING_WORDS) readonly buffer WordBlock { uint words[]; };

Real fetched(int i, int j, int k) {
  Real unit = LATTICE_BITS == 16 ? HALF_UNIT : Real(1);
  int at = (k * int(scene.lattice_ny) + j) * int(scene.lattice_nx) + i;
  if (WAY == WAY_TEXELS) return Real(texelFetch(texels, at).x) * unit;
  if (WAY == WAY_BUFFER && LATTICE_BITS == 32) return Real(uintBitsToFloat(words[at]));
  if (WAY == WAY_BUFFER) return Real(unpackHalf2x16(words[at / 2])[at % 2]) * unit;
  return Real(texelFetch(image, ivec3(i, j, k), 0).x) * unit;
}

// lattice_distance of sdf.glsl with another way to a sample.
Real fetched_distance(Vec3 p) {
  Cell cell = locate_cell(p);
  Vec3 f = cell.fraction;
  Real c00 = mix_reals(fetched(cell.i, cell.j, cell.k), fetched(cell.i + 1, cell.j, cell.k), f.x);
  Real c10 = mix_reals(fetched(cell.i, cell.j + 1, cell.k), fetched(cell.i + 1, cell.j + 1, cell.k), f.x);
  Real c01 = mix_reals(fetched(cell.i, cell.j, cell.k + 1), fetched(cell.i + 1, cell.j, cell.k + 1), f.x);
  Real c11 = mix_reals(fetched(cell.i, cell.j + 1, cell.k + 1), fetched(cell.i + 1, cell.j + 1, cell.k + 1), f.x);
  return distance_beyond(mix_reals(mix_reals(c00, c10, f.y), mix_reals(c01, c11, f.y), f.z), cell.outside);
}

// The sampler's own interpolation: texel (i, j, k) has its center half a texel further.
Real filtered_distance(Vec3 p) {
  Vec3 origin = Vec3(scene.lattice_x, scene.lattice_y, scene.lattice_z);
  Vec3 counts = Vec3(Real(scene.lattice_nx), Real(scene.lattice_ny), Real(scene.lattice_nz));
  Vec3 clamped = min(max(p, origin), origin + (counts - Real(1)) * scene.lattice_spacing);
  Vec3 place = ((clamped - origin) / scene.lattice_spacing + Real(0.5)) / counts;
  return distance_beyond(Real(textureLod(image, vec3(place), 0.0).x) * (LATTICE_BITS == 16 ? HALF_UNIT : Real(1)), p - clamped);
}

Real distance_by(Vec3 p) {
  if (WAY == WAY_NOTHING) return p.x + p.y + p.z;
  if (WAY == WAY_FILTER) return filtered_distance(p);
  return fetched_distance(p);
}

void main() {
  uint ray = INVOCATION;
  if (ray >= push.count) return;
  Vec3 start = Vec3(rays[ray], rays[push.stride + ray], rays[2u * push.stride + ray]);
  Vec3 way = Vec3(rays[3u * push.stride + ray], rays[4u * push.stride + ray], rays[5u * push.stride + ray]);
  precise Real left = Real(1);
  for (int step = 0; step < RAY_STEPS; ++step) {
    precise Vec3 p = start + (Real(1) - left) * way;
    distances[uint(step) * push.stride + ray] = distance_by(p);
    left *= Real(STEP_SHARE);
  }
}
