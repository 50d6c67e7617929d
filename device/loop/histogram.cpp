// SPDX-License-Identifier: MIT
#include "device/loop/histogram.h"

#include <algorithm>
#include <cmath>

namespace wholehand::device {

// Nanoseconds as 2^octave (1 + part / PARTS).
void Histogram::add(double seconds) noexcept {
  // a time that is no number counts as the least
  const double nanoseconds = seconds * 1e9 >= 1 ? std::min(seconds * 1e9, std::ldexp(1.0, OCTAVES) - 1) : 1;
  int exponent = 0;
  const double mantissa = std::frexp(nanoseconds, &exponent);  // in [0.5, 1)
  const int octave = exponent - 1;
  const int part = static_cast<int>((2 * mantissa - 1) * PARTS);
  ++bins_[static_cast<std::size_t>(octave * PARTS + part)];
  ++count_;
  largest_ = std::max(largest_, seconds);
}

double Histogram::quantile(double share) const noexcept {
  if (count_ == 0) return 0;
  const auto wanted = static_cast<std::uint64_t>(std::ceil(std::clamp(share, 0.0, 1.0) * static_cast<double>(count_)));
  if (wanted >= count_) return largest_;
  std::uint64_t passed = 0;
  for (std::size_t k = 0; k < bins_.size(); ++k) {
    passed += bins_[k];
    if (passed >= std::max<std::uint64_t>(1, wanted)) {
      const int octave = static_cast<int>(k) / PARTS, part = static_cast<int>(k) % PARTS;
      const double middle = std::ldexp(1 + (part + 0.5) / PARTS, octave) * 1e-9;
      return std::min(middle, largest_);
    }
  }
  return largest_;
}

}  // namespace wholehand::device
