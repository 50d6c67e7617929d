// SPDX-License-Identifier: MIT
#include "host/specialize.h"

#include <initializer_list>
#include <optional>

#include "host/spirv_codes.h"

namespace wholehand::host {
namespace {

using Words = std::vector<std::uint32_t>;
using Code = std::span<const std::uint32_t>;  // one instruction

void put(Words& out, Op op, std::initializer_list<std::uint32_t> operands) {
  out.push_back(static_cast<std::uint32_t>(operands.size() + 1) << 16 | op);
  out.insert(out.end(), operands);
}

void put(Words& out, Op op, Code like) {
  out.push_back(static_cast<std::uint32_t>(like.size()) << 16 | op);
  out.insert(out.end(), like.begin() + 1, like.end());
}

// Writes what comes before the functions.
class Specializer {
 public:
  Specializer(const SpecializationBits& bits, const std::array<std::uint32_t, 3>& group_size, Code kept_widths)
      : bits_(bits), group_size_(group_size), kept_widths_(kept_widths) {}

  void put_declaration(Code code, Words& out) {
    const Op op = static_cast<Op>(code[0] & 0xFFFF);
    switch (op) {
      case OpExecutionMode:
      case OpExecutionModeId:
        for (const std::uint32_t width : kept_widths_) put(out, OpExecutionMode, {code[1], MODE_KEEPS_SPECIALS, width});
        kept_widths_ = {};
        if (op == OpExecutionModeId && code[2] == MODE_LOCAL_SIZE_ID)
          return put(out, OpExecutionMode, {code[1], MODE_LOCAL_SIZE, group_size_[0], group_size_[1], group_size_[2]});
        break;
      case OpDecorate:
        if (code[2] != DECORATION_SPEC_ID) break;
        spec_id_[code[1]] = code[3];
        return;
      case OpSpecConstantTrue:
      case OpSpecConstantFalse:
        return put(out, given(code[2]).value_or(op == OpSpecConstantTrue) != 0 ? OpConstantTrue : OpConstantFalse,
                   {code[1], code[2]});
      case OpSpecConstant:
        return put_number(code, out);
      case OpSpecConstantComposite:
        return put(out, OpConstantComposite, code);
      default:
        break;
    }
    out.insert(out.end(), code.begin(), code.end());
  }

 private:
  std::optional<std::uint64_t> given(std::uint32_t id) const {
    const auto spec = spec_id_.find(id);
    if (spec == spec_id_.end()) return std::nullopt;
    const auto bits = bits_.find(spec->second);
    return bits == bits_.end() ? std::nullopt : std::optional(bits->second);
  }

  void put_number(Code code, Words& out) const {
    const std::size_t start = out.size();
    put(out, OpConstant, code);
    if (const auto bits = given(code[2])) {
      out[start + 3] = static_cast<std::uint32_t>(*bits);
      if (code.size() > 4) out[start + 4] = static_cast<std::uint32_t>(*bits >> 32);
    }
  }

  const SpecializationBits& bits_;
  const std::array<std::uint32_t, 3>& group_size_;
  Code kept_widths_;  // still to be declared
  std::map<std::uint32_t, std::uint32_t> spec_id_;
};

}  // namespace

std::vector<std::uint32_t> specialized(std::span<const std::uint32_t> words, const SpecializationBits& bits,
                                       const std::array<std::uint32_t, 3>& group_size, std::span<const std::uint32_t> kept_widths) {
  Words out(words.begin(), words.begin() + SPIRV_HEADER);
  out.reserve(words.size());
  if (!kept_widths.empty()) put(out, OpCapability, {CAPABILITY_KEEPS_SPECIALS});
  Specializer specializer(bits, group_size, kept_widths);
  std::size_t at = SPIRV_HEADER;
  for (; at < words.size() && (words[at] & 0xFFFF) != OpFunction; at += words[at] >> 16)
    specializer.put_declaration(words.subspan(at, words[at] >> 16), out);
  out.insert(out.end(), words.begin() + static_cast<std::ptrdiff_t>(at), words.end());
  return out;
}

}  // namespace wholehand::host
