// SPDX-License-Identifier: MIT
// Conditions on grips as text: "fingers_used >= 4 and palm_depth_mm < 2".
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace wholehand::sweeps {

enum class WhereKind { number, truth, mask };  // truth: 0 or 1; mask: bits of a whole number
enum class WhereUnit { own, mm, deg };         // of the numbers that a name is compared with; own: the value's unit

// A name that a condition may use.
struct WhereName {
  std::string name;   // with its unit, if that is not the value's own: "gap", "gap_mm"
  std::string units;  // of the value itself: "m"
  WhereKind kind = WhereKind::number;
  WhereUnit unit = WhereUnit::own;
  std::string over;        // what a grip's several values range over ("fill"): then it must be in min() or max(); empty: one value
  std::string refusal;     // why it is not available; empty: it is
  std::size_t source = 0;  // the caller's own number of the value
};

enum class WhereFold { none, least, largest };  // of several values; NaN if one of them is

// A value that a condition needs for each grip.
struct WhereValue {
  std::size_t source = 0;
  WhereFold fold = WhereFold::none;
  bool operator==(const WhereValue&) const = default;
};

// Grammar, from the weakest to the strongest binding: or; and; not; < <= > >= == != (two values, once); & (a mask and a whole number). A name of kind
// truth or mask alone, or a masked one, is also a condition: not 0. Parentheses, min(name), max(name), numbers, inf. A comparison with a missing
// value (NaN) is false.
class Where {
 public:
  // All of the conditions `texts` (one at least). Throws Error (usage), "--where, column 7: ..": what is wrong there, and what is known.
  Where(const std::vector<std::string>& texts, const std::vector<WhereName>& names);

  const std::vector<WhereValue>& values() const { return values_; }        // each once
  bool holds(const double* values) const { return holds(root_, values); }  // one for each of values(), in their own units

 private:
  friend class WhereParser;
  enum class Operation { both, either, negation, less, at_most, more, at_least, equal, unequal, truth };

  // One side of a comparison.
  struct Operand {
    int value = -1;  // index in values_; -1: the number
    double number = 0;
    std::uint32_t mask = ~std::uint32_t{0};
    bool is_masked = false;
  };
  struct Node {
    Operation operation = Operation::truth;
    int first = -1, second = -1;  // nodes of both, either, negation
    Operand left, right;          // of the others
  };

  bool holds(int node, const double* values) const;
  static double number_of(const Operand& operand, const double* values);

  std::vector<WhereValue> values_;
  std::vector<Node> nodes_;
  int root_ = -1;
};

}  // namespace wholehand::sweeps
