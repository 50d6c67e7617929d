// SPDX-License-Identifier: MIT
// Numbers of the SPIR-V specification (sections 2.3, 3.7, 3.20 and 3.32), as far as host/ reads them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace wholehand::host {

constexpr std::uint32_t SPIRV_MAGIC = 0x07230203;
constexpr std::size_t SPIRV_HEADER = 5;  // words before the first instruction
constexpr std::uint32_t DECORATION_SPEC_ID = 1;
constexpr std::uint32_t MODE_LOCAL_SIZE = 17, MODE_LOCAL_SIZE_ID = 38, MODE_KEEPS_SPECIALS = 4461;  // SignedZeroInfNanPreserve
constexpr std::uint32_t CAPABILITY_KEEPS_SPECIALS = 4466;

enum Op : std::uint32_t {
  OpEntryPoint = 15,
  OpExecutionMode = 16,
  OpCapability = 17,
  OpTypeBool = 20,
  OpTypeInt = 21,
  OpTypeFloat = 22,
  OpConstantTrue = 41,
  OpConstantFalse = 42,
  OpConstant = 43,
  OpConstantComposite = 44,
  OpSpecConstantTrue = 48,
  OpSpecConstantFalse = 49,
  OpSpecConstant = 50,
  OpSpecConstantComposite = 51,
  OpFunction = 54,
  OpFunctionEnd = 56,
  OpFunctionCall = 57,
  OpVariable = 59,
  OpLoad = 61,
  OpStore = 62,
  OpCopyMemory = 63,
  OpAccessChain = 65,
  OpInBoundsAccessChain = 66,
  OpPtrAccessChain = 67,
  OpArrayLength = 68,
  OpDecorate = 71,
  OpCopyObject = 83,
  OpExecutionModeId = 331
};

}  // namespace wholehand::host
