// SPDX-License-Identifier: MIT
// The grips of the group that there is something to do for, one after another: all lanes of a vector run until the slowest is done.
#ifndef BUSY_GLSL
#define BUSY_GLSL

#include "real.glsl"

layout(local_size_x_id = CONST_GROUP_SIZE) in;  // before INVOCATION, which would take groups of one else

shared uint busy_grips[GROUP_SIZE];
shared uint busy_count;

// Whether this invocation has a grip of those that are busy. Called once, by all invocations of the group.
bool take_grip(bool is_busy, out uint grip) {
  if (gl_LocalInvocationIndex == 0u) busy_count = 0u;
  barrier();
  if (is_busy) busy_grips[atomicAdd(busy_count, 1u)] = INVOCATION;
  barrier();
  bool has_grip = gl_LocalInvocationIndex < busy_count;
  grip = has_grip ? busy_grips[gl_LocalInvocationIndex] : 0u;
  return has_grip;
}

#endif
