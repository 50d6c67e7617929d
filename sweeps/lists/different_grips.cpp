// SPDX-License-Identifier: MIT
#include "sweeps/lists/different_grips.h"

#include <algorithm>
#include <cmath>

#include "core/joints.h"

namespace wholehand::sweeps {
namespace {

constexpr int SORTED_BY = finger_start(2) + 1;  // joint by whose cell hands are found: any one would do
constexpr double CELL = 1.001;                  // times `apart`: hands that are near have cells side by side, rounding or not
constexpr double SMALLEST_CELL = 1e-3;          // m
constexpr double LARGEST_PLACE = 1e9;           // m; cells beyond would have no number

bool differ(const PosedHand& a, const PosedHand& b, double apart) {
  for (std::size_t j = 0; j < a.size(); ++j) {
    const double x = a[j][0] - b[j][0], y = a[j][1] - b[j][1], z = a[j][2] - b[j][2];
    if (x * x + y * y + z * z > apart * apart) return true;
  }
  return false;
}

}  // namespace

bool are_different(const std::optional<PosedHand>& a, const std::optional<PosedHand>& b, double apart) {
  return apart == 0 || !a || !b || differ(*a, *b, apart);
}

DifferentGrips::Cell DifferentGrips::cell_of(const PosedHand& hand) const {
  const double side = CELL * std::max(apart_, SMALLEST_CELL);
  Cell cell;
  for (std::size_t k = 0; k < cell.size(); ++k)
    cell[k] = static_cast<std::int64_t>(std::floor(std::clamp(hand[SORTED_BY][k], -LARGEST_PLACE, LARGEST_PLACE) / side));
  return cell;
}

bool DifferentGrips::differs(const std::optional<PosedHand>& hand) const {
  if (apart_ == 0 || !hand) return true;
  const Cell own = cell_of(*hand);
  for (std::int64_t x = own[0] - 1; x <= own[0] + 1; ++x)
    for (std::int64_t y = own[1] - 1; y <= own[1] + 1; ++y)
      for (std::int64_t z = own[2] - 1; z <= own[2] + 1; ++z) {
        const auto there = hands_.find({x, y, z});
        if (there == hands_.end()) continue;
        for (const PosedHand& other : there->second)
          if (!differ(*hand, other, apart_)) return false;
      }
  return true;
}

void DifferentGrips::offer(const Candidate& candidate, const std::optional<PosedHand>& hand) {
  if (is_full() || !differs(hand)) return;
  chosen_.push_back(candidate);
  if (hand && apart_ > 0) hands_[cell_of(*hand)].push_back(*hand);
}

}  // namespace wholehand::sweeps
