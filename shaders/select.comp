// SPDX-License-Identifier: MIT
// Finds the best of many grips without reading back all scores: each invocation keeps the push.number best of up to SELECT_ENTRIES grips and passes
// them on; the host dispatches again over these until one invocation is left. Higher scores come first, then the lower index, so that the answer does
// not depend on how grips were distributed. push.first is one of SELECT_*: from the scores, or from one half of the candidates into the other.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "grips.glsl"

layout(std430, binding = BINDING_CANDIDATES) buffer CandidateBlock { Real candidate_scores[]; };
layout(std430, binding = BINDING_INDICES) buffer IndexBlock { uint candidate_indices[]; };

bool comes_first(Real score_a, uint index_a, Real score_b, uint index_b) {
  return score_a > score_b || (score_a == score_b && index_a < index_b);
}

void main() {
  uint block = INVOCATION;
  uint blocks = (push.count + SELECT_ENTRIES - 1u) / SELECT_ENTRIES;
  if (block >= blocks) return;
  bool from_scores = push.first == SELECT_SCORES_TO_FIRST || push.first == SELECT_SCORES_TO_SECOND;
  uint middle = uint(candidate_scores.length()) / 2u;
  uint from = push.first == SELECT_SECOND_TO_FIRST ? middle : 0u;
  uint to = push.first == SELECT_FIRST_TO_SECOND || push.first == SELECT_SCORES_TO_SECOND ? middle : 0u;
  // a score must exceed push.floor_*, the worst of the best so far, to matter; -1 stands for none, since every score is at least 0
  Real floor_score = push_floor();
  // keeps the ordered list in the output; few entries ever enter it, so shifting is cheaper than sorting with neighbors
  uint list = to + block * push.number, last = list + push.number - 1u;
  for (uint i = list; i <= last; ++i) {
    candidate_scores[i] = Real(-1);
    candidate_indices[i] = 0xffffffffu;
  }
  Real last_score = floor_score;
  uint last_index = 0u;
  // neighbors take neighboring entries
  for (uint entry = block; entry < push.count; entry += blocks) {
    Real score = from_scores ? real_out[uint(PLANE_SCORE) * push.stride + entry] : candidate_scores[from + entry];
    if (score < last_score) continue;
    uint index = entry;
    if (from_scores) {
      uint status = status_of(entry);
      if (!is_eligible(status)) continue;
    } else {
      index = candidate_indices[from + entry];
    }
    if (!comes_first(score, index, last_score, last_index)) continue;
    uint place = last;
    while (place > list && comes_first(score, index, candidate_scores[place - 1u], candidate_indices[place - 1u])) {
      candidate_scores[place] = candidate_scores[place - 1u];
      candidate_indices[place] = candidate_indices[place - 1u];
      --place;
    }
    candidate_scores[place] = score;
    candidate_indices[place] = index;
    if (candidate_scores[last] >= floor_score && candidate_indices[last] != 0xffffffffu) {
      last_score = candidate_scores[last];
      last_index = candidate_indices[last];
    }
  }
}
