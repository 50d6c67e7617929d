// SPDX-License-Identifier: MIT
#include "host/specialize.h"

#include <algorithm>
#include <optional>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "host/spirv_codes.h"

namespace wholehand::host {
namespace {

using Words = std::vector<std::uint32_t>;
using Code = std::span<const std::uint32_t>;  // one instruction

Op op_of(Code code) { return static_cast<Op>(code[0] & 0xFFFF); }

void put(Words& out, Op op, std::initializer_list<std::uint32_t> operands) {
  out.push_back(static_cast<std::uint32_t>(operands.size() + 1) << 16 | op);
  out.insert(out.end(), operands);
}

void put(Words& out, Op op, Code like) {
  out.push_back(static_cast<std::uint32_t>(like.size()) << 16 | op);
  out.insert(out.end(), like.begin() + 1, like.end());
}

bool ends_block(Op op) { return op >= OpBranch && op <= OpUnreachable; }

// Where a terminator may go. Between the labels of a switch are literals as wide as its selector: one word, as no module with wider integers
// is followed. A literal taken for a label would keep a block without those that it takes values from.
Words targets(Code code) {
  switch (op_of(code)) {
    case OpBranch:
      return {code[1]};
    case OpBranchConditional:
      return {code[2], code[3]};
    case OpSwitch: {
      Words labels;
      for (std::size_t k = 2; k < code.size(); k += 2) labels.push_back(code[k]);
      return labels;
    }
    default:
      return {};
  }
}

struct Block {
  std::uint32_t label = 0;
  std::vector<Code> code;  // after the label, without a merge that is dropped; the last ends the block
  Code merge;              // the instruction that declares its merge, if any
  Words jump;              // in place of the last, where a constant decides
  bool reached = false;    // from the function's start
  bool declared = false;   // as the merge of a block that is reached

  Code end() const { return jump.empty() ? code.back() : Code(jump); }
};

// What is known of a module: numbers and truth of its constants of 32 bits and of booleans.
class Specializer {
 public:
  Specializer(Code words, const SpecializationBits& bits, Code kept_widths)
      : words_(words), bits_(bits), kept_widths_(kept_widths) {}

  // False where it meets what it does not follow.
  bool run(Words& out) {
    std::vector<Code> body;
    out.assign(words_.begin(), words_.begin() + SPIRV_HEADER);
    out.reserve(words_.size());
    if (!kept_widths_.empty()) put(out, OpCapability, {CAPABILITY_KEEPS_SPECIALS});
    for (std::size_t at = SPIRV_HEADER; at < words_.size();) {
      const Code code = words_.subspan(at, words_[at] >> 16);
      at += code.size();
      const Op op = op_of(code);
      if (!body.empty() || op == OpFunction) {
        body.push_back(code);
        if (op != OpFunctionEnd) continue;
        if (!put_function(body, out)) return false;
        body.clear();
      } else {
        if (op == OpTypeInt && code[2] > 32) return false;
        put_declaration(code, out);
      }
    }
    set_group_size(out);
    drop_words_on_what_is_gone(out);
    return true;
  }

 private:
  void put_declaration(Code code, Words& out) {
    switch (op_of(code)) {
      case OpExecutionMode:
      case OpExecutionModeId:
        for (const std::uint32_t width : kept_widths_) put(out, OpExecutionMode, {code[1], MODE_KEEPS_SPECIALS, width});
        kept_widths_ = {};
        if (op_of(code) == OpExecutionModeId && code[2] == MODE_LOCAL_SIZE_ID) size_at_ = out.size();
        break;
      case OpDecorate:
        if (code[2] != DECORATION_SPEC_ID) break;
        spec_id_[code[1]] = code[3];
        return;
      case OpTypeInt:
        if (code[2] == 32) small_.insert(code[1]);
        break;
      case OpConstantTrue:
      case OpConstantFalse:
        value_[code[2]] = op_of(code) == OpConstantTrue;
        break;
      case OpConstant:
        if (small_.contains(code[1])) value_[code[2]] = code[3];
        break;
      case OpSpecConstantTrue:
      case OpSpecConstantFalse:
        return put_truth(code, given(code[2]).value_or(op_of(code) == OpSpecConstantTrue) != 0, out);
      case OpSpecConstant:
        return put_number(code, out);
      case OpSpecConstantComposite:
        return put(out, OpConstantComposite, code);
      case OpSpecConstantOp:
        return put_operation(code, out);
      default:
        break;
    }
    out.insert(out.end(), code.begin(), code.end());
  }

  void set_group_size(Words& out) const {
    if (size_at_ == 0) return;
    const std::span size(out.data() + size_at_, 6);
    if (!std::ranges::all_of(size.last(3), [&](std::uint32_t id) { return value_.contains(id); })) return;
    size[0] = 6 << 16 | OpExecutionMode;
    size[2] = MODE_LOCAL_SIZE;
    for (std::uint32_t& axis : size.last(3)) axis = value_.at(axis);
  }

