// SPDX-License-Identifier: MIT
// A shader with its specialization constants given, and without what they switch off.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace wholehand::host {

// Bits of a specialization constant's value by its id: of 32 or 64 bits as the shader declares it, of a boolean 0 or 1.
using SpecializationBits = std::map<std::uint32_t, std::uint64_t>;

// The module with these constants in place of those of its own, and without the blocks that nothing reaches then: a branch upon such a
// constant goes one way. What is computed stays the same to the bit, since no arithmetic of a function is touched. A driver does the same,
// but only after it has translated all of it: half of the work on a large kernel is spared. `words`: a module that
// read_interface takes. Gives the module back as it is where it has something that this does not follow (see the .cpp); its constants are
// then to be given to the driver, which takes them in either case. The group's size becomes numbers, because AMDVLK before 2023-10 reads
// the ids of its constants as the size. For each of `kept_widths` (32, 64) the module declares that NaN, infinities and signed zeros of such reals count: the kernels decide by
// them, and without it a driver may take them for impossible.
std::vector<std::uint32_t> specialized(std::span<const std::uint32_t> words, const SpecializationBits& bits,
                                       std::span<const std::uint32_t> kept_widths = {});

}  // namespace wholehand::host
