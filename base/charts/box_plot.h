// SPDX-License-Identifier: MIT
// A chart: how the values of groups scatter, as box plots (Tukey 1977).
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/charts/axes.h"

namespace wholehand {

// What a box plot shows of values.
struct Box {
  static constexpr std::size_t MOST_OUTLIERS = 60;

  std::size_t count = 0;  // of the values; 0: all else has no meaning
  double lower_quartile = 0, median = 0, upper_quartile = 0;
  double low = 0, high = 0;         // ends of the whiskers
  std::vector<double> outliers{};   // beyond the whiskers, ascending; of many, MOST_OUTLIERS that are evenly spread among them
  std::size_t outliers_beside = 0;  // those that are left out of `outliers`
};

// Values come in any order; those that are not finite do not count. Quartiles are by percentile_of (base/statistics/interval.h). A whisker
// ends at the furthest value within 1.5 interquartile ranges of its quartile, or at the quartile where no value lies beyond it.
Box box_of(std::span<const double> values);

// Groups side by side. The page needs BOX_RULES (base/charts/style.h).
struct BoxChart {
  ChartName name;       // its description gets the numbers of each group, for those who do not see them
  std::string y_label;  // with its unit
  std::string mark;     // what a mark means: "paper: mean and SD". Not drawn where no group has one
  struct Mark {
    double mean = 0;
    double deviation = std::numeric_limits<double>::quiet_NaN();  // half of its bar; NaN: it has none
  };
  struct Group {
    std::string label;  // too long ones are slanted, and then cut
    Box box;
    std::optional<Mark> mark{};  // beside the box
  };
  std::vector<Group> groups;
};
void write_chart(MarkupWriter& svg, const BoxChart& chart);

}  // namespace wholehand