  std::optional<std::uint64_t> given(std::uint32_t id) const {
    const auto spec = spec_id_.find(id);
    if (spec == spec_id_.end()) return std::nullopt;
    const auto bits = bits_.find(spec->second);
    return bits == bits_.end() ? std::nullopt : std::optional(bits->second);
  }

  void put_truth(Code code, bool value, Words& out) {
    value_[code[2]] = value;
    put(out, value ? OpConstantTrue : OpConstantFalse, {code[1], code[2]});
  }

  void put_number(Code code, Words& out) {
    const std::size_t start = out.size();
    put(out, OpConstant, code);
    if (const auto bits = given(code[2])) {
      out[start + 3] = static_cast<std::uint32_t>(*bits);
      if (code.size() > 4) out[start + 4] = static_cast<std::uint32_t>(*bits >> 32);
    }
    if (small_.contains(code[1])) value_[code[2]] = out[start + 3];
  }

  // An operation upon constants; one that is not followed stays, and the driver computes it.
  void put_operation(Code code, Words& out) {
    const auto value = result(static_cast<Op>(code[3]), code.subspan(4));
    if (!value) {
      out.insert(out.end(), code.begin(), code.end());
    } else if (small_.contains(code[1])) {
      value_[code[2]] = *value;
      put(out, OpConstant, {code[1], code[2], *value});
    } else {
      put_truth(code, *value != 0, out);
    }
  }

  std::optional<std::uint32_t> result(Op op, Code operands) const {
    std::vector<std::uint32_t> v;
    for (const std::uint32_t id : operands) {
      const auto known = value_.find(id);
      if (known == value_.end()) return std::nullopt;
      v.push_back(known->second);
    }
    if (v.size() == 3 && op == OpSelect) return v[0] ? v[1] : v[2];
    if (v.size() == 1 && op == OpLogicalNot) return !v[0];
    return v.size() == 2 ? of_two(op, v[0], v[1]) : std::nullopt;
  }

  static std::optional<std::uint32_t> of_two(Op op, std::uint32_t a, std::uint32_t b) {
    const auto x = static_cast<std::int32_t>(a), y = static_cast<std::int32_t>(b);
    switch (op) {
      case OpIAdd:
        return a + b;
      case OpISub:
        return a - b;
      case OpIMul:
        return a * b;
      case OpLogicalEqual:
      case OpIEqual:
        return a == b;
      case OpLogicalNotEqual:
      case OpINotEqual:
        return a != b;
      case OpLogicalOr:
        return a | b;
      case OpLogicalAnd:
        return a & b;
      case OpSGreaterThan:
        return x > y;
      case OpSGreaterThanEqual:
        return x >= y;
      case OpSLessThan:
        return x < y;
      case OpSLessThanEqual:
        return x <= y;
      default:
        return std::nullopt;
    }
  }

  bool put_function(const std::vector<Code>& body, Words& out) {
    std::vector<Block> blocks;
    std::size_t at = 0;
    for (; at < body.size() && op_of(body[at]) != OpLabel; ++at) out.insert(out.end(), body[at].begin(), body[at].end());
    if (!split(std::span(body).subspan(at), blocks)) return false;
    if (!blocks.empty() && !mark_reached(blocks)) return false;
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const Block& block : blocks) {
      if (!block.reached) continue;
      for (const std::uint32_t target : targets(block.end())) edges.emplace(block.label, target);
    }
    for (const Block& block : blocks) {
      if (!block.reached) forget(block);
      put_block(block, edges, out);
    }
    put(out, OpFunctionEnd, {});
    return true;
  }

  bool split(std::span<const Code> body, std::vector<Block>& blocks) const {
    for (const Code code : body) {
      const Op op = op_of(code);
      if (op == OpLabel) {
        blocks.push_back({code[1], {}, {}, {}, false, false});
      } else if (op == OpSelectionMerge || op == OpLoopMerge) {
        blocks.back().merge = code;
      } else if (op != OpFunctionEnd) {
        blocks.back().code.push_back(code);
        if (ends_block(op)) decide(blocks.back());
      }
    }
    return std::ranges::all_of(blocks,
                               [](const Block& block) { return !block.code.empty() && ends_block(op_of(block.code.back())); });
  }

  // A selection whose condition is known is none. A loop's head keeps its branch.
  void decide(Block& block) const {
    const Code end = block.code.back();
    if (op_of(end) != OpBranchConditional || (!block.merge.empty() && op_of(block.merge) == OpLoopMerge)) return;
    const auto condition = value_.find(end[1]);
    if (condition == value_.end()) return;
    put(block.jump, OpBranch, {condition->second ? end[2] : end[3]});
    block.merge = {};
  }

