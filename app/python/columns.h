// SPDX-License-Identifier: MIT
// Grips as NumPy arrays: six columns of doubles, each with its own stride, read in place.
#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "core/backend.h"
#include "core/result.h"

namespace wholehand {

constexpr std::size_t GRIP_COLUMNS = 6;
extern const std::array<const char*, GRIP_COLUMNS> GRIP_COLUMN_NAMES;  // height .. hand_scale

using GripNumbers = std::array<double, GRIP_COLUMNS>;
GripNumbers grip_columns(const GripInput& grip);

using Doubles = pybind11::array_t<double, 0>;  // strided as given; nothing is converted
using GripArrays = std::array<Doubles, GRIP_COLUMNS>;

// The columns without the interpreter: pointers and strides in bytes, which need not fit a double's alignment. The arrays must outlive it.
class GripColumns {
 public:
  // Throws Error (usage) unless all have one dimension and the same length.
  explicit GripColumns(const GripArrays& arrays);

  std::size_t count() const { return count_; }
  GripInput grip(std::size_t i) const;
  // Throws Error (usage) for the first disallowed number, with its column, its row and what is allowed. Ends early on `stop`, which another thread
  // may set.
  void check(const std::atomic<bool>& stop) const;
  // The rows as a request's grips: grip i of the plan is row i.
  GripSource source() const;

 private:
  struct Column {
    const char* data = nullptr;
    std::ptrdiff_t stride = 0;
  };
  double number(std::size_t column, std::size_t i) const;

  std::array<Column, GRIP_COLUMNS> columns_{};
  std::size_t count_ = 0;
};

// Throws Error (usage) if a grip has a disallowed number. `name` stands for it in the line: "grip 17", "the grip".
void check_grip(const GripInput& grip, const char* name);

}  // namespace wholehand
