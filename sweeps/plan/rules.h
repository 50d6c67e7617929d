// SPDX-License-Identifier: MIT
// The rules by which a sweep scores and lists grips. Scores of two sweeps are comparable only if these are equal.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "core/scene.h"

namespace wholehand::sweeps {

struct Rule {
  const char* name;
  std::string text;
};

enum RulePlace : std::size_t {
  RULE_HAND,
  RULE_STRENGTH,
  RULE_ARM,
  RULE_FORCE,
  RULE_STATES,
  RULE_WEIGHTS,
  RULE_GATE,
  RULE_ROBUST,
  RULE_COUNT
};

// The rules of a scene by RulePlace, in words; a result stores them in its attribute `rules`.
std::array<Rule, RULE_COUNT> scene_rules(const Scene& scene);

// Their names, with commas between.
std::string rule_names();

// Which of them two scenes share, even if the words do not show it.
std::array<bool, RULE_COUNT> shared_rules(const Scene& a, const Scene& b);

// Weights of the score's terms, without those of weight 0: "depth 0.69, force 0.13".
std::string weights_text(const Scene& scene);

}  // namespace wholehand::sweeps
