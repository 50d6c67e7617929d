// SPDX-License-Identifier: MIT
#version 450
// Adds one to a counter per invocation.
layout(local_size_x = 64) in;
layout(binding = 2) buffer Counter { uint counter; };

void main() { atomicAdd(counter, 1); }
