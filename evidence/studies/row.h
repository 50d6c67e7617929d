// SPDX-License-Identifier: MIT
// One statistic of a study, as stored in the table, the dataset and the page.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include "base/statistics/interval.h"

namespace wholehand {

// What a statistic is taken over.
struct StudyCount {
  std::optional<std::uint64_t> people{};
  std::optional<std::uint64_t> grasps{};  // absent: the statistic is not of single grasps

  // Adds one person with so many grasps that count; 0: the person does not count either.
  void add_person(std::uint64_t grasps_of_person) {
    people = people.value_or(0) + (grasps_of_person > 0 ? 1 : 0);
    grasps = grasps.value_or(0) + grasps_of_person;
  }
};

// What the order of grasps may change in a share of them: the paper's 7/71 is inside an interval that ends there.
constexpr double SHARE_ROUNDING = 1e-9;

struct StudyRow {
  std::string experiment, pose, vessel;
  std::string statistic, subject;  // subject: what it applies to, such as a point of the hand or a choice of forces; empty: all
  double value = std::numeric_limits<double>::quiet_NaN();  // of the population; NaN: there is none
  Interval interval;                                        // of 95 %, at the paper's sample size; NaN: there is none
  std::optional<double> paper;                              // absent: not known here
  StudyCount count{};                                       // behind the value

  // Whether the paper's value is in the interval; absent without a value or an interval.
  std::optional<bool> inside() const {
    if (!paper || !(interval.low <= interval.high)) return std::nullopt;
    return interval.low - SHARE_ROUNDING <= *paper && *paper <= interval.high + SHARE_ROUNDING;
  }

  // What would have to be added to the paper's value to bring it to the nearer end of the interval: 0 if it is inside; absent as in inside().
  std::optional<double> off() const {
    const std::optional<bool> is_inside = inside();
    if (!is_inside) return std::nullopt;
    return *is_inside ? 0 : (*paper < interval.low ? interval.low : interval.high) - *paper;
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
