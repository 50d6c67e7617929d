// SPDX-License-Identifier: MIT
// Percentiles of times without storing the times: counts in bins of equal ratio.
#pragma once

#include <array>
#include <cstdint>

namespace wholehand::device {

// Times from 1 ns to an hour, to 1/1024 of each. Neither allocates nor throws.
class Histogram {
 public:
  void add(double seconds) noexcept;
  // The least time that a share of all times (0..1) does not exceed, as the middle of its bin; s. 0 if there are none.
  double quantile(double share) const noexcept;
  double largest() const noexcept { return largest_; }  // exact
  std::uint64_t count() const noexcept { return count_; }

 private:
  static constexpr int PARTS = 1024, OCTAVES = 42;  // 2^42 ns: more than an hour
  std::array<std::uint64_t, PARTS * OCTAVES> bins_{};
  std::uint64_t count_ = 0;
  double largest_ = 0;
};

}  // namespace wholehand::device
