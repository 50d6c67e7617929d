// SPDX-License-Identifier: MIT
#include "sweeps/cluster/work_range.h"

#include <algorithm>
#include <utility>

namespace wholehand::sweeps {
namespace {

constexpr std::uint64_t LEAST = 1024;       // grips: what a device takes as a first chunk
constexpr double ELAPSED_SHARE = 1.0 / 64;  // later pieces are longer: each takes a line in the mark
constexpr std::uint64_t SHARES = 4;         // of what is left, each rank takes at most 1 / (4 ranks)

}  // namespace

WorkRange::WorkRange(std::vector<GripRange> left) : left_(std::move(left)) {
  for (const GripRange& range : left_) size_ += range.last - range.first;
}

std::vector<GripRange> WorkRange::piece(std::uint64_t first, std::uint64_t count) const {
  std::vector<GripRange> piece;
  const std::uint64_t last = std::min(size_, first + count);
  std::uint64_t before = 0;
  for (const GripRange& range : left_) {
    const std::uint64_t after = before + range.last - range.first;
    const std::uint64_t from = std::max(first, before), to = std::min(last, after);
    if (from < to) piece.push_back({range.vessel, range.first + from - before, range.first + to - before});
    before = after;
  }
  return piece;
}

std::uint64_t PieceSize::next(std::uint64_t left, double elapsed) const {
  double seconds = std::max(seconds_, elapsed * ELAPSED_SHARE);
  // A rank requests a piece before it computes the previous one. A slow rank would end after the others if it took a share of the grips, so it takes
  // a share of the time that all need for the rest.
  if (left < all_) seconds = std::min(seconds, elapsed * static_cast<double>(left) / static_cast<double>(all_ - left) / SHARES);
  const auto at_rate = static_cast<std::uint64_t>(std::min(rate_ * seconds, 1e15));
  const std::uint64_t share = left / (SHARES * static_cast<std::uint64_t>(ranks_));
  return std::max(LEAST, std::min(at_rate, share));
}

void PieceSize::done(std::uint64_t grips, double seconds) {
  if (grips > 0 && seconds > 0) rate_ = static_cast<double>(grips) / seconds;
}

}  // namespace wholehand::sweeps
