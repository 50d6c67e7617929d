// SPDX-License-Identifier: MIT
// One statistic of a study, as stored in the table, the dataset and the page.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include "base/statistics/interval.h"

namespace wholehand {

struct StudyRow {
  std::string experiment, pose, vessel;
  std::string statistic, subject;  // subject: what it applies to, such as a point of the hand or a choice of forces; empty: all
  double value = std::numeric_limits<double>::quiet_NaN();  // of the population; NaN: there is none
  Interval interval;                                        // of 95 %, at the paper's sample size; NaN: there is none
  std::optional<double> paper;                              // absent: not known here

  // Whether the paper's value is in the interval; absent without a value or an interval.
  std::optional<bool> inside() const {
    if (!paper || !(interval.low <= interval.high)) return std::nullopt;
    return interval.low <= *paper && *paper <= interval.high;
  }
};

// Rows whose interval contains the paper's value, among the rows that have both.
struct InsideCount {
  std::size_t inside = 0, of = 0;
};
InsideCount count_inside(std::span<const StudyRow> rows);

// Their share; NaN if no row has both.
double inside_share(std::span<const StudyRow> rows);
inline constexpr const char* INSIDE_SHARE = "inside_share";  // the statistic of the row that contains it

}  // namespace wholehand
