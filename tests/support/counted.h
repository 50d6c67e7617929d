// SPDX-License-Identifier: MIT
// A double that counts what is done with it: core/ compiled with it as its Real (core_counted) counts how many floating-point operations
// a kernel takes. Values and branches are those of double, to the bit; the test Counted.* holds it to that.
//
// Operations count as the source asks for them, in the thread that does them. The compiler of the product may do fewer: it folds constants
// and shares what is common. What constants are made of (constexpr) does not count, and neither do conversions, signs and absolute values.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace wholehand {

struct OperationCounts {
  std::uint64_t additions = 0, multiplications = 0;  // a difference is an addition
  std::uint64_t divisions = 0, roots = 0;
  std::uint64_t transcendentals = 0;  // sine, cosine, arc cosine, arc tangent: one each, whatever it takes
  std::uint64_t comparisons = 0;      // minima and maxima too; no floating-point operations of a roofline

  // One each.
  std::uint64_t operations() const { return additions + multiplications + divisions + roots + transcendentals; }

  OperationCounts& operator+=(const OperationCounts& other);
  OperationCounts operator-(const OperationCounts& other) const;
  bool operator==(const OperationCounts&) const = default;
};

// Operations of this thread so far.
inline constinit thread_local OperationCounts operations_so_far{};

// Trivial as double is, so that it fits into unions of glm and is not initialized where a double would not be.
struct Counted {
  double value;

  Counted() = default;
  template <class Number>
  requires std::is_arithmetic_v<Number>
  constexpr Counted(Number number) : value(static_cast<double>(number)) {}
  // Only double itself is reached without a cast: otherwise `condition ? real : 0` had two answers.
  template <class Number>
  requires std::is_arithmetic_v<Number>
  constexpr explicit(!std::is_same_v<Number, double>) operator Number() const { return static_cast<Number>(value); }

  constexpr Counted operator-() const { return -value; }
  constexpr Counted operator+() const { return value; }
  constexpr Counted& operator+=(Counted other) { return *this = *this + other; }
  constexpr Counted& operator-=(Counted other) { return *this = *this - other; }
  constexpr Counted& operator*=(Counted other) { return *this = *this * other; }
  constexpr Counted& operator/=(Counted other) { return *this = *this / other; }

  static constexpr void count(std::uint64_t OperationCounts::*kind) {
    if (!std::is_constant_evaluated()) ++(operations_so_far.*kind);
  }

  friend constexpr Counted operator+(Counted a, Counted b) {
    count(&OperationCounts::additions);
    return a.value + b.value;
  }
  friend constexpr Counted operator-(Counted a, Counted b) {
    count(&OperationCounts::additions);
    return a.value - b.value;
  }
  friend constexpr Counted operator*(Counted a, Counted b) {
    count(&OperationCounts::multiplications);
    return a.value * b.value;
  }
  friend constexpr Counted operator/(Counted a, Counted b) {
    count(&OperationCounts::divisions);
    return a.value / b.value;
  }
  friend constexpr bool operator==(Counted a, Counted b) {
    count(&OperationCounts::comparisons);
    return a.value == b.value;
  }
  friend constexpr bool operator<(Counted a, Counted b) {
    count(&OperationCounts::comparisons);
    return a.value < b.value;
  }
  friend constexpr bool operator>(Counted a, Counted b) { return b < a; }
  friend constexpr bool operator<=(Counted a, Counted b) {
    count(&OperationCounts::comparisons);
    return a.value <= b.value;
  }
  friend constexpr bool operator>=(Counted a, Counted b) { return b <= a; }
};
static_assert(std::is_trivial_v<Counted> && sizeof(Counted) == sizeof(double));

// A plain number on either side: otherwise the built-in operators of double would do as well.
#define WHOLEHAND_MIXED_OPERATOR(result, op)                                    \
  template <class Number>                                                       \
  requires std::is_arithmetic_v<Number>                                         \
  constexpr result operator op(Counted a, Number b) { return a op Counted(b); } \
  template <class Number>                                                       \
  requires std::is_arithmetic_v<Number>                                         \
  constexpr result operator op(Number a, Counted b) { return Counted(a) op b; }
WHOLEHAND_MIXED_OPERATOR(Counted, +)
WHOLEHAND_MIXED_OPERATOR(Counted, -)
WHOLEHAND_MIXED_OPERATOR(Counted, *)
WHOLEHAND_MIXED_OPERATOR(Counted, /)
WHOLEHAND_MIXED_OPERATOR(bool, <)
WHOLEHAND_MIXED_OPERATOR(bool, >)
WHOLEHAND_MIXED_OPERATOR(bool, <=)
WHOLEHAND_MIXED_OPERATOR(bool, >=)
#undef WHOLEHAND_MIXED_OPERATOR
template <class Number>
requires std::is_arithmetic_v<Number>
constexpr bool operator==(Counted a, Number b) { return a == Counted(b); }

inline OperationCounts& OperationCounts::operator+=(const OperationCounts& other) {
  additions += other.additions;
  multiplications += other.multiplications;
  divisions += other.divisions;
  roots += other.roots;
  transcendentals += other.transcendentals;
  comparisons += other.comparisons;
  return *this;
}

inline OperationCounts OperationCounts::operator-(const OperationCounts& other) const {
  return {additions - other.additions, multiplications - other.multiplications, divisions - other.divisions,
          roots - other.roots,         transcendentals - other.transcendentals, comparisons - other.comparisons};
}

inline Counted sqrt(Counted x) {
  Counted::count(&OperationCounts::roots);
  return std::sqrt(x.value);
}
inline Counted abs(Counted x) { return std::abs(x.value); }
inline Counted floor(Counted x) { return std::floor(x.value); }
#define WHOLEHAND_COUNTED_FUNCTION(name)               \
  inline Counted name(Counted x) {                     \
    Counted::count(&OperationCounts::transcendentals); \
    return std::name(x.value);                         \
  }
WHOLEHAND_COUNTED_FUNCTION(sin)
WHOLEHAND_COUNTED_FUNCTION(cos)
WHOLEHAND_COUNTED_FUNCTION(acos)
WHOLEHAND_COUNTED_FUNCTION(atan)
#undef WHOLEHAND_COUNTED_FUNCTION

}  // namespace wholehand

namespace std {

template <>
struct numeric_limits<wholehand::Counted> : numeric_limits<double> {
  static constexpr wholehand::Counted min() { return numeric_limits<double>::min(); }
  static constexpr wholehand::Counted max() { return numeric_limits<double>::max(); }
  static constexpr wholehand::Counted lowest() { return numeric_limits<double>::lowest(); }
  static constexpr wholehand::Counted epsilon() { return numeric_limits<double>::epsilon(); }
  static constexpr wholehand::Counted infinity() { return numeric_limits<double>::infinity(); }
  static constexpr wholehand::Counted quiet_NaN() { return numeric_limits<double>::quiet_NaN(); }
};

// The core calls these by their full names, so they must be here. The standard leaves overloads in std undefined; GCC and clang take them.
// Without them its calls would convert to double, and count nothing.
using wholehand::abs;
using wholehand::acos;
using wholehand::atan;
using wholehand::cos;
using wholehand::floor;
using wholehand::sin;
using wholehand::sqrt;

}  // namespace std
