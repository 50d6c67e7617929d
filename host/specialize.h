// SPDX-License-Identifier: MIT
// Turns a shader into what the device gets.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace wholehand::host {

// A specialization constant's value as bits, by id: 32 or 64 bits as the shader declares it; 0 or 1 for a boolean.
using SpecializationBits = std::map<std::uint32_t, std::uint64_t>;

// The module with numbers in place of its specialization constants (those without bits keep their defaults) and of its group size, which must agree
// with the bits: AMDVLK before 2023-10 takes the constants' ids for the size. For each of `kept_widths` (32, 64) it declares
// SignedZeroInfNanPreserve: the kernels decide by NaN and infinity, which a driver may otherwise assume absent. `words`: a module that read_interface
// accepts.
std::vector<std::uint32_t> specialized(std::span<const std::uint32_t> words, const SpecializationBits& bits,
                                       const std::array<std::uint32_t, 3>& group_size,
                                       std::span<const std::uint32_t> kept_widths = {});

}  // namespace wholehand::host
