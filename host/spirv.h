// SPDX-License-Identifier: MIT
// Reads a compute shader's interface from its SPIR-V: the bindings it uses, its specialization constants and its group size.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace wholehand::host {

enum class BindingKind { storage, uniform, texels };  // texels: a uniform texel buffer of uint

struct ShaderBinding {
  std::uint32_t binding = 0;
  BindingKind kind = BindingKind::storage;
};

enum class ConstantKind { boolean, int32, uint32, float32, float64 };

struct ShaderInterface {
  std::vector<ShaderBinding> bindings;              // of set 0, used by a function of the shader, ascending
  std::map<std::uint32_t, ConstantKind> constants;  // by specialization constant id
  bool float64 = false;                             // computes in double
  // group size: if the id is not NO_ID, the value is only the default of that specialization constant
  static constexpr std::uint32_t NO_ID = ~0u;
  std::array<std::uint32_t, 3> group_size{1, 1, 1};
  std::array<std::uint32_t, 3> group_size_id{NO_ID, NO_ID, NO_ID};
};

// Throws Error, naming the shader, if the words are not a compute shader or use a set other than 0.
ShaderInterface read_interface(std::span<const std::uint32_t> words, const std::string& name);

}  // namespace wholehand::host
