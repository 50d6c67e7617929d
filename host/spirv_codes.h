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
  OpNop = 0,
  OpName = 5,
  OpLine = 8,
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
  OpSpecConstantOp = 52,
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
  OpImageWrite = 99,
  OpIAdd = 128,
  OpISub = 130,
  OpIMul = 132,
  OpLogicalEqual = 164,
  OpLogicalNotEqual = 165,
  OpLogicalOr = 166,
  OpLogicalAnd = 167,
  OpLogicalNot = 168,
  OpSelect = 169,
  OpIEqual = 170,
  OpINotEqual = 171,
  OpSGreaterThan = 173,
  OpSGreaterThanEqual = 175,
  OpSLessThan = 177,
  OpSLessThanEqual = 179,
  OpControlBarrier = 224,
  OpMemoryBarrier = 225,
  OpAtomicStore = 228,
  OpPhi = 245,
  OpLoopMerge = 246,
  OpSelectionMerge = 247,
  OpLabel = 248,
  OpBranch = 249,
  OpBranchConditional = 250,
  OpSwitch = 251,
  OpKill = 252,
  OpReturn = 253,
  OpReturnValue = 254,
  OpUnreachable = 255,
  OpNoLine = 317,
  OpExecutionModeId = 331
};

}  // namespace wholehand::host
