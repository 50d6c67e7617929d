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

// The statistics that a box plot shows.
struct Box {
  static constexpr std::size_t MOST_OUTLIERS = 60;

  std::size_t count = 0;  // number of values; if 0, the other members have no meaning
  double lower_quartile = 0, median = 0, upper_quartile = 0;
  double low = 0, high = 0;         // ends of the whiskers
  std::vector<double> outliers{};   // beyond the whiskers, ascending; if there are many, MOST_OUTLIERS evenly spread ones
  std::size_t outliers_beside = 0;  // outliers omitted from `outliers`
};

// Values may come in any order; values that are not finite are ignored. Quartiles use percentile_of (base/statistics/interval.h). A whisker ends at
// the furthest value within 1.5 interquartile ranges of its quartile, or at the quartile if no value lies beyond it.
Box box_of(std::span<const double> values);

// Groups side by side. The page needs BOX_RULES (base/charts/style.h).
struct BoxChart {
  ChartName name;       // its description lists each group's numbers for screen readers
  std::string y_label;  // with its unit
  std::string mark;     // what a mark means: "paper: mean and SD". Not drawn if no group has one
  struct Mark {
    double mean = 0;
    double deviation = std::numeric_limits<double>::quiet_NaN();  // half of the bar's length; NaN: no bar
  };
  struct Group {
    std::string label;  // long labels are slanted, and then cut
    Box box;
    std::optional<Mark> mark{};  // beside the box
  };
  std::vector<Group> groups;
};
void write_chart(MarkupWriter& svg, const BoxChart& chart);

}  // namespace wholehand
