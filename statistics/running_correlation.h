// SPDX-License-Identifier: MIT
// The correlation of pairs that come one by one: none of them is kept.
#pragma once

#include <cstddef>

#include "statistics/correlation.h"

namespace wholehand {

// Moments of pairs by Welford's updates. The same pairs in the same order give the same bits.
class RunningCorrelation {
 public:
  void add(double x, double y);

  std::size_t pairs() const { return pairs_; }
  // Of the second ones; NaN of none.
  double mean_y() const;

  // As pearson and point_biserial of the same pairs, to rounding. For the latter each y is 0 or 1.
  Correlation pearson() const;
  Correlation point_biserial() const;

 private:
  struct Side {
    double mean = 0, squares = 0;  // sum of squares about the mean
    double low = 0, high = 0;
    void widen(double value, bool is_first);
    bool varies() const;
  };

  std::size_t pairs_ = 0;
  Side x_, y_;
  double products_ = 0;  // about both means
};

}  // namespace wholehand
