// SPDX-License-Identifier: MIT
// The facade once more, over the core in float.
#define REAL float
#define CORE_NS core_f32
#define MAKE_LEAVES make_float_leaves
#include "tests/support/leaf_facade.cpp"
