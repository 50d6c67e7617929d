// SPDX-License-Identifier: MIT
// The inner operations of core/effort.cpp's solve: a contact's support, and the basis of the simplex method. Its functions have no twin: in the wide
// build the basis lies in registers, and no branch may copy it.
#ifndef GAUGE_GLSL
#define GAUGE_GLSL

#include "build.glsl"
#include "real.glsl"

// Comparisons allow more than a hundred roundings, so no sum is `precise`: a driver that contracts a sum changes it by one rounding
// (docs/drivers.md).
#if REAL_IS_DOUBLE
#define ROUNDING 1e-11lf
#define LEAST_PIVOT 1e-9lf
#else
#define ROUNDING 1e-5
#define LEAST_PIVOT 1e-4
#endif
#define UNRESISTED_EFFORT Real(1000000)
#define LEAST_LENGTH RATIO(1, 1000)
#define DIGITS (FINGERS + 1)

layout(constant_id = CONST_EFFORT_TOLERANCE) const Real EFFORT_TOLERANCE = RATIO(1, 1000);

struct Six {
  Vec3 first, second;
};

Real dot6(Six a, Six b) { return dot(a.first, b.first) + dot(a.second, b.second); }
Six times(Real share, Six a) { return Six(share * a.first, share * a.second); }
Six plus(Six a, Real share, Six b) { return Six(a.first + share * b.first, a.second + share * b.second); }
Six chosen(bool is_a, Six a, Six b) { return Six(is_a ? a.first : b.first, is_a ? a.second : b.second); }
Real value_of(int k, Six six) { return k < 3 ? six.first[k] : six.second[k - 3]; }

struct Cost {
  Real real, artificial, least;
};

// Rows of the inverse, and which columns are artificial. Unrolled loops make the indices constants, so the rows stay in registers.
struct Basis {
  Six inverse[6];
  bool is_artificial[6];
};

Basis basis;

// Columns of the basis (points of Z or artificial) and the direction of the last lower bound; rarely read.
#define CUT 6
#if SMALL

shared Real columns[SOLVE_REALS * GROUP_SIZE];

Six column(int c) {
  uint at = uint(6 * c) * GROUP_SIZE + gl_LocalInvocationIndex;
  return Six(Vec3(columns[at], columns[at + GROUP_SIZE], columns[at + 2 * GROUP_SIZE]),
             Vec3(columns[at + 3 * GROUP_SIZE], columns[at + 4 * GROUP_SIZE], columns[at + 5 * GROUP_SIZE]));
}

void set_column(int c, Six six, bool is_set) {
  if (!is_set) return;
  uint at = uint(6 * c) * GROUP_SIZE + gl_LocalInvocationIndex;
  columns[at] = six.first.x;
  columns[at + GROUP_SIZE] = six.first.y;
  columns[at + 2 * GROUP_SIZE] = six.first.z;
  columns[at + 3 * GROUP_SIZE] = six.second.x;
  columns[at + 4 * GROUP_SIZE] = six.second.y;
  columns[at + 5 * GROUP_SIZE] = six.second.z;
}

#else

Six columns[7];

Six column(int c) { return columns[c]; }

void set_column(int c, Six six, bool is_set) { columns[c] = chosen(is_set, six, columns[c]); }

#endif

Real press(Vec3 arm, Vec3 normal, Real friction, Real gamma, Six direction) {
  Vec3 velocity = direction.first + cross(direction.second, arm);
  Real spin = gamma * dot(direction.second, normal);
  Vec3 across = cross(cross(normal, velocity), normal);
  return dot(normal, velocity) + friction * sqrt(dot(across, across) + spin * spin);
}

Six pressed(Vec3 arm, Vec3 normal, Real friction, Real gamma, Six direction) {
  Vec3 velocity = direction.first + cross(direction.second, arm);
  Real spin = gamma * dot(direction.second, normal);
  Vec3 across = cross(cross(normal, velocity), normal);
  Real root = sqrt(dot(across, across) + spin * spin);
  Real share = root > Real(0) ? friction / root : Real(0);
  Vec3 pushed = normal + share * across;
  return Six(pushed, cross(arm, pushed) + (share * gamma * spin) * normal);
}

void levels_of(Six wanted, out Real levels[6]) {
  [[unroll]] for (int r = 0; r < 6; ++r) levels[r] = dot6(basis.inverse[r], wanted);
}

// If `anew`: six artificial columns at right angles with equal shares of `wanted`. If `warm`: the last basis for another load, in which a column
// whose level would be negative is replaced by an opposite artificial one. Both have no branches in the wide build, because each would copy the
// basis.
void restart(Six wanted, Real rounding, bool anew, bool warm) {
#if SMALL
  if (!anew && !warm) return;
#endif
  Real size = sqrt(dot6(wanted, wanted));
  Real equal = sqrt(Real(1) / Real(6));
  Six mirror = Six(wanted.first / size - Vec3(equal), wanted.second / size - Vec3(equal));
  Real square = dot6(mirror, mirror);
  Real scale = square > Real(0) ? Real(2) / square : Real(0);
  UNROLL for (int r = 0; r < 6; ++r) {
    Real along = value_of(r, mirror) * scale;
    Six mirrored = times(-along, mirror);
    if (r < 3) {
      mirrored.first[r < 3 ? r : 0] += Real(1);
    } else {
      mirrored.second[r < 3 ? 0 : r - 3] += Real(1);
    }
    bool is_turned = warm && dot6(basis.inverse[r], wanted) < -rounding;
    Real sense = is_turned ? Real(-1) : Real(1);
    basis.is_artificial[r] = basis.is_artificial[r] || is_turned || anew;
    Six before = column(r);
    set_column(r, chosen(anew, mirrored, times(sense, before)), anew || is_turned);
    basis.inverse[r] = chosen(anew, mirrored, times(sense, basis.inverse[r]));
  }
}

