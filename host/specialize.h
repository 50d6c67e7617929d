// SPDX-License-Identifier: MIT
// A shader as a device gets it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace wholehand::host {

// Bits of a specialization constant's value by its id: of 32 or 64 bits as the shader declares it, of a boolean 0 or 1.
using SpecializationBits = std::map<std::uint32_t, std::uint64_t>;

// The module with numbers in place of its specialization constants (those without bits keep their defaults) and of its group size, which must agree
// with the bits: AMDVLK before
// 2023-10 reads the ids of the constants as the size. For each of `kept_widths` (32, 64) it declares SignedZeroInfNanPreserve: the kernels decide by
// NaN and infinity, which a driver may otherwise take for impossible. `words`: a module that read_interface takes.
std::vector<std::uint32_t> specialized(std::span<const std::uint32_t> words, const SpecializationBits& bits,
                                       const std::array<std::uint32_t, 3>& group_size,
                                       std::span<const std::uint32_t> kept_widths = {});

}  // namespace wholehand::host
