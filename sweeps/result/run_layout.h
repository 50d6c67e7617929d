// SPDX-License-Identifier: MIT
// Where the values of a grip lie in a result file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/files/checksum.h"

namespace wholehand::sweeps {

// A variable's block: vessel by vessel, plane by plane, copy by copy, grip by grip.
struct LayoutBlock {
  std::uint64_t offset = 0;  // bytes from the start of the file
  std::uint64_t planes = 1;
  std::uint64_t size = 1;  // bytes a value
  bool operator==(const LayoutBlock&) const = default;
};

struct RunLayout {
  std::uint64_t grips = 0;   // of a vessel, evaluated
  std::uint64_t copies = 1;  // azimuths for which each stands
  std::vector<LayoutBlock> blocks;
  std::optional<std::uint64_t> height;  // offset of the vessels' heights at Sobol points, 8 B each, if their axis has fractions
  std::vector<std::uint64_t> axes;      // offsets of the axes' values at Sobol points, 8 B each, shared by all vessels
  bool operator==(const RunLayout&) const = default;

  // Calls visit(run, range) for each run of grips [first, first + count) that the file stores contiguously: planes of variables, then heights and
  // axes of Sobol points. `run` counts from 0, and means the same for each copy.
  template <class Visit>
  void visit(std::size_t vessel, std::uint64_t first, std::uint64_t count, std::uint64_t copy, const Visit& visit) const {
    std::size_t run = 0;
    for (const LayoutBlock& block : blocks) {
      for (std::uint64_t plane = 0; plane < block.planes; ++plane) {
        const std::uint64_t place = ((vessel * block.planes + plane) * copies + copy) * grips + first;
        visit(run++, FileRange{block.offset + place * block.size, count * block.size});
      }
    }
    if (height) visit(run++, FileRange{*height + (vessel * grips + first) * sizeof(double), count * sizeof(double)});
    if (vessel > 0) return;
    for (const std::uint64_t offset : axes) visit(run++, FileRange{offset + first * sizeof(double), count * sizeof(double)});
  }
};

}  // namespace wholehand::sweeps
