// SPDX-License-Identifier: MIT
// Bytes of a fuzzer as choices and numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/reader/ranges.h"

namespace wholehand {

// Bytes as choices and numbers; past their end all are 0.
class Choices {
 public:
  Choices(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  int of(int count) { return byte() % count; }
  bool yes() { return of(2) == 1; }

  double share() { return (byte() + 256.0 * byte()) / 65535; }

  // A number of the range: a share of it, an end, one beside one that was, or eight bytes as they stand.
  double in(const Quantity& range) {
    static constexpr double NUDGES[] = {0, 1e-17, -1e-12, 1e-9, -1e-6, 1e-3, 5e-324, 1e-300};
    double value = 0;
    switch (of(6)) {
      case 0:
        value = range.low;
        break;
      case 1:
        value = range.high;
        break;
      case 2:
        value = numbers_[of(KEPT)] * (yes() ? 1 : -1) + NUDGES[of(8)];
        break;
      case 3: {
        std::uint8_t bytes[sizeof value];
        for (std::uint8_t& b : bytes) b = byte();
        std::memcpy(&value, bytes, sizeof value);
        break;
      }
      default:
        value = range.low + share() * (range.high - range.low);
    }
    value = std::isfinite(value) ? std::clamp(value, range.low, range.high) : range.low;
    return keep(value);
  }

  // One that later numbers may be equal or near to.
  double keep(double value) { return numbers_[next_++ % KEPT] = value; }

 private:
  static constexpr int KEPT = 16;
  std::uint8_t byte() { return at_ < size_ ? data_[at_++] : 0; }

  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
  double numbers_[KEPT] = {};
  std::size_t next_ = 0;
};

}  // namespace wholehand
