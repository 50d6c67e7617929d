// SPDX-License-Identifier: MIT
#include "core/extreme_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wholehand {
namespace {

constexpr std::size_t SHARE_ROWS = 6;  // five coordinates, and the sum of the shares
constexpr int SHARE_ROUNDS = 60;       // of points that enter; then the point counts as extreme
constexpr double LEAST_REST = 1e-9;    // of the largest point

using ShareRow = std::array<double, SHARE_ROWS>;

double product(const ShareRow& a, const ShareRow& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

// Shares of the columns that come closest to `wanted`, by orthogonal directions. Empty: the columns depend on each other.
std::vector<double> closest_shares(const std::vector<ShareRow>& columns, ShareRow wanted) {
  const std::size_t count = columns.size();
  std::vector<ShareRow> directions = columns;
  std::vector<std::vector<double>> upper(count, std::vector<double>(count, 0.0));
  std::vector<double> shares(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int twice = 0; twice < 2; ++twice)
      for (std::size_t k = 0; k < i; ++k) {
        const double along = product(directions[k], directions[i]);
        upper[k][i] += along;
        for (std::size_t r = 0; r < SHARE_ROWS; ++r) directions[i][r] -= along * directions[k][r];
      }
    upper[i][i] = std::sqrt(product(directions[i], directions[i]));
    if (!(upper[i][i] > 1e-12)) return {};
    for (double& value : directions[i]) value /= upper[i][i];
    shares[i] = product(directions[i], wanted);
    for (std::size_t r = 0; r < SHARE_ROWS; ++r) wanted[r] -= shares[i] * directions[i][r];
  }
  for (std::size_t i = count; i-- > 0;) {
    for (std::size_t k = i + 1; k < count; ++k) shares[i] -= upper[i][k] * shares[k];
    shares[i] /= upper[i][i];
  }
  return shares;
}

// Least squares with nonnegative shares (Lawson and Hanson 1974): columns enter while one has a part in the rest, and leave if their share would be
// negative.
bool is_sum_of(const std::vector<ShareRow>& columns, const std::vector<std::size_t>& kept, std::size_t point) {
  std::vector<std::size_t> used;
  std::vector<double> shares;
  ShareRow rest = columns[point];
  const ShareRow origin{0, 0, 0, 0, 0, 1};
  const auto column = [&](std::size_t i) { return i == columns.size() ? origin : columns[i]; };
  for (int round = 0; round < SHARE_ROUNDS; ++round) {
    if (std::sqrt(product(rest, rest)) <= LEAST_REST) return true;
    std::size_t best = columns.size() + 1;
    double most = 0;
    const auto look = [&](std::size_t i) {
      const ShareRow candidate = column(i);
      const double part = product(candidate, rest) / std::sqrt(product(candidate, candidate));
      if (i == point || !(part > most) || std::find(used.begin(), used.end(), i) != used.end()) return;
      most = part;
      best = i;
    };
    for (const std::size_t i : kept) look(i);
    look(columns.size());
    if (best > columns.size() || used.size() == SHARE_ROWS) return false;
    used.push_back(best);
    shares.push_back(0);
    for (;;) {
      std::vector<ShareRow> chosen;
      for (const std::size_t i : used) chosen.push_back(column(i));
      const std::vector<double> wanted = closest_shares(chosen, columns[point]);
      if (wanted.empty()) return false;
      double step = 1;
      for (std::size_t i = 0; i < used.size(); ++i)
        if (wanted[i] < 0) step = std::min(step, shares[i] / (shares[i] - wanted[i]));
      for (std::size_t i = 0; i < used.size(); ++i) shares[i] += step * (wanted[i] - shares[i]);
      if (step == 1) break;
      const std::size_t before = used.size();
      for (std::size_t i = used.size(); i-- > 0;) {
        if (shares[i] > 1e-15) continue;
        used.erase(used.begin() + static_cast<std::ptrdiff_t>(i));
        shares.erase(shares.begin() + static_cast<std::ptrdiff_t>(i));
      }
      if (used.size() == before) return false;
    }
    rest = columns[point];
    for (std::size_t i = 0; i < used.size(); ++i)
      for (std::size_t r = 0; r < SHARE_ROWS; ++r) rest[r] -= shares[i] * column(used[i])[r];
  }
  return false;
}

}  // namespace

std::vector<std::size_t> extreme_points(const std::vector<Point5>& points) {
  double largest = 0;
  for (const Point5& point : points) {
    double square = 0;
    for (const double value : point) square += value * value;
    largest = std::max(largest, std::sqrt(square));
  }
  std::vector<ShareRow> columns;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    ShareRow& column = columns.emplace_back(ShareRow{0, 0, 0, 0, 0, 1});
    bool is_zero = true;
    for (std::size_t k = 0; k < points[i].size(); ++k) {
      column[k] = largest > 0 ? points[i][k] / largest : 0;
      is_zero = is_zero && column[k] == 0;
    }
    if (!is_zero) kept.push_back(i);
  }
  if (kept.size() > MOST_EXTREME) return kept;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::find(kept.begin(), kept.end(), i) != kept.end() && is_sum_of(columns, kept, i)) std::erase(kept, i);
  return kept;
}

}  // namespace wholehand
