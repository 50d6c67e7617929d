// SPDX-License-Identifier: MIT
// A line of text that a signal handler may build: no allocation, no locale, no unsafe library call.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace wholehand::device {

// Text that does not fit is dropped.
class SafeLine {
 public:
  SafeLine& add(std::string_view text) noexcept {
    for (const char letter : text)
      if (size_ < text_.size()) text_[size_++] = letter;
    return *this;
  }

  // A number of up to `decimals` decimals, without trailing zeros; 2^53 and more as "many", NaN as "nan".
  SafeLine& add(double number, int decimals) noexcept {
    if (number != number) return add("nan");
    if (number < 0) return add("-").add(-number, decimals);
    std::uint64_t unit = 1;
    for (int k = 0; k < decimals; ++k) unit *= 10;
    if (number * static_cast<double>(unit) >= 0x1p53) return add("many");
    auto scaled = static_cast<std::uint64_t>(std::llround(number * static_cast<double>(unit)));
    whole(scaled / unit);
    scaled %= unit;
    if (scaled == 0) return *this;
    add(".");
    while (scaled > 0) {
      unit /= 10;
      digit(scaled / unit);
      scaled %= unit;
    }
    return *this;
  }

  std::string_view text() const noexcept { return {text_.data(), size_}; }

 private:
  void digit(std::uint64_t value) noexcept {
    const char letter = static_cast<char>('0' + value);
    add(std::string_view(&letter, 1));
  }
  void whole(std::uint64_t value) noexcept {
    std::array<char, 20> digits{};
    std::size_t at = digits.size();
    do {
      digits[--at] = static_cast<char>('0' + value % 10);
      value /= 10;
    } while (value > 0);
    add(std::string_view(digits.data() + at, digits.size() - at));
  }

  std::array<char, 640> text_{};
  std::size_t size_ = 0;
};

}  // namespace wholehand::device