Cost cost_of(Real levels[6]) {
  Cost cost = Cost(Real(0), Real(0), Real(0));
  [[unroll]] for (int r = 0; r < 6; ++r) {
    Real level = max(Real(0), levels[r]);
    cost.real += basis.is_artificial[r] ? Real(0) : level;
    cost.artificial += basis.is_artificial[r] ? level : Real(0);
    cost.least = min(cost.least, levels[r]);
  }
  return cost;
}

Six priced(bool is_short) {
  Six direction = Six(Vec3(0), Vec3(0));
  [[unroll]] for (int r = 0; r < 6; ++r) {
    Real cost = basis.is_artificial[r] == is_short ? Real(1) : Real(0);
    direction = plus(direction, cost, basis.inverse[r]);
  }
  return direction;
}

// Without branches, like `restart`; does nothing unless `allowed`. False: no column leaves.
bool enter(Six point, Real levels[6], Real rounding, bool allowed) {
  Real turned[6];
  levels_of(point, turned);
  Real largest = Real(0);
  UNROLL for (int r = 0; r < 6; ++r) largest = max(largest, abs(turned[r]));
  bool has_pivot = false;
  UNROLL for (int r = 0; r < 6; ++r) {
    bool may_be_idle = basis.is_artificial[r] && levels[r] <= rounding;
    has_pivot = has_pivot || (may_be_idle ? abs(turned[r]) : turned[r]) > LEAST_PIVOT * largest;
  }
  int leaves = 6;
  Real least = NO_DISTANCE, pivot = Real(0);
  bool is_artificial = false;
  Six row = Six(Vec3(0), Vec3(0));
  UNROLL for (int r = 0; r < 6; ++r) {
    Real summed = dot(abs(basis.inverse[r].first), abs(point.first)) + dot(abs(basis.inverse[r].second), abs(point.second));
    Real least_pivot = LEAST_PIVOT * (has_pivot ? largest : summed);
    bool is_idle = basis.is_artificial[r] && levels[r] <= rounding && turned[r] < -least_pivot;
    bool may_leave = is_idle || turned[r] > least_pivot;
    Real ratio = is_idle ? Real(0) : max(Real(0), levels[r]) / turned[r];
    bool is_tie = leaves < 6 && abs(ratio - least) <= ROUNDING * least;
    bool is_better = basis.is_artificial[r] != is_artificial ? basis.is_artificial[r] : abs(turned[r]) > abs(pivot);
    bool is_chosen = may_leave && (is_tie ? is_better : ratio < least);
    leaves = is_chosen ? r : leaves;
    least = is_chosen ? ratio : least;
    pivot = is_chosen ? turned[r] : pivot;
    is_artificial = is_chosen ? basis.is_artificial[r] : is_artificial;
    row = chosen(is_chosen, basis.inverse[r], row);
  }
  leaves = allowed ? leaves : 6;
  bool is_found = leaves < 6;
  row = times(is_found ? Real(1) / pivot : Real(0), row);
  UNROLL for (int r = 0; r < 6; ++r) {
    bool is_this = r == leaves;
    Real turn = is_found ? turned[r] : Real(0);
    basis.inverse[r] = chosen(is_this, row, plus(basis.inverse[r], -turn, row));
    basis.is_artificial[r] = !is_this && basis.is_artificial[r];
  }
#if SMALL
  set_column(leaves, point, is_found);
#else
  UNROLL for (int r = 0; r < 6; ++r) set_column(r, point, r == leaves);
#endif
  return is_found;
}

// X + (1 - X B) X of the inverse X, row by row in place: squares the rounding that rank-one updates accumulated, if it is small enough.
void refine() {
  Real most = Real(0);
  UNROLL for (int c = 0; c < 6; ++c) {
    Six point = column(c);
    UNROLL for (int r = 0; r < 6; ++r) most = max(most, abs((r == c ? Real(1) : Real(0)) - dot6(basis.inverse[r], point)));
  }
  Real share = most < Real(0.1) ? Real(1) : Real(0);
  UNROLL for (int r = 0; r < 6; ++r) {
    Six row = basis.inverse[r], refined = row;
    UNROLL for (int c = 0; c < 6; ++c) {
      Real error = share * ((r == c ? Real(1) : Real(0)) - dot6(row, column(c)));
      refined = plus(refined, error, basis.inverse[c]);
    }
    basis.inverse[r] = refined;
  }
}

// Includes what the inverse's rounding leaves unbalanced.
void balanced_levels(Six wanted, out Real levels[6]) {
  levels_of(wanted, levels);
  Six rest = wanted;
  UNROLL for (int r = 0; r < 6; ++r) rest = plus(rest, -levels[r], column(r));
  Real more[6];
  levels_of(rest, more);
  UNROLL for (int r = 0; r < 6; ++r) levels[r] += more[r];
}

#endif
