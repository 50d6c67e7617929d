// SPDX-License-Identifier: MIT
#include "host/spirv.h"

#include <algorithm>
#include <set>

#include "base/text/error.h"
#include "host/spirv_codes.h"

namespace wholehand::host {
namespace {

constexpr std::uint32_t GL_COMPUTE = 5, CAPABILITY_FLOAT64 = 10;
constexpr std::uint32_t DECORATION_BINDING = 33, DECORATION_DESCRIPTOR_SET = 34;
constexpr std::uint32_t STORAGE_UNIFORM_CONSTANT = 0, STORAGE_UNIFORM = 2, STORAGE_BUFFER = 12;

// Ids of `code` (one instruction of a function body) that may be a buffer variable.
std::span<const std::uint32_t> pointers(std::uint32_t op, std::span<const std::uint32_t> code) {
  switch (op) {
    case OpLoad:
    case OpAccessChain:
    case OpInBoundsAccessChain:
    case OpPtrAccessChain:
    case OpArrayLength:
    case OpCopyObject:
      return code.subspan(3, 1);
    case OpStore:
      return code.subspan(1, 1);
    case OpCopyMemory:
      return code.subspan(1, 2);
    case OpFunctionCall:
      return code.subspan(4);
    default:
      return {};
  }
}

// The declarations of a module, by result id, and the ids that its functions use.
struct ModuleParts {
  std::map<std::uint32_t, std::uint32_t> binding, set, spec_id, constant;
  std::map<std::uint32_t, ConstantKind> type;
  std::map<std::uint32_t, BindingKind> buffers;  // variables
  std::set<std::uint32_t> used;
  std::array<std::uint32_t, 3> size_result{};
  bool is_compute = false;
};

void read_decoration(std::span<const std::uint32_t> code, ModuleParts& parts) {
  if (code[2] == DECORATION_BINDING) {
    parts.binding[code[1]] = code[3];
  } else if (code[2] == DECORATION_DESCRIPTOR_SET) {
    parts.set[code[1]] = code[3];
  } else if (code[2] == DECORATION_SPEC_ID) {
    parts.spec_id[code[1]] = code[3];
  }
}

void read_variable(std::span<const std::uint32_t> code, ModuleParts& parts) {
  if (code[3] == STORAGE_UNIFORM || code[3] == STORAGE_BUFFER || code[3] == STORAGE_UNIFORM_CONSTANT) {
    parts.buffers[code[2]] = code[3] == STORAGE_UNIFORM  ? BindingKind::uniform
                             : code[3] == STORAGE_BUFFER ? BindingKind::storage
                                                         : BindingKind::texels;
  }
}

// One instruction outside of functions.
void read_instruction(std::uint32_t op, std::span<const std::uint32_t> code, ModuleParts& parts, ShaderInterface& result) {
  switch (op) {
    case OpEntryPoint:
      parts.is_compute |= code[1] == GL_COMPUTE;
      break;
    case OpCapability:
      result.float64 |= code[1] == CAPABILITY_FLOAT64;
      break;
    case OpExecutionMode:
      if (code[2] == MODE_LOCAL_SIZE) {
        std::copy_n(code.begin() + 3, 3, result.group_size.begin());
      }
      break;
    case OpExecutionModeId:
      if (code[2] == MODE_LOCAL_SIZE_ID) {
        std::copy_n(code.begin() + 3, 3, parts.size_result.begin());
      }
      break;
    case OpDecorate:
      read_decoration(code, parts);
      break;
    case OpTypeBool:
      parts.type[code[1]] = ConstantKind::boolean;
      break;
    case OpTypeInt:
      parts.type[code[1]] = code[3] ? ConstantKind::int32 : ConstantKind::uint32;
      break;
    case OpTypeFloat:
      parts.type[code[1]] = code[2] == 64 ? ConstantKind::float64 : ConstantKind::float32;
      break;
    case OpConstant:
    case OpSpecConstant:
      parts.constant[code[2]] = code[3];
      [[fallthrough]];
    case OpSpecConstantTrue:
    case OpSpecConstantFalse:
      if (const auto id = parts.spec_id.find(code[2]); id != parts.spec_id.end()) {
        result.constants[id->second] = parts.type.at(code[1]);
      }
      break;
    case OpVariable:
      read_variable(code, parts);
      break;
    default:
      break;
  }
}

void set_group_size(const ModuleParts& parts, ShaderInterface& result) {
  for (std::size_t axis = 0; axis < 3; axis++) {
    if (const std::uint32_t id = parts.size_result[axis]; id != 0) {
      result.group_size[axis] = parts.constant.at(id);
      const auto spec = parts.spec_id.find(id);
      result.group_size_id[axis] = spec != parts.spec_id.end() ? spec->second : ShaderInterface::NO_ID;
    }
  }
}

}  // namespace

ShaderInterface read_interface(std::span<const std::uint32_t> words, const std::string& name) {
  const auto broken = [&](const char* what) { return failure_error("shader " + name + ": " + what + "; rebuild the program"); };
  if (words.size() < SPIRV_HEADER || words[0] != SPIRV_MAGIC) {
    throw broken("no SPIR-V");
  }
  ShaderInterface result;
  ModuleParts parts;
  bool in_function = false;
  std::uint32_t last = 0;
  for (std::size_t at = SPIRV_HEADER; at < words.size();) {
    const std::uint32_t op = words[at] & 0xFFFF, length = words[at] >> 16;
    if (length == 0 || at + length > words.size()) {
      throw broken("damaged SPIR-V");
    }
    const auto code = words.subspan(at, length);
    at += length;
    last = op;
    in_function |= op == OpFunction;
    if (in_function) {
      for (const std::uint32_t id : pointers(op, code)) {
        parts.used.insert(id);
      }
    } else {
      read_instruction(op, code, parts, result);
    }
  }
  if (!parts.is_compute || last != OpFunctionEnd) {
    throw broken(parts.is_compute ? "damaged SPIR-V" : "no compute shader");
  }
  for (const auto& [id, kind] : parts.buffers) {
    if (parts.used.contains(id)) {
      if (parts.set[id] != 0 || !parts.binding.contains(id)) {
        throw broken("a buffer that is not in set 0");
      }
      result.bindings.push_back({parts.binding[id], kind});
    }
  }
  std::ranges::sort(result.bindings, {}, &ShaderBinding::binding);
  set_group_size(parts, result);
  return result;
}

}  // namespace wholehand::host
