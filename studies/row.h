// SPDX-License-Identifier: MIT
// One statistic of a study, as the table, the dataset and the page have it.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "statistics/interval.h"

namespace wholehand {

struct StudyRow {
  std::string experiment, pose, vessel;
  std::string statistic, subject;                           // subject: the point of the hand; empty: the whole hand
  double value = std::numeric_limits<double>::quiet_NaN();  // of the population; NaN: there is none
  Interval interval;                                        // of 95 %, at the paper's sample size; NaN: there is none
  std::optional<double> paper;                              // absent: not known here

  // Whether the paper's value is in the interval; absent without a value or an interval.
  std::optional<bool> inside() const {
    if (!paper || !(interval.low <= interval.high)) return std::nullopt;
    return interval.low <= *paper && *paper <= interval.high;
  }
};

}  // namespace wholehand
