// SPDX-License-Identifier: MIT
// Correlations against closed forms, sums in long double, and scipy.
// sanitizers: address
#include "base/statistics/correlation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/statistics/moments.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

// Some roundings of numbers near 1.
constexpr double ROUNDING = 1e-12;

// Two passes in long double, from the definition.
double reference_r(const std::vector<double>& x, const std::vector<double>& y) {
  long double mean_x = 0, mean_y = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i];
    mean_y += y[i];
  }
  mean_x /= static_cast<long double>(x.size());
  mean_y /= static_cast<long double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return static_cast<double>(xy / std::sqrt(xx * yy));
}

TEST(Pearson, OfALineIsOne) {
  const std::vector<double> x{0, 1, 2, 5}, up{3, 5, 7, 13}, down{4, 3, 2, -1};
  EXPECT_NEAR(*pearson(x, up).r, 1, ROUNDING);
  EXPECT_NEAR(*pearson(x, down).r, -1, ROUNDING);
}

TEST(Pearson, OfKnownPairs) {
  // sums of squares 10 and 10, of products 8
  EXPECT_NEAR(*pearson(std::vector<double>{1, 2, 3, 4, 5}, std::vector<double>{2, 1, 4, 3, 5}).r, 0.8, ROUNDING);
  // symmetric about the middle
  EXPECT_NEAR(*pearson(std::vector<double>{-1, 0, 1}, std::vector<double>{1, 0, 1}).r, 0, ROUNDING);
}

TEST(Pearson, IsTheDefinitionsOnRandomPairs) {
  Random random(3);
  for (const double far : {0.0, 1e3}) {
    std::vector<double> x, y;
    for (int i = 0; i < 2000; ++i) {
      x.push_back(far + random.uniform(0, 1));
      y.push_back(0.3 * x.back() + random.uniform(-1, 1));
    }
    // deviations of a thousandth of the values lose three digits
    EXPECT_NEAR(*pearson(x, y).r, reference_r(x, y), 1e-11);
  }
}

TEST(Pearson, OfWhatDoesNotVaryThereIsNone) {
  const std::vector<double> x{1, 2, 3}, same{0.1, 0.1, 0.1}, nearly{0.1, 0.1 + 1e-12, 0.1};
  for (const auto& flat : {same, nearly}) {
    EXPECT_FALSE(pearson(flat, x).r);
    EXPECT_FALSE(pearson(x, flat).r);
    EXPECT_NE(pearson(x, flat).lack, Lack::none);
  }
  const std::vector<double> two{1, 2};
  EXPECT_FALSE(pearson(two, two).r);
  EXPECT_FALSE(pearson({}, {}).r);
}

TEST(PointBiserial, OfKnownGroups) {
  // means 2.5 and 0.5, deviation sqrt(1.25), shares a half each
  EXPECT_NEAR(*point_biserial(std::vector<double>{0, 1, 2, 3}, std::vector<char>{0, 0, 1, 1}).r, 2 / std::sqrt(1.25) * 0.5,
              ROUNDING);
  // one yes of four at 4, the others at 0: 4 / sqrt(3) sqrt(3) / 4
  EXPECT_NEAR(*point_biserial(std::vector<double>{4, 0, 0, 0}, std::vector<char>{1, 0, 0, 0}).r, 1, ROUNDING);
  EXPECT_NEAR(*point_biserial(std::vector<double>{1, 3, 1, 3}, std::vector<char>{1, 1, 0, 0}).r, 0, ROUNDING);
}

TEST(PointBiserial, IsPearsonsOfZeroAndOne) {
  Random random(5);
  for (const double share : {0.01, 0.3, 0.98}) {
    std::vector<double> x, number;
    std::vector<char> yes;
    for (int i = 0; i < 3000; ++i) {
      yes.push_back(random.uniform(0, 1) < share ? 1 : 0);
      number.push_back(yes.back());
      x.push_back(random.uniform(0, 0.05) + 0.01 * number.back());
    }
    EXPECT_NEAR(*point_biserial(x, yes).r, reference_r(x, number), 1e-11) << share;
    EXPECT_NEAR(*point_biserial(x, yes).r, *pearson(x, number).r, 1e-11) << share;
  }
}

TEST(PointBiserial, TurnsWithTheSignAndKeepsItsSizeUnderScale) {
  const std::vector<double> x{1, 4, 2, 8, 5, 7};
  const std::vector<char> yes{0, 1, 0, 1, 1, 0}, no{1, 0, 1, 0, 0, 1};
  std::vector<double> scaled;
  for (const double value : x) scaled.push_back(1e-3 * value + 0.2);
  EXPECT_NEAR(*point_biserial(x, yes).r, -*point_biserial(x, no).r, ROUNDING);
  EXPECT_NEAR(*point_biserial(x, yes).r, *point_biserial(scaled, yes).r, 1e-11);
}

TEST(PointBiserial, OfAlwaysAndNeverThereIsNone) {
  const std::vector<double> x{1, 2, 3}, flat{2, 2, 2};
  EXPECT_EQ(point_biserial(x, std::vector<char>{1, 1, 1}).lack, Lack::always);
  EXPECT_EQ(point_biserial(x, std::vector<char>{0, 0, 0}).lack, Lack::never);
  EXPECT_EQ(point_biserial(flat, std::vector<char>{0, 1, 0}).lack, Lack::one_x);
  EXPECT_FALSE(point_biserial(std::vector<double>{1, 2}, std::vector<char>{0, 1}).r);
}

// scipy.stats.pearsonr and pointbiserialr
TEST(Pearson, OfAnotherProgram) {
  const std::vector<double> x{0.3, 1.2, 2.5, 2.2, 4.1, 3.3, 5.0}, y{1.1, 0.7, 2.4, 1.9, 2.2, 3.6, 2.9};
  const double r = *pearson(x, y).r;
  EXPECT_NEAR(r, 0.7609104023395881, 1e-14);
  EXPECT_NEAR(correlation_p(r, 7), 0.04697165081846363, 1e-12);
  EXPECT_NEAR(correlation_interval(r, 7).low, 0.0183898647677801, 1e-12);
  EXPECT_NEAR(correlation_interval(r, 7).high, 0.9624660703372595, 1e-12);
  const double biserial = *point_biserial(x, std::vector<char>{0, 0, 1, 0, 1, 1, 1}).r;
  EXPECT_NEAR(biserial, 0.8182236096504476, 1e-14);
  EXPECT_NEAR(correlation_p(biserial, 7), 0.02447035023287879, 1e-12);
  const double weak = *pearson(x, std::vector<double>{-0.1, 0.2, -0.3, 0.4, -0.2, 0.1, 0.05}).r;
  EXPECT_NEAR(correlation_p(weak, 7), 0.7866191827378463, 1e-12);
}

TEST(Pearson, HasNoIntervalOfAFewPairs) {
  EXPECT_TRUE(std::isnan(correlation_interval(0.5, 3).low));
  EXPECT_TRUE(std::isnan(correlation_p(0.5, 2)));
  EXPECT_EQ(correlation_p(1, 5), 0);
}

TEST(Moments, OfKnownNumbers) {
  const std::vector<double> values{2, 4, 4, 4, 5, 5, 7, 9};
  EXPECT_EQ(mean_of(values), 5);
  EXPECT_NEAR(deviation_of(values), std::sqrt(32.0 / 7), 1e-15);
  EXPECT_TRUE(std::isnan(mean_of({})));
  EXPECT_TRUE(std::isnan(deviation_of(std::vector<double>{1})));
}

}  // namespace
}  // namespace wholehand
