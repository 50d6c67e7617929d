// SPDX-License-Identifier: MIT
// The correlation of pairs that come one by one; none is stored.
#pragma once

#include <cstddef>

#include "base/statistics/correlation.h"

namespace wholehand {

// Moments of pairs by Welford's updates. The same pairs in the same order give the same bits.
class RunningCorrelation {
 public:
  // `least_x`: how far apart the first numbers must lie to count as varying, in their unit, for numbers with an error of their own.
  explicit RunningCorrelation(double least_x = 0) : least_x_(least_x) {}

  void add(double x, double y);
  // Adds all pairs of another object, each as if it came `weight` (above 0) times. By Chan, Golub & LeVeque 1983 (Am. Stat. 37:242).
  void add(const RunningCorrelation& other, double weight);

  std::size_t pairs() const { return pairs_; }  // whatever their weight
  // Mean of the second numbers; NaN if there are none.
  double mean_y() const;

  // Equal pearson and point_biserial of the same pairs, to rounding. For the latter each y is 0 or 1.
  Correlation pearson() const;
  Correlation point_biserial() const;

 private:
  struct Side {
    double mean = 0, squares = 0;  // sum of squares about the mean
    double low = 0, high = 0;
    void widen(double value, bool is_first);
    void widen(const Side& other, bool is_first);
    bool varies() const;
  };

  double least_x_;
  std::size_t pairs_ = 0;
  double weight_ = 0;  // of all pairs
  Side x_, y_;
  double products_ = 0;  // about both means
};

}  // namespace wholehand