  // A loop whose end nothing reaches, or from whose end nothing goes back, is not followed: its head would wait for it.
  static bool mark_reached(std::vector<Block>& blocks) {
    std::unordered_map<std::uint32_t, std::size_t> place;
    for (std::size_t i = 0; i < blocks.size(); ++i) place[blocks[i].label] = i;
    reach(blocks, place);
    const std::unordered_set<std::uint32_t> repeated = repeated_heads(blocks, place);
    for (const Block& block : blocks) {
      if (!block.reached || block.merge.empty()) continue;
      blocks[place.at(block.merge[1])].declared = true;
      if (op_of(block.merge) != OpLoopMerge) continue;
      if (!blocks[place.at(block.merge[2])].reached || !repeated.contains(block.label)) return false;
    }
    return true;
  }

  static void reach(std::vector<Block>& blocks, const std::unordered_map<std::uint32_t, std::size_t>& place) {
    std::vector<std::size_t> waiting{0};
    blocks[0].reached = true;
    while (!waiting.empty()) {
      const Block& block = blocks[waiting.back()];
      waiting.pop_back();
      for (const std::uint32_t target : targets(block.end())) {
        const auto to = place.find(target);
        if (to == place.end() || blocks[to->second].reached) continue;
        blocks[to->second].reached = true;
        waiting.push_back(to->second);
      }
    }
  }

  // Blocks to which a later one, or they themselves, go: blocks stand after those that dominate them, so this is the way back of a loop.
  static std::unordered_set<std::uint32_t> repeated_heads(const std::vector<Block>& blocks,
                                                          const std::unordered_map<std::uint32_t, std::size_t>& place) {
    std::unordered_set<std::uint32_t> heads;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      if (!blocks[i].reached) continue;
      for (const std::uint32_t target : targets(blocks[i].end())) {
        const auto to = place.find(target);
        if (to != place.end() && to->second <= i) heads.insert(target);
      }
    }
    return heads;
  }

  static void put_block(const Block& block, const std::set<std::pair<std::uint32_t, std::uint32_t>>& edges, Words& out) {
    if (!block.reached && !block.declared) return;
    put(out, OpLabel, {block.label});
    if (!block.reached) return put(out, OpUnreachable, {});
    for (const Code code : std::span(block.code).first(block.code.size() - 1)) {
      if (op_of(code) == OpPhi) {
        put_phi(code, block.label, edges, out);
      } else {
        out.insert(out.end(), code.begin(), code.end());
      }
    }
    out.insert(out.end(), block.merge.begin(), block.merge.end());
    const Code end = block.end();
    out.insert(out.end(), end.begin(), end.end());
  }

  // Without the values from blocks that no longer come here.
  static void put_phi(Code code, std::uint32_t label, const std::set<std::pair<std::uint32_t, std::uint32_t>>& edges, Words& out) {
    const std::size_t start = out.size();
    out.insert(out.end(), code.begin(), code.begin() + 3);
    for (std::size_t k = 3; k + 1 < code.size(); k += 2)
      if (edges.contains({code[k + 1], label})) out.insert(out.end(), {code[k], code[k + 1]});
    out[start] = static_cast<std::uint32_t>(out.size() - start) << 16 | OpPhi;
  }

  void forget(const Block& block) {
    if (!block.declared) gone_.insert(block.label);
    for (const Code code : block.code)
      if (has_result(op_of(code))) gone_.insert(code[2]);
  }

  static bool has_result(Op op) {
    constexpr Op WITHOUT[] = {OpNop,        OpLine,           OpNoLine,        OpStore,      OpCopyMemory,
                              OpImageWrite, OpControlBarrier, OpMemoryBarrier, OpAtomicStore};
    return !ends_block(op) && std::ranges::find(WITHOUT, op) == std::end(WITHOUT);
  }

  // Names and decorations may only be of what is there.
  void drop_words_on_what_is_gone(Words& module) const {
    Words kept(module.begin(), module.begin() + SPIRV_HEADER);
    kept.reserve(module.size());
    for (std::size_t at = SPIRV_HEADER; at < module.size();) {
      const Code code = Code(module).subspan(at, module[at] >> 16);
      at += code.size();
      const bool is_about = op_of(code) == OpName || op_of(code) == OpDecorate;
      if (!is_about || !gone_.contains(code[1])) kept.insert(kept.end(), code.begin(), code.end());
    }
    module = std::move(kept);
  }

  Code words_;
  const SpecializationBits& bits_;
  Code kept_widths_;         // still to be declared
  std::size_t size_at_ = 0;  // place of the instruction with the ids of the group's size; 0: there is none
  std::unordered_map<std::uint32_t, std::uint32_t> spec_id_, value_;
  std::unordered_set<std::uint32_t> small_;  // types of integers of 32 bits
  std::unordered_set<std::uint32_t> gone_;   // results that were left out
};

}  // namespace

std::vector<std::uint32_t> specialized(std::span<const std::uint32_t> words, const SpecializationBits& bits,
                                       std::span<const std::uint32_t> kept_widths) {
  Words out;
  return Specializer(words, bits, kept_widths).run(out) ? out : Words(words.begin(), words.end());
}

}  // namespace wholehand::host
