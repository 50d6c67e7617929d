// SPDX-License-Identifier: MIT
#include "app/python/columns.h"

#include <fmt/format.h>

#include <cstring>

#include "base/text/error.h"
#include "core/reader/ranges.h"

namespace wholehand {
namespace {

// What a scene's [grips] may contain, in SI. An angle of 360 degrees may be rounded up when converted to radians.
struct Range {
  double low, high;
  const char* unit;
};
constexpr double ROUNDING = 1e-12;

std::array<Range, GRIP_COLUMNS> make_ranges() {
  const auto range = [](const Quantity& quantity, const char* unit) {
    return Range{to_si(quantity.low, quantity.unit), to_si(quantity.high, quantity.unit), unit};
  };
  return {range(ranges::GRIP_HEIGHT, " m"), range(ranges::ROTATION, " rad"), range(ranges::OBLIQUITY, " rad"),
          range(ranges::ROTATION, " rad"),  range(ranges::OFFSET, " m"),     range(ranges::SCALE, "")};
}

const std::array<Range, GRIP_COLUMNS>& grip_ranges() {
  static const std::array<Range, GRIP_COLUMNS> RANGES = make_ranges();
  return RANGES;
}

// Written so that a NaN is out of range.
bool is_within(double value, const Range& range) {
  return value >= range.low * (1 + (range.low < 0 ? ROUNDING : -ROUNDING)) && value <= range.high * (1 + ROUNDING);
}

}  // namespace

const std::array<const char*, GRIP_COLUMNS> GRIP_COLUMN_NAMES{"height", "azimuth", "obliquity", "roll", "offset", "hand_scale"};

GripNumbers grip_columns(const GripInput& grip) {
  return {grip.height, grip.azimuth, grip.obliquity, grip.roll, grip.offset, grip.hand_scale};
}

GripColumns::GripColumns(const GripArrays& arrays) {
  for (std::size_t c = 0; c < GRIP_COLUMNS; ++c) {
    if (arrays[c].ndim() != 1)
      throw usage_error(
          fmt::format("grips: the column {} has {} dimensions; allowed: one", GRIP_COLUMN_NAMES[c], arrays[c].ndim()));
    const auto length = static_cast<std::size_t>(arrays[c].shape(0));
    if (c == 0) count_ = length;
    if (length != count_)
      throw usage_error(fmt::format("grips: the column {} has {} numbers and height has {}; allowed: as many", GRIP_COLUMN_NAMES[c],
                                    length, count_));
    columns_[c] = {reinterpret_cast<const char*>(arrays[c].data()), arrays[c].strides(0)};
  }
}

double GripColumns::number(std::size_t column, std::size_t i) const {
  double value = 0;
  std::memcpy(&value, columns_[column].data + static_cast<std::ptrdiff_t>(i) * columns_[column].stride, sizeof value);
  return value;
}

GripInput GripColumns::grip(std::size_t i) const {
  return {number(0, i), number(1, i), number(2, i), number(3, i), number(4, i), number(5, i)};
}

void GripColumns::check(const std::atomic<bool>& stop) const {
  for (std::size_t i = 0; i < count_ && !stop; ++i)
    for (std::size_t c = 0; c < GRIP_COLUMNS; ++c)
      if (!is_within(number(c, i), grip_ranges()[c])) check_grip(grip(i), fmt::format("grip {}", i).c_str());
}

GripSource GripColumns::source() const {
  return [this](std::size_t, std::uint64_t first, std::size_t count, GripInput* out) {
    for (std::size_t i = 0; i < count; ++i) out[i] = grip(static_cast<std::size_t>(first) + i);
  };
}

void check_grip(const GripInput& grip, const char* name) {
  const GripNumbers numbers = grip_columns(grip);
  for (std::size_t c = 0; c < GRIP_COLUMNS; ++c) {
    const Range& range = grip_ranges()[c];
    if (!is_within(numbers[c], range))
      throw usage_error(fmt::format("grips: the {} of {} is {:.6g}; allowed: a number, {:.6g} to {:.6g}{}", GRIP_COLUMN_NAMES[c],
                                    name, numbers[c], range.low, range.high, range.unit));
  }
}

}  // namespace wholehand
